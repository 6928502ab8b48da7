//! `threshold`: thresholds of a field, a row for each cell of a grid.

use clap::Args;
use interwell::scene::{Axis, Document};
use interwell::study::{Grid, Onset, Scan, Task, threshold_table};

use super::failure::Failure;
use super::interrupt;
use super::options::Common;
use super::support::{finish, inputs, load_with_mechanism, open, write_table};
use super::sweep::{located, pool};

/// What it takes.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene; each run begins at rest
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// The field and its range [default of the step: a 200th of the range]
    #[arg(
        long,
        value_name = "FIELD=FROM:TO[:STEP]",
        default_value = "excitation.amplitude_g=0:2",
        allow_hyphen_values = true
    )]
    pub field: String,

    /// What begins there: release (the mass leaves the stop it rests on), crossing (the settled motion
    /// crosses at all) or interwell (its crossings repeat)
    #[arg(long, value_name = "ONSET", default_value = "crossing",
          value_parser = ["release", "crossing", "interwell"])]
    pub of: String,

    /// How closely the threshold is located, in the field's unit [default: a 1000th of the step]
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub resolution: Option<String>,

    /// One row for each value of another field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// Steps of a scan whose step was left out.
const STEPS: f64 = 200.0;

/// Searches and writes the table.
pub fn run(options: &Arguments) -> Result<(), Failure> {
    let common = &options.common;
    let (document, _) = load_with_mechanism(&options.scene, common)?;
    let scan = scan(options, &document)?;
    let grid = match options.over.as_slice() {
        [] => None,
        over => Some(Grid::new(document.axes(over)?)?),
    };
    if let Some(axis) = grid.iter().flat_map(|grid| grid.axes()).find(|axis| axis.field == scan.field) {
        let field = &axis.field;
        return Err(Failure::argument(format!(
            "--over {field}: the threshold is over it; sweep another field"
        )));
    }
    let onset = Onset::ALL.into_iter().find(|onset| onset.name() == options.of).unwrap_or(Onset::Crossing);
    let pool = pool(common)?;
    let mut sinks = open(&inputs(&options.scene, &document), [Some(("--out", common.out()))])?;
    let task = Task { tick: &|| (), cancel: interrupt::listen() };
    let found =
        threshold_table((&document.scene, &document.files), grid.as_ref(), (&scan, onset), &pool, &task);
    let table = found.ok_or_else(Failure::interrupted)?.map_err(|cell| located(&document, cell))?;
    write_table(&mut sinks[0], &table)?;
    finish(sinks)
}

/// What is searched over.
fn scan(options: &Arguments, document: &Document) -> Result<Scan, Failure> {
    let argument = options.field.trim();
    let wrong = |problem: String| Failure::argument(format!("--field {argument}: {problem}"));
    let parts: Vec<&str> = argument.split(':').collect();
    let full = match parts[..] {
        [from, to] => {
            let number = |text: &str| {
                let end = text.rsplit('=').next().unwrap_or(text).trim();
                end.parse::<f64>().ok().filter(|own| own.is_finite())
            };
            let (Some(low), Some(high)) = (number(from), number(to)) else {
                return Err(wrong(
                    "write FIELD=FROM:TO or FIELD=FROM:TO:STEP, such as excitation.amplitude_g=0:2".into(),
                ));
            };
            if low >= high {
                return Err(wrong("TO must be above FROM".into()));
            }
            format!("{argument}:{}", (high - low) / STEPS)
        }
        _ => argument.to_owned(),
    };
    let axis = Axis::parse(&full, &document.scene).map_err(wrong)?;
    let mut values = axis.values;
    values.sort_by(f64::total_cmp);
    let span = values.last().copied().unwrap_or(0.0) - values.first().copied().unwrap_or(0.0);
    let step = span / (values.len().max(2) - 1) as f64;
    let resolution = match &options.resolution {
        None => 1e-3 * step,
        Some(text) => {
            text.trim().parse().ok().filter(|own: &f64| *own > 0.0 && own.is_finite()).ok_or_else(|| {
                Failure::argument(format!(
                    "--resolution {text}: give a number above 0, in the unit of the field"
                ))
            })?
        }
    };
    Ok(Scan { field: axis.field, values, resolution })
}
