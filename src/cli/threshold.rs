//! `threshold`: thresholds of a field, a row for each cell of a grid.

use clap::Args;
use interwell::numeric::extent;
use interwell::output::{ThresholdPicture, can_show_thresholds, threshold_chart};
use interwell::scene::{Axis, Document, is_whole};
use interwell::study::{CellFaults, Grid, NoThresholds, Onset, Scan, Table, threshold_table};

use super::support::{
    drive_alone, is_positive, load, located, mechanism, number, outputs, pool, until_settled, warn,
};
use super::{ChartOptions, Common, Failure, Output, Picture, caption, refuse, with_bar};

const EXAMPLES: &str = "\
Examples:
  interwell --headless threshold paper
  interwell --headless threshold paper --of release --over stops.travel_limit_mm=0.5:6.5:0.5 --plot free.png
  interwell --headless threshold paper --over stops.travel_limit_mm=0.5:6.5:0.25 --plot cross.png
  interwell --headless threshold paper --field stops.travel_limit_mm=0.5:3:0.05 --of interwell
  interwell --headless threshold paper --over excitation.frequency_hz=2,3,4 \\
      --over stops.travel_limit_mm=0.5:6:0.25 --plot lines.png";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene; each run begins at rest
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// The field and its range [default of the step: a 200th of the range]
    #[arg(
        long,
        value_name = "FIELD=FROM:TO[:STEP]",
        default_value = AMPLITUDES,
        allow_hyphen_values = true
    )]
    pub field: String,

    /// What begins there: release (the mass leaves the stop it rests on), crossing (the settled motion
    /// crosses at all) or interwell (its crossings repeat)
    #[arg(long, value_name = "ONSET", default_value = "crossing",
          value_parser = ["release", "crossing", "interwell"])]
    pub of: String,

    /// How closely the threshold is located, in the field's unit [default: a 1000th of the step; of a field
    /// of whole numbers 1]
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub resolution: Option<String>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s: longer is
    /// surer where the motion is irregular [default: 1000 forcing periods after the scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// One row for each value of another field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// The picture: over one field of --over a line, over two a line for each value of the one that has few,
    /// or a map.
    #[command(flatten)]
    pub chart: ChartOptions,
}

const AMPLITUDES: &str = "excitation.amplitude_g=0:2";

const STEPS: f64 = 200.0;

const MAX_NAMED: usize = 8;

/// Searches and writes the table.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, "--plot-x", common)?;
    // without --over the sweep in the scene is ignored
    let over = Some(options.over.as_slice()).filter(|over| !over.is_empty());
    let (document, warnings) = load(&options.scene, common, over)?;
    let mut scan = scan(options, &document)?;
    let grid = match over {
        None => Grid::of_one(),
        Some(over) => Grid::new(document.axes(over)?)?,
    };
    if grid.axes().iter().any(|axis| axis.field == scan.field) {
        refuse!("--over {}: the threshold is over it; sweep another field", scan.field);
    }
    let onset = Onset::named(&options.of).unwrap_or(Onset::Crossing);
    if picture.is_some() {
        can_show_thresholds(&grid)?;
    }
    let mechanism = (!grid.changes_mechanism()).then(|| mechanism(&document)).transpose()?;
    warn(&document, common, &warnings, mechanism.as_deref());
    if let Some(text) = options.until_settled.as_deref() {
        let mut first = document.scene.clone();
        grid.apply(0, &mut first);
        scan.until_settled = until_settled(Some(text), &document, &drive_alone(&document, first)?)?;
    }
    let pool = pool(common)?;
    let mut outputs = outputs(&options.scene, &document, common)?.with_picture(picture)?;
    let Document { scene, files, name, .. } = &document;
    let values = grid.cells() * scan.values.len() as u64;
    let found = with_bar(values, "values", common, |task| {
        threshold_table(scene, files, &grid, &scan, onset, &pool, task)
    });
    let table = found.map_err(|end| match end {
        NoThresholds::Cancelled => Failure::interrupted(),
        NoThresholds::Wrong(cells) => wrong(&document, cells),
    })?;
    outputs.table(Output::DATA, &table)?;
    let remarks = [missing(&table, &scan, onset, &grid), undecided(&table)];
    remarks.iter().flatten().for_each(|words| common.say(&format!("{name}: {words}")));
    if let Some(picture) = picture {
        let (rows, grid, field) = (&table, &grid, &*scan.field);
        let shown = ThresholdPicture { rows, grid, scene, field, onset, ranges: picture.ranges };
        picture.write(&mut outputs, &threshold_chart(&shown)?, &caption(&document))?;
    }
    outputs.finish()
}

/// The clause "`count` of `all` rows" with the singular or plural of a verb. Returns `None` if `count` is 0.
fn of_rows(count: usize, all: usize, verbs: [&str; 2]) -> Option<String> {
    match (count, all) {
        (0, _) => None,
        (1, 1) => Some(format!("the row {}", verbs[0])),
        (count, all) => Some(format!("{count} of {all} rows {}", verbs[1])),
    }
}

/// Explains `undecided`, if it is true in a row.
fn undecided(table: &Table) -> Option<String> {
    let words = table.words("undecided");
    let count = words.iter().filter(|word| **word == "true").count();
    let rows = of_rows(count, words.len(), ["is undecided", "are undecided"])?;
    Some(format!(
        "{rows}: the answer just below or at the value (without a value, at the end of the range) is not \
         known: the motion does not repeat in the time for which it is followed, the run ended early, or \
         there is no valid scene; low and high, where given, are values whose answers are known, and \
         --until-settled with a longer time may bring them together"
    ))
}

/// Explains an empty `value`, if a row has one.
fn missing(table: &Table, scan: &Scan, onset: Onset, grid: &Grid) -> Option<String> {
    let values = table.numbers("value")?;
    let count = values.iter().filter(|value| value.is_nan()).count();
    let rows = of_rows(count, values.len(), ["has no value", "have no value"])?;
    let what = match onset {
        Onset::Release => "releases the mass from a stop",
        Onset::Crossing => "makes the settled motion cross",
        Onset::Interwell => "makes the settled motion interwell",
    };
    let (low, high) = extent(scan.values.iter().copied());
    let unsolved = match grid.changes_mechanism() || scan.field.starts_with("mechanism") {
        true => ", or the flexures are not solved",
        false => "",
    };
    Some(format!(
        "{rows}: no {} that was tried from {low} to {high} {what}{unsolved}; give --field a wider range or \
         smaller steps",
        scan.field
    ))
}

fn wrong(document: &Document, cells: Vec<CellFaults>) -> Failure {
    let more = cells.len().saturating_sub(MAX_NAMED);
    let mut text: Vec<String> =
        cells.into_iter().take(MAX_NAMED).map(|cell| located(document, cell).to_string()).collect();
    if more > 0 {
        text.push(format!("and {more} more cells are wrong"));
    }
    Failure::argument(text.join("\n"))
}

fn scan(options: &Arguments, document: &Document) -> Result<Scan, Failure> {
    let argument = options.field.trim();
    let default = if argument == AMPLITUDES { " (the default; give another)" } else { "" };
    let option = format!("--field {argument}{default}");
    let parsed = |text: &str| -> Result<Axis, Failure> {
        let axis = Axis::parse(text, &document.scene);
        let axis = axis.map_err(|problem| Failure::argument(format!("{option}: {problem}")))?;
        if !axis.values.iter().all(|value| value.is_finite()) {
            refuse!("{option}: the ends of the range must be finite");
        }
        Ok(axis)
    };
    let (mut full, mut end) = (argument.to_owned(), None);
    if let Some((from, to)) = argument.split_once(':').filter(|(_, to)| !to.contains(':')) {
        // parsed as a list, so that the message names a wrong end
        let ends = parsed(&format!("{from},{to}"))?;
        let [low, high] = ends.values[..] else {
            refuse!(
                "{option}: write FIELD=FROM:TO or FIELD=FROM:TO:STEP, such as excitation.amplitude_g=0:2"
            );
        };
        if low == high {
            refuse!("{option}: FROM and TO are both {low}; give a range, such as 0:2");
        }
        if low > high {
            refuse!("{option}: TO must be above FROM; write {high}:{low}");
        }
        let step = (high - low) / STEPS;
        let step = if is_whole(&document.scene, &ends.field) { step.ceil() } else { step };
        (full, end) = (format!("{argument}:{step}"), Some(high));
    }
    let axis = parsed(&full)?;
    let mut values = axis.values;
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        refuse!("{option}: it is a single value; give a range of which STEP is a part, such as 0:2:0.1");
    }
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    if let Some(high) = end {
        // the range may be no whole number of steps, and rounding may place the last one just below its end
        values.retain(|value| *value < high - 1e-6 * step);
        values.push(high);
    }
    let whole = is_whole(&document.scene, &axis.field);
    let resolution = match &options.resolution {
        None if whole => 1.0,
        None => 1e-3 * step,
        Some(text) => {
            let fits = |value: &f64| is_positive(value) && (!whole || value.fract() == 0.0);
            let kind = if whole { "whole number" } else { "number" };
            number("--resolution", text, fits, &format!("give a {kind} above 0, in the unit of the field"))?
        }
    };
    Ok(Scan { field: axis.field, values, resolution, until_settled: None })
}
