//! Lyapunov exponents of a settled motion: rates in 1/s at which small changes of it grow or die away.
//!
//! Where the motion repeats they are ln|multiplier| over its period, of the periodic motion itself, which
//! Newton's method finds. Elsewhere they are averages over forcing periods (Benettin et al. 1980): a change
//! is carried along by the derivatives of the stroboscopic map, which hold through impacts (Müller 1995),
//! and is made a unit long once a period. The map of a phase plane has two; the third one of the driven
//! motion, along its own path, is 0.
//!
//! Both together have an exact value, since damping and impacts alone shrink areas:
//! -c/m + 2 ln(restitution) times the rate of impacts, of each stop. The second exponent is this sum less the
//! first, so that it keeps its digits however far they lie apart. After a rest on a stop nothing is left of a
//! change: both are minus infinity.

mod average;
mod orbit;
mod result;
mod tangent;

use std::sync::atomic::AtomicBool;

use crate::dynamics::{Model, Outcome, Request, Run};
use crate::scene::{Fault, Scene};
use crate::study::grid_study::fields;
use crate::study::settled::PATIENCE;
use crate::study::walk::without_a_period;
use crate::study::{Cell, Grid, GridStudy, Question, Row, Table, Tally, followed_until};
use average::average;
use orbit::of_orbit;
use tangent::Tangent;

pub use average::average_exponents;
pub use result::{Estimate, ExponentOptions, Exponents, NoExponents};

/// Forcing periods of a window in which a motion that repeats after up to 12 of them is recognised.
const WINDOW: f64 = 36.0;

/// The exponents of the settled motion of `model`.
///
/// Its run goes on, window after window, until it repeats or the time of the options is over. If it repeats,
/// the exponents are those of the periodic motion; else averages over the periods that follow. Without a
/// drive the mass is followed for 1000 periods of its small oscillations.
pub fn exponents(
    model: &Model,
    options: &ExponentOptions,
    cancel: &AtomicBool,
) -> Result<Exponents, NoExponents> {
    let (run, until_settled) = match model.forcing_period().filter(|_| model.repeats()) {
        Some(period) => {
            let window = (model.duration() - model.settle()).max(WINDOW * period);
            let until = options.until_settled.unwrap_or(followed_until(model));
            (model.with_duration(model.settle() + window, model.settle()), Some(until))
        }
        None if model.excitation().is_constant() => {
            let end = model.duration() + f64::from(PATIENCE) * model.natural_time();
            (model.with_duration(end, end), None)
        }
        None => return Err(NoExponents::NoPeriod),
    };
    let summary = run.run(&Request { cancel: Some(cancel), until_settled, ..Request::default() }).summary;
    match summary.outcome {
        Outcome::Done => {}
        Outcome::Cancelled { .. } => return Err(NoExponents::Cancelled),
        other => return Err(NoExponents::EndedEarly(other)),
    }
    let state = (summary.final_x, summary.final_v);
    let phase = model.drive_phase(summary.window.1).unwrap_or(0.0);
    let tangent = Tangent::of(model, phase)?;
    // a motion that has not settled may pass near a periodic one that it does not go to
    let found = match model.repeats() && summary.settled != Some(true) {
        true => None,
        false => of_orbit(&tangent, state, summary.period.unwrap_or(1))?,
    };
    found.map_or_else(|| average(&tangent, state, options.periods, cancel), Ok)
}

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

/// The fault of an excitation that changes and does not repeat, so that there are no exponents.
pub fn drive_fault(model: &Model, scene: &Scene) -> Option<Fault> {
    let suits = model.excitation().is_constant();
    if suits { None } else { without_a_period(model, scene, "an exponent") }
}

/// The exponents of one motion as a table of one row.
pub fn exponents_row(found: &Exponents) -> Table {
    with_columns(Table::new(), &[Some(*found)])
}

fn with_columns(table: Table, found: &[Found]) -> Table {
    let number = |of: fn(&Exponents) -> f64| move |cell: &Found| cell.as_ref().map(of);
    table
        .each("exponent_1_per_s", found, number(|exponents| exponents.first.per_s))
        .each("exponent_1_se", found, number(|exponents| exponents.first.error))
        .each("exponent_2_per_s", found, number(|exponents| exponents.second.per_s))
        .each("exponent_2_se", found, number(|exponents| exponents.second.error))
        .each("sum_per_s", found, number(|exponents| exponents.sum))
        .each("exact_sum_per_s", found, |cell| cell.as_ref()?.exact_sum)
        .each("dimension", found, number(Exponents::dimension))
}
