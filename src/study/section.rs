//! Section of a motion: its state once a forcing period, or its impacts, over the settled window.
//!
//! Over a grid it is the bifurcation diagram.

use std::sync::atomic::AtomicBool;

use super::Task;
use super::cell::{CellFaults, SweepEnd, Tally};
use super::cells::{Cells, Question, Ran};
use super::grid::Grid;
use super::slice::{Shard, Slice};
use super::sweep::fields;
use super::table::Table;
use super::walk::{Carry, without_a_period};
use crate::dynamics::{EventKind, Model, Request, Run, SectionPoint, Side, Summary};
use crate::scene::{Fault, Files, Scene};
use crate::system::threads::Pool;

/// The most states of one section.
pub const MAX_SECTION: u64 = 1 << 22;

/// States that are kept in memory before their rows are written.
const KEPT: u64 = 1 << 21;

/// Extra column of the table of states: the number of impacts in the settled window.
pub const IMPACTS: &str = "impacts";

/// Where a section is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SectionAt {
    /// At this phase of the drive in degrees: the argument of its sine; of a sum, the share of the common
    /// period since the start.
    Phase(f64),
    /// At every impact that counts, contacts with a compliant stop among them.
    Impacts,
}

/// How a section is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionOptions {
    /// Where.
    pub at: SectionAt,
    /// Forcing periods that are skipped and that make the settled window, in place of the scene's run.
    pub periods: Option<(u64, u64)>,
    /// Each run goes on until its motion repeats, or up to this time in s.
    pub until_settled: Option<f64>,
    /// The last field of a grid is walked, as in a [sweep](super::SweepOptions::carry).
    pub carry: Option<Carry>,
}

/// The rows of one run.
#[derive(Debug, Clone)]
pub(super) enum Points {
    States(Vec<SectionPoint>),
    Impacts(Vec<Struck>),
}

/// An impact: its time in s, the stop, the drive's phase in degrees, and the velocity in m/s before it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Struck {
    t: f64,
    side: Side,
    phase: f64,
    v_in: f64,
}

impl Points {
    fn len(&self) -> usize {
        match self {
            Self::States(states) => states.len(),
            Self::Impacts(impacts) => impacts.len(),
        }
    }
}

impl Question for SectionOptions {
    type Answer = Points;

    fn request(&self) -> Request<'_> {
        let (section, events) = match self.at {
            SectionAt::Phase(degrees) => (Some(degrees.rem_euclid(360.0) / 360.0), false),
            SectionAt::Impacts => (None, true),
        };
        Request { section, events, until_settled: self.until_settled, ..Request::default() }
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

    fn answer(&self, model: &Model, run: Run) -> Points {
        if matches!(self.at, SectionAt::Phase(_)) {
            return Points::States(run.section);
        }
        let (from, to) = run.summary.window;
        let strikes = run.events.iter().filter(|event| {
            matches!(event.kind, EventKind::Impact | EventKind::Contact)
                && event.v_in.abs() > model.least_impact_speed()
                && event.t >= from
                && event.t < to
        });
        let struck = strikes.map(|event| Struck {
            t: event.t,
            side: event.side,
            phase: model.drive_phase(event.t).map_or(f64::NAN, |turns| 360.0 * turns),
            v_in: event.v_in,
        });
        Points::Impacts(struck.collect())
    }

    fn table(&self, grid: &Grid, ran: &[Ran<Points>]) -> Table {
        let table = fields(grid, ran, |row| row.answer.as_ref().map_or(0, Points::len), self.carry.is_some());
        let each = ran.iter().filter_map(|row| row.answer.as_ref().zip(row.cell.summary()));
        self.rows(table, &each.collect::<Vec<_>>())
    }

    fn most_cells(&self) -> u64 {
        let each = self.periods.map_or(1 << 12, |(_, keep)| keep.max(1));
        (KEPT / each).max(1)
    }
}

impl SectionOptions {
    /// The columns of the rows of these runs, after those of `table`.
    fn rows(&self, table: Table, runs: &[(&Points, &Summary)]) -> Table {
        let index = runs.iter().flat_map(|(points, _)| (0..points.len() as u64).map(Some));
        let table = table.with("index", index.collect());
        match self.at {
            SectionAt::Phase(_) => {
                let states: Vec<(SectionPoint, u64)> = runs
                    .iter()
                    .flat_map(|(points, summary)| {
                        let states: &[SectionPoint] =
                            if let Points::States(states) = points { states } else { &[] };
                        states.iter().map(|state| (*state, summary.impacts))
                    })
                    .collect();
                table
                    .each("t_s", &states, |state| state.0.t)
                    .each("x_m", &states, |state| state.0.x)
                    .each("v_m_per_s", &states, |state| state.0.v)
                    .each(IMPACTS, &states, |state| Some(state.1))
            }
            SectionAt::Impacts => {
                let impacts: Vec<Struck> = runs
                    .iter()
                    .flat_map(|(points, _)| if let Points::Impacts(all) = points { &all[..] } else { &[] })
                    .copied()
                    .collect();
                table
                    .each("t_s", &impacts, |impact| impact.t)
                    .each("side", &impacts, |impact| impact.side.name())
                    .each("phase_deg", &impacts, |impact| impact.phase)
                    .each("v_in_m_per_s", &impacts, |impact| impact.v_in)
            }
        }
    }

    /// The model as it is run.
    pub fn run_of(&self, model: &Model) -> Model {
        self.model(model.clone())
    }

    /// The names of the columns of a section alone, in the order of its rows.
    pub fn columns(&self) -> &'static [&'static str] {
        match self.at {
            SectionAt::Phase(_) => &["index", "t_s", "x_m", "v_m_per_s"],
            SectionAt::Impacts => &["index", "t_s", "side", "phase_deg", "v_in_m_per_s"],
        }
    }
}

/// The section of a run of `model`, which is that of `scene`: its [columns](SectionOptions::columns), of
/// states also [`IMPACTS`], and the run's summary. A fault where the drive does not repeat, or the settled
/// window holds no period or too many.
pub fn section(
    model: &Model,
    scene: &Scene,
    options: &SectionOptions,
    cancel: &AtomicBool,
) -> Result<(Table, Summary), Fault> {
    let model = options.run_of(model);
    if let Some(fault) = options.fault(&model, scene) {
        return Err(fault);
    }
    let run = model.run(&Request { cancel: Some(cancel), ..options.request() });
    let summary = run.summary;
    let points = options.answer(&model, run);
    Ok((options.rows(Table::new(), &[(&points, &summary)]), summary))
}

/// Sections of the cells of a grid: the bifurcation diagram.
#[derive(Debug)]
pub struct Sections {
    cells: Cells,
    options: SectionOptions,
}

impl Sections {
    /// Sections of `grid` over `base`, which has passed its check, as have the grid's corners.
    pub fn new(base: &Scene, files: &Files, grid: Grid, options: SectionOptions) -> Self {
        Self { cells: Cells::new(base, files, grid), options }
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.cells.grid
    }

    /// The number of runs.
    pub fn runs(&self) -> u64 {
        let walks = self.options.carry.map_or(1, |carry| carry.directions().len() as u64);
        self.grid().cells() * walks
    }

    /// The table without rows: the swept fields, the direction of a walk, then as of one [`section`].
    pub fn empty_table(&self) -> Table {
        self.options.table(self.grid(), &[])
    }

    /// The model of the first cell as it is run, or its faults; `None` if its mechanism was not solved.
    pub fn first_model(&self, task: &Task) -> Option<Result<Model, Vec<Fault>>> {
        let built = self.cells.model(0, &mut self.cells.base.clone(), task)?;
        Some(built.map(|model| self.options.model(model)))
    }

    /// The same with runs that go on until they have settled, or up to this time in s.
    #[must_use]
    pub fn until_settled(mut self, until: Option<f64>) -> Self {
        self.options.until_settled = until;
        self
    }

    /// Builds every cell without running it; the error is the first invalid one, with all its faults. A
    /// cancelled check finds nothing.
    pub fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        self.cells.validate(&self.options, (self.grid().cells(), |cell| cell), pool, task)
    }

    /// Runs every cell on `pool` and hands the rows to `write`, some at a time, in order. `write` answers
    /// whether more rows are wanted. Precondition: [`validate`](Self::validate) found nothing.
    pub fn run<E>(
        &self,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let write = |table: &Table, _: &Tally| write(table);
        let walk = self.grid().axes().last().map_or(1, |axis| axis.values.len() as u64);
        let unit = self.options.carry.map_or(1, |_| walk);
        let all = (&Slice::new(self.runs(), unit, Shard::WHOLE), 0);
        match self.options.carry {
            Some(carry) => self.cells.walk(&self.options, carry, all, pool, task, write),
            None => self.cells.run(&self.options, all, pool, task, write),
        }
    }
}
