//! Chord of a step of free flight: bounds of its distance from the ends of its mode, and of its extremes.

use crate::numeric::Scalar;

/// Safety factor on the bounds by which a step is clear of a surface: rounding never decides it.
pub(crate) const CLEARANCE: f64 = 1.0625;

/// A step of free flight.
pub(crate) struct Chord<T> {
    /// Displacement at its start and at its end.
    pub start: T,
    pub end: T,
    /// Bound of |x - x(start)|.
    pub bound: T,
    /// Bounds of how far displacement, and velocity times length, leave the chords between their ends, as
    /// [`chord_deviations`](crate::dynamics::series::polynomial::chord_deviations) gives them.
    pub deviations: (T, T),
    /// The velocities at its ends, times its length.
    pub ways: (T, T),
    /// Ends of the mode.
    pub limits: (T, T),
}

impl<T: Scalar> Chord<T> {
    /// Whether the step is clear of the low and of the high end of the mode, by its chord.
    #[inline(always)]
    pub fn is_clear(&self) -> (bool, bool) {
        let deviation = self.deviations.0 * T::of(CLEARANCE);
        let low = self.start.smaller(self.end) - deviation > self.limits.0;
        let high = self.start.larger(self.end) + deviation < self.limits.1;
        (low, high)
    }

    /// Whether the velocity keeps its sign, by its chord.
    #[inline(always)]
    pub fn is_monotone(&self) -> bool {
        let (from, to) = self.ways;
        let alike = (from > T::zero()) == (to > T::zero());
        alike & (self.deviations.1 * T::of(CLEARANCE) < from.abs().smaller(to.abs()))
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
