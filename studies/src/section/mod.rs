//! Section of a motion: its stroboscopic states or its impacts over the settled window.
//!
//! Over a grid it gives a bifurcation diagram.

mod chart;

use std::sync::atomic::AtomicBool;

use clap::Args;
use serde::{Deserialize, Serialize};

use crate::dynamics::{Event, EventKind, Model, Request, Run, SectionPoint, Summary};
use crate::output::NoPicture;
use crate::questions::{Error, Progress, check_until, phase, settles};
use crate::scene::{Fault, Scene};
use crate::study::grid_study::{AHEAD, fields};
use crate::study::walk::without_a_period;
use crate::study::{
    Answered, Carry, Cell, Grid, GridStudy, Heading, Over, Question, Remark, Row, Scenes, Streamed, Study,
    Table, Tally, counted, named, number, study_methods, whole,
};

/// The state once a forcing period or at every impact; over a field the bifurcation diagram.
///
/// # Method
///
/// The states are a section of Poincaré, taken from the polynomials of the integrator. The more periods are
/// skipped, the fewer rows belong to a transient. The cost is that of the forcing periods that are run.
/// Motions that begin to graze a stop have bifurcations of their own (Nordmark 1991).
///
/// # Errors
///
/// [`Error::Argument`] for wrong fields, numbers of periods, phase or `until_settled`, and for `carry`
/// without a field; [`Error::Scene`], in a grid [`Error::Cells`], if the drive does not repeat (impacts alone
/// need no period) or the settled window holds no forcing period or more than 4194304.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Progress, Section, Simulation};
///
/// // From 5 to 10 s at 3 Hz: 15 states, all at rest on the stop at 4 mm.
/// let simulation = Simulation::preset("nominal-cubic")?;
/// let table = Section::default().run(&simulation, &Progress::none())?;
/// assert_eq!(table.rows(), 15);
/// assert!(table.numbers("x_m").unwrap().iter().all(|x| (x - 4e-3).abs() < 1e-9));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Section {
    /// The fields, the slowest first; if there are none, the section is that of the scene.
    #[arg(skip)]
    pub over: Over,
    /// A row once a forcing period, or at each impact of the settled window that counts
    #[arg(long, value_name = "phase|impacts", default_value = "phase")]
    pub at: SectionKind,
    /// The drive's phase in degrees at which the states are [default: 0]
    #[arg(long, value_name = "P", allow_hyphen_values = true)]
    #[arg(value_parser = number("give an angle in degrees, such as 90"))]
    pub phase_deg: Option<f64>,
    /// Walk the last field in its order (up), backwards (down) or both ways: each run from the end of the one
    /// before, only the first from the scene's start
    #[arg(long, value_name = "up|down|both")]
    pub carry: Option<Carry>,
    /// Forcing periods to skip, in place of run.settle_s; needs those to keep
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole::<u64>(0..=MAX_SKIP))]
    pub skip: Option<u64>,
    /// Forcing periods of the settled window after the skipped ones, in place of run.duration_s
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole::<u64>(1..=MAX_SECTION))]
    pub keep: Option<u64>,
    /// Follow each run, window after window, until its motion repeats, or up to this time in s
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    #[arg(value_parser = number("not a time; give seconds, such as 300"))]
    pub until_settled: Option<f64>,
}

words! {
    /// What a section lists.
    SectionKind {
        /// The state at one phase of each forcing period.
        Phase = "phase",
        /// The impacts that count.
        Impacts = "impacts",
    }
}

const EXAMPLES: &str = "\
Examples:
  interwell --headless section duffing-chaos --out section.csv --plot section.png
  interwell --headless section paper --at impacts
  interwell --headless section paper-unconstrained --over excitation.amplitude_g=1:1.5:0.005 --carry both \\
      --skip 200 --keep 100 --out diagram.csv --plot diagram.png";

/// Largest number of forcing periods that a section skips.
const MAX_SKIP: u64 = 1_000_000_000;

impl Default for Section {
    fn default() -> Self {
        let (at, carry) = (SectionKind::Phase, None);
        Self { over: Vec::new(), at, phase_deg: None, carry, skip: None, keep: None, until_settled: None }
    }
}

study_methods!(Section);

impl Study for Section {
    const NAME: &'static str = "section";
    const PARTS: &'static str = "runs";
    const ROW_A_CELL: bool = false;
    const PYTHON: &'static str = "\
>>> scene.section().rows
15";

    fn over(&self) -> &Over {
        &self.over
    }

    fn check(&self, scenes: &Scenes) -> Result<(), Error> {
        let wrong = |name: &str, value: &str, problem: &str| Err(Error::argument(name, value, problem));
        let together = format!(
            "{} and {} belong together: give both, in forcing periods",
            named!("skip"),
            named!("keep")
        );
        match (self.at, self.phase_deg, self.carry) {
            (SectionKind::Impacts, Some(degrees), _) => {
                let problem = format!(
                    "belongs to states once a period: leave it out, or leave out {} impacts",
                    named!("at")
                );
                return wrong("phase_deg", &degrees.to_string(), &problem);
            }
            (.., Some(carry)) if scenes.grid.axes().is_empty() => {
                return wrong(
                    "carry",
                    carry.name(),
                    &format!("walks a field: name one by {}", named!("over")),
                );
            }
            (_, degrees, _) => phase(degrees.unwrap_or(0.0))?,
        };
        match (self.skip, self.keep) {
            (Some(periods), None) => wrong("skip", &periods.to_string(), &together),
            (None, Some(periods)) => wrong("keep", &periods.to_string(), &together),
            (Some(periods), _) if periods > MAX_SKIP => {
                wrong("skip", &periods.to_string(), &format!("skip at most {MAX_SKIP} forcing periods"))
            }
            (_, Some(periods)) if !(1..=MAX_SECTION).contains(&periods) => {
                wrong("keep", &periods.to_string(), &format!("keep 1 to {MAX_SECTION} forcing periods"))
            }
            _ => Ok(()),
        }
    }

    /// The section of the scene alone.
    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let (model, document, options) = (scenes.model()?, scenes.document, self.options());
        check_until(self.until_settled, document, &options.model(model.clone()))?;
        let found = section(&model, scenes.scene(), &options, progress.stop());
        let (table, summary) = found.map_err(|fault| Error::faults_of(document, vec![fault]))?;
        if progress.is_stopped() {
            return Err(Error::Cancelled);
        }
        let none = (table.rows() == 0 && self.at == SectionKind::Impacts)
            .then(|| "no rows, since no impact counts in the settled window".to_owned().into());
        let early = summary.outcome.ended_at().map(|at| {
            let name = summary.outcome.name();
            Remark::warning(format!("the run ended early at t = {at} s ({name}): the rows end there"))
        });
        let (phase_deg, stops) = (self.phase_deg(), model.stop_positions());
        let answer = Answered::new(table).told(none.into_iter().chain(early));
        Ok(answer.drawn(move |rows, framing| Ok(chart::chart(rows, None, phase_deg, stops, framing.ranges))))
    }

    fn streamed(&self, scenes: &Scenes, progress: &Progress) -> Result<Option<Streamed>, Error> {
        if scenes.grid.axes().is_empty() {
            return Ok(None);
        }
        let (document, grid, phase_deg) = (scenes.document, scenes.grid.clone(), self.phase_deg());
        let study = GridStudy::new(&document.scene, &document.files, grid.clone()).with(self.options());
        Ok(Some(Streamed {
            rows: Box::new(settles(study, self.until_settled, document, progress)?),
            remark: described,
            manifest: |manifest, grid, tally| manifest.of_rows(grid, tally, None),
            chart: Box::new(move |rows, framing| {
                Ok(chart::chart(rows, Some(&grid), phase_deg, (None, None), framing.ranges))
            }),
        }))
    }

    fn can_draw(&self, grid: &Grid) -> Result<(), NoPicture> {
        match grid.axes().len() {
            0 | 1 => Ok(()),
            n => Err(NoPicture::OneField("a diagram", n)),
        }
    }

    fn columns() -> Vec<Vec<Heading>> {
        Vec::new()
    }
}

impl Section {
    fn options(&self) -> SectionOptions {
        let at = self.phase_deg().map_or(SectionAt::Impacts, SectionAt::Phase);
        let (periods, until_settled) = (self.skip.zip(self.keep), self.until_settled);
        SectionOptions { at, periods, until_settled, carry: self.carry }
    }

    /// The phase in degrees of the states.
    fn phase_deg(&self) -> Option<f64> {
        (self.at == SectionKind::Phase).then(|| self.phase_deg.unwrap_or(0.0))
    }
}

/// The number of rows and runs in words, and the number of those that ended early.
fn described(tally: &Tally, rows: usize, seconds: f64) -> String {
    let runs = counted(tally.cells, "run");
    let early = match (tally.ended_early, tally.not_converged) {
        (0, 0) => String::new(),
        (n, 0) => format!(", {n} of which ended early,"),
        (0, m) => format!(", {m} of which have no solution of the flexures,"),
        (n, m) => format!(", {n} of which ended early and {m} have no solution of the flexures,"),
    };
    format!("{} of {runs}{early} in {seconds:.2} s", counted(rows as u64, "row"))
}

/// Largest number of states of one section.
pub const MAX_SECTION: u64 = 1 << 22;

/// Number of states that are kept in memory before their rows are written.
const KEPT: u64 = 1 << 21;

/// Extra column of the table of states: the number of impacts in the settled window.
pub const IMPACTS: &str = "impacts_in_window";

/// Where a section is taken.
///
/// Sections at several phases show how the set of states is stretched and folded within a period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SectionAt {
    /// At this phase of the drive in degrees; for a sum of sines, 360 degrees are the common period.
    Phase(f64),
    /// At every impact that counts, contacts with a compliant stop among them.
    Impacts,
}

/// How a section is taken.
///
/// Without [`periods`](Self::periods) the section is that of the settled window of the scene's run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionOptions {
    /// Where it is taken.
    pub at: SectionAt,
    /// Forcing periods that are skipped and that make the settled window, in place of the scene's run.
    pub periods: Option<(u64, u64)>,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
    /// The last field of a grid is walked, as in a [sweep](crate::questions::Sweep::carry).
    pub carry: Option<Carry>,
}

/// The section of one run.
#[derive(Debug, Clone)]
pub struct Sectioned {
    cell: Cell,
    /// Its states, if it is taken at a phase.
    states: Vec<SectionPoint>,
    /// Its impacts, if it is taken at impacts, each with the phase in degrees of a drive that repeats.
    impacts: Vec<(Event, Option<f64>)>,
}

impl Sectioned {
    fn len(&self) -> usize {
        self.states.len() + self.impacts.len()
    }
}

impl Question for SectionOptions {
    type Answer = Sectioned;

    fn request(&self) -> Option<Request<'_>> {
        let (section, events) = match self.at {
            SectionAt::Phase(degrees) => (Some(degrees.rem_euclid(360.0) / 360.0), false),
            SectionAt::Impacts => (None, true),
        };
        Some(Request { section, events, until_settled: self.until_settled, ..Request::default() })
    }

    fn model(&self, model: Model) -> Model {
        match self.periods.zip(model.forcing_period()) {
            Some(((skip, keep), period)) => {
                model.with_duration((skip + keep) as f64 * period, skip as f64 * period)
            }
            None => model,
        }
    }

    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault> {
        let strobed = matches!(self.at, SectionAt::Phase(_));
        let needs = match (strobed, self.carry, self.periods) {
            (true, ..) => "a section at one phase",
            (_, Some(_), _) => "a walk from cell to cell",
            (.., Some(_)) => "a number of periods",
            _ => return None,
        };
        if let Some(fault) = without_a_period(model, scene, needs) {
            return Some(fault);
        }
        let (periods, period) = (model.window_periods().0, model.forcing_period()?);
        let long = |problem: String| {
            let value = scene.run.duration_s.to_string();
            Some(Fault { field: "run.duration_s".into(), value, problem })
        };
        match periods {
            _ if !strobed => None,
            0 => long(format!(
                "leaves a settled window of {} s, less than one forcing period of {period} s; lengthen the \
                 run",
                model.duration() - model.settle()
            )),
            1..=MAX_SECTION => None,
            _ => long(format!(
                "makes a settled window of {periods} forcing periods; at most {MAX_SECTION} are listed: \
                 raise run.settle_s, or shorten the run"
            )),
        }
    }

    fn answer(&self, model: &Model, run: Option<Run>, _: &AtomicBool) -> Sectioned {
        let Some(run) = run else { return Self::without_model(Cell::NotRun) };
        let (from, to) = run.summary.window;
        let strikes = run.events.iter().filter(|event| {
            matches!(event.kind, EventKind::Impact | EventKind::Contact)
                && event.v_in.abs() > model.min_impact_speed()
                && event.t >= from
                && event.t < to
        });
        let phase = |event: &Event| model.drive_phase(event.t).map(|turns| 360.0 * turns);
        let impacts = strikes.map(|event| (*event, phase(event))).collect();
        Sectioned { cell: Cell::Run(run.summary), impacts, states: run.section }
    }

    fn without_model(cell: Cell) -> Sectioned {
        Sectioned { cell, states: Vec::new(), impacts: Vec::new() }
    }

    fn count(tally: &mut Tally, answer: &Sectioned) {
        tally.count(&answer.cell);
    }

    fn table(&self, grid: &Grid, rows: &[Row<Sectioned>]) -> Table {
        let table = fields(grid, rows, Sectioned::len, self.carry.is_some());
        let index = rows.iter().flat_map(|row| (0..row.answer.len() as u64).map(Some));
        let table = table.with("index", index.collect());
        match self.at {
            SectionAt::Phase(_) => {
                let of_row = |row: &Row<Sectioned>| {
                    let impacts = row.answer.cell.summary().map_or(0, |summary| summary.impacts);
                    row.answer.states.iter().map(move |state| (*state, impacts)).collect::<Vec<_>>()
                };
                let states: Vec<(SectionPoint, u64)> = rows.iter().flat_map(of_row).collect();
                table
                    .each("t_s", &states, |(state, _)| state.t)
                    .each("x_m", &states, |(state, _)| state.x)
                    .each("v_m_per_s", &states, |(state, _)| state.v)
                    .each(IMPACTS, &states, |(_, impacts)| Some(*impacts))
            }
            SectionAt::Impacts => {
                let impacts: Vec<&(Event, Option<f64>)> =
                    rows.iter().flat_map(|row| &row.answer.impacts).collect();
                table
                    .each("t_s", &impacts, |(event, _)| event.t)
                    .each("side", &impacts, |(event, _)| event.side.name())
                    .each("phase_deg", &impacts, |(_, phase)| *phase)
                    .each("v_in_m_per_s", &impacts, |(event, _)| event.v_in)
            }
        }
    }

    fn carry(&self) -> Option<Carry> {
        self.carry
    }

    fn ahead(&self, threads: u64) -> u64 {
        let each = self.periods.map_or(1 << 12, |(_, keep)| keep.max(1));
        (KEPT / each).clamp(threads, AHEAD * threads)
    }
}

impl Default for SectionOptions {
    /// The states at the phase 0 over the scene's own run.
    fn default() -> Self {
        Self { at: SectionAt::Phase(0.0), periods: None, until_settled: None, carry: None }
    }
}

/// The section of a run of `model`, the model of `scene`, and the summary of the run. The table of states has
/// the column [`IMPACTS`]. A fault if the drive does not repeat, or if the settled window has no period or
/// too many.
pub fn section(
    model: &Model,
    scene: &Scene,
    options: &SectionOptions,
    cancel: &AtomicBool,
) -> Result<(Table, Summary), Fault> {
    let model = options.model(model.clone());
    if let Some(fault) = options.fault(&model, scene) {
        return Err(fault);
    }
    let run = model.run(&Request { cancel: Some(cancel), ..options.request().unwrap_or_default() });
    let summary = run.summary;
    let row = Row { index: 0, direction: None, answer: options.answer(&model, Some(run), cancel) };
    Ok((options.table(&Grid::of_one(), &[row]), summary))
}

/// Sections of the cells of a grid: the swept fields, the direction of a walk, then one [`section`].
pub type Sections = GridStudy<SectionOptions>;
