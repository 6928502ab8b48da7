//! Pursuit of a motion from a start of its own, until it is known what it goes to.

use super::ending::Begun;
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::drive::Drive;
use crate::dynamics::drive::form::{Form, clock, form};
use crate::dynamics::equation::{End, Equation};
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::barrier::side_of;
use crate::dynamics::record::goal::Goal;
use crate::dynamics::result::{Arrival, Outcome, Pursuit, Request};
use crate::dynamics::state::{Contact, MotionState};
use crate::numeric::Scalar;

impl<'a, T: Scalar, D: Drive<T>> Motion<'a, T, D, false> {
    /// Puts it at the start of a pursuit, whose end is its own. A release from rest ends it, so no recurrence
    /// completes it.
    pub fn pursuing(mut self, pursuit: &Pursuit<'a>, model: &Model) -> Self {
        let Self { stepper, record, state, .. } = &mut self;
        let (x, v) = (T::of(pursuit.start.0), T::of(pursuit.start.1 * stepper.equation.unit));
        let mode = stepper.equation.mode_at(x, model.mechanism.curve.piece_index(pursuit.start.0));
        *state = MotionState::new((x, v), mode, Contact::Free);
        record.barrier_side = record.barrier.map_or(0, |barrier| side_of(x, barrier));
        stepper.end = record.pursue(Goal::new(*pursuit), pursuit.most_periods);
        (self.recurs, self.until_settled) = (true, None);
        self
    }

    /// What it has come to.
    pub fn arrived(mut self, model: &Model, begun: &Begun<T>, outcome: Outcome) -> Arrival {
        let arrival = self.record.arrival().filter(|_| outcome == Outcome::Done);
        arrival.unwrap_or_else(|| Arrival::Unsettled(Box::new(self.finish(model, begun, outcome).summary)))
    }
}

impl<T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'_, T, D, LEDGER> {
    /// After a rebound that is pressed back with this acceleration: where it and those after it are sure to
    /// end in rest before the next stroboscopic state, those of a pursuit are passed over, since what comes
    /// later does not depend on them.
    ///
    /// As long as the acceleration towards the stop stays between a and b, a flight from the speed v takes 2
    /// v / a at most, goes v^2 / (2 a) far and is followed by one from q v at most, q = e (b / a)^(1/2): all
    /// of them take no longer than 2 v / (a (1 - q)). Bounds of a and b over twice the time that they would
    /// take if nothing changed are known from the drive at its ends and its second derivative, and from what
    /// force and damping change where a is half as much as now at least, and b four times a at most.
    pub fn will_rest(&mut self, end: End, acceleration: T) -> bool {
        let Self { stepper, record, state, .. } = &self;
        let (Some(_), Some(stop), Some(bend), Some(strobe)) =
            (&record.goal, stepper.equation.stop(end), stepper.drive.bend(), &record.next_strobe)
        else {
            return false;
        };
        let (zero, one, two, speed) = (T::zero(), T::of(1.0), T::of(2.0), state.v.abs());
        let whole = T::of(4.0) * speed / (acceleration * (one - stop.restitution));
        let until = stepper.clock.advance(&state.at, whole);
        let before = |border: &Instant<T>| stepper.clock.between(&until, border) > zero;
        if !before(strobe) || !before(&stepper.segment_limit(state)) || record.in_window(&state.at) {
            return false;
        }
        let mode = stepper.mode(state);
        let (level, other) = (mode.end(end).0, mode.end(end.other()).0);
        let height = speed * speed / acceleration;
        let push = mode.force.steepest((level - mode.origin).abs() + height) * height;
        let drag = stepper.equation.damping * two * speed;
        let base = stepper.drive.acceleration(&stepper.clock, &until, state.segment);
        let last = stop.acceleration - end.sign::<T>() * base;
        let aside = bend * whole * whole * T::of(0.125) + push;
        let low = acceleration.smaller(last) - (aside + drag);
        let high = acceleration.larger(last) + aside;
        let slower = one - stop.restitution * (high / low).sqrt();
        let rests = height < (level - other).abs()
            && low > T::of(0.5) * acceleration
            && high < T::of(4.0) * low
            && two * speed < low * slower * whole;
        if rests {
            self.rest_after(until, end);
        }
        rests
    }
}

/// Pursues a motion alone.
pub(crate) fn pursue_alone(model: &Model, pursuit: &Pursuit, request: &Request) -> Arrival {
    let unit = model.scales.unit();
    let (equation, clock) = (Equation::new(model, unit), clock(model, unit));
    match form(model, &clock) {
        Form::Still(drive) => with_drive(model, pursuit, request, &equation, clock, &drive),
        Form::Sine(drive) => with_drive(model, pursuit, request, &equation, clock, &drive),
        Form::Composite(drive) => with_drive(model, pursuit, request, &equation, clock, &drive),
        Form::Coupled(drive) => with_drive(model, pursuit, request, &equation, clock, &drive),
    }
}

fn with_drive<D: Drive<f64>>(
    model: &Model,
    pursuit: &Pursuit,
    request: &Request,
    equation: &Equation<f64>,
    clock: Clock<f64>,
    drive: &D,
) -> Arrival {
    let motion = Motion::<f64, D, false>::new(model, request, model.tolerance, equation, clock, drive);
    let mut motion = motion.pursuing(pursuit, model);
    let begun = motion.begin(model);
    let outcome = motion.go_on();
    motion.arrived(model, &begun, outcome)
}
