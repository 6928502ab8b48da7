//! `exponents`: Lyapunov exponents of a settled motion, or of every cell of a grid.

use clap::Args;
use interwell::output::{can_show_over_field, exponents_chart};
use interwell::questions::{ExponentOptions, Exponents, Grid, Table};
use interwell_studies::study::Tally;

use super::grid_job::GridJob;
use super::support::{counted, load_over, load_simulation, outputs, pool, settle_limit, warn};
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

    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let periods = options.periods.unwrap_or(ExponentOptions::PERIODS);
    let until_settled = settle_limit(options.until_settled.as_deref())?;
    let settings = ExponentOptions { periods, until_settled, circuits: false };
    let question = Exponents { over: Vec::new(), options: settings };
    if !options.over.is_empty() {
        return over(options, common, &question, picture);
    }
    if picture.is_some() {
        can_show_over_field(&Grid::of_one(), "exponents")?;
    }
    let simulation = load_simulation(&options.scene, common)?;
    let document = simulation.document();
    let mut outputs = outputs(&options.scene, document, common)?;
    let found = question.of_one(&simulation, &interrupt::progress())?;
    outputs.table(Output::DATA, &found.table())?;
    outputs.finish_rows(document, 1)?;
    common.say(&format!("{}: {}", document.name, found.describe(simulation.model().repeats())));
    Ok(())
}

/// Computes the exponents of every cell of a grid, one row for each.
fn over(
    options: &Arguments,
    common: &Common,
    question: &Exponents,
    picture: Option<Picture>,
) -> Result<(), Failure> {
    let (document, warnings, grid) = load_over(&options.scene, &options.over, common)?;
    if picture.is_some() {
        can_show_over_field(&grid, "exponents")?;
    }
    let cells = question.cells(&document, grid, &interrupt::progress())?;
    warn(&document, common, &warnings, cells.first_mechanism().ok().as_deref());
    let outputs = outputs(&options.scene, &document, common)?;
    let grid = cells.grid();
    let mut job = GridJob::open(&document, common, outputs, picture, pool(common)?)?;
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
