//! `section`: the state once a forcing period or at every impact; over a field the bifurcation diagram.

use clap::Args;
use interwell::output::section_chart;
use interwell::questions::{Carry, Section, SectionAt, SectionOptions, Table};
use interwell_studies::study::{IMPACTS, MAX_SECTION, Tally};

use super::grid_job::GridJob;
use super::support::{counted, finite, load_over, load_simulation, outputs, pool, settle_limit, warn};
use super::{ChartOptions, Common, Failure, Output, Picture, interrupt, refuse, say, whole};

const EXAMPLES: &str = "\
Examples:
  interwell --headless section duffing-chaos --out section.csv --plot section.png
  interwell --headless section paper --at impacts
  interwell --headless section paper-unconstrained --over excitation.amplitude_g=1:1.5:0.005 --carry both \\
      --skip 200 --keep 100 --out diagram.csv --plot diagram.png";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// A row once a forcing period, or at each impact of the settled window that counts
    #[arg(long, value_name = "phase|impacts", value_parser = ["phase", "impacts"], default_value = "phase")]
    pub at: String,

    /// The drive's phase in degrees at which the states are [default: 0]
    #[arg(long, value_name = "P", allow_hyphen_values = true)]
    pub phase_deg: Option<String>,

    /// One section for each value of a field: the bifurcation diagram (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Walk the last --over field in its order (up), backwards (down) or both ways: each run from the end of
    /// the one before, only the first from the scene's start
    #[arg(long, value_name = "up|down|both", value_parser = ["up", "down", "both"], requires = "over")]
    pub carry: Option<String>,

    /// Forcing periods to skip, in place of run.settle_s; needs --keep
    #[arg(long, value_name = "N", allow_hyphen_values = true, requires = "keep",
          value_parser = whole::<u64>(0..=1_000_000_000))]
    pub skip: Option<u64>,

    /// Forcing periods of the settled window after the skipped ones, in place of run.duration_s; needs --skip
    #[arg(long, value_name = "N", allow_hyphen_values = true, requires = "skip",
          value_parser = whole::<u64>(1..=MAX_SECTION))]
    pub keep: Option<u64>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    #[command(flatten)]
    pub chart: ChartOptions,
}

/// Takes the section, or one for each cell, and writes the rows.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let at = match (&*options.at, options.phase_deg.as_deref()) {
        ("impacts", None) => SectionAt::Impacts,
        ("impacts", Some(_)) => {
            refuse!("--phase-deg belongs to states once a period: leave it out, or leave out --at impacts")
        }
        (_, None) => SectionAt::Phase(0.0),
        (_, Some(text)) => {
            SectionAt::Phase(finite("--phase-deg", text, "give an angle in degrees, such as 90")?)
        }
    };
    let carry = options.carry.as_deref().and_then(Carry::named);
    let until_settled = settle_limit(options.until_settled.as_deref())?;
    let settings = SectionOptions { at, periods: options.skip.zip(options.keep), until_settled, carry };
    let question = Section { over: Vec::new(), options: settings };
    if options.over.is_empty() {
        single(options, common, &question)
    } else {
        diagram(options, common, &question)
    }
}

fn single(options: &Arguments, common: &Common, question: &Section) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let simulation = load_simulation(&options.scene, common)?;
    let document = simulation.document();
    let mut outputs = outputs(&options.scene, document, common)?.with_picture(picture)?;
    let (table, summary) = question.of_one(&simulation, &interrupt::progress())?;
    outputs.table(Output::DATA, &table.without(IMPACTS))?;
    let stops = simulation.model().stop_positions();
    let chart = |ranges| Ok(section_chart(&table, None, phase(question), stops, ranges));
    outputs.draw(picture, document, chart)?;
    outputs.finish_rows(document, 1)?;
    if table.rows() == 0 && question.options.at == SectionAt::Impacts {
        common.say(&format!("{}: no rows, since no impact counts in the settled window", document.name));
    }
    if let Some(at) = summary.outcome.ended_at() {
        let name = summary.outcome.name();
        say(&format!("{}: the run ended early at t = {at} s ({name}): the rows end there", document.name));
    }
    Ok(())
}

fn phase(question: &Section) -> Option<f64> {
    if let SectionAt::Phase(degrees) = question.options.at { Some(degrees) } else { None }
}

/// The sections of all cells, written as they are computed.
fn diagram(options: &Arguments, common: &Common, question: &Section) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let (document, warnings, grid) = load_over(&options.scene, &options.over, common)?;
    let fields = grid.axes().len();
    if picture.is_some() && fields > 1 {
        refuse!(
            "--plot shows a diagram over one field, not over {fields}: take the others out, or draw nothing"
        );
    }
    let sections = question.cells(&document, grid, &interrupt::progress())?;
    warn(&document, common, &warnings, sections.first_mechanism().ok().as_deref());
    let pool = pool(common)?;
    let outputs = outputs(&options.scene, &document, common)?;
    let mut job = GridJob::open(&document, common, outputs, picture, pool)?;
    let (tally, count) = job.stream(&sections, "runs")?;
    let grid = sections.grid();
    let chart =
        |rows: &Table, ranges| Ok(section_chart(rows, Some(grid), phase(question), (None, None), ranges));
    let wall_s = job.finish(chart, |manifest| Ok(manifest.of_rows(grid, &tally, None)))?;
    if tally.cells == sections.rows() {
        let rows = counted(count as u64, "row");
        common.say(&format!("{rows} of {} in {wall_s:.2} s", runs(&tally)));
    }
    Ok(())
}

/// The number of runs in words, and the number of those that ended early.
fn runs(tally: &Tally) -> String {
    let cells = counted(tally.cells, "run");
    match (tally.ended_early, tally.not_converged) {
        (0, 0) => cells,
        (n, 0) => format!("{cells}, {n} of which ended early,"),
        (0, m) => format!("{cells}, {m} of which have no solution of the flexures,"),
        (n, m) => format!("{cells}, {n} of which ended early and {m} have no solution of the flexures,"),
    }
}
