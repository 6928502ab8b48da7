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
mod tangent;

use std::sync::atomic::AtomicBool;

use crate::dynamics::{Model, Outcome, Request, Run};
use crate::scene::{Fault, Scene};
use crate::study::grid_study::fields;
use crate::study::settled::PATIENCE;
use crate::study::walk::without_a_period;
use crate::study::{Cell, Grid, GridStudy, Question, Row, Table, Tally, followed_until};
use average::average;
pub use average::average_exponents;
use orbit::of_orbit;
use tangent::Tangent;

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

/// How exponents are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExponentOptions {
    /// Forcing periods over which a motion without a period is averaged.
    pub periods: u32,
    /// Time in s up to which a motion is followed until it repeats; by default 1000 periods beyond the run.
    pub until_settled: Option<f64>,
}

impl ExponentOptions {
    /// Periods averaged over where none are named.
    pub const PERIODS: u32 = 1000;
}

impl Default for ExponentOptions {
    fn default() -> Self {
        Self { periods: Self::PERIODS, until_settled: None }
    }
}

/// An average with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value in 1/s; minus infinity where nothing is left of a change, NaN where it is not known.
    pub per_s: f64,
    /// Its standard error in 1/s: 0 of a periodic motion or of minus infinity, NaN of too few periods.
    pub error: f64,
}

impl Estimate {
    /// A value without scatter.
    pub(super) fn exact(per_s: f64) -> Self {
        Self { per_s: per_s + 0.0, error: 0.0 }
    }
}

/// Both exponents of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Exponents {
    /// The larger one.
    pub first: Estimate,
    /// The smaller one. NaN where stops are compliant and the derivatives do not show so strong a loss.
    pub second: Estimate,
    /// Their sum in 1/s by the determinants of the derivatives. NaN where a forcing period shrinks areas so
    /// much that a determinant, the difference of two products, has lost its digits.
    pub sum: f64,
    /// Their sum in 1/s by damping and impacts; `None` with compliant stops, whose loss varies.
    pub exact_sum: Option<f64>,
    /// Forcing periods after which the motion repeats, where they are those of a periodic motion.
    pub period: Option<u32>,
    /// Forcing periods that they are of, and the time in s that those take.
    pub span: (u32, f64),
}

/// Standard errors above 0 from which an exponent counts as positive.
const CLEAR: f64 = 3.0;

/// Least growth of an irregular motion, in multiples of that of a shear: the logarithm of the periods.
const BEYOND_SHEAR: f64 = 3.0;

impl Exponents {
    /// Of a motion that has rested on a stop within these forcing periods.
    pub(super) fn of_rest(period: Option<u32>, span: (u32, f64), exact: bool) -> Self {
        let nothing = f64::NEG_INFINITY;
        let (first, second) = (Estimate::exact(nothing), Estimate::exact(nothing));
        Self { first, second, sum: nothing, exact_sum: exact.then_some(nothing), period, span }
    }

    /// Whether the motion has rested on a stop, so that nothing was left of a change.
    pub fn rests(&self) -> bool {
        self.first.per_s == f64::NEG_INFINITY
    }

    /// Whether the motion is irregular: it does not repeat, the first exponent is above 0 by more than three
    /// standard errors, and small changes have grown far more over these periods than in proportion to time,
    /// as they do in regular motion without damping.
    ///
    /// A transient that wanders irregularly for these periods and settles later is irregular for as long.
    pub fn is_irregular(&self) -> bool {
        let (periods, time) = self.span;
        let shear = f64::from(periods.max(2)).ln();
        self.period.is_none()
            && self.first.per_s > CLEAR * self.first.error
            && self.first.per_s * time > BEYOND_SHEAR * shear
    }

    /// Kaplan-Yorke dimension of the stroboscopic section (Kaplan and Yorke 1979): 0 where both exponents
    /// are below 0, 2 where their sum is not, 1 + first/|second| between. That of the motion in time is one
    /// more. NaN where the second exponent is not known and matters.
    pub fn dimension(&self) -> f64 {
        let (first, second) = (self.first.per_s, self.second.per_s);
        match first + second {
            _ if first < 0.0 => 0.0,
            sum if sum >= 0.0 => 2.0,
            _ => 1.0 + first / second.abs(),
        }
    }
}

/// Why there are no exponents.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoExponents {
    /// The excitation changes and does not repeat.
    #[error("its excitation has no period that repeats")]
    NoPeriod,
    /// Its transducer has a state of its own.
    #[error("{}", crate::study::ELECTRICAL_STATE)]
    ElectricalState,
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The motion ended.
    #[error("the motion ended early ({}), so it has no exponents", .0.name())]
    EndedEarly(Outcome),
    /// The mass has touched a stop without speed to the last digit, where the map has no derivatives.
    #[error("the mass touched a stop without speed, where a small change has no rate")]
    Grazing,
}
