//! Sweep: a run for each cell of a grid, in parallel, a row a cell.
//!
//! Rows leave in chunks as soon as a chunk is whole, so memory does not grow with the cells already
//! written, and what a cell gives depends on its own scene alone, so the bytes are the same for any
//! number of threads.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::Task;
use super::fields::SummaryField;
use super::grid::Grid;
use super::table::{Table, Values};
use crate::dynamics::{Model, Outcome, Request, Summary};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, Files, Scene};
use crate::system::clock::WallClock;
use crate::system::threads::Pool;

/// The columns that every sweep has after those of its fields.
pub const STANDARD: [&str; 7] =
    ["rms_velocity_m_per_s", "regime", "crossings", "impacts", "max_abs_x_m", "period", "outcome"];

/// What a sweep does beyond running each cell for its duration.
#[derive(Debug, Clone, Default)]
pub struct SweepOptions {
    /// More columns than the [standard](STANDARD) ones. One that needs the energy ledger has the cells run
    /// one by one.
    pub columns: Vec<&'static SummaryField>,
    /// Each run goes on until its motion repeats, or up to this time in s.
    pub until_settled: Option<f64>,
}

/// A scene, the grid over it, and the mechanisms that its cells share.
#[derive(Debug)]
pub struct Sweep {
    base: Scene,
    files: Files,
    grid: Grid,
    options: SweepOptions,
    mechanisms: Vec<Mutex<Option<Built>>>,
    /// Mechanisms built so far.
    built: AtomicU64,
}

/// The mechanism of a cell, or why it has none.
type Built = Result<Arc<Mechanism>, BuildError>;

/// What one cell came to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "nearly all cells are run")]
pub enum Cell {
    /// It has not been run.
    NotRun,
    /// Its mechanism is right and was not solved.
    Unsolved,
    /// It was run.
    Run(Summary),
}

impl Cell {
    /// The summary of its run.
    pub fn summary(&self) -> Option<&Summary> {
        if let Self::Run(summary) = self { Some(summary) } else { None }
    }

    /// The word in the CSV; empty where the cell was not run.
    pub fn outcome(&self) -> &'static str {
        match self {
            Self::NotRun => "",
            Self::Unsolved => "not_converged",
            Self::Run(summary) => summary.outcome.name(),
        }
    }

    /// Whether its run lasted to its end.
    pub fn is_done(&self) -> bool {
        self.summary().is_some_and(|summary| summary.outcome == Outcome::Done)
    }

    /// The summary of a run that reached its settled window. Earlier there are no numbers there, and
    /// counts of 0 would lie.
    pub fn settled(&self) -> Option<&Summary> {
        self.summary().filter(|summary| summary.rms_velocity.is_some())
    }
}

/// What is wrong with one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellFaults {
    /// The cell in words.
    pub cell: String,
    /// Its faults.
    pub faults: Vec<Fault>,
}

/// How a sweep ended short of its last cell; `E` is the writer's error.
#[derive(Debug)]
pub enum SweepEnd<E> {
    /// It was told to stop.
    Cancelled,
    /// The rows could not be written.
    Write(E),
}

/// What a sweep came to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tally {
    /// Cells run, those without a solved mechanism among them.
    pub cells: u64,
    /// Cells whose run ended early, as their outcome says.
    pub ended_early: u64,
    /// Cells whose mechanism was not solved.
    pub not_converged: u64,
    /// Cells in which the contact with a compliant stop was pressed beyond what its material bears.
    pub yielding: u64,
    /// Mechanisms built: one for each combination of the swept fields of the mechanism, however many cells
    /// share it.
    pub mechanisms: u64,
    /// Cells by outcome.
    pub outcomes: BTreeMap<&'static str, u64>,
    /// Cells by regime; those that ended before their settled window, and those of one well, have none.
    pub regimes: BTreeMap<&'static str, u64>,
}

impl Tally {
    fn count(&mut self, cell: &Cell) {
        self.ended_early += u64::from(cell.summary().is_some_and(|row| row.outcome.ended_at().is_some()));
        self.not_converged += u64::from(*cell == Cell::Unsolved);
        self.yielding += u64::from(cell.summary().is_some_and(|row| row.contact_yields));
        *self.outcomes.entry(cell.outcome()).or_default() += 1;
        if let Some(row) = cell.settled().filter(|row| !row.regime.name().is_empty()) {
            *self.regimes.entry(row.regime.name()).or_default() += 1;
        }
    }
}

/// Cells a thread gets of the first chunk, and the most of any. A chunk waits for its last cell: while chunks
/// are over in less than [`SHORT`], the next is twice as large, so that the wait is a small part of it; where
/// cells take long, rows come often.
const CELLS_PER_THREAD: u64 = 512;
const MOST_CELLS_PER_THREAD: u64 = 1 << 14;

/// A short time for a chunk in s.
const SHORT: f64 = 0.3;

/// Cells that a thread runs together: several times the lanes of any processor, so that few of them fly alone
/// at the end.
const BATCH: usize = 128;
/// The same where each cell is waited for.
const SHOWN: usize = 16;

/// Mechanisms kept for the whole sweep, up to some 50 kB each (flexures with their states); beyond that each
/// cell builds its own.
const KEPT_MECHANISMS: u64 = 4096;

impl Sweep {
    /// A sweep of `grid` over `base`, which has passed its check, as have the grid's corners.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        // What no cell needs is not copied for each.
        let base = Scene { notes: String::new(), sweep: Vec::new(), app: None, ..base.clone() };
        let kept = Some(grid.mechanisms()).filter(|n| *n <= KEPT_MECHANISMS).unwrap_or(0);
        let mechanisms = (0..kept).map(|_| Mutex::new(None)).collect();
        let options = SweepOptions::default();
        Self { base, files: files.clone(), grid, options, mechanisms, built: AtomicU64::new(0) }
    }

    /// The same with these options.
    #[must_use]
    pub fn with(mut self, options: SweepOptions) -> Self {
        self.options = options;
        self
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The table without rows.
    pub fn empty_table(&self) -> Table {
        self.table(0, &[])
    }

    /// The mechanism of the first cell, or why it has none. Where no axis changes the mechanism, it is that
    /// of every cell.
    pub fn first_mechanism(&self) -> Result<Arc<Mechanism>, BuildError> {
        let mut scene = self.base.clone();
        self.grid.apply(0, &mut scene);
        let never = AtomicBool::new(false);
        let built = self.mechanism(0, &scene, &never);
        built.unwrap_or_else(|| Mechanism::build(&scene.mechanism, &self.files).map(Arc::new))
    }

    /// The model of the first cell, or its faults; none where its mechanism was not solved.
    pub fn first_model(&self, task: &Task) -> Option<Result<Model, Vec<Fault>>> {
        self.model(0, &mut self.base.clone(), task)
    }

    /// Builds every cell without running it; the first one that is wrong, with all its faults. A mechanism
    /// that is not solved is no fault but an outcome. A cancelled check finds nothing.
    pub fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        let faults = |scene: &mut Scene, index: u64| {
            if task.is_cancelled() {
                return None;
            }
            match self.model(index, scene, task)? {
                Ok(_) => None,
                Err(faults) => Some(CellFaults { cell: self.grid.describe(index), faults }),
            }
        };
        pool.find_first(self.grid.cells(), || self.base.clone(), faults).map_or(Ok(()), Err)
    }

    /// Runs every cell on `pool` and hands the rows to `write`, chunk by chunk in order. `write`
    /// answers whether more rows are wanted. Precondition: [`validate`](Self::validate) found nothing.
    pub fn run<E>(
        &self,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let threads = pool.count() as u64;
        let mut chunk = CELLS_PER_THREAD * threads;
        let mut tally = Tally::default();
        while tally.cells < self.grid.cells() {
            let (begin, clock) = (tally.cells, WallClock::start());
            let end = (begin + chunk).min(self.grid.cells());
            let batches: Vec<u64> = (begin..end).step_by(BATCH).collect();
            let run = |scene: &mut Scene, batch: usize| {
                let cells: Vec<u64> = (batches[batch]..end).take(BATCH).collect();
                let rows = self.run_batch(&cells, scene, task);
                cells.iter().for_each(|_| (task.tick)());
                if task.is_cancelled() { Err(()) } else { Ok(rows) }
            };
            let rows = pool.map(batches.len(), || self.base.clone(), run);
            let rows = rows.map_err(|()| SweepEnd::Cancelled)?.concat();
            if clock.seconds() < SHORT {
                chunk = (2 * chunk).min(MOST_CELLS_PER_THREAD * threads);
            }
            tally.cells = end;
            rows.iter().for_each(|row| tally.count(row));
            tally.mechanisms = self.built.load(Ordering::Relaxed);
            if !write(&self.table(begin, &rows)).map_err(SweepEnd::Write)? {
                break;
            }
        }
        Ok(tally)
    }

    /// Runs these cells on `pool`, begun in their order, and hands each over from its thread as soon as it is
    /// there. Whether all of them were run, which a cancelled task's are not.
    pub fn run_cells(
        &self,
        pool: &Pool,
        task: &Task,
        cells: &[u64],
        each: &(dyn Fn(u64, Cell) + Sync),
    ) -> bool {
        // A shared counter keeps the order that a recursive split would lose, and no thread waits for a part.
        let next = AtomicUsize::new(0);
        let batches: Vec<&[u64]> = cells.chunks(SHOWN).collect();
        pool.everywhere(|| {
            let mut scene = self.base.clone();
            while let Some(batch) = batches.get(next.fetch_add(1, Ordering::Relaxed)) {
                let rows = self.run_batch(batch, &mut scene, task);
                if task.is_cancelled() {
                    return;
                }
                for (index, cell) in batch.iter().zip(rows) {
                    each(*index, cell);
                    (task.tick)();
                }
            }
        });
        !task.is_cancelled()
    }

    /// Runs some cells on this thread, many at once where the processor can.
    fn run_batch(&self, cells: &[u64], scene: &mut Scene, task: &Task) -> Vec<Cell> {
        let mut rows = vec![Cell::NotRun; cells.len()];
        let (mut models, mut places) = (Vec::with_capacity(cells.len()), Vec::with_capacity(cells.len()));
        for (place, index) in cells.iter().enumerate() {
            if task.is_cancelled() {
                return rows;
            }
            match self.model(*index, scene, task) {
                Some(Ok(model)) => {
                    models.push(model);
                    places.push(place);
                }
                // Not after the sweep has been validated.
                Some(Err(_)) => {}
                None => rows[place] = Cell::Unsolved,
            }
        }
        let until_settled = self.options.until_settled;
        let runs = if self.options.columns.iter().any(|field| field.needs_ledger) {
            let request =
                Request { ledger: true, until_settled, cancel: Some(task.cancel), ..Request::default() };
            models.iter().map(|model| model.run(&request)).collect()
        } else {
            Model::run_all(&models, until_settled, Some(task.cancel))
        };
        for (place, run) in places.into_iter().zip(runs) {
            rows[place] = Cell::Run(run.summary);
        }
        rows
    }

    /// The model of a cell, or its faults; none where its mechanism was not solved, or the task was cancelled
    /// meanwhile.
    pub fn model(&self, index: u64, scene: &mut Scene, task: &Task) -> Option<Result<Model, Vec<Fault>>> {
        self.grid.apply(index, scene);
        match self.mechanism(index, scene, task.cancel)? {
            Ok(mechanism) => Some(Model::build(scene, mechanism)),
            Err(BuildError::Wrong(fault)) => Some(Err(vec![fault])),
            Err(BuildError::Unsolved(_)) => None,
        }
    }

    /// The mechanism of a cell; none where it was cancelled before it was built.
    fn mechanism(&self, index: u64, scene: &Scene, cancel: &AtomicBool) -> Option<Built> {
        let build = || {
            let built = Mechanism::build_unless(&scene.mechanism, &self.files, cancel)?;
            self.built.fetch_add(1, Ordering::Relaxed);
            Some(built.map(Arc::new))
        };
        let Some(place) = self.mechanisms.get(self.grid.mechanism(index) as usize) else { return build() };
        let mut place = place.lock().unwrap_or_else(PoisonError::into_inner);
        if place.is_none() {
            *place = build();
        }
        place.clone()
    }

    /// The rows of the cells from `begin` on.
    pub fn table(&self, begin: u64, rows: &[Cell]) -> Table {
        let mut table = Table::new();
        for (i, column) in self.grid.columns().iter().enumerate() {
            let value = |row: usize| self.grid.values(begin + row as u64).nth(i).unwrap_or(f64::NAN);
            table = table.with(column, (0..rows.len()).map(value).collect());
        }
        for name in STANDARD {
            table = table.with(name, self.column(name, rows));
        }
        let more = self.options.columns.iter().filter(|field| !STANDARD.contains(&field.name));
        more.fold(table, |table, field| table.with(field.name, self.column(field.name, rows)))
    }

    fn column(&self, name: &str, rows: &[Cell]) -> Values {
        match SummaryField::find(name) {
            // Of a cell that has no run too.
            _ if name == "outcome" => Values::Words(rows.iter().map(|row| row.outcome()).collect()),
            Some(field) => field.column(rows.iter().map(Cell::summary)),
            None => Values::Words(vec![""; rows.len()]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::FlexureError;
    use crate::scene::Document;

    #[test]
    fn a_mechanism_that_was_not_solved_is_an_outcome_of_its_cells() {
        let mut document = Document::load("nominal-cubic").unwrap();
        document.set("run.duration_s=1").unwrap();
        document.set("run.settle_s=0").unwrap();
        let over = ["mechanism.linear_n_per_m=-40,-30", "excitation.amplitude_g=0.5,1,1.5"];
        let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
        let sweep = Sweep::new(&document.scene, &document.files, grid);
        let error = FlexureError::NotConverged { x: 1e-3, residual: 1.0 };
        *sweep.mechanisms[1].lock().unwrap() = Some(Err(error.into()));
        let pool = Pool::new(2).unwrap();
        let cancel = AtomicBool::new(false);
        let task = Task { tick: &|| (), cancel: &cancel };
        sweep.validate(&pool, &task).unwrap();
        let mut rows = Table::new();
        let write = |table: &Table| {
            rows.append(table);
            Ok::<_, ()>(true)
        };
        let tally = sweep.run(&pool, &task, write).unwrap();
        assert_eq!((tally.cells, tally.ended_early, tally.not_converged, tally.mechanisms), (6, 0, 3, 1));
        assert_eq!(tally.outcomes, BTreeMap::from([("done", 3), ("not_converged", 3)]));
        let words = |name: &str| rows.column(name).unwrap().values.clone();
        let outcomes = [["done"; 3], ["not_converged"; 3]].concat();
        assert_eq!(words("outcome"), Values::Words(outcomes));
        assert!(rows.numbers("rms_velocity_m_per_s").unwrap()[3..].iter().all(|speed| speed.is_nan()));
        assert!(rows.numbers("max_abs_x_m").unwrap()[3..].iter().all(|x| x.is_nan()));
        for name in ["crossings", "impacts", "period"] {
            assert!(matches!(words(name), Values::Counts(counts) if counts[3..] == [None; 3]), "{name}");
        }
        assert!(matches!(words("regime"), Values::Words(words) if words[3..] == [""; 3]));
    }
}
