//! Runs of the cells of a grid, in parallel, many at once where the processor can.
//!
//! Rows leave in order as soon as those before them have left, and few cells are begun ahead of them, so
//! memory does not grow with the number of cells. What a cell gives depends on its own scene alone, so the
//! bytes are the same for any number of threads.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::Task;
use super::cell::{Cell, CellFaults, SweepEnd, Tally};
use super::grid::Grid;
use super::slice::Slice;
use super::table::Table;
use crate::dynamics::{Model, Request, Run};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, Files, Scene};
use crate::system::threads::{Pool, Queue, UnderWay};

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

/// Result of one cell.
#[derive(Debug, Clone)]
pub(super) struct Ran<A> {
    pub index: u64,
    /// The direction of the walk, if each cell goes on from the one before.
    pub direction: Option<Direction>,
    pub cell: Cell,
    /// What was read off its run, where it was run.
    pub answer: Option<A>,
}

/// A question asked of each cell.
pub(super) trait Question: Sync {
    /// What is read off a run besides its summary.
    type Answer: Send;

    /// What a run keeps, and when it ends.
    fn request(&self) -> Request<'_>;

    /// The model to run, made from that of the cell.
    fn model(&self, model: Model) -> Model {
        model
    }

    /// Why the question does not apply to this model; `scene` is that of its cell.
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

/// Cells that may be begun, for each thread, before the first of them has left.
const AHEAD: u64 = 4096;

/// Walks that may be begun in any case, however long they are: as many as a thread has under way.
const WALKS: u64 = 64;

/// Mechanisms kept for the whole sweep; with more of them each cell builds its own.
const KEPT_MECHANISMS: u64 = 4096;
/// About the bytes of a large one (flexures with their states).
const LARGEST_MECHANISM: u64 = 50_000;

impl Cells {
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        // left out, so that it is not copied for each cell
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

    /// Builds `count` cells without running them, each as `cell` numbers it; the error is the first invalid
    /// one, with all its faults. A mechanism that is not solved is no fault but an outcome. A cancelled check
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
        write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let threads = pool.count() as u64;
        let ahead = question.most_cells().clamp(threads, AHEAD * threads) as usize;
        let cell = |number: usize| slice.row(from + number as u64);
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, Ran<Q::Answer>)| {
            self.ask(question, &cell, task, next, done);
        };
        let count = (slice.rows() - from) as usize;
        self.in_order(question, (count, 1, ahead), pool, task, work, write)
    }

    /// Hands the rows of `work` to `write` in order, with the tally of these alone. The counts are those
    /// of [`Pool::in_order`].
    pub(super) fn in_order<Q: Question, E>(
        &self,
        question: &Q,
        (count, rows, ahead): (usize, usize, usize),
        pool: &Pool,
        task: &Task,
        work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>, &dyn Fn(usize, Ran<Q::Answer>)) + Sync,
        mut write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let (mut tally, mut end) = (Tally::default(), None);
        let leave = |ran: Vec<Ran<Q::Answer>>| {
            let mut part = Tally::default();
            ran.iter().for_each(|row| part.count(&row.cell));
            tally.add(&part);
            tally.mechanisms = self.built.load(Ordering::Relaxed);
            let wanted = write(&question.table(&self.grid, &ran), &part);
            wanted.unwrap_or_else(|error| {
                end = Some(SweepEnd::Write(error));
                false
            })
        };
        pool.in_order((count, rows, ahead), work, leave);
        let cancelled = task.is_cancelled() && tally.cells < (count * rows) as u64;
        end.or(cancelled.then_some(SweepEnd::Cancelled)).map_or(Ok(tally), Err)
    }

    /// Walks of `length` cells that may be begun, for each thread, before the first of them has left.
    pub(super) fn walks_ahead(length: u64) -> u64 {
        (AHEAD / length).max(WALKS)
    }

    /// An upper bound of the bytes that [`run`](Self::run), or [`walk`](Self::walk) with walks of `length`
    /// cells, keeps, however many cells there are.
    pub fn memory<Q: Question>(&self, threads: u64, length: Option<u64>) -> u64 {
        let row = size_of::<Ran<Q::Answer>>() as u64;
        let mechanisms = if self.grid.changes_mechanism() { self.mechanisms.len() as u64 } else { 1 };
        let ahead = length.map_or(AHEAD, |length| Self::walks_ahead(length) * length);
        ahead * threads * row + mechanisms * LARGEST_MECHANISM
    }

    /// Runs these cells on `pool`, begun in their order, and hands each over from its thread as soon as it is
    /// there. Returns whether all of them were run: false if cancelled.
    pub fn run_each(
        &self,
        question: &impl Question,
        pool: &Pool,
        task: &Task,
        cells: &[u64],
        each: &(dyn Fn(u64, Cell) + Sync),
    ) -> bool {
        let queue = Queue::new(cells.len(), pool.count());
        let done = |_, ran: Ran<_>| each(ran.index, ran.cell);
        pool.everywhere(|| {
            self.ask(question, &|number| cells[number], task, &|under_way| queue.take(under_way), &done)
        });
        !task.is_cancelled()
    }

    /// Runs cells on this thread, many at once where the processor can. `next` gets how many are under way
    /// here and gives the number of a further one; each result goes to `done` with its number.
    fn ask<Q: Question>(
        &self,
        question: &Q,
        cell: &dyn Fn(usize) -> u64,
        task: &Task,
        next: &dyn Fn(UnderWay) -> Option<usize>,
        done: &dyn Fn(usize, Ran<Q::Answer>),
    ) {
        let request = Request { cancel: Some(task.cancel), ..question.request() };
        let done = |number: usize, outcome: Cell, answer: Option<Q::Answer>| {
            if !task.is_cancelled() {
                done(number, Ran { index: cell(number), direction: None, cell: outcome, answer });
                (task.tick)();
            }
        };
        let mut scene = self.base.clone();
        let mut next = |under_way: UnderWay| loop {
            // checked before waiting for more, since there may be none left
            if task.is_cancelled() {
                return None;
            }
            let number = next(under_way)?;
            match self.model(cell(number), &mut scene, task) {
                Some(Ok(model)) => return Some((number, question.model(model), request)),
                // cannot happen once the grid has been validated
                Some(Err(_)) => done(number, Cell::NotRun, None),
                None => done(number, Cell::Unsolved, None),
            }
        };
        let mut ended = |number: usize, model: &Model, run: Run| {
            done(number, Cell::Run(run.summary), Some(question.answer(model, run)));
        };
        Model::run_from(&mut next, &mut ended);
    }

    /// The model of a cell, or its faults; `None` if its mechanism was not solved, or the task was
    /// cancelled meanwhile.
    pub fn model(&self, index: u64, scene: &mut Scene, task: &Task) -> Option<Result<Model, Vec<Fault>>> {
        self.grid.apply(index, scene);
        match self.mechanism(index, scene, task.cancel)? {
            Ok(mechanism) => Some(Model::build(scene, mechanism)),
            Err(BuildError::Wrong(fault)) => Some(Err(vec![fault])),
            Err(BuildError::Unsolved(_)) => None,
        }
    }

    /// The mechanism of a cell; `None` if cancelled before it was built.
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
