//! How long does a rebound fly that is pressed back onto its stop?
//!
//! Before a mass comes to rest it bounces a dozen times, each time a fraction as fast; most impacts of a run are such.
//! Their flights are all but parabolas, so they need no search: with the gap as the variable, which is 0 at the start by
//! definition, the flight ends where a polynomial with one root is 0, and Newton's method from the parabola's own
//! end finds that to the last digit in three or four steps, however short the flight.

use super::drive::Drive;
use super::equation::EndKind;
use super::motion::{BY_SPEED, Flow, Motion, Touch};
use crate::numeric::Scalar;

/// The most steps of Newton's method; each squares the error, and the first is smaller than a half.
const MOST_STEPS: usize = 12;

impl<T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'_, T, D, LEDGER> {
    /// Flies from the stop that the mass has just been thrown off back to it; none where the flight may be longer than
    /// `flight`, or is too far from a parabola for its end to be known without a search. Expects the series to be begun.
    pub(super) fn rebound(&mut self, flight: T, left: T) -> Option<Flow> {
        let Some(Touch { end, order: BY_SPEED }) = self.touch else { return None };
        let (level, kind) = self.equation.arenas[self.arena].end(end);
        let border = self.drive.segment_end(self.segment);
        let before = |border| flight < self.clock.between(&self.at, &border);
        if kind != EndKind::Stop || !(flight < left) || !border.is_none_or(before) {
            return None;
        }
        if !self.expand_for(flight) {
            return None;
        }
        let length = self.parabola_like(end.sign(), flight)?;
        let state = self.series.state(length);
        // Nowhere near the other end.
        let (other, _) = self.equation.arenas[self.arena].end(end.other());
        if !((other - level).abs() > state.bound) || !self.step_holds(length, &state) {
            return None;
        }
        Some(self.arrive((length, length), state.bound, (level, state.v), None, Some(end)))
    }

    /// Where gap / time, positive at 0 and falling all the way up to `flight`, is 0.
    fn parabola_like(&self, sign: T, flight: T) -> Option<T> {
        let zero = T::zero();
        let y = &self.series.y[1..self.series.known];
        // The slope is that of the parabola, give or take what all the others can come to.
        let mut others = zero;
        for (k, c) in y.iter().enumerate().skip(2).rev() {
            others = others * flight + c.abs() * T::of(k as f64);
        }
        let others = others * flight;
        let falls = sign * y[1];
        if !(falls > others) {
            return None;
        }
        let value_and_slope = |t: T| {
            let (mut value, mut slope) = (zero, zero);
            for c in y.iter().rev() {
                slope = slope * t + value;
                value = value * t - sign * *c;
            }
            (value, slope)
        };
        if value_and_slope(flight).0 > zero {
            return None;
        }
        let mut t = -(y[0] / y[1]);
        for _ in 0..MOST_STEPS {
            let (value, slope) = value_and_slope(t);
            let change = value / slope;
            t -= change;
            if !(t > zero && t <= flight) {
                return None;
            }
            if change.abs() <= t * T::of(4.0 * T::EPSILON) {
                return Some(t);
            }
        }
        None
    }
}
