//! `threshold`: thresholds of a field, a row for each cell of a grid.

use clap::Args;
use interwell::output::{can_show_thresholds, threshold_chart};
use interwell::questions::{Escape, Onset, ProbableThreshold, Searched, Threshold};
use interwell::scene::Document;

use super::support::{if_given, load_over, mechanism_of_all, outputs, settle_limit};
use super::{ChartOptions, Common, Failure, Output, Picture, ask, whole};

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

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene; each run begins at rest
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// The field and its range [default of the step: a 200th of the range]. An amplitude of the drive needs
    /// no range: it is searched upward, in steps that suit the mechanism, as by compare [default: the
    /// amplitude of the drive; with --probability the RMS of the noise, 0 to 2 g]
    #[arg(long, value_name = "FIELD[=FROM:TO[:STEP]]", allow_hyphen_values = true)]
    pub field: Option<String>,

    /// Onset: release (the mass leaves the stop it rests on), crossing (the settled motion
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

    /// Under a noise: search the value at which this share of the runs, each with another seed, crosses the
    /// barrier within a time, such as 0.5 for half of them
    #[arg(long, value_name = "P", allow_hyphen_values = true, conflicts_with_all = ["of", "until_settled"])]
    pub probability: Option<String>,

    /// With --probability: number of runs, 1 to 1000000 [default: 100]
    #[arg(long, value_name = "N", allow_hyphen_values = true, requires = "probability",
          value_parser = whole::<u64>(1..=1_000_000))]
    pub runs: Option<u64>,

    /// With --probability: the time in s within which a run is to cross [default: the duration of the
    /// scene's run]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, requires = "probability")]
    pub within: Option<String>,

    /// Add the column melnikov_g: Melnikov's threshold of the amplitude of a Sine, from quadrature; of a
    /// Cosine or Force melnikov_m_per_s2 or melnikov_n
    #[arg(long, conflicts_with = "probability")]
    pub melnikov: bool,

    /// One row for each value of another field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    #[command(flatten)]
    pub chart: ChartOptions,
}

/// The threshold of a motion, and that of a share of the runs under noise where one is given.
fn questions(options: &Arguments) -> Result<(Threshold, Option<ProbableThreshold>), Failure> {
    let remedy = "give a number above 0, in the unit of the field";
    let resolution = if_given("--resolution", options.resolution.as_deref(), remedy)?;
    let probability = options.probability.as_deref();
    let probability = if_given("--probability", probability, "give a share, such as 0.5")?;
    let within = if_given("--within", options.within.as_deref(), "give a time in s, such as 100")?;
    let probable = probability.map(|probability| {
        let (field, runs) = (options.field.clone(), options.runs.unwrap_or(Escape::RUNS));
        ProbableThreshold { over: Vec::new(), field, probability, runs, within, resolution }
    });
    let of = Onset::named(&options.of).unwrap_or(Onset::Crossing);
    let until_settled = settle_limit(options.until_settled.as_deref())?;
    let (over, field, melnikov) = (Vec::new(), options.field.clone(), options.melnikov);
    Ok((Threshold { over, field, of, resolution, until_settled, melnikov }, probable))
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let (document, warnings, grid) = load_over(&options.scene, &options.over, common)?;
    let ((question, probable), Document { scene, name, .. }) = (questions(options)?, &document);
    let (onset, searched) = match &probable {
        Some(probable) => {
            probable.chance(&document, &grid)?;
            (Onset::Crossing, Searched::Scan(probable.scan(&document, &grid)?))
        }
        None => (question.of, question.searched(&document, &grid)?),
    };
    if picture.is_some() {
        can_show_thresholds(&grid)?;
    }
    let parts = if let Searched::Scan(_) = &searched { "values" } else { "thresholds" };
    let mechanism = mechanism_of_all(&document, &grid, common, &warnings)?;
    let mut outputs = outputs(&options.scene, &document, common)?.with_picture(picture)?;
    let table = match &probable {
        Some(probable) => ask("runs", common, |progress| probable.in_cells(&document, &grid, progress)),
        None => ask(parts, common, |progress| question.in_cells(&document, &grid, progress)),
    }?;
    outputs.table(Output::DATA, &table)?;
    let remarks = match &probable {
        Some(probable) => probable.remarks_in_cells(&document, &grid, &table),
        None => question.remarks_in_cells(&document, &grid, mechanism.as_deref(), &table),
    };
    remarks.iter().for_each(|words| common.say(&format!("{name}: {words}")));
    let chart = |ranges| Ok(threshold_chart(&table, &grid, scene, searched.field(), onset, ranges)?);
    outputs.draw(picture, &document, chart)?;
    outputs.finish_rows(&document, common.jobs())
}
