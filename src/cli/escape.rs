//! `escape`: rates at which motions under noise leave their well, a row for each cell of a grid.

use clap::Args;
use interwell::output::{can_show_over_field, escape_chart};
use interwell::questions::{Escape, Until};

use super::support::{if_given, load_over, mechanism_of_all, outputs};
use super::{ChartOptions, Common, Failure, Output, Picture, ask, whole};

const EXAMPLES: &str = "\
Examples:
  interwell --headless escape paper --set 'excitation=Noise(rms_g:0.8,low_hz:0.5,high_hz:20,seed:1)' --runs 50
  interwell --headless escape my-noise.ron --runs 200 --within 100 --over excitation.rms_g=0.2:0.6:0.05 \\
      --plot rate.png
  interwell --headless escape my-noise.ron --until crossing --over stops.travel_limit_mm=2:6:0.5 --out e.csv

Run number i, from 0, has the seed of the scene plus i: `simulate --set excitation.seed=..` repeats one.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene; its excitation is a noise, or a sum with one
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Runs of each cell, each with another seed of the noise, 1 to 1000000
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "100",
          value_parser = whole::<u64>(1..=1_000_000))]
    pub runs: u64,

    /// Time in s at which a run without an escape ends [default: the duration of the scene's run]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub within: Option<String>,

    /// What ends a run: well (the mass first reaches the well behind the barrier, or the middle between the
    /// barrier and a stop before it) or crossing (it first crosses the top of the barrier, from which it may
    /// fall back)
    #[arg(long, value_name = "ESCAPE", default_value = "well", value_parser = ["well", "crossing"])]
    pub until: String,

    /// One row for each value of a field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let (document, warnings, grid) = load_over(&options.scene, &options.over, common)?;
    if picture.is_some() {
        can_show_over_field(&grid, "escapes")?;
    }
    let within = if_given("--within", options.within.as_deref(), "give a time in s, such as 100")?;
    let until = Until::named(&options.until).unwrap_or(Until::Well);
    let question = Escape { runs: options.runs, within, until, ..Escape::default() };
    question.options(&document, &grid)?;
    mechanism_of_all(&document, &grid, common, &warnings)?;
    let mut outputs = outputs(&options.scene, &document, common)?.with_picture(picture)?;
    let table = ask("runs", common, |progress| question.in_cells(&document, &grid, progress))?;
    outputs.table(Output::DATA, &table)?;
    common.say(&format!("{}: {}", document.name, Escape::describe(&table)));
    outputs.draw(picture, &document, |ranges| {
        Ok(escape_chart(&table, &grid, &document.scene, &question, ranges)?)
    })?;
    outputs.finish_rows(&document, common.jobs())
}
