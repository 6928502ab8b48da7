//! Advance of a motion by one step of flight or contact, or by one rest, within its budgets.

mod flight;

use crate::dynamics::drive::Drive;
use crate::dynamics::motion::Motion;
use crate::dynamics::result::Outcome;
use crate::dynamics::state::{Contact, Flow};
use crate::dynamics::step::work::IMPACT_BUDGET;
use crate::numeric::Scalar;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// The outcome if a budget is spent or the run is cancelled.
    #[inline]
    pub fn spent(&mut self) -> Flow {
        let cancelled = self.stepper.work.check_cancelled();
        let at = || self.stepper.seconds(&self.state);
        if cancelled {
            return Some(Outcome::Cancelled { at: at() });
        }
        if self.stepper.work.impacts >= IMPACT_BUDGET {
            return Some(Outcome::ImpactBudget { at: at(), count: self.stepper.work.impacts });
        }
        if self.stepper.work.is_done() {
            return Some(Outcome::StepBudget { at: at(), count: self.steps });
        }
        None
    }

    /// Advances by one step of flight or contact or one rest; `left` is the time to the end of the run.
    #[inline]
    pub fn proceed(&mut self, left: T) -> Flow {
        match self.state.contact {
            Contact::Motionless => {
                self.stand(self.stepper.end, self.state.phase());
                None
            }
            Contact::Resting(end) => {
                self.rest(end);
                None
            }
            Contact::Free => self.fly(left),
            Contact::Compressing(end) | Contact::Clipped(end) => self.contact_step(end, left),
        }
    }
}
