//! Pursuit of a motion from a given start, until it is known what it goes to.

use super::ending::Initial;
use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::drive::form::{clock, form, with_drive};
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::goal::Goal;
use crate::dynamics::result::{Arrival, Outcome, Pursued, Pursuit, Request};
use crate::numeric::Scalar;

impl<'a, T: Scalar, D: Drive<T>> Motion<'a, T, D> {
    /// Puts the motion at the start of a pursuit and sets the end of the pursuit. A release from rest ends
    /// it, so it is never completed from a recurrence.
    pub fn pursuing(mut self, pursuit: &Pursuit<'a>) -> Self {
        let start = (T::of(pursuit.start.0), T::of(pursuit.start.1 * self.stepper.equation.unit));
        self.put(start, Instant { cycle: 0, phase: T::zero() });
        self.stepper.work.limit(pursuit.most_work);
        self.stepper.end = self.record.pursue(Goal::new(*pursuit), pursuit.most_periods);
        (self.recurs, self.until_settled) = (true, None);
        self
    }

    /// Result of the pursuit.
    pub fn arrived(mut self, model: &Model, start: &Initial<T>, outcome: Outcome) -> Pursued {
        let (crossings, work) = (self.record.counts.total_crossings, self.stepper.work.done());
        let arrival = self.record.arrival().filter(|_| outcome == Outcome::Done);
        let unsettled = || Arrival::Unsettled(Box::new(self.finish(model, start, outcome).summary));
        Pursued { arrival: arrival.unwrap_or_else(unsettled), crossings, work }
    }
}

/// Pursues a motion alone.
pub(crate) fn pursue_alone(model: &Model, pursuit: &Pursuit, request: &Request) -> Pursued {
    let unit = model.scales.unit();
    let (equation, clock) = (Equation::<f64>::new(model, unit), clock(model, unit));
    with_drive!(&form(model, &clock), drive => {
        let motion = Motion::new(model, request, model.tolerance, &equation, clock, drive);
        let mut motion = motion.pursuing(pursuit);
        let start = motion.begin(model);
        let outcome = motion.go_on();
        motion.arrived(model, &start, outcome)
    })
}
