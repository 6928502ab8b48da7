//! A study of every cell of a grid, on several threads and with several runs per thread in vector lanes.
//!
//! Rows are delivered in order, and a bounded number of cells is begun ahead of them, so that memory does not
//! grow with the number of cells. The result of a cell depends only on its scene, so it has the same bits for
//! any number of threads.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::walk::Walk;
use super::{
    Cancelled, Carry, Cell, CellFaults, Direction, Draws, Grid, NoThresholds, Shard, Slice, SweepEnd, Table,
    Tally, Task,
};
use crate::dynamics::{Model, Request, Run};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, Files, Scene, check};
use crate::system::threads::{Pool, Queue, UnderWay};

/// The answer of one cell.
#[derive(Debug, Clone)]
pub struct Row<A> {
    /// Index of the cell.
    pub index: u64,
    /// The direction of the walk, if each cell continues from the one before.
    pub direction: Option<Direction>,
    /// The result of the cell.
    pub answer: A,
}

/// What is computed for each cell.
pub trait Question: Default + Sync {
    /// The result of a cell.
    type Answer: Send;

    /// The request for the run of a cell; `None` if the answer is computed from the model without a run.
    fn request(&self) -> Option<Request<'_>>;

    /// The model to run, derived from that of the cell.
    fn model(&self, model: Model) -> Model {
        model
    }

    /// Why the question does not apply to this model; `scene` is that of its cell.
    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault>;

    /// The answer from the model and the run that was [requested](Self::request).
    fn answer(&self, model: &Model, run: Option<Run>, cancel: &AtomicBool) -> Self::Answer;

    /// The answer for a cell without a model.
    fn without_model(cell: Cell) -> Self::Answer;

    /// Adds an answer to the tally.
    fn count(tally: &mut Tally, answer: &Self::Answer);

    /// The table of some rows. With [draws](Self::draws) a cell has a row without one, then with each.
    fn table(&self, grid: &Grid, rows: &[Row<Self::Answer>]) -> Table;

    /// The directions in which the last field is walked, if each cell continues from the one before.
    fn carry(&self) -> Option<Carry> {
        None
    }

    /// The draws of uncertain fields that are run in each cell besides the cell itself.
    fn draws(&self) -> Option<&Draws> {
        None
    }

    /// Number of cells that `threads` together may begin ahead of the first one that has not been delivered.
    fn ahead(&self, threads: u64) -> u64 {
        AHEAD * threads
    }
}

/// Number of cells with small results that a thread may begin ahead.
pub(crate) const AHEAD: u64 = 4096;

pub(crate) type Built = Result<Arc<Mechanism>, BuildError>;

/// A scene, the grid over it, and the mechanisms that its cells share.
#[derive(Debug)]
pub struct Cells {
    pub(crate) base: Scene,
    pub(crate) grid: Grid,
    pub(crate) files: Files,
    draws: Draws,
    mechanisms: Vec<Mutex<Option<Built>>>,
    /// Mechanisms built so far.
    built: AtomicU64,
}

/// A question about the cells of a grid over a scene.
#[derive(Debug)]
pub struct GridStudy<Q> {
    cells: Cells,
    question: Q,
}

/// Number of walks of any length that a thread may begin ahead: about as many as it runs at a time.
const MIN_WALKS_AHEAD: u64 = 64;

/// Largest number of mechanisms that are kept for the whole study; of more, each cell builds its own.
const MAX_KEPT_MECHANISMS: u64 = 4096;
/// Approximate size of a large mechanism in bytes (flexures with their states).
const MECHANISM_BYTES: u64 = 50_000;

impl Cells {
    /// The cells of `grid` over `base`, before any mechanism is built.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        // fields without influence on a run are dropped, so that they are not copied for each cell
        let base = Scene { notes: String::new(), sweep: Vec::new(), app: None, ..base.clone() };
        let (files, draws, built) = (files.clone(), Draws::default(), AtomicU64::new(0));
        let mechanisms = places(grid.mechanisms());
        Self { base, files, grid, draws, mechanisms, built }
    }

    /// The scene over which the grid is.
    pub(crate) fn scene(&self) -> &Scene {
        &self.base
    }

    /// The columns of the swept fields, a row for each cell.
    pub(crate) fn table(&self) -> Table {
        self.grid.table(|| 0..self.grid.cells())
    }

    /// Number of different mechanisms in a cell of the grid.
    fn mechanisms_per_cell(&self) -> u64 {
        if self.draws.change_mechanism() { self.draws.runs() } else { 1 }
    }

    /// Turns `scene` into that of a cell with a draw, where 0 is none, and returns its mechanism; `None` if
    /// cancelled before it was built.
    fn mechanism(&self, index: u64, draw: u64, scene: &mut Scene, cancel: &AtomicBool) -> Option<Built> {
        self.grid.apply(index, scene);
        self.draws.apply(draw, self.grid.values(index), scene);
        if draw > 0
            && let Some(fault) = check(scene).faults.into_iter().next()
        {
            // the relations between fields were checked for the grid alone
            return Some(Err(BuildError::Wrong(fault)));
        }
        let build = || {
            let built = Mechanism::build_cancellable(&scene.mechanism, &self.files, cancel)?;
            self.built.fetch_add(1, Ordering::Relaxed);
            Some(built.map(Arc::new))
        };
        let each = self.mechanisms_per_cell();
        let number = self.grid.mechanism(index) * each + draw % each;
        let Some(place) = self.mechanisms.get(number as usize) else { return build() };
        let mut place = place.lock().unwrap_or_else(PoisonError::into_inner);
        if place.is_none() {
            *place = build();
        }
        place.clone()
    }

    /// Checks all cells; wrong are those in which `faults` finds any, or whose mechanism is wrong. A
    /// mechanism that is not solved is no fault.
    pub(crate) fn check(
        &self,
        pool: &Pool,
        task: &Task,
        faults: impl Fn(&Scene, &Arc<Mechanism>) -> Option<Vec<Fault>> + Sync,
    ) -> Result<(), NoThresholds> {
        let of_cell = |scene: &Scene, built: Built, _: u64| match built {
            Ok(mechanism) => Ok(faults(scene, &mechanism)),
            Err(BuildError::Unsolved(_)) => Ok(None),
            Err(BuildError::Wrong(fault)) => Ok(Some(vec![fault])),
        };
        let all = (0..).zip(self.map(1, pool, task, of_cell)?);
        let described = |index: u64, faults| CellFaults { cell: self.grid.describe(index), faults };
        let wrong: Vec<CellFaults> =
            all.filter_map(|(index, faults)| Some(described(index, faults?))).collect();
        if wrong.is_empty() { Ok(()) } else { Err(NoThresholds::Wrong(wrong)) }
    }

    /// The answers for `parts` parts of each cell, from the scene of the cell, its mechanism or why it has
    /// none, and the number of the part.
    pub(crate) fn map<R: Send>(
        &self,
        parts: usize,
        pool: &Pool,
        task: &Task,
        answer: impl Fn(&Scene, Built, u64) -> Result<R, Cancelled> + Sync,
    ) -> Result<Vec<R>, Cancelled> {
        let part = |number: usize| {
            task.check_cancelled()?;
            let (cell, mut scene) = ((number / parts) as u64, self.base.clone());
            let built = self.mechanism(cell, 0, &mut scene, task.cancel).ok_or(Cancelled)?;
            answer(&scene, built, (number % parts) as u64)
        };
        pool.map(self.grid.cells() as usize * parts, part)
    }

    /// The model of a cell with a draw, or its faults; `None` without a solved mechanism, or if cancelled.
    fn model(
        &self,
        index: u64,
        draw: u64,
        scene: &mut Scene,
        task: &Task,
    ) -> Option<Result<Model, Vec<Fault>>> {
        match self.mechanism(index, draw, scene, task.cancel)? {
            Ok(mechanism) => Some(Model::build(scene, mechanism)),
            Err(BuildError::Wrong(fault)) => Some(Err(vec![fault])),
            Err(BuildError::Unsolved(_)) => None,
        }
    }
}

impl<Q: Question> GridStudy<Q> {
    /// A study of `grid` over `base`. Precondition: `base` and the corners of the grid are checked.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        Self { cells: Cells::new(base, files, grid), question: Q::default() }
    }

    /// The study with this question.
    #[must_use]
    pub fn with(mut self, question: Q) -> Self {
        if let Some(draws) = question.draws() {
            self.cells.draws = draws.clone();
            self.cells.mechanisms = places(self.mechanisms());
        }
        self.question = question;
        self
    }

    /// The question.
    pub fn options(&self) -> &Q {
        &self.question
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.cells.grid
    }

    /// The number of rows of a sweep; each is a run, and one more for each draw of uncertain fields.
    pub fn rows(&self) -> u64 {
        self.grid().cells() * self.rows_per_cell()
    }

    /// Number of runs that make a row.
    pub fn runs_per_row(&self) -> u64 {
        self.cells.draws.runs()
    }

    /// Number of different mechanisms in all runs.
    pub fn mechanisms(&self) -> u64 {
        self.grid().mechanisms() * self.cells.mechanisms_per_cell()
    }

    fn rows_per_cell(&self) -> u64 {
        self.question.carry().map_or(1, |carry| carry.directions().len() as u64)
    }

    /// Number of rows that must be computed one after the other: the length of a walk, or 1.
    fn unit(&self) -> u64 {
        let walk = self.grid().axes().last().map_or(1, |axis| axis.values.len() as u64);
        self.question.carry().map_or(1, |_| walk)
    }

    /// The rows of a shard.
    pub fn slice(&self, shard: Shard) -> Slice {
        Slice::new(self.rows(), self.unit(), shard)
    }

    fn walk(&self, row: u64, draw: u64) -> Walk {
        let number = (row / self.unit() % self.rows_per_cell()) as usize;
        let direction = self.question.carry().map(|carry| carry.directions()[number]);
        Walk::new(self.cell(row), self.unit(), direction, draw)
    }

    /// The cell of a row. In walks of both directions cells are counted in the order of the grid.
    pub fn cell(&self, row: u64) -> u64 {
        row / self.unit() / self.rows_per_cell() * self.unit() + row % self.unit()
    }

    /// Approximate upper bound of the memory of a run in bytes; walks are kept until they end.
    pub fn memory(&self, threads: usize) -> u64 {
        let kept = self.cells.mechanisms.len() as u64;
        let several = self.grid().changes_mechanism() || self.cells.draws.change_mechanism();
        let mechanisms = if several { kept } else { 1 };
        let ahead = self.question.carry().map_or(AHEAD, |_| self.walks_ahead() * self.unit());
        ahead * threads as u64 * size_of::<Row<Q::Answer>>() as u64 + mechanisms * MECHANISM_BYTES
    }

    /// Number of walks per thread that may be begun ahead of the first one that has not been delivered.
    fn walks_ahead(&self) -> u64 {
        (AHEAD / self.unit()).max(MIN_WALKS_AHEAD)
    }

    /// The table without rows.
    pub fn empty_table(&self) -> Table {
        self.table(0, [])
    }

    /// The rows of consecutive cells from `begin` on, without walks, from all runs of each.
    pub fn table(&self, begin: u64, answers: impl IntoIterator<Item = Q::Answer>) -> Table {
        let runs = self.runs_per_row();
        let row = |(number, answer)| Row { index: begin + number / runs, direction: None, answer };
        let rows: Vec<Row<Q::Answer>> = (0..).zip(answers).map(row).collect();
        self.question.table(self.grid(), &rows)
    }

    /// The mechanism of the first cell, or why it has none. It is that of all cells if no axis changes it.
    pub fn first_mechanism(&self) -> Result<Arc<Mechanism>, BuildError> {
        let (mut scene, never) = (self.cells.base.clone(), AtomicBool::new(false));
        let built = self.cells.mechanism(0, 0, &mut scene, &never);
        built.unwrap_or_else(|| Mechanism::build(&scene.mechanism, &self.cells.files).map(Arc::new))
    }

    /// The model of the first cell as it is run; `None` if it has faults or its mechanism was not solved.
    pub fn first_model(&self, task: &Task) -> Option<Model> {
        let model = self.cells.model(0, 0, &mut self.cells.base.clone(), task)?.ok()?;
        Some(self.question.model(model))
    }

    /// Builds the model of every cell, without draws, and does not run it. The error is the first invalid
    /// cell, with all its faults. An unsolved mechanism is an outcome, not a fault. A cancelled check returns
    /// `Ok`.
    pub fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        self.validate_rows(&self.slice(Shard::WHOLE), 0, pool, task)
    }

    /// Like [`validate`](Self::validate), for the cells of a slice from its row `from` on.
    pub fn validate_rows(&self, part: &Slice, from: u64, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        let faults = |scene: &mut Scene, place: u64| {
            task.check_cancelled().ok()?;
            let index = self.cell(part.row(from + place));
            let faults = match self.cells.model(index, 0, scene, task)? {
                Ok(model) => vec![self.question.fault(&self.question.model(model), scene)?],
                Err(faults) => faults,
            };
            Some(CellFaults { cell: self.grid().describe(index), faults })
        };
        pool.find_first(part.rows() - from, || self.cells.base.clone(), faults).map_or(Ok(()), Err)
    }

    /// Replaces a mechanism that would be built.
    #[cfg(test)]
    pub fn set_mechanism(&self, number: usize, mechanism: Built) {
        *self.cells.mechanisms[number].lock().unwrap() = Some(mechanism);
    }

    /// Runs every cell on `pool` and passes the rows in order to `write`, several at a time. `write` returns
    /// whether more rows are wanted. Precondition: [`validate`](Self::validate) found no fault.
    pub fn run<E>(
        &self,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        self.run_rows(&self.slice(Shard::WHOLE), 0, pool, task, |table, _| write(table))
    }

    /// Like [`run`](Self::run), for the rows of a slice from `from` on, which must be the first row of a
    /// unit. `write` also gets the tally of its rows.
    pub fn run_rows<E>(
        &self,
        slice: &Slice,
        from: u64,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let (unit, threads) = (self.unit(), pool.count() as u64);
        let ahead = match self.question.carry() {
            Some(_) => self.walks_ahead() * threads,
            None => self.question.ahead(threads),
        };
        let runs = self.runs_per_row();
        let walk = |number: usize| {
            let (place, draw) = (number as u64 / runs, number as u64 % runs);
            self.walk(slice.row(from + place * unit), draw)
        };
        let work = |take: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, Row<Q::Answer>)| {
            self.run_walks(&walk, task, take, done);
        };
        let (mut tally, mut end, mut held) = (Tally::default(), None, Vec::new());
        let receive = |rows: Vec<Row<Q::Answer>>| {
            held.extend(rows);
            // runs of a row that is not yet whole wait for the others
            let rest = held.split_off(held.len() - held.len() % runs as usize);
            let rows = std::mem::replace(&mut held, rest);
            if rows.is_empty() {
                return true;
            }
            let mut part = Tally::default();
            rows.iter().step_by(runs as usize).for_each(|row| Q::count(&mut part, &row.answer));
            tally.add(&part);
            tally.mechanisms = self.cells.built.load(Ordering::Relaxed);
            let wanted = write(&self.question.table(self.grid(), &rows), &part);
            wanted.unwrap_or_else(|error| {
                end = Some(SweepEnd::Write(error));
                false
            })
        };
        let rows = slice.rows() - from;
        pool.in_order((rows / unit * runs) as usize, unit as usize, ahead as usize, work, receive);
        let cancelled = task.is_cancelled() && tally.cells < rows;
        end.or(cancelled.then_some(SweepEnd::Cancelled)).map_or(Ok(tally), Err)
    }

    /// Runs these cells on `pool` in this order, without walks and draws, and calls `each` with every result
    /// on the thread that computed it. False if cancelled before all were run.
    pub fn run_cells(
        &self,
        pool: &Pool,
        task: &Task,
        cells: &[u64],
        each: &(dyn Fn(u64, Q::Answer) + Sync),
    ) -> bool {
        let queue = Queue::new(cells.len(), pool.count());
        let walk = |number: usize| Walk::new(cells[number], 1, None, 0);
        let done = |_, row: Row<Q::Answer>| each(row.index, row.answer);
        pool.everywhere(|| self.run_walks(&walk, task, &|under_way| queue.take(under_way), &done));
        !task.is_cancelled()
    }

    /// Runs walks on this thread, several at a time in vector lanes. `take` gets the number of runs under way
    /// on this thread and returns the index of the next walk; `done` gets each row with its index.
    fn run_walks(
        &self,
        walk: &dyn Fn(usize) -> Walk,
        task: &Task,
        take: &dyn Fn(UnderWay) -> Option<usize>,
        done: &dyn Fn(usize, Row<Q::Answer>),
    ) {
        let (request, mut scene) = (self.question.request(), self.cells.base.clone());
        // walks whose next cell can be run, and those with a run under way, by index
        let (ready, walking) = (RefCell::new(Vec::new()), RefCell::new(BTreeMap::new()));
        let answered = |number: usize, mut walk: Walk, answer: Q::Answer| {
            if task.is_cancelled() {
                return;
            }
            let row = Row { index: walk.cell(), direction: walk.direction, answer };
            done(number * walk.length as usize + walk.done as usize, row);
            (task.tick)();
            walk.done += 1;
            if walk.done < walk.length {
                ready.borrow_mut().push((number, walk));
            }
        };
        let mut next = |under_way: UnderWay| loop {
            // checked first, since `take` may wait for another thread
            task.check_cancelled().ok()?;
            let kept = ready.borrow_mut().pop();
            let (number, begun) = kept.or_else(|| take(under_way).map(|number| (number, walk(number))))?;
            let model = self.cells.model(begun.cell(), begun.draw, &mut scene, task);
            let answer = match (model, request) {
                (Some(Ok(model)), Some(request)) => {
                    let model = begun.carried.continued(self.question.model(model));
                    let carry = begun.direction.is_some();
                    walking.borrow_mut().insert(number, begun);
                    return Some((number, model, Request { carry, cancel: Some(task.cancel), ..request }));
                }
                (Some(Ok(model)), None) => self.question.answer(&model, None, task.cancel),
                // once the grid has been validated, only a draw can have faults
                (Some(Err(_)), _) => Q::without_model(Cell::NotRun),
                (None, _) => Q::without_model(Cell::Unsolved),
            };
            answered(number, begun, answer);
        };
        let mut ended = |number: usize, model: &Model, run: Run| {
            let Some(mut walk): Option<Walk> = walking.borrow_mut().remove(&number) else { return };
            walk.carried.keep(model, &run);
            answered(number, walk, self.question.answer(model, Some(run), task.cancel));
        };
        Model::run_from(&mut next, &mut ended);
    }
}

/// A place for each of `count` mechanisms; none if these are too many to keep.
fn places(count: u64) -> Vec<Mutex<Option<Built>>> {
    let kept = if count <= MAX_KEPT_MECHANISMS { count } else { 0 };
    (0..kept).map(|_| Mutex::new(None)).collect()
}

/// The columns of the swept fields and, if `walked`, of the direction; an answer has `count` rows.
pub(crate) fn fields<A>(grid: &Grid, rows: &[Row<A>], count: impl Fn(&A) -> usize, walked: bool) -> Table {
    let each = || rows.iter().flat_map(|row| std::iter::repeat_n(row, count(&row.answer)));
    let table = grid.table(|| each().map(|row| row.index));
    if !walked {
        return table;
    }
    table.with(super::DIRECTION, each().map(|row| row.direction.map_or("", Direction::name)).collect())
}
