//! Runs of the cells of a grid, in parallel, many at once where the processor can.
//!
//! Rows leave in order as soon as those before them have left, and few cells are begun ahead of them, so
//! memory does not grow with the number of cells. What a cell gives depends on its own scene alone, so the
//! bytes are the same for any number of threads.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::Task;
use super::cell::{Cell, CellFaults, SweepEnd, Tally};
use super::grid::Grid;
use super::slice::Slice;
use super::table::Table;
use crate::dynamics::{Model, Request, Run};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, Files, Scene};
use crate::system::clock::WallClock;
use crate::system::threads::Pool;

/// A scene, the grid over it, and the mechanisms that its cells share.
#[derive(Debug)]
pub(super) struct Cells {
    pub base: Scene,
    pub files: Files,
    pub grid: Grid,
    pub mechanisms: Vec<Mutex<Option<Built>>>,
    /// Mechanisms built so far.
    pub built: AtomicU64,
}

/// The mechanism of a cell, or why it has none.
pub(super) type Built = Result<Arc<Mechanism>, BuildError>;

/// The direction in which the values of a field are gone through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// In their order.
    Up,
    /// From the last to the first.
    Down,
}

impl Direction {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// What one cell gave.
#[derive(Debug, Clone)]
pub(super) struct Ran<A> {
    pub index: u64,
    /// Where each cell goes on from the one before: in which direction.
    pub direction: Option<Direction>,
    pub cell: Cell,
    /// What was read off its run, where it was run.
    pub answer: Option<A>,
}

/// What is asked of each cell.
pub(super) trait Question: Sync {
    /// What is read off a run besides its summary.
    type Answer: Send;

    /// What a run keeps, and when it ends.
    fn request(&self) -> Request<'_>;

    /// The model that is run, of that of the cell.
    fn model(&self, model: Model) -> Model {
        model
    }

    /// Why this model cannot be asked; `scene` is that of its cell.
    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault>;

    /// Reads the answer.
    fn answer(&self, model: &Model, run: Run) -> Self::Answer;

    /// The rows of some cells.
    fn table(&self, grid: &Grid, ran: &[Ran<Self::Answer>]) -> Table;

    /// The most cells that are kept in memory.
    fn most_cells(&self) -> u64 {
        u64::MAX
    }
}

/// Cells that a thread runs together: several times the lanes of any processor, so that few of them fly alone
/// at the end.
const BATCH: usize = 128;
/// The same where each cell is waited for, and the fewest where cells take long.
const SHOWN: usize = 16;

/// The fewest of the last batches, which several threads share: where cells take long, and where they do not,
/// so that lanes stay filled.
const LAST: (u64, u64) = (8, 32);

/// Batches that may be begun, for each thread, before the first of them is over.
const AHEAD: usize = 32;

/// The time in s that a batch may take where its cells allow: rows come that often.
const OFTEN: f64 = 1.0;

/// Mechanisms kept for the whole sweep; beyond that each cell builds its own.
const KEPT_MECHANISMS: u64 = 4096;
/// About the bytes of a large one (flexures with their states).
const LARGEST_MECHANISM: u64 = 50_000;

impl Cells {
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        // What no cell needs is not copied for each.
        let base = Scene { notes: String::new(), sweep: Vec::new(), app: None, ..base.clone() };
        let kept = Some(grid.mechanisms()).filter(|n| *n <= KEPT_MECHANISMS).unwrap_or(0);
        let mechanisms = (0..kept).map(|_| Mutex::new(None)).collect();
        Self { base, files: files.clone(), grid, mechanisms, built: AtomicU64::new(0) }
    }

    /// The mechanism of the first cell, or why it has none.
    pub fn first_mechanism(&self) -> Built {
        let mut scene = self.base.clone();
        self.grid.apply(0, &mut scene);
        let never = AtomicBool::new(false);
        let built = self.mechanism(0, &scene, &never);
        built.unwrap_or_else(|| Mechanism::build(&scene.mechanism, &self.files).map(Arc::new))
    }

    /// Builds `count` cells without running them, each as `cell` numbers it; the first one that is wrong,
    /// with all its faults. A mechanism that is not solved is no fault but an outcome. A cancelled check
    /// finds nothing.
    pub fn validate(
        &self,
        question: &impl Question,
        (count, cell): (u64, impl Fn(u64) -> u64 + Sync),
        pool: &Pool,
        task: &Task,
    ) -> Result<(), CellFaults> {
        let faults = |scene: &mut Scene, place: u64| {
            if task.is_cancelled() {
                return None;
            }
            let index = cell(place);
            let faults = match self.model(index, scene, task)? {
                Ok(model) => vec![question.fault(&question.model(model), scene)?],
                Err(faults) => faults,
            };
            Some(CellFaults { cell: self.grid.describe(index), faults })
        };
        pool.find_first(count, || self.base.clone(), faults).map_or(Ok(()), Err)
    }

    /// Asks the cells of a slice from its row `from` on and hands the rows to `write`, some at a time, in
    /// order, with the tally of these alone. `write` answers whether more rows are wanted. Precondition:
    /// [`validate`](Self::validate) found nothing.
    pub fn run<Q: Question, E>(
        &self,
        question: &Q,
        (slice, from): (&Slice, u64),
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let threads = pool.count() as u64;
        let largest = (question.most_cells() / (4 * threads)).clamp(1, BATCH as u64);
        let ahead = (question.most_cells() / largest).clamp(threads, AHEAD as u64 * threads);
        let size = AtomicU64::new(largest.min(SHOWN as u64));
        let mut next = from;
        let batches = std::iter::from_fn(|| {
            let begin = next;
            // Towards the end ever smaller, so that no thread waits long for the last one.
            let share = if threads == 1 { u64::MAX } else { (slice.rows() - begin).div_ceil(2 * threads) };
            let fitting = size.load(Ordering::Relaxed);
            let least = (fitting / 4).clamp(LAST.0, LAST.1);
            next = (begin + share.max(least).min(fitting)).min(slice.rows());
            (begin < next).then(|| (begin..next).map(|place| slice.row(place)).collect::<Vec<u64>>())
        });
        let run = |scene: &mut Scene, cells: Vec<u64>| {
            let clock = WallClock::start();
            let rows = self.ask(question, &cells, scene, task);
            cells.iter().for_each(|_| (task.tick)());
            let fitting = OFTEN * cells.len() as f64 / clock.seconds().max(f64::MIN_POSITIVE);
            let fitting = (fitting as u64).max(SHOWN as u64).min(largest);
            size.store(fitting, Ordering::Relaxed);
            if task.is_cancelled() { None } else { Some(rows) }
        };
        let (mut tally, mut end) = (Tally::default(), None);
        pool.in_order(
            ahead as usize,
            batches,
            || self.base.clone(),
            run,
            |rows| {
                let Some(rows) = rows else {
                    end = Some(SweepEnd::Cancelled);
                    return false;
                };
                let mut own = Tally::default();
                rows.iter().for_each(|row| own.count(&row.cell));
                tally.add(&own);
                let wanted = write(&question.table(&self.grid, &rows), &own);
                wanted.unwrap_or_else(|error| {
                    end = Some(SweepEnd::Write(error));
                    false
                })
            },
        );
        tally.mechanisms = self.built.load(Ordering::Relaxed);
        end.map_or(Ok(tally), Err)
    }

    /// An upper bound of the bytes that [`run`](Self::run) keeps, however many cells there are.
    pub fn memory<Q: Question>(&self, threads: u64) -> u64 {
        let row = size_of::<Ran<Q::Answer>>() as u64;
        let mechanisms = if self.grid.changes_mechanism() { self.mechanisms.len() as u64 } else { 1 };
        (AHEAD * BATCH) as u64 * threads * row + mechanisms * LARGEST_MECHANISM
    }

    /// Runs these cells on `pool`, begun in their order, and hands each over from its thread as soon as it is
    /// there. Whether all of them were run, which a cancelled task's are not.
    pub fn run_each(
        &self,
        question: &impl Question,
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
                let rows = self.ask(question, batch, &mut scene, task);
                if task.is_cancelled() {
                    return;
                }
                for row in rows {
                    each(row.index, row.cell);
                    (task.tick)();
                }
            }
        });
        !task.is_cancelled()
    }

    /// Asks some cells on this thread, many at once where the processor can.
    fn ask<Q: Question>(
        &self,
        question: &Q,
        cells: &[u64],
        scene: &mut Scene,
        task: &Task,
    ) -> Vec<Ran<Q::Answer>> {
        let ran = |index: &u64| Ran { index: *index, direction: None, cell: Cell::NotRun, answer: None };
        let mut rows: Vec<Ran<Q::Answer>> = cells.iter().map(ran).collect();
        let (mut models, mut places) = (Vec::with_capacity(cells.len()), Vec::with_capacity(cells.len()));
        for (place, row) in rows.iter_mut().enumerate() {
            if task.is_cancelled() {
                return rows;
            }
            match self.model(row.index, scene, task) {
                Some(Ok(model)) => {
                    models.push(question.model(model));
                    places.push(place);
                }
                // Not after the grid has been validated.
                Some(Err(_)) => {}
                None => row.cell = Cell::Unsolved,
            }
        }
        let request = Request { cancel: Some(task.cancel), ..question.request() };
        let runs = Model::run_together(&models, &request);
        for ((place, model), run) in places.into_iter().zip(&models).zip(runs) {
            rows[place].cell = Cell::Run(run.summary);
            rows[place].answer = Some(question.answer(model, run));
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
}
