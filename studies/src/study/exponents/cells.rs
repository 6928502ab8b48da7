//! Exponents of every cell of a grid, a row a cell.

use std::sync::atomic::AtomicBool;

use super::exponents;
use super::result::{ExponentOptions, Exponents};
use crate::dynamics::{Model, Request, Run};
use crate::scene::{Fault, Scene};
use crate::study::cell::{Cell, Tally};
use crate::study::grid::Grid;
use crate::study::grid_study::{GridStudy, Question, Row, fields};
use crate::study::table::Table;
use crate::study::walk::without_a_period;

/// The exponents of every cell of a grid.
pub type ExponentCells = GridStudy<ExponentOptions>;

/// The exponents of a cell; `None` if it has none.
type Found = Option<Exponents>;

impl Question for ExponentOptions {
    type Answer = Found;

    fn request(&self) -> Option<Request<'_>> {
        None
    }

    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault> {
        drive_fault(model, scene)
    }

    fn answer(&self, model: &Model, _: Option<Run>, cancel: &AtomicBool) -> Found {
        exponents(model, self, cancel).ok()
    }

    fn without_model(_: Cell) -> Found {
        None
    }

    fn count(tally: &mut Tally, found: &Found) {
        tally.cells += 1;
        tally.resting += u64::from(found.is_some_and(|exponents| exponents.rests()));
        tally.without_exponents += u64::from(found.is_none());
    }

    fn table(&self, grid: &Grid, rows: &[Row<Found>]) -> Table {
        let found: Vec<Found> = rows.iter().map(|row| row.answer).collect();
        with_columns(fields(grid, rows, |_| 1, false), &found)
    }

    fn ahead(&self, threads: u64) -> u64 {
        32 * threads
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
