//! Impacts on a rigid stop, and the closed-form sum of the rest of a chatter.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::End;
use crate::dynamics::model::scales::MIN_IMPACT;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::events::Call;
use crate::dynamics::result::Phase;
use crate::dynamics::state::{Opening, Touch};
use crate::numeric::Scalar;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// The mass reaches the stop of `end` with outward speed `speed` > 0.
    pub fn strike(&mut self, end: End, speed: T) {
        let sign = end.sign::<T>();
        let rebound = self.stepper.equation.stop(end).map_or(speed, |stop| stop.restitution * speed);
        self.stepper.work.impacts += 1;
        // 0 - keeps a rebound of 0 from being -0
        let (v_in, v_out) = (sign * speed, T::zero() - sign * rebound);
        self.report(Call::Impact { at: self.state.at, side: end.side(), v_in, v_out });
        if rebound > T::zero() {
            self.state.v = -(sign * rebound);
            self.state.touch = Some(Touch { end, opening: Opening::Speed });
        } else {
            self.settle(end);
        }
    }

    /// After a slow rebound that is pressed back to the stop: sums the rest of the chatter in closed form.
    /// Expects the drive to be seeded.
    ///
    /// The sum of the flight times is S (1 - (2 j/a + g) S/6) + O(S^3), S = 2 v/(a (1 - e)), a the contact
    /// acceleration, j its rate, g = c/m. It is used if its error is below the tolerance and the contact
    /// acceleration keeps its sign until the end of the chatter.
    pub fn sum_chatter(&mut self, end: End, rates: [T; 3]) -> bool {
        let Some(stop) = self.stepper.equation.stop(end) else { return false };
        let one = T::of(1.0);
        let speed = self.state.v.abs();
        let [acceleration, jerk, snap] = rates;
        if !(acceleration > T::zero()
            && stop.restitution < one
            && speed < self.stepper.settings.speed * T::of(MIN_IMPACT))
        {
            return false;
        }
        let damping = self.stepper.equation.damping;
        let whole = T::of(2.0) * speed / (acceleration * (one - stop.restitution));
        let squares = (jerk.abs() / acceleration) * (jerk.abs() / acceleration)
            + damping * damping
            + stop.stiffness.abs()
            + snap.abs() / acceleration;
        let squares = self.stepper.circuit_stiffness().map_or(squares, |stiffness| squares + stiffness);
        let change = whole * whole * squares;
        if change > T::of(2.5e-3) || whole * change > T::of(0.1 * self.stepper.settings.tolerance) {
            return false;
        }
        let sum = whole * (one - (T::of(2.0) * jerk / acceleration + damping) * whole / T::of(6.0));
        let until = self.stepper.clock.advance(&self.state.at, sum);
        let limit = self.stepper.segment_limit(&self.state);
        if self.stepper.clock.between(&until, &limit) <= T::zero() {
            return false;
        }
        self.report(Call::Chatter { at: self.state.at, v: speed });
        self.rest_after(until, end);
        true
    }

    /// After a rebound that is pressed back with this acceleration, in a pursuit: if this rebound and those
    /// after it are certain to end in rest before the next stroboscopic state, they are skipped, since the
    /// later motion does not depend on them. Returns whether they were skipped.
    ///
    /// As long as the acceleration towards the stop stays between a and b, a flight that starts at speed v
    /// takes at most 2 v / a, reaches at most v^2 / (2 a), and is followed by one that starts at no more than
    /// q v, where q = e (b / a)^(1/2). All flights together take at most 2 v / (a (1 - q)). The bounds a and
    /// b hold over twice the time that the flights would take at constant acceleration. They follow from the
    /// drive at both ends of that time and its second derivative, and from the change of force and damping if
    /// a is at least half the present acceleration and b at most 4 a.
    pub fn will_rest(&mut self, end: End, acceleration: T) -> bool {
        let Self { stepper, record, state, .. } = &self;
        let (Some(_), Some(stop), Some(bend), Some(strobe)) = (
            &record.goal,
            stepper.equation.stop(end),
            stepper.drive.second_derivative_bound(),
            &record.next_strobe,
        ) else {
            return false;
        };
        let (one, two, speed) = (T::of(1.0), T::of(2.0), state.v.abs());
        let whole = T::of(4.0) * speed / (acceleration * (one - stop.restitution));
        let before = |border: &Instant<T>| whole < stepper.clock.between(&state.at, border);
        if !before(strobe) || !before(&stepper.segment_limit(state)) || record.in_window(&state.at) {
            return false;
        }
        let until = stepper.clock.advance(&state.at, whole);
        let mode = stepper.mode(state);
        let (level, other) = (mode.end(end).0, mode.end(end.other()).0);
        let height = speed * speed / acceleration;
        let push = mode.force.steepest((level - mode.origin).abs() + height) * height;
        let drag = stepper.equation.damping * two * speed;
        let base = stepper.drive.acceleration(&until, state.segment);
        let last = stop.acceleration - end.sign::<T>() * base;
        let variation = bend * whole * whole * T::of(0.125) + push;
        let low = acceleration.smaller(last) - (variation + drag);
        let high = acceleration.larger(last) + variation;
        let reduction = one - stop.restitution * (high / low).sqrt();
        let rests = height < (level - other).abs()
            && low > T::of(0.5) * acceleration
            && high < T::of(4.0) * low
            && two * speed < low * reduction * whole;
        if rests {
            self.rest_after(until, end);
        }
        rests
    }

    /// The mass, whose last flight ends at `until`, is at rest from then on.
    pub fn rest_after(&mut self, until: Instant<T>, end: End) {
        self.stand(until, Phase::Free);
        self.state.v = T::zero();
        self.steps += 1;
        self.stepper.work.add(self.stepper.costs.check);
        self.state.touch = None;
        self.begin_rest(end);
    }
}
