//! Exponents of every cell of a grid, a row a cell.

use super::result::{ExponentOptions, Exponents, NoExponents};
use super::settle::exponents;
use crate::dynamics::Model;
use crate::scene::{Fault, Files, Scene};
use crate::study::periodic::without_a_period;
use crate::study::sweep::{CellFaults, Sweep, SweepEnd};
use crate::study::table::Table;
use crate::study::{Grid, Task};
use crate::system::threads::Pool;

/// Cells that a thread has of a chunk of rows.
const CELLS_PER_THREAD: u64 = 32;

/// A scene and the grid over it whose exponents are asked for.
#[derive(Debug)]
pub struct ExponentCells {
    base: Scene,
    sweep: Sweep,
}

/// What the cells of a grid came to.
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

/// The exponents of a cell; none where it has none.
type Found = Option<Exponents>;

impl ExponentCells {
    /// The exponents of `grid` over `base`.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        Self { base: base.clone(), sweep: Sweep::new(base, files, grid) }
    }

    /// The cells as those of a sweep.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// The table without rows.
    pub fn empty_table(&self) -> Table {
        self.table(0, &[])
    }

    /// Builds every cell; the first one that is wrong, or whose excitation changes and does not repeat.
    pub fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        let faults = |scene: &mut Scene, index: u64| {
            if task.is_cancelled() {
                return None;
            }
            let faults = match self.sweep.model(index, scene, task)? {
                Ok(model) => vec![without_a_period(&model, scene, WHAT)?],
                Err(faults) => faults,
            };
            Some(CellFaults { cell: self.sweep.grid().describe(index), faults })
        };
        pool.find_first(self.sweep.grid().cells(), || self.base.clone(), faults).map_or(Ok(()), Err)
    }

    /// Measures every cell on `pool` and hands the rows to `write`, chunk by chunk in order. `write` answers
    /// whether more rows are wanted. Precondition: [`validate`](Self::validate) found nothing.
    pub fn run<E>(
        &self,
        options: &ExponentOptions,
        pool: &Pool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<ExponentTally, SweepEnd<E>> {
        let cells = self.sweep.grid().cells();
        let mut tally = ExponentTally::default();
        while tally.cells < cells {
            let begin = tally.cells;
            let count = (CELLS_PER_THREAD * pool.count() as u64).min(cells - begin);
            let cell = |scene: &mut Scene, place: usize| {
                let model = self.sweep.model(begin + place as u64, scene, task).and_then(Result::ok);
                let found = match model.map(|model| exponents(&model, options, task.cancel)) {
                    Some(Err(NoExponents::Cancelled)) => return Err(()),
                    Some(Ok(found)) => Some(found),
                    Some(Err(_)) | None => None,
                };
                (task.tick)();
                if task.is_cancelled() { Err(()) } else { Ok(found) }
            };
            let found = pool.map(count as usize, || self.base.clone(), cell);
            let found = found.map_err(|()| SweepEnd::Cancelled)?;
            tally.cells += count;
            tally.missing += found.iter().filter(|own| own.is_none()).count() as u64;
            tally.resting += found.iter().flatten().filter(|own| own.rests()).count() as u64;
            if !write(&self.table(begin, &found)).map_err(SweepEnd::Write)? {
                break;
            }
        }
        Ok(tally)
    }

    fn table(&self, begin: u64, found: &[Found]) -> Table {
        let grid = self.sweep.grid();
        let mut table = Table::new();
        for (place, column) in grid.columns().iter().enumerate() {
            let value = |row: usize| grid.values(begin + row as u64).nth(place).unwrap_or(f64::NAN);
            table = table.with(column, (0..found.len()).map(value).collect());
        }
        with_columns(table, found)
    }
}

/// What needs the period.
const WHAT: &str = "an exponent";

/// What is wrong with the excitation of a scene whose exponents are asked for.
pub fn drive_fault(model: &Model, scene: &Scene) -> Option<Fault> {
    without_a_period(model, scene, WHAT)
}

/// The exponents of one motion as a table of one row.
pub fn exponents_row(found: &Exponents) -> Table {
    with_columns(Table::new(), &[Some(*found)])
}

fn with_columns(table: Table, found: &[Found]) -> Table {
    let number = |of: fn(&Exponents) -> f64| move |own: &Found| own.as_ref().map_or(f64::NAN, of);
    table
        .each("exponent_1_per_s", found, number(|own| own.first.per_s))
        .each("exponent_1_se", found, number(|own| own.first.error))
        .each("exponent_2_per_s", found, number(|own| own.second.per_s))
        .each("exponent_2_se", found, number(|own| own.second.error))
        .each("sum_per_s", found, number(|own| own.sum))
        .each("exact_sum_per_s", found, number(|own| own.exact_sum.unwrap_or(f64::NAN)))
        .each("dimension", found, number(Exponents::dimension))
}
