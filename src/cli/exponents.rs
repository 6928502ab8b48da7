//! `exponents`: Lyapunov exponents of a settled motion, or of every cell of a grid.

use clap::Args;
use interwell::dynamics::Model;
use interwell::output::{can_show_over_field, exponents_chart};
use interwell::questions::{Error, may_have_circuit};
use interwell::scene::Document;
use interwell::study::{
    ExponentCells, ExponentOptions, Exponents, Grid, NoExponents, Table, Tally, drive_fault, exponents,
    exponents_row,
};

use super::grid_job::GridJob;
use super::support::{counted, load_model, load_over, outputs, pool, until_settled_on_grid, warn};
use super::{ChartOptions, Common, Failure, Output, Picture, interrupt, whole};

const EXAMPLES: &str = "\
Examples:
  interwell --headless exponents duffing-chaos
  interwell --headless exponents paper-unconstrained --set excitation.amplitude_g=1.3 --periods 10000
  interwell --headless exponents duffing --over excitation.amplitude_g=0.02:0.068:0.0005 --plot e.png
  interwell --headless exponents paper --over stops.travel_limit_mm=3:7:1 --over stops.restitution=0.3,0.9

A rest on a stop ends every dependence on the earlier motion: all exponents are then minus infinity, -inf.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene; its drive has a period, or there is none
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// One row for each value of a field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Forcing periods over which a motion that does not repeat is averaged, 1 to 10000000; without a drive
    /// periods of small oscillations [default: 1000]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
          value_parser = whole::<u32>(1..=10_000_000))]
    pub periods: Option<u32>,

    /// Follow the motion, window after window, until it repeats, or up to this time in s, before anything
    /// is averaged [default: 1000 forcing periods after the scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// The picture, with --over one field: the exponents, each with its standard error.
    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, "--plot-x", common)?;
    if !options.over.is_empty() {
        return over(options, common, picture);
    }
    if picture.is_some() {
        can_show_over_field(&Grid::of_one(), "exponents")?;
    }
    let (document, model) = load_model(&options.scene, common)?;
    if let Some(fault) = drive_fault(&model, &document.scene) {
        return Err(document.error_from(vec![fault]).into());
    }
    let settings = settings(options, &document, Some(&model))?;
    let mut outputs = outputs(&options.scene, &document, common)?;
    let found = exponents(&model, &settings, interrupt::listen()).map_err(|problem| match problem {
        NoExponents::Cancelled => Failure::interrupted(),
        _ => Failure::failed(format!("{}: {problem}", document.name)),
    })?;
    outputs.table(Output::DATA, &exponents_row(&found))?;
    outputs.finish_rows(&document, 1)?;
    common.say(&format!("{}: {}", document.name, about(&found, model.repeats())));
    Ok(())
}

/// Settings of the computation; `model` is that of the first cell, `None` if its flexures have no solution.
fn settings(
    options: &Arguments,
    document: &Document,
    model: Option<&Model>,
) -> Result<ExponentOptions, Failure> {
    let text = options.until_settled.as_deref();
    let until_settled = until_settled_on_grid(text, document, model)?;
    let periods = options.periods.unwrap_or(ExponentOptions::PERIODS);
    Ok(ExponentOptions { periods, until_settled, circuits: false })
}

/// Explains the exponents of one motion in a sentence.
fn about(found: &Exponents, forced: bool) -> String {
    let (unit, units) = match forced {
        true => ("forcing period", "forcing periods"),
        false => ("period of small oscillations", "periods of small oscillations"),
    };
    let multipliers = "the exponents are those of its multipliers";
    let over = format!("averages over {} {units}", found.span.0);
    match found.period {
        _ if found.rests() => "the mass rests on a stop, after which nothing is left of a change: all \
                               exponents are minus infinity, written -inf"
            .to_owned(),
        Some(1) => format!("the motion repeats in every {unit}; {multipliers}"),
        Some(n) => format!("the motion repeats after {n} {units}; {multipliers}"),
        None if found.is_irregular() => {
            format!("{over}, in which the motion is irregular: the first exponent is clearly above 0")
        }
        None => format!("{over}, in which no growth shows that the motion is irregular"),
    }
}

/// Computes the exponents of every cell of a grid, one row for each.
fn over(options: &Arguments, common: &Common, picture: Option<Picture>) -> Result<(), Failure> {
    let (document, warnings, grid) = load_over(&options.scene, &options.over, common)?;
    let circuits = may_have_circuit(&document, grid.axes());
    if picture.is_some() {
        can_show_over_field(&grid, "exponents")?;
    }
    let cells = ExponentCells::new(&document.scene, &document.files, grid);
    let task = interrupt::silent_task();
    let pool = pool(common)?;
    cells.validate(&pool, &task).map_err(|cell| Error::cells_of(&document, vec![cell]))?;
    let settings = settings(options, &document, cells.first_model(&task).as_ref())?;
    let cells = cells.with(ExponentOptions { circuits, ..settings });
    warn(&document, common, &warnings, cells.first_mechanism().ok().as_deref());
    let outputs = outputs(&options.scene, &document, common)?;
    let grid = cells.grid();
    let mut job = GridJob::open(&document, common, outputs, picture, pool)?;
    let (tally, _) = job.stream(&cells, "cells")?;
    let chart = |rows: &Table, ranges| Ok(exponents_chart(rows, grid, &document.scene, ranges)?);
    let wall_s = job.finish(chart, |manifest| Ok(manifest.of_exponents(grid, &tally)))?;
    if tally.cells == grid.cells() {
        common.say(&summary(&tally, wall_s));
    }
    Ok(())
}

fn summary(tally: &Tally, seconds: f64) -> String {
    let mut text = format!("{} in {seconds:.2} s", counted(tally.cells, "cell"));
    if tally.resting > 0 {
        text += &format!(", {} with a rest on a stop, so that all exponents are -inf", tally.resting);
    }
    if tally.without_exponents > 0 {
        text += &format!(
            ", {} without exponents (the motion ended early, touched a stop without speed, or the flexures \
             have no solution)",
            tally.without_exponents
        );
    }
    text
}
