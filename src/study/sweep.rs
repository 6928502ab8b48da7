//! Sweep: a run for each cell of a grid, in parallel, a row a cell.

use super::Task;
use super::cell::{Cell, CellFaults, SweepEnd, Tally};
use super::cells::{Built, Cells, Question, Ran};
use super::fields::SummaryField;
use super::grid::Grid;
use super::slice::{Shard, Slice};
use super::table::{Table, Values};
use super::walk::{Carry, without_a_period};
use crate::dynamics::{Model, Request, Run};
use crate::scene::{Fault, Files, Scene};
use crate::system::threads::Pool;

/// The columns that every sweep has after those of its fields.
pub const STANDARD: [&str; 7] =
    ["rms_velocity_m_per_s", "regime", "crossings", "impacts", "max_abs_x_m", "period", "outcome"];

/// The column that says in which direction a field was walked.
pub const DIRECTION: &str = "direction";

/// What a sweep does beyond running each cell for its duration.
#[derive(Debug, Clone, Default)]
pub struct SweepOptions {
    /// More columns than the [standard](STANDARD) ones. One that needs the energy ledger has the cells run
    /// one by one.
    pub columns: Vec<&'static SummaryField>,
    /// Each run goes on until its motion repeats, or up to this time in s.
    pub until_settled: Option<f64>,
    /// The last field is walked: each cell begins in the state of the one before, at the last instant of its
    /// run that is a whole number of forcing periods after its start. Only the first begins at its scene's
    /// start. A column `direction` follows those of the fields, and the rows are in the order of the walk.
    pub carry: Option<Carry>,
}

/// A sweep of a grid over a scene.
#[derive(Debug)]
pub struct Sweep {
    cells: Cells,
    options: SweepOptions,
}

impl Question for SweepOptions {
    type Answer = ();

    fn request(&self) -> Request<'_> {
        let ledger = self.columns.iter().any(|field| field.needs_ledger);
        Request { ledger, until_settled: self.until_settled, ..Request::default() }
    }

    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault> {
        self.carry.and_then(|_| without_a_period(model, scene, "a walk from cell to cell"))
    }

    fn answer(&self, _: &Model, _: Run) {}

    fn table(&self, grid: &Grid, ran: &[Ran<()>]) -> Table {
        let mut table = fields(grid, ran, |_| 1, self.carry.is_some());
        for name in STANDARD {
            table = table.with(name, column(name, ran));
        }
        let more = self.columns.iter().filter(|field| !STANDARD.contains(&field.name));
        more.fold(table, |table, field| table.with(field.name, column(field.name, ran)))
    }
}

/// The columns of the swept fields, and that of the direction where the cells were walked; of each cell so
/// many rows.
pub(super) fn fields<A>(grid: &Grid, ran: &[Ran<A>], rows: impl Fn(&Ran<A>) -> usize, walked: bool) -> Table {
    let mut table = Table::new();
    for (i, name) in grid.columns().iter().enumerate() {
        let value = |row: &Ran<A>| {
            let value = grid.values(row.index).nth(i).unwrap_or(f64::NAN);
            std::iter::repeat_n(value, rows(row))
        };
        table = table.with(name, ran.iter().flat_map(value).collect());
    }
    if !walked {
        return table;
    }
    let word = |row: &Ran<A>| std::iter::repeat_n(row.direction.map_or("", |way| way.name()), rows(row));
    table.with(DIRECTION, ran.iter().flat_map(word).collect())
}

fn column(name: &str, ran: &[Ran<()>]) -> Values {
    match SummaryField::find(name) {
        // also for cells without a run
        _ if name == "outcome" => Values::Words(ran.iter().map(|row| row.cell.outcome()).collect()),
        Some(field) => field.column(ran.iter().map(|row| row.cell.summary())),
        None => Values::Words(vec![""; ran.len()]),
    }
}

impl Sweep {
    /// A sweep of `grid` over `base`, which has passed its check, as have the grid's corners.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        Self { cells: Cells::new(base, files, grid), options: SweepOptions::default() }
    }

    /// The same with these options.
    #[must_use]
    pub fn with(mut self, options: SweepOptions) -> Self {
        self.options = options;
        self
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.cells.grid
    }

    /// The number of rows.
    pub fn rows(&self) -> u64 {
        let walks = self.options.carry.map_or(1, |carry| carry.directions().len() as u64);
        self.grid().cells() * walks
    }

    /// Rows that are computed one after the other: those of a walk, else one.
    fn unit(&self) -> u64 {
        let walk = self.grid().axes().last().map_or(1, |axis| axis.values.len() as u64);
        self.options.carry.map_or(1, |_| walk)
    }

    /// The rows of a shard.
    pub fn slice(&self, shard: Shard) -> Slice {
        Slice::new(self.rows(), self.unit(), shard)
    }

    /// The options.
    pub fn options(&self) -> &SweepOptions {
        &self.options
    }

    /// Approximate upper bound of the bytes that a run of it keeps, however many cells there are. Walks are
    /// kept while they go on.
    pub fn memory(&self, threads: usize) -> u64 {
        let length = self.options.carry.map(|_| self.unit());
        self.cells.memory::<SweepOptions>(threads as u64, length)
    }

    /// The cell of a row.
    pub fn cell(&self, row: u64) -> u64 {
        let walks = self.options.carry.map_or(1, |carry| carry.directions().len() as u64);
        let (walk, step) = (row / self.unit(), row % self.unit());
        walk / walks * self.unit() + step
    }

    /// The table without rows.
    pub fn empty_table(&self) -> Table {
        self.table(0, &[])
    }

    /// The mechanism of the first cell, or why it has none. Where no axis changes the mechanism, it is that
    /// of every cell.
    pub fn first_mechanism(&self) -> Built {
        self.cells.first_mechanism()
    }

    /// The model of the first cell, or its faults; `None` if its mechanism was not solved.
    pub fn first_model(&self, task: &Task) -> Option<Result<Model, Vec<Fault>>> {
        self.cells.model(0, &mut self.cells.base.clone(), task)
    }

    /// Builds every cell without running it; the error is the first invalid one, with all its faults. In a
    /// walk, a drive that does not repeat is one. A mechanism that is not solved is no fault but an outcome.
    /// A cancelled check finds nothing.
    pub fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        self.validate_rows(&self.slice(Shard::WHOLE), 0, pool, task)
    }

    /// The same for the cells of a slice from its row `from` on.
    pub fn validate_rows(
        &self,
        slice: &Slice,
        from: u64,
        pool: &Pool,
        task: &Task,
    ) -> Result<(), CellFaults> {
        let cell = |place: u64| self.cell(slice.row(from + place));
        self.cells.validate(&self.options, (slice.rows() - from, cell), pool, task)
    }

    /// Runs every cell on `pool` and hands the rows to `write`, some at a time, in order. `write` answers
    /// whether more rows are wanted. Precondition: [`validate`](Self::validate) found nothing.
    pub fn run<E>(
        &self,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        self.run_rows(&self.slice(Shard::WHOLE), 0, pool, task, |table, _| write(table))
    }

    /// The same for the rows of a slice from `from` on, the first row of a unit; `write` also gets the tally
    /// of the rows that it gets.
    pub fn run_rows<E>(
        &self,
        slice: &Slice,
        from: u64,
        pool: &Pool,
        task: &Task,
        write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        match self.options.carry {
            Some(carry) => self.cells.walk(&self.options, carry, (slice, from), pool, task, write),
            None => self.cells.run(&self.options, (slice, from), pool, task, write),
        }
    }

    /// Runs these cells on `pool`, none of them carried, begun in their order, and hands each over from its
    /// thread as soon as it is there. Returns whether all of them were run: false if cancelled.
    pub fn run_cells(
        &self,
        pool: &Pool,
        task: &Task,
        cells: &[u64],
        each: &(dyn Fn(u64, Cell) + Sync),
    ) -> bool {
        self.cells.run_each(&self.options, pool, task, cells, each)
    }

    /// The rows of the cells from `begin` on, none of them carried.
    pub fn table(&self, begin: u64, rows: &[Cell]) -> Table {
        let ran = |(index, cell): (u64, &Cell)| Ran { index, direction: None, cell: *cell, answer: Some(()) };
        let rows: Vec<Ran<()>> = (begin..).zip(rows).map(ran).collect();
        self.options.table(&self.cells.grid, &rows)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::atomic::AtomicBool;

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
        let error = FlexureError::NotConverged { x: 1e-3, residual: 1.0, is_preloaded: true };
        *sweep.cells.mechanisms[1].lock().unwrap() = Some(Err(error.into()));
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
        assert_eq!(tally.outcomes, BTreeMap::from([("done".into(), 3), ("not_converged".into(), 3)]));
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
