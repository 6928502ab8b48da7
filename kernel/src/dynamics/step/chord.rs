//! Chord of a step of free flight: bounds of its distance from the ends of its mode, and of its extremes.

use crate::dynamics::series::polynomial;
use crate::numeric::Scalar;

/// Safety factor on the bounds by which a step is clear of a surface, so that rounding never decides it.
pub(crate) const CLEARANCE: f64 = 1.0625;

/// Share of the displacement of a step that is far above rounding.
pub(crate) const ROUNDING: f64 = 1e-9;

pub(crate) struct Chord<T> {
    pub start: T,
    pub end: T,
    /// Bound of |x - x(start)|.
    pub bound: T,
    /// Bounds of the deviations of displacement, velocity times length, and acceleration times squared
    /// length from the chords between their ends, as given by
    /// [`chord_deviations`](crate::dynamics::series::polynomial::chord_deviations).
    pub deviations: (T, T, T),
    /// The velocities at its ends, times its length.
    pub slopes: (T, T),
    /// The accelerations at its ends, times the square of its length; 0 if they are not needed.
    pub curvatures: (T, T),
    pub limits: (T, T),
}

impl<T: Scalar> Chord<T> {
    /// From the coefficients of a step, its length and the velocity at its end.
    pub fn new(y: &[T], (start, end): (T, T), (length, v): (T, T), bound: T, limits: (T, T)) -> Self {
        let square = length * length;
        Self {
            start,
            end,
            bound,
            deviations: polynomial::chord_deviations(y, length),
            slopes: (y[1] * length, v * length),
            curvatures: ((y[2] + y[2]) * square, polynomial::curvature(y, length) * square),
            limits,
        }
    }

    /// Whether the step is clear of the low and of the high end of the mode, by its chord.
    #[inline(always)]
    pub fn is_clear(&self) -> (bool, bool) {
        let deviation = self.deviations.0 * T::of(CLEARANCE);
        let low = self.start.smaller(self.end) - deviation > self.limits.0;
        let high = self.start.larger(self.end) + deviation < self.limits.1;
        (low, high)
    }

    /// Whether the step stays above the low and below the high end of the mode. It does if both its ends do
    /// (the start may just have `left` that end) and one of them is its extreme.
    #[inline(always)]
    pub fn stays_between(&self, left: (bool, bool)) -> (bool, bool) {
        let (margin, (low, high)) = (self.bound * T::of(ROUNDING), self.limits);
        let (monotone, one_way) = (self.is_monotone(), self.bends_one_way());
        let above = (self.end - low > margin) & ((self.start > low) | left.0);
        let below = (high - self.end > margin) & ((self.start < high) | left.1);
        let (falls, rises) = (self.curvatures.0 < T::zero(), self.curvatures.0 > T::zero());
        (above & (monotone | (one_way & falls)), below & (monotone | (one_way & rises)))
    }

    /// Whether the step is clear of both ends of the mode, by its chord or by its ends.
    #[inline(always)]
    pub fn stays_clear(&self) -> bool {
        let (clear, between) = (self.is_clear(), self.stays_between((false, false)));
        (clear.0 | between.0) & (clear.1 | between.1)
    }

    /// Whether the velocity keeps its sign, by its chord or because the acceleration keeps its sign.
    #[inline(always)]
    pub fn is_monotone(&self) -> bool {
        keeps_sign(self.slopes, self.deviations.1)
            | (self.bends_one_way() & keeps_sign(self.slopes, T::zero()))
    }

    /// Whether the acceleration keeps its sign, by its chord.
    #[inline(always)]
    pub fn bends_one_way(&self) -> bool {
        keeps_sign(self.curvatures, self.deviations.2)
    }

    /// Whether the velocity changes its sign exactly once, given that the acceleration keeps its sign.
    #[inline(always)]
    pub fn turns_once(&self) -> bool {
        let (from, to) = self.slopes;
        self.bends_one_way() & keeps_sign((from, T::zero() - to), T::zero())
    }

    /// The extremes including the ends of the step, and whether a turning point inside it may lie beyond
    /// them.
    #[inline(always)]
    pub fn extremes(&self, (low, high): (T, T)) -> (T, T, bool) {
        let start = self.start.larger(self.limits.0).smaller(self.limits.1);
        let (lower, higher) = (start.smaller(self.end), start.larger(self.end));
        let (low, high) = (low.smaller(lower), high.larger(higher));
        let highest = (self.start + self.bound).smaller(self.limits.1).smaller(higher + self.deviations.0);
        let lowest = (self.start - self.bound).larger(self.limits.0).larger(lower - self.deviations.0);
        (low, high, ((highest > high) | (lowest < low)) & !self.is_monotone())
    }
}

/// Whether a function with these values at its ends and this deviation from its chord keeps its sign.
#[inline(always)]
fn keeps_sign<T: Scalar>((from, to): (T, T), deviation: T) -> bool {
    let alike = (from > T::zero()) == (to > T::zero());
    alike & (deviation * T::of(CLEARANCE) < from.abs().smaller(to.abs()))
}
