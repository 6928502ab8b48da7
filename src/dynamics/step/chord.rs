//! Chord of a step of free flight: bounds of its distance from the ends of its mode, and of its extremes.

use crate::dynamics::series::polynomial;
use crate::numeric::Scalar;

/// Safety factor on the bounds by which a step is clear of a surface: rounding never decides it.
pub(crate) const CLEARANCE: f64 = 1.0625;

/// A share of the way that rounding is far below.
pub(crate) const ROUNDING: f64 = 1e-9;

/// A step of free flight.
pub(crate) struct Chord<T> {
    /// Displacement at its start and at its end.
    pub start: T,
    pub end: T,
    /// Bound of |x - x(start)|.
    pub bound: T,
    /// Bounds of how far displacement, velocity times length, and acceleration times its square leave the
    /// chords between their ends, as
    /// [`chord_deviations`](crate::dynamics::series::polynomial::chord_deviations) gives them.
    pub deviations: (T, T, T),
    /// The velocities at its ends, times its length.
    pub ways: (T, T),
    /// The accelerations there, times the square of its length; 0 where they are not asked for.
    pub bends: (T, T),
    /// Ends of the mode.
    pub limits: (T, T),
}

impl<T: Scalar> Chord<T> {
    /// Of a step with these coefficients, of this length and with this velocity at its end.
    pub fn new(y: &[T], (start, end): (T, T), (length, v): (T, T), bound: T, limits: (T, T)) -> Self {
        let square = length * length;
        Self {
            start,
            end,
            bound,
            deviations: polynomial::chord_deviations(y, length),
            ways: (y[1] * length, v * length),
            bends: ((y[2] + y[2]) * square, polynomial::curvature(y, length) * square),
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

    /// Whether it stays above the low and below the high end of the mode, since its own ends do, or it has
    /// just `left` that one, and one of them is its lowest or its highest place.
    #[inline(always)]
    pub fn stays_between(&self, left: (bool, bool)) -> (bool, bool) {
        let (margin, (low, high)) = (self.bound * T::of(ROUNDING), self.limits);
        let (monotone, bends) = (self.is_monotone(), self.bends_one_way());
        let above = (self.end - low > margin) & ((self.start > low) | left.0);
        let below = (high - self.end > margin) & ((self.start < high) | left.1);
        let (falls, rises) = (self.bends.0 < T::zero(), self.bends.0 > T::zero());
        (above & (monotone | (bends & falls)), below & (monotone | (bends & rises)))
    }

    /// Whether it is clear of both ends of the mode, by its chord or by its ends.
    #[inline(always)]
    pub fn stays_clear(&self) -> bool {
        let (clear, between) = (self.is_clear(), self.stays_between((false, false)));
        (clear.0 | between.0) & (clear.1 | between.1)
    }

    /// Whether the velocity keeps its sign, by its chord or since the acceleration does.
    #[inline(always)]
    pub fn is_monotone(&self) -> bool {
        keeps_sign(self.ways, self.deviations.1) | (self.bends_one_way() & keeps_sign(self.ways, T::zero()))
    }

    /// Whether the acceleration keeps its sign, by its chord.
    #[inline(always)]
    pub fn bends_one_way(&self) -> bool {
        keeps_sign(self.bends, self.deviations.2)
    }

    /// Whether the velocity changes its sign once, since the acceleration keeps its own.
    #[inline(always)]
    pub fn turns_once(&self) -> bool {
        let (from, to) = self.ways;
        self.bends_one_way() & keeps_sign((from, T::zero() - to), T::zero())
    }

    /// The extremes with the ends of the step, and whether a turning point inside it may lie beyond them.
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

/// Whether a function keeps its sign that has these values at its ends and deviates so much from the chord.
#[inline(always)]
fn keeps_sign<T: Scalar>((from, to): (T, T), deviation: T) -> bool {
    let alike = (from > T::zero()) == (to > T::zero());
    alike & (deviation * T::of(CLEARANCE) < from.abs().smaller(to.abs()))
}
