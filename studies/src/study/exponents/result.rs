//! Lyapunov exponents of a motion, and the reasons why there are none.

use crate::dynamics::Outcome;

/// How exponents are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExponentOptions {
    /// Forcing periods over which a motion without a period is averaged.
    pub periods: u32,
    /// Time in s up to which a motion is followed until it repeats; by default 1000 forcing periods beyond
    /// the run.
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
    /// Its standard error in 1/s: 0 where the value is that of a periodic motion or minus infinity, NaN if
    /// there are too few periods.
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
    /// Their sum in 1/s by damping and impacts; `None` with compliant stops, whose loss depends on the
    /// motion.
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
    /// It was told to stop.
    #[error("interrupted")]
    Cancelled,
    /// The motion ended.
    #[error("the motion ended early ({}), so it has no exponents", .0.name())]
    EndedEarly(Outcome),
    /// The mass has touched a stop without speed to the last digit, where the map has no derivatives.
    #[error("the mass touched a stop without speed, where a small change has no rate")]
    Grazing,
}
