//! Best design for an environment: the values of some fields that maximise a result.
//!
//! Results of a mass with stops are discontinuous functions of the design (a small change may bring the mass
//! to rest) and have isolated windows, so gradients are not used. The whole range is scanned first, coarsely
//! and then finely; then the scan is repeated in ever smaller boxes around the best designs. A maximum that
//! is narrower than the step of the scan may be missed.

mod chart;
mod design;
mod evaluate;
mod kept;
mod plan;
mod search;
mod seeds;
mod varied;
mod words;

use std::path::PathBuf;

use crate::questions::{Error, Progress, Simulation, check_until, drive_alone};
use crate::scene::{Axis, Document, FieldPath, RunSettings, Transducer, find_name, is_whole, read_number};
use crate::study::{Read, SUMMARY_FIELDS, SummaryField, Table, named};
use crate::sweep::{can_vary, deviation};
use crate::system::files::{canonical, is_file};
pub use chart::best_chart;
pub use design::{
    BestDesign, BestQuestion, Constraint, DesignRange, Environment, NoBest, Optimum, Spread, Tolerance,
    Tried, best,
};
use design::{INTERVALS, MOST_FIELDS, scan_places};
pub use evaluate::{DesignRun, Memory, Results};
use kept::Kept;
pub use seeds::Seeds;
use varied::SAMPLES;
pub use words::{names, place, quantity};

/// The best design for an environment: the values of one to four fields that maximise a result of the run.
///
/// Fields and constraints are written as in the arguments of the command `best`. [`BestAnswer::table`] has
/// one row: the fields, `maximised`, `value` (the mean over the environments), `margin_low` and `margin_high`
/// of each field in its unit, `worst` and `quantile_5` of the samples, and where it is safer to step back to.
///
/// # Method
///
/// Results are discontinuous functions of the design, so no gradients are used. The whole range is
/// scanned (by default 256, 32, 12 or 8 intervals per field for one to four fields) and the scan is repeated
/// in smaller and smaller boxes around the best places. A maximum narrower than a step may be missed: a
/// smaller step (`FIELD=A:B:STEP`) costs more runs, the more the more fields there are. `vary` adds 200
/// random samples to the answer, and each environment adds a run at each place.
///
/// # Errors
///
/// [`Error::Argument`] for a text that cannot be read, a field that an environment lacks, constraints
/// that no place in the range keeps (the nearest one is named), or a result that no run has; [`Error::Scene`]
/// for a scene with faults; [`Error::Unfit`] for a result of a transducer that the scene lacks.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Best, Progress, Simulation};
///
/// // The RMS velocity rises with the travel limit, so the constraint on the travel decides.
/// let question = Best {
///     over: vec!["stops.travel_limit_mm=1:6:0.5".to_owned()],
///     subject_to: vec!["max_abs_x_m<=0.003".to_owned()],
///     ..Best::default()
/// };
/// let best = question.run(&Simulation::preset("nominal-cubic")?, &Progress::none())?;
/// assert!((best.design.optimum.at[0] - 3.0).abs() < 0.01);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// Fields of the design with their ranges, `FIELD=A:B[:STEP]`; one to four.
    pub over: Vec<String>,
    /// The summary field to maximise.
    pub maximise: String,
    /// Constraints that hold in every environment, such as `max_abs_x_m<=0.003`.
    pub subject_to: Vec<String>,
    /// Environments in place of the scene's own excitation: another scene, a record (CSV), or values of a
    /// field, `FIELD=a,b,c`. A suffix `*WEIGHT` sets the weight of one, which is 1 by default.
    pub environment: Vec<String>,
    /// Fields with manufacturing tolerances, the least and the largest deviation from the value:
    /// `FIELD=-1%:1%` or `FIELD=-0.05:0.02`. Every deviation between them is as likely.
    pub vary: Vec<String>,
    /// Seed of the random samples of these fields.
    pub seed: u64,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
    /// File (CSV) to which the results of each run are added as soon as it has ended. Those that it has of
    /// the same question, from a search that was interrupted, are taken from there.
    pub runs_to: Option<PathBuf>,
}

impl Default for Best {
    fn default() -> Self {
        Self {
            over: Vec::new(),
            maximise: "rms_velocity_m_per_s".to_owned(),
            subject_to: Vec::new(),
            environment: Vec::new(),
            vary: Vec::new(),
            seed: 1,
            until_settled: None,
            runs_to: None,
        }
    }
}

/// The answer of [`Best::run`]: the best design, with the parsed question.
///
/// The best place may stand at the edge of a jump: see [`BestDesign::margins`] before it is built.
#[derive(Debug, Clone)]
pub struct BestAnswer {
    /// The parsed question, as [`best_chart`](crate::output::best_chart) takes it.
    pub question: BestQuestion,
    /// The best design.
    pub design: BestDesign,
    /// Why results of runs could not be written to [`Best::runs_to`], if some could not.
    pub unkept: Option<String>,
}

impl BestAnswer {
    /// One row: the design, the value of the maximised field, and the margins.
    pub fn table(&self) -> Table {
        self.design.table(&self.question)
    }

    /// The result in sentences.
    pub fn words(&self) -> Vec<String> {
        let unkept = self.unkept.iter().map(|problem| format!("not all runs could be kept: {problem}"));
        self.design.words(&self.question).into_iter().chain(unkept).collect()
    }
}

impl Best {
    /// The best design over one field between two values, in the unit of the field.
    pub fn over(field: &str, low: f64, high: f64) -> Self {
        Self { over: vec![format!("{field}={low}:{high}")], ..Self::default() }
    }

    /// Searches for the best design.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<BestAnswer, Error> {
        let document = simulation.document();
        self.search(self.question(document)?, document, progress, &mut |_, _| ())
    }

    /// Searches for the best design of a scene whose fields of the design need not be valid; `preview` gets
    /// the best design so far, and the same in words.
    #[doc(hidden)]
    pub fn search(
        &self,
        question: BestQuestion,
        document: &Document,
        progress: &Progress,
        preview: &mut (dyn FnMut(&Optimum, String) + Send),
    ) -> Result<BestAnswer, Error> {
        let (fields, maximised) = (names(&question), question.maximise.name);
        let wrong = |path: &PathBuf, problem| Error::argument("runs_to", path.display(), problem);
        let open = |path: &PathBuf| Kept::open(path, &question).map_err(|problem| wrong(path, problem));
        let kept = self.runs_to.as_ref().map(open).transpose()?;
        let found = progress.planned(|pool, task, plan| {
            let memory = kept.as_ref().map(|kept| kept as &dyn Memory);
            best(&question, pool, task, memory, plan, &mut |design| {
                let (at, value) = (place(&fields, &design.at), quantity(design.value, maximised));
                preview(design, format!("{at}: {maximised} {value}"));
            })
        })?;
        match found {
            Ok(design) => {
                let unkept = kept.and_then(|kept| kept.unwritten());
                Ok(BestAnswer { question, design, unkept })
            }
            Err(why) => Err(self.no_best(why, &question, document)),
        }
    }

    /// Parses and checks the texts of the question.
    #[doc(hidden)]
    pub fn question(&self, document: &Document) -> Result<BestQuestion, Error> {
        let question = BestQuestion {
            over: ranges(&self.over, document)?,
            maximise: number("maximise", &self.maximise, &self.maximise)?,
            subject_to: self.subject_to.iter().map(|text| constraint(text)).collect::<Result<_, _>>()?,
            environments: environments(&self.environment, document)?,
            vary: self.vary.iter().map(|text| tolerance(text, document)).collect::<Result<_, _>>()?,
            seed: self.seed,
            until_settled: self.until_settled,
        };
        check_fields(&question)?;
        if self.until_settled.is_some() {
            let model = drive_alone(document, question.environments[0].scene.clone())?;
            check_until(self.until_settled, document, &model)?;
        }
        Ok(question)
    }

    /// The error for a search without a result.
    fn no_best(&self, why: NoBest, question: &BestQuestion, document: &Document) -> Error {
        match why {
            NoBest::Cancelled => Error::Cancelled,
            NoBest::Invalid(faults) => Error::faults_of(document, faults),
            NoBest::NoValue => {
                let without = |environment: &Environment| environment.scene.transducer == Transducer::None;
                let columns = std::iter::once(question.maximise)
                    .chain(question.subject_to.iter().map(|constraint| constraint.of));
                let electrical =
                    columns.map(|field| field.name).find(|name| TRANSDUCER_COLUMNS.contains(name));
                let missing = electrical.filter(|_| question.environments.iter().any(without));
                match missing {
                    Some(name) => Error::unfit(
                        document,
                        format!(
                            "{name} needs a transducer, and the scene has none; name one with {} \
                             'transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60)'",
                            named!("set")
                        ),
                    ),
                    None => {
                        let constrained = match question.subject_to.is_empty() {
                            true => String::new(),
                            false => format!(", or one of {}", named!("subject_to")),
                        };
                        let problem = format!(
                            "no design of the range has this result{constrained} in a run that reaches its \
                             end"
                        );
                        Error::argument("maximise", &self.maximise, problem)
                    }
                }
            }
            NoBest::NoneMeets { nearest, results } => {
                let results = question.subject_to.iter().zip(results);
                let results = results.map(|(constraint, value)| {
                    format!("{} is {}", constraint.of.name, quantity(value, constraint.of.name))
                });
                let problem = format!(
                    "nothing that was tried in the range keeps to it; nearest is {}, where {}",
                    place(&names(question), &nearest),
                    results.collect::<Vec<_>>().join(", ")
                );
                Error::argument("subject_to", self.subject_to.join(", "), problem)
            }
        }
    }
}

/// Checks that every changed field exists in every environment; a record, for example, has no amplitude.
fn check_fields(question: &BestQuestion) -> Result<(), Error> {
    let over = question.over.iter().map(|range| ("over", &range.field));
    let vary = question.vary.iter().map(|tolerance| ("vary", &tolerance.field));
    for (name, field) in over.chain(vary) {
        let missing = |environment: &&Environment| FieldPath::new(field).get(&environment.scene).is_none();
        if let Some(environment) = question.environments.iter().find(missing) {
            let problem = format!(
                "the environment {} has no such number; change a field that all have",
                environment.name
            );
            return Err(Error::argument(name, field, problem));
        }
    }
    Ok(())
}

fn ranges(over: &[String], document: &Document) -> Result<Vec<DesignRange>, Error> {
    let mut ranges: Vec<DesignRange> = Vec::new();
    if over.is_empty() {
        let problem = "is missing: name a field of the design, such as stops.travel_limit_mm=0.5:7";
        return Err(Error::argument("over", "", problem));
    }
    let intervals = INTERVALS[over.len().min(MOST_FIELDS) - 1];
    for text in over {
        let wrong = |problem: String| Error::argument("over", text, problem);
        let form = || wrong("write FIELD=A:B, such as stops.travel_limit_mm=0.5:7".into());
        let (field, values) = text.split_once('=').ok_or_else(form)?;
        let parts: Vec<&str> = values.split(':').collect();
        let ends = match parts[..] {
            [low, high] | [low, high, _] => format!("{field}={low},{high}"),
            _ => return Err(form()),
        };
        let axis = Axis::parse(&ends, &document.scene).map_err(wrong)?;
        let (low, high) = (axis.values[0], axis.values[1]);
        if !(low.is_finite() && high.is_finite()) {
            return Err(wrong("the ends of the range must be finite".into()));
        }
        if low >= high {
            return Err(wrong(format!("the range must go upward: {low} is not below {high}")));
        }
        let whole = is_whole(&document.scene, &axis.field);
        let intervals = match parts.get(2) {
            None if whole => intervals.min((high - low) as usize),
            None => intervals,
            Some(step) => {
                let fits = |step: &f64| *step > 0.0 && step.is_finite() && (!whole || step.fract() == 0.0);
                let kind = if whole { "whole number" } else { "number" };
                let step = read_number(step).ok().filter(fits);
                let step = step.ok_or_else(|| wrong(format!("the step must be a {kind} above 0")))?;
                let intervals = ((high - low) / step).round();
                if !(1.0..=1e5).contains(&intervals) {
                    return Err(wrong(format!("takes {intervals} steps; give one with 1 to 100000")));
                }
                intervals as usize
            }
        };
        if ranges.iter().any(|range| range.field == axis.field) {
            return Err(wrong("is given twice; give each field one range".into()));
        }
        ranges.push(DesignRange::new(axis.field, (low, high), intervals));
    }
    if ranges.len() > MOST_FIELDS {
        let problem = format!("{} fields; at most {MOST_FIELDS} are searched together", ranges.len());
        return Err(Error::argument("over", over.join(", "), problem));
    }
    let places: f64 = ranges.iter().map(|range| range.intervals as f64 + 1.0).product();
    if places > MAX_PLACES {
        let problem =
            format!("makes {places} places of the scan; at most {MAX_PLACES} fit: give longer steps");
        return Err(Error::argument("over", over.join(", "), problem));
    }
    Ok(ranges)
}

/// Largest number of places of a scan: each is kept, and so many take 1 GB of memory.
const MAX_PLACES: f64 = 1e7;

const TRANSDUCER_COLUMNS: [&str; 3] = ["mean_load_power_w", "mean_coil_power_w", "voltage_rms_v"];

/// The numeric summary field called `name`. `argument` and `value` are those that an error names.
fn number(argument: &str, value: &str, name: &str) -> Result<&'static SummaryField, Error> {
    let is_number = |field: &&SummaryField| matches!(field.read, Read::Number(_) | Read::Count(_));
    let known: Vec<&str> = SUMMARY_FIELDS.iter().filter(is_number).map(|field| field.name).collect();
    let found = find_name("number", name, &known);
    found.and_then(SummaryField::named).map_err(|problem| {
        let which = if value == name { String::new() } else { format!("{name}: ") };
        Error::argument(argument, value, format!("{which}{problem}"))
    })
}

fn constraint(text: &str) -> Result<Constraint, Error> {
    let wrong = || {
        let problem = "write COLUMN<=VALUE or COLUMN>=VALUE, such as 'max_abs_x_m<=0.003'";
        Error::argument("subject_to", text, problem)
    };
    let (name, limit, at_most) = match (text.split_once("<="), text.split_once(">=")) {
        (Some((name, limit)), _) => (name, limit, true),
        (None, Some((name, limit))) => (name, limit, false),
        _ => return Err(wrong()),
    };
    let limit = read_number(limit).ok().filter(|limit| limit.is_finite()).ok_or_else(wrong)?;
    Ok(Constraint { of: number("subject_to", text, name.trim())?, at_most, limit })
}

fn tolerance(text: &str, document: &Document) -> Result<Tolerance, Error> {
    let wrong = |problem: String| Error::argument("vary", text, problem);
    let form = "write FIELD=-1%:1% or FIELD=-0.05:0.05, the least and the largest deviation";
    let (field, ends) = text.split_once('=').ok_or_else(|| wrong(form.to_owned()))?;
    let (field, ends) = (field.trim(), ends.trim());
    if let Some(by) = ends.strip_prefix("+-").or_else(|| ends.strip_prefix('\u{b1}')) {
        let by = by.trim();
        return Err(wrong(format!(
            "+- is a standard deviation, as in {} of sweep, and these are bounds: write {field}=-{by}:{by}",
            named!("uncertain")
        )));
    }
    can_vary(field, document).map_err(wrong)?;
    let (low, high) = ends.split_once(':').ok_or_else(|| wrong(form.to_owned()))?;
    let [(low, of_low), (high, of_high)] =
        [deviation(low, form).map_err(wrong)?, deviation(high, form).map_err(wrong)?];
    // 0 is both a share and a length
    let relative = if low == 0.0 { of_high } else { of_low };
    if low != 0.0 && high != 0.0 && of_low != of_high {
        return Err(wrong("give both ends in per cent, or both in the unit of the field".to_owned()));
    }
    if low > high {
        return Err(wrong("give the least deviation first".to_owned()));
    }
    if relative && FieldPath::new(field).get(&document.scene) == Some(0.0) {
        return Err(wrong("a share of 0 is nothing; give the tolerance in the unit of the field".to_owned()));
    }
    Ok(Tolerance { field: field.to_owned(), low, high, relative })
}

/// Splits off the weight after the last `*` of a text; without one the weight is 1. `whole` is the argument
/// that an error names.
fn weighted<'a>(text: &'a str, whole: &str) -> Result<(&'a str, f64), Error> {
    let Some((text, weight)) = text.rsplit_once('*') else { return Ok((text.trim(), 1.0)) };
    let weight = read_number(weight).ok().filter(|weight| *weight > 0.0 && weight.is_finite());
    let problem = "the weight after * must be a number above 0";
    Ok((text.trim(), weight.ok_or_else(|| Error::argument("environment", whole, problem))?))
}

const MAX_ENVIRONMENTS: usize = 1000;

/// The environments of the design; if none are given, the scene itself is the only one.
fn environments(given: &[String], document: &Document) -> Result<Vec<Environment>, Error> {
    let environment = |name: String, weight: f64, document: &Document| Environment {
        name,
        weight,
        scene: document.scene.clone(),
        files: document.files.clone(),
    };
    if given.is_empty() {
        return Ok(vec![environment(document.name.clone(), 1.0, document)]);
    }
    let mut all = Vec::new();
    for text in given {
        let wrong = |problem: String| Error::argument("environment", text, problem);
        let mut changed = document.clone();
        changed.scene.sweep.clear(); // the other excitation may not have its fields
        if let Some((field, values)) = text.split_once('=').filter(|_| !is_file(text.as_ref())) {
            for value in values.split(',') {
                let (value, weight) = weighted(value, text)?;
                let axis = Axis::parse(&format!("{field}={value}"), &document.scene).map_err(wrong)?;
                axis.apply(&mut changed.scene, 0);
                changed.check()?;
                all.push(environment(format!("{} = {value}", axis.field), weight, &changed));
            }
        } else {
            let (name, weight) = weighted(text, text)?;
            if name.to_ascii_lowercase().ends_with(".csv") {
                // a name that is not a file may be that of a built-in table
                let path = canonical(name.as_ref()).unwrap_or_else(|| name.into());
                let set =
                    changed.set(&format!("excitation=Recorded(path: {:?})", path.display().to_string()));
                let set = set.map_err(|error| error.to_string());
                let checked = set.and_then(|()| changed.check().map_err(|error| error.to_string()));
                checked.map_err(|problem| match is_file(name.as_ref()) {
                    true => wrong(problem),
                    false => wrong("no such file; give a record with columns t_s and accel_m_per_s2".into()),
                })?;
            } else {
                let other = Document::of_argument(name).map_err(|error| wrong(error.to_string()))?;
                other.check()?;
                let RunSettings { tolerance, recurrence, .. } = document.scene.run;
                changed.scene.excitation = other.scene.excitation;
                changed.scene.run = RunSettings { tolerance, recurrence, ..other.scene.run };
            }
            changed.check()?;
            all.push(environment(name.to_owned(), weight, &changed));
        }
    }
    if all.len() > MAX_ENVIRONMENTS {
        let given = format!("{} of them", all.len());
        let problem = format!("at most {MAX_ENVIRONMENTS} are run; give fewer");
        return Err(Error::argument("environment", given, problem));
    }
    Ok(all)
}
