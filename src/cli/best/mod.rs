//! `best`: the best design for an environment, one row, with its margins.

use clap::Args;
use interwell::scene::{Axis, Document, FieldPath, RunSettings, Transducer, is_whole};
use interwell::study::{
    BestQuestion, Constraint, DesignRange, Environment, INTERVALS, MOST_FIELDS, NoBest, Read, SUMMARY_FIELDS,
    SummaryField, Task, Variation, best, scan_runs,
};
use interwell::system::files::{canonical, is_file};

mod words;

use words::{names, place, quantity, words};

use super::support::{drive_alone, is_positive, load, outputs, pool, until_settled, warn};
use super::{Common, Failure, Output, bar, interrupt, refuse, say};

const EXAMPLES: &str = "\
Examples:
  interwell --headless best paper --over stops.travel_limit_mm=0.5:7
  interwell --headless best paper --over stops.travel_limit_mm=0.5:7 --subject-to 'max_abs_x_m<=0.001'
  interwell --headless best paper --over stops.travel_limit_mm=0.5:7 \\
      --environment excitation.amplitude_g=0.8,1,1.2 --vary excitation.amplitude_g=+-2%
  interwell --headless best paper --over stops.travel_limit_mm=0.2:2 --environment walking
  interwell --headless best random-shaking --over stops.travel_limit_mm=0.2:3 \\
      --environment excitation.seed=1,2,3,4,5
  interwell --headless best paper --over mechanism.preload_mm=1:3 --over stops.travel_limit_mm=0.5:5";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// A field of the design and its range (repeatable, at most four); a step is that of the first scan
    /// [default: a 256th of the range; of two fields a 32nd, of three a 12th, of four an 8th]
    #[arg(long, value_name = "FIELD=A:B[:STEP]", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// What is to be largest: a number of the summary. mean_power_w, the power into the load, needs a scene
    /// with a transducer
    #[arg(long, value_name = "COLUMN", default_value = "rms_velocity_m_per_s", visible_alias = "maximize")]
    pub maximise: String,

    /// What every environment must keep to, such as 'max_abs_x_m<=0.003' (repeatable)
    #[arg(long, value_name = "COLUMN<=VALUE|COLUMN>=VALUE")]
    pub subject_to: Vec<String>,

    /// What the design is for, in place of the scene's own excitation: the excitation and run of another
    /// scene, a record (CSV), or values of a field; *WEIGHT after one is its weight, otherwise 1
    /// (repeatable; the weighted mean over all is what is to be largest)
    #[arg(long, value_name = "SCENE|FILE|FIELD=a,b,c", allow_hyphen_values = true)]
    pub environment: Vec<String>,

    /// A tolerance of a field: writes the worst of 200 samples and what all but a twentieth of them reach
    /// (repeatable)
    #[arg(long, value_name = "FIELD=+-1%|+-0.05", allow_hyphen_values = true)]
    pub vary: Vec<String>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s; where the
    /// drive never repeats, each run is as long as the scene says [default: 1000 forcing periods after the
    /// scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// Seed of the samples of --vary
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,
}

/// Searches and writes the row.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let (document, warnings) = load(&options.scene, common, None)?;
    let mut question = BestQuestion {
        over: ranges(&options.over, &document)?,
        maximise: number("--maximise", &options.maximise)?,
        subject_to: options.subject_to.iter().map(|text| constraint(text)).collect::<Result<_, _>>()?,
        environments: environments(&options.environment, &document)?,
        vary: options.vary.iter().map(|text| variation(text, &document)).collect::<Result<_, _>>()?,
        seed: options.seed,
        until_settled: None,
    };
    has_fields(&question)?;
    if let (Some(text), [first, ..]) = (options.until_settled.as_deref(), &question.environments[..]) {
        let model = drive_alone(&document, first.scene.clone())?;
        question.until_settled = until_settled(Some(text), &document, &model)?;
    }
    warn(&document, common, &warnings, None);
    let pool = pool(common)?;
    let mut outputs = outputs(&options.scene, &document, common)?;
    let bar = bar(scan_runs(&question), 0, "runs", common);
    // the number of runs after the scan is not known in advance
    let tick = || bar.inc_beyond();
    let task = Task { tick: &tick, cancel: interrupt::listen() };
    let mut so_far = None;
    let found = best(&question, &pool, &task, &mut |design| so_far = Some(design.clone()));
    drop(bar);
    if let (Err(NoBest::Cancelled), Some(design)) = (&found, &so_far) {
        let maximised = question.maximise.name;
        let at = place(&names(&question), &design.at);
        let value = quantity(design.value, maximised);
        say(&format!("{}: best so far at {at}: {maximised} {value}", document.name));
    }
    let design = found.map_err(|why| failure(why, options, &question, &document))?;
    outputs.table(Output::DATA, &design.table(&question))?;
    words(&design, &question).iter().for_each(|line| common.say(&format!("{}: {line}", document.name)));
    outputs.finish()
}

/// Checks that every field that is changed exists in every environment: a record has no amplitude.
fn has_fields(question: &BestQuestion) -> Result<(), Failure> {
    let over = question.over.iter().map(|range| ("--over", &range.field));
    let vary = question.vary.iter().map(|variation| ("--vary", &variation.field));
    for (option, field) in over.chain(vary) {
        let missing = |environment: &&Environment| FieldPath::new(field).get(&environment.scene).is_none();
        if let Some(environment) = question.environments.iter().find(missing) {
            refuse!(
                "{option} {field}: the environment {} has no such number; change a field that all have",
                environment.name
            );
        }
    }
    Ok(())
}

fn failure(why: NoBest, options: &Arguments, question: &BestQuestion, document: &Document) -> Failure {
    match why {
        NoBest::Cancelled => Failure::interrupted(),
        NoBest::Invalid(faults) => document.error_from(faults).into(),
        NoBest::NoValue => {
            let without = |environment: &Environment| environment.scene.transducer == Transducer::None;
            let columns = std::iter::once(question.maximise)
                .chain(question.subject_to.iter().map(|constraint| constraint.of));
            let electrical = columns.map(|field| field.name).find(|name| OF_TRANSDUCER.contains(name));
            let missing = electrical.filter(|_| question.environments.iter().any(without));
            Failure::argument(match missing {
                Some(name) => format!(
                    "{}: {name} needs a transducer, and the scene has none; name one with --set \
                     'transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60)'",
                    document.name
                ),
                None => format!(
                    "--maximise {}: no design of the range has this result{} in a run that reaches its end",
                    options.maximise,
                    if question.subject_to.is_empty() { "" } else { ", or one of --subject-to" }
                ),
            })
        }
        NoBest::NoneMeets { nearest, results } => {
            let results = question.subject_to.iter().zip(results);
            let results = results.map(|(constraint, value)| {
                format!("{} is {}", constraint.of.name, quantity(value, constraint.of.name))
            });
            Failure::argument(format!(
                "--subject-to {}: nothing that was tried in the range keeps to it; nearest is {}, where {}",
                options.subject_to.join(", "),
                place(&names(question), &nearest),
                results.collect::<Vec<_>>().join(", ")
            ))
        }
    }
}

fn ranges(over: &[String], document: &Document) -> Result<Vec<DesignRange>, Failure> {
    let mut ranges: Vec<DesignRange> = Vec::new();
    if over.is_empty() {
        refuse!("--over is missing: name a field of the design, such as --over stops.travel_limit_mm=0.5:7");
    }
    let intervals = INTERVALS[over.len().min(MOST_FIELDS) - 1];
    for text in over {
        let wrong = |problem: String| Failure::argument(format!("--over {text}: {problem}"));
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
            refuse!("--over {text}: the ends of the range must be finite");
        }
        if low >= high {
            refuse!("--over {text}: the range must go upward: {low} is not below {high}");
        }
        let whole = is_whole(&document.scene, &axis.field);
        let intervals = match parts.get(2) {
            None if whole => intervals.min((high - low) as usize),
            None => intervals,
            Some(step) => {
                let fits = |step: &f64| is_positive(step) && (!whole || step.fract() == 0.0);
                let kind = if whole { "whole number" } else { "number" };
                let step = step.trim().parse().ok().filter(fits);
                let step = step.ok_or_else(|| wrong(format!("the step must be a {kind} above 0")))?;
                let intervals = ((high - low) / step).round();
                if !(1.0..=1e5).contains(&intervals) {
                    refuse!("--over {text}: takes {intervals} steps; give one with 1 to 100000");
                }
                intervals as usize
            }
        };
        if ranges.iter().any(|range| range.field == axis.field) {
            refuse!("--over {text}: is given twice; give each field one range");
        }
        ranges.push(DesignRange::new(axis.field, (low, high), intervals));
    }
    if ranges.len() > MOST_FIELDS {
        refuse!("--over: {} fields; at most {MOST_FIELDS} are searched together", ranges.len());
    }
    Ok(ranges)
}

/// Columns that only a scene with a transducer has.
const OF_TRANSDUCER: [&str; 3] = ["mean_load_power_w", "mean_coil_power_w", "voltage_rms_v"];

/// A shorter name for the column of the power into the load, and the column.
const POWER: (&str, &str) = ("mean_power_w", "mean_load_power_w");

/// The column called `name`; an error if it is not a number.
fn number(option: &str, name: &str) -> Result<&'static SummaryField, Failure> {
    let is_number = |field: &&SummaryField| matches!(field.read, Read::Number(_) | Read::Count(_));
    let name = if name == POWER.0 { POWER.1 } else { name };
    let found = SummaryField::find(name).filter(is_number);
    found.ok_or_else(|| {
        let known: Vec<&str> = SUMMARY_FIELDS.iter().filter(is_number).map(|field| field.name).collect();
        Failure::argument(format!("{option} {name}: no such number; there are {}", known.join(", ")))
    })
}

fn constraint(text: &str) -> Result<Constraint, Failure> {
    let wrong = || {
        let message = "write COLUMN<=VALUE or COLUMN>=VALUE, such as 'max_abs_x_m<=0.003'";
        Failure::argument(format!("--subject-to {text}: {message}"))
    };
    let (name, limit, at_most) = match (text.split_once("<="), text.split_once(">=")) {
        (Some((name, limit)), _) => (name, limit, true),
        (None, Some((name, limit))) => (name, limit, false),
        _ => return Err(wrong()),
    };
    let limit = limit.trim().parse().ok().filter(|limit: &f64| limit.is_finite()).ok_or_else(wrong)?;
    Ok(Constraint { of: number(&format!("--subject-to {text}:"), name.trim())?, at_most, limit })
}

fn variation(text: &str, document: &Document) -> Result<Variation, Failure> {
    let wrong = |problem: &str| Failure::argument(format!("--vary {text}: {problem}"));
    let form = "write FIELD=+-1% or FIELD=+-0.05, such as stops.travel_limit_mm=+-1%";
    let (field, by) = text.split_once('=').ok_or_else(|| wrong(form))?;
    let field = field.trim();
    let Some(value) = FieldPath::new(field).get(&document.scene) else {
        // this error lists the fields
        Axis::parse(&format!("{field}=1"), &document.scene).map_err(|problem| wrong(&problem))?;
        refuse!("--vary {text}: the scene leaves this field out; give it a value with --set");
    };
    if is_whole(&document.scene, field) {
        refuse!(
            "--vary {text}: holds whole numbers, which do not come out a little otherwise; vary another field"
        );
    }
    let by = by.trim().trim_start_matches("+-").trim_start_matches('\u{b1}');
    let (number, relative) = by.strip_suffix('%').map_or((by, false), |share| (share, true));
    let number = number.trim().parse().ok().filter(|number: &f64| *number >= 0.0 && number.is_finite());
    let number = number.ok_or_else(|| wrong(form))?;
    if relative && value == 0.0 {
        refuse!("--vary {text}: a share of 0 is nothing; give the tolerance in the unit of the field");
    }
    let by = if relative { number / 100.0 } else { number };
    Ok(Variation { field: field.to_owned(), by, relative })
}

/// Splits a text from the weight after its last `*`, which is 1 if left out.
fn weighted<'a>(text: &'a str, option: &str) -> Result<(&'a str, f64), Failure> {
    let Some((text, weight)) = text.rsplit_once('*') else { return Ok((text.trim(), 1.0)) };
    let weight = weight.trim().parse().ok().filter(is_positive);
    let wrong = || Failure::argument(format!("{option}: the weight after * must be a number above 0"));
    Ok((text.trim(), weight.ok_or_else(wrong)?))
}

const MAX_ENVIRONMENTS: usize = 1000;

/// The environments of the design; if none are given, that of the scene.
fn environments(given: &[String], document: &Document) -> Result<Vec<Environment>, Failure> {
    let of = |name: String, weight: f64, document: &Document| Environment {
        name,
        weight,
        scene: document.scene.clone(),
        files: document.files.clone(),
    };
    if given.is_empty() {
        return Ok(vec![of(document.name.clone(), 1.0, document)]);
    }
    let mut all = Vec::new();
    for text in given {
        let option = format!("--environment {text}");
        let mut changed = document.clone();
        changed.scene.sweep.clear(); // the other excitation may not have its fields
        if let Some((field, values)) = text.split_once('=').filter(|_| !is_file(text.as_ref())) {
            for value in values.split(',') {
                let (value, weight) = weighted(value, &option)?;
                let axis = Axis::parse(&format!("{field}={value}"), &document.scene);
                let axis = axis.map_err(|problem| Failure::argument(format!("{option}: {problem}")))?;
                axis.apply(&mut changed.scene, 0);
                changed.check()?;
                all.push(of(format!("{} = {value}", axis.field), weight, &changed));
            }
        } else {
            let (name, weight) = weighted(text, &option)?;
            let wrong = |problem: String| Failure::argument(format!("{option}: {problem}"));
            if name.to_ascii_lowercase().ends_with(".csv") {
                // a name that is no file may be that of a built-in table
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
            all.push(of(name.to_owned(), weight, &changed));
        }
    }
    if all.len() > MAX_ENVIRONMENTS {
        refuse!("--environment: {} of them; at most {MAX_ENVIRONMENTS} are run", all.len());
    }
    Ok(all)
}
