//! Exponents of every cell of a grid, a row a cell.

use super::result::{ExponentOptions, Exponents};
use super::settle::exponents;
use crate::dynamics::Model;
use crate::scene::{Fault, Files, Scene};
use crate::study::cell::{CellFaults, SweepEnd};
use crate::study::cells::{Built, Cells};
use crate::study::table::Table;
use crate::study::walk::without_a_period;
use crate::study::{Grid, Task};
use crate::system::threads::{Pool, UnderWay};

/// Cells that may be begun, for each thread, before the first of them is over.
const AHEAD: usize = 32;

/// A scene and the grid over it whose exponents are asked for.
#[derive(Debug)]
pub struct ExponentCells {
    cells: Cells,
}

/// Counts of the results of the cells of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ExponentTally {
    /// Cells done.
    pub cells: u64,
    /// Cells whose motion rests on a stop, so that both exponents are minus infinity.
    pub resting: u64,
    /// Cells without exponents: the motion ended early or touched a stop without speed, or the flexures were
    /// not solved.
    pub missing: u64,
}

/// The exponents of a cell; `None` if it has none.
type Found = Option<Exponents>;

impl ExponentCells {
    /// The exponents of `grid` over `base`.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        Self { cells: Cells::new(base, files, grid) }
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.cells.grid
    }

    /// The mechanism of the first cell, or why it has none.
    pub fn first_mechanism(&self) -> Built {
        self.cells.first_mechanism()
    }

    /// The model of the first cell, or its faults; `None` if its mechanism was not solved.
    pub fn first_model(&self, task: &Task) -> Option<Result<Model, Vec<Fault>>> {
        self.cells.model(0, &mut self.cells.base.clone(), task)
    }

    /// The table without rows.
    pub fn empty_table(&self) -> Table {
        self.table(0, &[])
    }

    /// Builds every cell; the error is the first invalid one, or one whose excitation changes and does
    /// not repeat.
    pub fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        let faults = |scene: &mut Scene, index: u64| {
            if task.is_cancelled() {
                return None;
            }
            let faults = match self.cells.model(index, scene, task)? {
                Ok(model) => vec![drive_fault(&model, scene)?],
                Err(faults) => faults,
            };
            Some(CellFaults { cell: self.cells.grid.describe(index), faults })
        };
        pool.find_first(self.cells.grid.cells(), || self.cells.base.clone(), faults).map_or(Ok(()), Err)
    }

    /// Measures every cell on `pool` and hands the rows to `write`, some at a time, in order. `write` answers
    /// whether more rows are wanted. Precondition: [`validate`](Self::validate) found nothing.
    pub fn run<E>(
        &self,
        options: &ExponentOptions,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<ExponentTally, SweepEnd<E>> {
        let cells = self.cells.grid.cells() as usize;
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, Found)| {
            let mut scene = self.cells.base.clone();
            while let Some(number) = next(UnderWay::default()) {
                let model = self.cells.model(number as u64, &mut scene, task).and_then(Result::ok);
                let found = model.map(|model| exponents(&model, options, task.cancel));
                if task.is_cancelled() {
                    return;
                }
                done(number, found.and_then(Result::ok));
                (task.tick)();
            }
        };
        let (mut tally, mut end) = (ExponentTally::default(), None);
        let leave = |found: Vec<Found>| {
            let table = self.table(tally.cells, &found);
            tally.cells += found.len() as u64;
            tally.missing += found.iter().filter(|cell| cell.is_none()).count() as u64;
            tally.resting += found.iter().flatten().filter(|exponents| exponents.rests()).count() as u64;
            write(&table).unwrap_or_else(|error| {
                end = Some(SweepEnd::Write(error));
                false
            })
        };
        pool.in_order((cells, 1, AHEAD * pool.count()), work, leave);
        let cancelled = task.is_cancelled() && tally.cells < cells as u64;
        end.or(cancelled.then_some(SweepEnd::Cancelled)).map_or(Ok(tally), Err)
    }

    fn table(&self, begin: u64, found: &[Found]) -> Table {
        let grid = &self.cells.grid;
        let mut table = Table::new();
        for (place, column) in grid.columns().iter().enumerate() {
            let value = |row: usize| grid.values(begin + row as u64).nth(place).unwrap_or(f64::NAN);
            table = table.with(column, (0..found.len()).map(value).collect());
        }
        with_columns(table, found)
    }
}

/// What is wrong with the excitation of a scene whose exponents are asked for: it changes and does
/// not repeat.
pub fn drive_fault(model: &Model, scene: &Scene) -> Option<Fault> {
    let suits = model.excitation().is_constant();
    if suits { None } else { without_a_period(model, scene, "an exponent") }
}

/// The exponents of one motion as a table of one row.
pub fn exponents_row(found: &Exponents) -> Table {
    with_columns(Table::new(), &[Some(*found)])
}

fn with_columns(table: Table, found: &[Found]) -> Table {
    let number = |of: fn(&Exponents) -> f64| move |cell: &Found| cell.as_ref().map_or(f64::NAN, of);
    table
        .each("exponent_1_per_s", found, number(|exponents| exponents.first.per_s))
        .each("exponent_1_se", found, number(|exponents| exponents.first.error))
        .each("exponent_2_per_s", found, number(|exponents| exponents.second.per_s))
        .each("exponent_2_se", found, number(|exponents| exponents.second.error))
        .each("sum_per_s", found, number(|exponents| exponents.sum))
        .each("exact_sum_per_s", found, number(|exponents| exponents.exact_sum.unwrap_or(f64::NAN)))
        .each("dimension", found, number(Exponents::dimension))
}
