//! Thresholds: the least value of a field at which a motion begins.

mod chart;
mod melnikov;
mod probable;
mod search;

use clap::Args;
use serde::{Deserialize, Serialize};

use crate::escape::{RUNS, check_runs};
use crate::numeric::extent;
use crate::output::NoPicture;
use crate::questions::{Error, Progress, check_until, drive_alone};
use crate::scene::{Amplitude, Axis, Document, Stops, is_whole};
use crate::study::{
    Answered, Grid, Heading, Over, Remark, Scenes, Study, Table, can_cross, named, number, study_methods,
    whole,
};
pub use melnikov::melnikov_threshold;
use melnikov::{suits_melnikov, with_melnikov};
use probable::Chance;
pub(crate) use search::{Above, Search, faults, from_rest};
pub use search::{Found, NoThresholds, Onset, Scan, Searched, Verdict, threshold};

/// The least value of a field from which on a motion from rest is released, crosses or is interwell.
///
/// For one scene, or in every cell of a grid; under noise the value at which a share of the runs crosses
/// within a time.
///
/// # Method
///
/// The release under one sine has a closed form. Otherwise all steps of the range are run from rest,
/// each until its motion repeats (by default for at most 1000 forcing periods beyond the run of the scene),
/// and the first change is bisected, since the values that cross need not form an interval. A window narrower
/// than a step may be missed; a smaller step costs more runs.
///
/// Without a range the amplitude of the scene's drive is searched upward from 0, as by
/// [`Compare`](crate::questions::Compare): at least 100 even steps up to the amplitude whose inertial force
/// equals the largest force of the mechanism between the rest position and the barrier, as many up to twice
/// that, then steps of 1 % to thirty times it. The steps above the first with the motion are run only up to
/// 1.5 times it. Without a barrier the range is 0 to 2 g.
///
/// Under noise each run keeps its random numbers and is bisected between the ends of the range; `value` is
/// the quantile of the values that were found, and its interval lies between two of them, whose ranks are
/// binomial (David and Nagaraja 2003, section 7.1). A run that crosses at a value is taken to cross at higher
/// ones; where it does not, the bisection finds one of the changes of its answer.
///
/// # Errors
///
/// [`Error::Argument`] for a wrong `field`, `resolution` or `until_settled`, for a release (`of`) without
/// stops, for a grid over the searched field, and for `melnikov` of a field that is not the amplitude of one
/// sine; [`Error::Cells`] for cells in which no value of the range gives a valid scene, or one whose drive
/// repeats, which interwell motion needs, or has noise and two wells, which a probability needs.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Onset, Progress, Simulation, Threshold};
///
/// // The mass is released when mass times base acceleration exceeds the force on the stop at 4 mm.
/// let question = Threshold { of: Onset::Release, ..Threshold::default() };
/// let table = question.run(&Simulation::preset("nominal-cubic")?, &Progress::none())?;
/// let force_n = 40.0 * 4e-3 - 816_326.530_612_245 * 4e-3_f64.powi(3);
/// let amplitude_g = force_n / (15.2e-3 * 9.806_65);
/// assert!((table.numbers("value").unwrap()[0] - amplitude_g).abs() < 1e-9);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Threshold {
    /// The fields of the grid, the slowest first; if there are none, the table has one row.
    #[arg(skip)]
    pub over: Over,
    /// The field and its range [default of the step: a 200th of the range]. An amplitude of the drive needs
    /// no range: it is searched upward, in steps that suit the mechanism, as by compare [default: the
    /// amplitude of the drive; with a probability the RMS of the noise, 0 to 2 g]
    #[arg(long, value_name = "FIELD[=FROM:TO[:STEP]]", allow_hyphen_values = true)]
    pub field: Option<String>,
    /// What begins at the threshold
    #[arg(long, value_name = "ONSET", default_value = "crossing")]
    pub of: Onset,
    /// How closely the threshold is located, in the field's unit [default: a 1000th of the step; of a field
    /// of whole numbers 1; with a probability the step]
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    #[arg(value_parser = number("give a number above 0, in the unit of the field"))]
    pub resolution: Option<f64>,
    /// Follow each run, window after window, until its motion repeats, or up to this time in s: longer is
    /// surer where the motion is irregular [default: 1000 forcing periods after the scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    #[arg(value_parser = number("not a time; give seconds, such as 300"))]
    pub until_settled: Option<f64>,
    /// Under a noise: search the value at which this share of the runs, each with another seed, crosses the
    /// barrier within a time, such as 0.5 for half of them
    #[arg(long, value_name = "P", allow_hyphen_values = true)]
    #[arg(value_parser = number("give a share, such as 0.5"))]
    pub probability: Option<f64>,
    /// With a probability: number of runs, 1 to 1000000 [default: 100]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole::<u64>(RUNS))]
    pub runs: Option<u64>,
    /// With a probability: the time in s within which a run is to cross [default: the duration of the
    /// scene's run]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    #[arg(value_parser = number("give a time in s, such as 100"))]
    pub within: Option<f64>,
    /// Add the column melnikov_g: Melnikov's threshold of the amplitude of a Sine, from quadrature; of a
    /// Cosine or Force melnikov_m_per_s2 or melnikov_n
    #[arg(long)]
    pub melnikov: bool,
}

const EXAMPLES: &str = "\
Examples:
  interwell --headless threshold paper
  interwell --headless threshold paper --of release --over stops.travel_limit_mm=0.5:6.5:0.5 --plot free.png
  interwell --headless threshold paper --over stops.travel_limit_mm=0.5:6.5:0.25 --plot cross.png
  interwell --headless threshold paper --field stops.travel_limit_mm=0.5:3:0.05 --of interwell
  interwell --headless threshold paper --over excitation.frequency_hz=2,3,4 \\
      --over stops.travel_limit_mm=0.5:6:0.25 --plot lines.png
  interwell --headless threshold duffing --field excitation.amplitude_g=0:0.1 --melnikov \\
      --over excitation.frequency_hz=0.1:0.3:0.02 --plot melnikov.png
  interwell --headless threshold my-noise.ron --field excitation.rms_g=0:2 --probability 0.5 --runs 50 \\
      --within 20 --over stops.travel_limit_mm=1:6:1 --plot half.png";

/// Why there is no Melnikov's threshold of a field.
const NO_MELNIKOV: &str = "Melnikov's threshold is an amplitude of one sine: take a Sine, \
                           Cosine or Force, and search its amplitude, such as excitation.amplitude_g";

/// Number of steps of a range that is given without a step.
const DEFAULT_STEPS: f64 = 200.0;

impl Default for Threshold {
    fn default() -> Self {
        Self {
            over: Vec::new(),
            field: None,
            of: Onset::Crossing,
            resolution: None,
            until_settled: None,
            probability: None,
            runs: None,
            within: None,
            melnikov: false,
        }
    }
}

study_methods!(Threshold);

impl Study for Threshold {
    const NAME: &'static str = "threshold";
    const SCENE: &'static str = "Scene file or built-in scene; each run begins at rest";
    const PARTS: &'static str = "values";
    const PYTHON: &'static str = "";

    fn over(&self) -> &Over {
        &self.over
    }

    fn parts(&self, scenes: &Scenes) -> &'static str {
        match self.searched(scenes) {
            _ if self.probability.is_some() => "runs",
            Ok(Searched::Upward { .. }) => "thresholds",
            _ => Self::PARTS,
        }
    }

    fn check(&self, scenes: &Scenes) -> Result<(), Error> {
        self.chance(scenes)?;
        self.searched(scenes).map(|_| ())
    }

    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let (cells, searched) = (scenes.cells(), self.searched(scenes)?);
        let found = match (self.chance(scenes)?, &searched) {
            (Some(chance), Searched::Scan(scan)) => progress
                .shared(scenes.grid.cells() * chance.runs, |pool, task| {
                    probable::table(&cells, scan, &chance, pool, task)
                }),
            _ => progress.shared(scenes.grid.cells() * searched.ticks(), |pool, task| {
                let table = search::table(&cells, &searched, self.of, pool, task)?;
                if self.melnikov { with_melnikov(table, &cells, pool, task) } else { Ok(table) }
            }),
        }?;
        let answer = Answered::new(found.map_err(|end| scenes.no_table(end))?);
        let remarks = self.remarks(scenes, &searched, &answer.table);
        let (grid, scene, of) = (scenes.grid.clone(), scenes.scene().clone(), self.of);
        Ok(answer.told(remarks).drawn(move |rows, framing| {
            Ok(chart::chart(rows, (&grid, &scene), searched.field(), of, framing.ranges))
        }))
    }

    fn can_draw(&self, grid: &Grid) -> Result<(), NoPicture> {
        match grid.axes().len() {
            0 => Err(NoPicture::SingleThreshold),
            1 | 2 => Ok(()),
            n => Err(NoPicture::Fields(n)),
        }
    }

    fn columns() -> Vec<Vec<Heading>> {
        vec![search::headings(), melnikov::headings(), probable::headings()]
    }
}

impl Threshold {
    /// Why the table has rows without a value, with the first value of the range, undecided ones, or ones
    /// without Melnikov's threshold.
    fn remarks(&self, scenes: &Scenes, searched: &Searched, table: &Table) -> Vec<Remark> {
        if let (Some(probability), Searched::Scan(scan)) = (self.probability, searched) {
            return self.too_few(scenes, table, scan, probability).into_iter().collect();
        }
        let blocked = blocked(scenes, searched.field()).filter(|_| self.of != Onset::Release);
        let at_first = match searched {
            Searched::Scan(scan) => at_first(table, scan).map(Remark::from),
            Searched::Upward { .. } => None,
        };
        let missing = missing(table, searched, self.of, scenes.grid, blocked);
        let melnikov = without_melnikov(table).map(Remark::from);
        [missing, at_first, undecided(table), melnikov].into_iter().flatten().collect()
    }

    /// Probability, runs and time of each cell, if a probability is asked for; an error if one of them is
    /// wrong, or does not belong to what is asked for.
    fn chance(&self, scenes: &Scenes) -> Result<Option<Chance>, Error> {
        let Some(probability) = self.probability else {
            let given = [("runs", self.runs.map(|runs| runs.to_string()))];
            let given = given.into_iter().chain([("within", self.within.map(|time| time.to_string()))]);
            return match given.into_iter().find_map(|(name, value)| Some((name, value?))) {
                None => Ok(None),
                Some((name, value)) => Err(Error::argument(
                    name,
                    value,
                    format!("belongs to {}: give that too, or leave it out", named!("probability")),
                )),
            };
        };
        let without = |name: &str, value: String| {
            let problem = format!("has no meaning with {}: leave one of them out", named!("probability"));
            Err(Error::argument(name, value, problem))
        };
        match self.until_settled {
            _ if self.of != Onset::Crossing => return without("of", self.of.name().to_owned()),
            Some(time) => return without("until_settled", time.to_string()),
            None if self.melnikov => return without("melnikov", String::new()),
            None => {}
        }
        let runs = self.runs.unwrap_or(crate::questions::Escape::RUNS);
        let within = self.within.unwrap_or(scenes.scene().run.duration_s);
        check_runs(runs, within, scenes.grid)?;
        if !(probability > 0.0 && probability < 1.0) {
            let problem = "give a share above 0 and below 1, such as 0.5";
            return Err(Error::number("probability", probability, problem));
        }
        Ok(Some(Chance { probability, runs, within }))
    }

    /// The range in which a share of the runs is searched, and its resolution.
    fn probable_scan(&self, scenes: &Scenes) -> Result<Scan, Error> {
        let field = match &self.field {
            Some(given) => given.trim().to_owned(),
            None => default_field(scenes.document)?,
        };
        let scan = scan(&field, self.resolution, None, scenes.document)?;
        not_swept(scenes.grid, &scan.field)?;
        let step = scan.values.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(scan.resolution);
        Ok(Scan { resolution: self.resolution.unwrap_or(step), ..scan })
    }

    /// Why a table of thresholds in probability has rows without a value.
    fn too_few(&self, scenes: &Scenes, table: &Table, scan: &Scan, probability: f64) -> Option<Remark> {
        let (rows, last, field) = (without_value(table)?, *scan.values.last()?, scan.field.clone());
        let within = self.within.unwrap_or(scenes.scene().run.duration_s);
        let text = format!(
            "{rows}: at {field} = {last} less than a share {probability} of the runs crosses within {within} \
             s; give a wider range, or {} a longer time",
            named!("within")
        );
        Some(text.into())
    }

    /// What is searched in the cells of `grid`.
    fn searched(&self, scenes: &Scenes) -> Result<Searched, Error> {
        let Scenes { document, grid, .. } = *scenes;
        if self.probability.is_some() {
            return Ok(Searched::Scan(self.probable_scan(scenes)?));
        }
        if self.of == Onset::Release && document.scene.stops == Stops::None {
            let remedy = "the scene has no stops to release the mass from; give it some, such as \
                          stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)";
            return Err(Error::argument("of", "release", remedy));
        }
        let given = self.field.as_deref().map(str::trim);
        let amplitudes = document.scene.amplitudes();
        let searched = match given.filter(|text| amplitudes.iter().all(|one| one.path != **text)) {
            None => {
                let field = given.map_or_else(|| only(&amplitudes), |text| Ok(text.to_owned()))?;
                if let Some(resolution) = self.resolution.filter(|value| !is_resolution(*value)) {
                    return Err(wrong_resolution(resolution, "number"));
                }
                let (resolution, until_settled) = (self.resolution, self.until_settled);
                Searched::Upward { field, resolution, until_settled }
            }
            Some(text) => {
                let (resolution, until_settled) = (self.resolution, self.until_settled);
                // a range alone is one of the amplitude
                let of_drive = if text.starts_with('=') { only(&amplitudes)? } else { String::new() };
                Searched::Scan(scan(&(of_drive + text), resolution, until_settled, document)?)
            }
        };
        let field = searched.field();
        if self.melnikov && !suits_melnikov(&document.scene, field) {
            return Err(Error::argument("field", given.unwrap_or(field), NO_MELNIKOV));
        }
        not_swept(grid, field)?;
        if self.until_settled.is_some() {
            let mut first = document.scene.clone();
            grid.apply(0, &mut first);
            check_until(self.until_settled, document, &drive_alone(document, first)?)?;
        }
        Ok(searched)
    }
}

/// The field of the amplitude of a drive that has one alone.
fn only(amplitudes: &[Amplitude]) -> Result<String, Error> {
    let problem = match amplitudes {
        [one] => return Ok(one.path.clone()),
        [] => "the drive of the scene has no amplitude; name a field with its range, such as \
               stops.travel_limit_mm=0.5:3"
            .to_owned(),
        several => {
            let paths: Vec<&str> = several.iter().map(|one| &*one.path).collect();
            format!("the drive of the scene has several amplitudes; name one of {}", paths.join(", "))
        }
    };
    Err(Error::argument("field", "", format!("is missing: {problem}")))
}

/// Refuses a grid over the searched field.
fn not_swept(grid: &Grid, field: &str) -> Result<(), Error> {
    if grid.axes().iter().any(|swept| swept.field == field) {
        return Err(Error::argument("over", field, "the threshold is over it; sweep another field"));
    }
    Ok(())
}

fn is_resolution(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn wrong_resolution(value: f64, kind: &str) -> Error {
    let problem = format!("give a {kind} above 0, in the unit of the field");
    Error::number("resolution", value, problem)
}

/// The values of a field and range, `FIELD=FROM:TO[:STEP]`, and the resolution of a threshold among them.
fn scan(
    argument: &str,
    resolution: Option<f64>,
    until_settled: Option<f64>,
    document: &Document,
) -> Result<Scan, Error> {
    let wrong = |problem: String| Error::argument("field", argument, problem);
    let parsed = |text: &str| -> Result<Axis, Error> {
        let axis = Axis::parse(text, &document.scene).map_err(wrong)?;
        match axis.values.iter().all(|value| value.is_finite()) {
            true => Ok(axis),
            false => Err(wrong("the ends of the range must be finite".into())),
        }
    };
    let (mut full, mut end) = (argument.to_owned(), None);
    if let Some((from, to)) = argument.split_once(':').filter(|(_, to)| !to.contains(':')) {
        // parsed as a list, so that the message names a wrong end
        let ends = parsed(&format!("{from},{to}"))?;
        let [low, high] = ends.values[..] else {
            let problem = "write FIELD=FROM:TO or FIELD=FROM:TO:STEP, such as excitation.amplitude_g=0:2";
            return Err(wrong(problem.into()));
        };
        if low == high {
            return Err(wrong(format!("FROM and TO are both {low}; give a range, such as 0:2")));
        }
        if low > high {
            return Err(wrong(format!("TO must be above FROM; write {high}:{low}")));
        }
        let step = (high - low) / DEFAULT_STEPS;
        let step = if is_whole(&document.scene, &ends.field) { step.ceil() } else { step };
        (full, end) = (format!("{argument}:{step}"), Some(high));
    }
    let axis = parsed(&full)?;
    let mut values = axis.values;
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        let problem = "it is a single value; give a range of which STEP is a part, such as 0:2:0.1";
        return Err(wrong(problem.into()));
    }
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    if let Some(high) = end {
        // rounding may put the last step just below the end of the range
        values.retain(|value| *value < high - 1e-6 * step);
        values.push(high);
    }
    let whole = is_whole(&document.scene, &axis.field);
    let resolution = match resolution {
        None if whole => 1.0,
        None => 1e-3 * step,
        Some(value) if is_resolution(value) && (!whole || value.fract() == 0.0) => value,
        Some(value) => return Err(wrong_resolution(value, if whole { "whole number" } else { "number" })),
    };
    Ok(Scan { field: axis.field, values, resolution, until_settled })
}

/// The root mean square of the noise of a scene that has one, 0 to 2 g.
fn default_field(document: &Document) -> Result<String, Error> {
    let mut noises = document.scene.amplitudes();
    noises.retain(|amplitude| amplitude.path.ends_with(".rms_g"));
    match &noises[..] {
        [noise] => Ok(format!("{}=0:2", noise.path)),
        _ => {
            let problem = "is missing, and the scene has no noise, or several: name a field with its range, \
                           such as excitation.rms_g=0:2";
            Err(Error::argument("field", "", problem))
        }
    }
}

/// Why no motion of any cell can cross, where this is known beforehand.
fn blocked(scenes: &Scenes, searched: &str) -> Option<&'static str> {
    let Scenes { document, grid, mechanism } = *scenes;
    let mut fields = grid.axes().iter().map(|axis| &*axis.field).chain([searched]);
    let fixed = !fields.any(|field| field.starts_with("stops") || field.starts_with("mechanism"));
    let mechanism = mechanism.filter(|mechanism| fixed && !can_cross(&document.scene, mechanism))?;
    Some(match mechanism.landscape.barrier {
        None => "there is no barrier between two wells",
        Some(_) => "no barrier lies between the stops",
    })
}

/// The clause "`count` of `all` rows" with the singular or plural of a verb. Returns `None` if `count` is 0.
fn of_rows(count: usize, all: usize, verbs: [&str; 2]) -> Option<String> {
    match (count, all) {
        (0, _) => None,
        (1, 1) => Some(format!("the row {}", verbs[0])),
        (count, all) => Some(format!("{count} of {all} rows {}", verbs[1])),
    }
}

/// The rows with an empty `value`, as a clause, if there are any.
fn without_value(table: &Table) -> Option<String> {
    without(table.numbers("value")?, "value")
}

/// The rows without one of these `numbers`, as a clause, if there are any.
fn without(numbers: &[f64], name: &str) -> Option<String> {
    let count = numbers.iter().filter(|number| number.is_nan()).count();
    of_rows(count, numbers.len(), [&format!("has no {name}"), &format!("have no {name}")])
}

/// Explains an empty Melnikov's threshold, if a row has one.
fn without_melnikov(table: &Table) -> Option<String> {
    let name = &table.columns().iter().find(|column| column.name.starts_with("melnikov"))?.name;
    let rows = without(table.numbers(name)?, name)?;
    Some(format!(
        "{rows}: it needs linear damping above 0, no current or voltage as a third state, a barrier without \
         a kink, a well whose homoclinic orbit meets neither a stop nor the end of the force curve, and a \
         drive that is not far faster than motions at the barrier"
    ))
}

/// Explains a `value` that is the first of the range, if a row has one.
fn at_first(table: &Table, scan: &Scan) -> Option<String> {
    let (values, first) = (table.numbers("value")?, *scan.values.first()?);
    let known = table.numbers("low")?;
    let is_first = |(value, low): (&f64, &f64)| *value == first && low.is_nan();
    let count = values.iter().zip(known).filter(|row| is_first(*row)).count();
    let rows = of_rows(count, values.len(), ["has its value", "have their value"])?;
    Some(format!(
        "{rows} at {first}, the first that was tried: where the field can have a lower one, that may do as \
         well; windows counts how often the answer changes above"
    ))
}

/// Explains `undecided`, if it is true in a row.
fn undecided(table: &Table) -> Option<Remark> {
    let words = table.words("undecided");
    let count = words.iter().filter(|word| **word == "true").count();
    let rows = of_rows(count, words.len(), ["is undecided", "are undecided"])?;
    let text = format!(
        "{rows}: the answer just below or at the value (without a value, at the end of the range) is not \
         known: the motion does not repeat in the time for which it is followed, the run ended early, or \
         there is no valid scene; low and high, where given, are values whose answers are known, and {} with \
         a longer time may bring them together",
        named!("until_settled")
    );
    Some(text.into())
}

/// Explains an empty `value`, if a row has one. `blocked` says why no row can have a crossing.
fn missing(
    table: &Table,
    searched: &Searched,
    onset: Onset,
    grid: &Grid,
    blocked: Option<&str>,
) -> Option<Remark> {
    let rows = without_value(table)?;
    if let Some(why) = blocked {
        return Some(format!("{rows}: {why}, so nothing to cross").into());
    }
    let what = match onset {
        Onset::Release => "releases the mass from a stop",
        Onset::Crossing => "makes the settled motion cross",
        Onset::Interwell => "makes the settled motion interwell",
    };
    let field = searched.field().to_owned();
    let unsolved = match grid.changes_mechanism() || field.starts_with("mechanism") {
        true => ", or the flexures are not solved",
        false => "",
    };
    let tried = |range: &str| format!("{rows}: no {field} that was tried {range}{what}{unsolved}");
    Some(match searched {
        Searched::Scan(scan) => {
            let (low, high) = extent(scan.values.iter().copied());
            let text = tried(&format!("from {low} to {high} "));
            format!("{text}; give a wider range or smaller steps").into()
        }
        Searched::Upward { .. } => {
            format!("{}; give a range, {} {field}=FROM:TO", tried(""), named!("field")).into()
        }
    })
}
