//! `exponents`: Lyapunov exponents of a settled motion, or of every cell of a grid.

use clap::Args;
use interwell::dynamics::Model;
use interwell::output::{ExponentPicture, can_show_exponents, exponents_figure, exponents_manifest, header};
use interwell::scene::Document;
use interwell::study::{
    ExponentCells, ExponentOptions, ExponentTally, Exponents, Grid, NoExponents, SweepEnd, Table, Task,
    drive_fault, exponents, exponents_row,
};

use super::failure::Failure;
use super::options::{ChartOptions, Common, whole};
use super::picture::{Picture, caption, ranges};
use super::support::{
    MANIFEST, Watch, finish, inputs, load, load_with_mechanism, open, put, refuse_electrical_state,
    until_settled, warn, write_table, write_text,
};
use super::sweep::{bar, file_name, located, manifest_path, pool};
use super::{interrupt, say};

const EXAMPLES: &str = "\
Examples:
  interwell --headless exponents duffing-chaos
  interwell --headless exponents paper-unconstrained --set excitation.amplitude_g=1.3 --periods 10000
  interwell --headless exponents duffing --over excitation.amplitude_g=0.02:0.068:0.0005 --plot e.png
  interwell --headless exponents paper --over stops.travel_limit_mm=3:7:1 --over stops.restitution=0.3,0.9

A motion that rests on a stop forgets where it came from: both exponents are then minus infinity, -inf.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene; its drive has a period, or there is none
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// One row for each value of a field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Forcing periods that a motion is averaged over which does not repeat, 1 to 10000000; without a drive
    /// periods of small oscillations [default: 1000]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
          value_parser = whole::<u32>(1..=10_000_000))]
    pub periods: Option<u32>,

    /// Let the motion go on, window after window, until it repeats, or up to this time in s, before anything
    /// is averaged [default: 1000 forcing periods after the scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// The picture, with --over one field: both exponents, each with its standard error.
    #[command(flatten)]
    pub chart: ChartOptions,
}

/// Computes the exponents and writes the table.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::new(&options.chart.plot, common)?;
    if !options.over.is_empty() {
        return over(options, common, picture);
    }
    if picture.is_some() {
        can_show_exponents(None)?;
    }
    let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
    let model = Model::build(&document.scene, mechanism).map_err(|faults| document.error_from(faults))?;
    if let Some(fault) = drive_fault(&model, &document.scene) {
        return Err(document.error_from(vec![fault]).into());
    }
    refuse_electrical_state(&document, &[], "exponents")?;
    let settings = settings(options, &document, Some(&model))?;
    let mut sinks = open(&inputs(&options.scene, &document), [Some(("--out", common.out()))])?;
    let found = exponents(&model, &settings, interrupt::listen()).map_err(|problem| match problem {
        NoExponents::Cancelled => Failure::interrupted(),
        _ => Failure::Failed(anyhow::anyhow!("{}: {problem}", document.name)),
    })?;
    write_table(&mut sinks[0], &exponents_row(&found))?;
    finish(sinks)?;
    if !common.quiet {
        say(&format!("{}: {}", document.name, about(&found, model.repeats())));
    }
    Ok(())
}

/// Settings of the computation; `model` is that of the first cell, `None` if its flexures have no solution.
fn settings(
    options: &Arguments,
    document: &Document,
    model: Option<&Model>,
) -> Result<ExponentOptions, Failure> {
    let text = options.until_settled.as_deref();
    let until_settled = model.map(|model| until_settled(text, document, model)).transpose()?.flatten();
    Ok(ExponentOptions { periods: options.periods.unwrap_or(ExponentOptions::PERIODS), until_settled })
}

/// Explains the exponents of one motion in a sentence.
fn about(found: &Exponents, forced: bool) -> String {
    let unit = if forced { "forcing period" } else { "period of small oscillations" };
    let units = if forced { "forcing periods" } else { "periods of small oscillations" };
    let over = format!("averages over {} {units}", found.span.0);
    match found.period {
        _ if found.rests() => "the mass rests on a stop, after which nothing is left of a change: both \
                               exponents are minus infinity, written -inf"
            .to_owned(),
        Some(1) => format!("the motion repeats in every {unit}; the exponents are those of its multipliers"),
        Some(n) => {
            format!("the motion repeats after {n} {units}; the exponents are those of its multipliers")
        }
        None if found.is_irregular() => {
            format!("{over}, in which the motion is irregular: the first exponent is clearly above 0")
        }
        None => format!("{over}, in which no growth tells that the motion is irregular"),
    }
}

/// Computes the exponents of every cell of a grid, one row for each.
fn over(options: &Arguments, common: &Common, picture: Option<Picture>) -> Result<(), Failure> {
    let axes = ranges(&options.chart, "--plot-x")?;
    let (mut document, warnings) = load(&options.scene, common, Some(&options.over))?;
    let beside = manifest_path(common.out());
    if beside.is_some() {
        document.hold_files();
    }
    let grid = Grid::new(document.axes(&options.over)?)?;
    refuse_electrical_state(&document, grid.axes(), "exponents")?;
    if picture.is_some() {
        can_show_exponents(Some(&grid))?;
    }
    let cells = ExponentCells::new(&document.scene, &document.files, grid);
    let task = Task { tick: &|| (), cancel: interrupt::listen() };
    let pool = pool(common)?;
    cells.validate(&pool, &task).map_err(|cell| located(&document, cell))?;
    let first = cells.first_model(&task).and_then(Result::ok);
    let settings = settings(options, &document, first.as_ref())?;
    warn(&document, common, &warnings, cells.first_mechanism().ok().as_deref());
    let beside = beside.as_deref().map(|path| (MANIFEST, path));
    let [plot, data] = Picture::outputs(picture);
    let outputs = [Some(("--out", common.out())), plot, data, beside];
    let mut sinks = open(&inputs(&options.scene, &document), outputs)?;
    let mut shown = picture.map(|_| Table::new());
    let grid = cells.grid();
    let bar = bar(grid.cells(), "cells", common.quiet, common.out());
    let task = Task { tick: &|| bar.inc(1), ..task };
    let watch = Watch::start();
    write_text(&mut sinks[0], &header(&cells.empty_table()))?;
    let result = cells.run(&settings, &pool, &task, |table| {
        if let Some(shown) = &mut shown {
            shown.append(table);
        }
        put(&mut sinks[0], table, shown.is_some())
    });
    bar.finish_and_clear();
    let tally = result.map_err(|end| match end {
        SweepEnd::Cancelled => Failure::interrupted(),
        SweepEnd::Write(failure) => failure,
    })?;
    if let Some((picture, rows)) = picture.zip(shown) {
        let shown = ExponentPicture { rows: &rows, grid, scene: &document.scene, ranges: axes };
        picture.write(&mut sinks[1..3], exponents_figure(&shown, &caption(&document), &picture.theme)?)?;
    }
    if sinks[3].is_some() {
        let origin = watch.origin(pool.count());
        let text = exponents_manifest(&document, grid, &tally, &origin, &file_name(common.out()));
        write_text(&mut sinks[3], &text)?;
    }
    finish(sinks)?;
    if !common.quiet && tally.cells == grid.cells() {
        say(&summary(&tally, watch.wall_s()));
    }
    Ok(())
}

/// Sums up the cells in one line.
fn summary(tally: &ExponentTally, seconds: f64) -> String {
    let cells = if tally.cells == 1 { "1 cell".to_owned() } else { format!("{} cells", tally.cells) };
    let mut text = format!("{cells} in {seconds:.2} s");
    if tally.resting > 0 {
        text += &format!(", {} with a rest on a stop, so that both exponents are -inf", tally.resting);
    }
    if tally.missing > 0 {
        text += &format!(
            ", {} without exponents (the motion ended early, touched a stop without speed, or the flexures \
             have no solution)",
            tally.missing
        );
    }
    text
}
