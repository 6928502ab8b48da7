//! Time of flight of a rebound that is pressed back onto its stop.
//!
//! Before a mass comes to rest it bounces a dozen times, each time at a fraction of the speed; most impacts
//! of a run are of this kind. A flight lasts about 2 v / a, so the series is extended only until its terms
//! are negligible over that time: four or five coefficients, where a full step has sixteen. It is nearly a
//! parabola, so its end needs no search: the gap is 0 at the start by definition, and divided by time it is a
//! polynomial with one root. A third-order method that starts from the end of the parabola finds the root to
//! the last digit in two or three steps.

use super::stepper::Stepper;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{End, EndKind};
use crate::dynamics::series::Endpoint;
use crate::dynamics::state::{MotionState, Opening, Touch};
use crate::numeric::Scalar;

/// Maximum number of steps to the root; each takes the error to its third power.
const MAX_STEPS: usize = 12;

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
    /// Whether the next step has the full order, and either touches no surface at its start or leaves one
    /// with speed.
    pub fn flies_freely(&mut self, state: &MotionState<T>) -> bool {
        match state.touch {
            None => true,
            Some(Touch { opening: Opening::Speed, .. }) => {
                self.seed(state);
                self.pressed_rebound(state)
                    .is_none_or(|(end, rates)| self.short_flight(state, end, rates).is_none())
            }
            Some(_) => false,
        }
    }

    /// The stop from which the mass has just rebounded, with the contact acceleration there and its first two
    /// derivatives; `None` if there is none or the mass is not pressed back. Expects a seeded drive.
    #[inline(always)]
    pub fn pressed_rebound(&self, state: &MotionState<T>) -> Option<(End, [T; 3])> {
        let Some(Touch { end, opening: Opening::Speed }) = state.touch else { return None };
        if !matches!(self.mode(state).end(end).1, EndKind::Stop | EndKind::Compliant) {
            return None;
        }
        let rates = self.seeded_contact_acceleration(end);
        (rates[0] > T::zero()).then_some((end, rates))
    }

    /// Bound of the time of flight of a rebound that is pressed back, if drive and mechanism change the
    /// contact acceleration little during it, and always on a compliant stop; `None` for an ordinary flight.
    #[inline(always)]
    pub fn short_flight(
        &self,
        state: &MotionState<T>,
        end: End,
        [acceleration, jerk, _]: [T; 3],
    ) -> Option<T> {
        let (speed, damping) = (state.v.abs(), self.equation.damping);
        let stiffness = self.equation.stop(end).map_or(T::zero(), |stop| stop.stiffness.abs());
        let flight = T::of(3.0) * speed / acceleration;
        let stiffness = self.circuit_stiffness().map_or(stiffness, |more| stiffness + more);
        let change = (jerk.abs() + stiffness * speed + damping * acceleration) * flight;
        (self.equation.compliant.is_some() || change < acceleration * T::of(1.5)).then_some(flight)
    }

    /// The flight of a rebound back to its stop: the stop, the length, and the state at the end; `None` if
    /// the flight may be longer than `flight`, or differs too much from a parabola for its end to be found
    /// without a search. Expects the series to be extended far enough.
    #[inline(always)]
    pub fn rebound(&mut self, state: &MotionState<T>, flight: T, left: T) -> Option<(End, T, Endpoint<T>)> {
        let Some(Touch { end, opening: Opening::Speed }) = state.touch else { return None };
        let (level, kind) = self.mode(state).end(end);
        let border = self.drive.segment_end(state.segment);
        let before = |border| flight < self.clock.between(&state.at, &border);
        let stop = matches!(kind, EndKind::Stop | EndKind::Compliant);
        if !stop || !(flight < left) || !border.is_none_or(before) {
            return None;
        }
        let (sign, y) = (end.sign(), &self.series.coefficients()[1..]);
        // for a constant number of coefficients the loops over them are unrolled
        let length = match y {
            [a, b, c, d] => parabola_like(&[*a, *b, *c, *d], sign, flight),
            [a, b, c, d, e] => parabola_like(&[*a, *b, *c, *d, *e], sign, flight),
            [a, b, c, d, e, f] => parabola_like(&[*a, *b, *c, *d, *e, *f], sign, flight),
            [a, b, c, d, e, f, g] => parabola_like(&[*a, *b, *c, *d, *e, *f, *g], sign, flight),
            _ => parabola_like(y, sign, flight),
        }?;
        let landing = self.series.state(length);
        // It must be far from the other end.
        let (other, _) = self.mode(state).end(end.other());
        if !((other - level).abs() > landing.bound) || !self.step_holds(state, length, &landing) {
            return None;
        }
        Some((end, length, landing))
    }
}

/// The root of gap / time, which is positive at 0 and decreases up to `flight`; `y` are the coefficients of
/// the displacement without the constant.
#[inline(always)]
fn parabola_like<T: Scalar>(y: &[T], sign: T, flight: T) -> Option<T> {
    let zero = T::zero();
    // The slope is that of the parabola, up to a bound of all other terms.
    let mut higher_terms = zero;
    for (k, c) in y.iter().enumerate().skip(2).rev() {
        higher_terms = higher_terms * flight + c.abs() * T::whole(k);
    }
    let higher_terms = higher_terms * flight;
    let falls = sign * y[1];
    if !(falls > higher_terms) {
        return None;
    }
    if y.iter().rev().fold(zero, |gap, c| gap * flight - sign * *c) > zero {
        return None;
    }
    let gap = |t: T| {
        let (mut value, mut slope, mut bend) = (zero, zero, zero);
        for c in y.iter().rev() {
            bend = bend * t + slope;
            slope = slope * t + value;
            value = value * t - sign * *c;
        }
        (value, slope, bend)
    };
    let mut t = -(y[0] / y[1]);
    for _ in 0..MAX_STEPS {
        let (value, slope, bend) = gap(t);
        let newton = value / slope;
        let bend_share = newton * bend / slope;
        let change = newton + newton * bend_share;
        t -= change;
        if !(t > zero && t <= flight) {
            return None;
        }
        let close = T::of(T::ROUGH);
        if change.abs() <= t * close && bend_share.abs() <= close {
            // the remaining error is the third power of that
            return Some(T::at_root(t, |t| {
                let (value, slope, _) = gap(t);
                (value, slope)
            }));
        }
    }
    None
}
