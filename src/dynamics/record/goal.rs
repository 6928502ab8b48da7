//! Goal of a motion that is pursued: what it is found to go to.

use super::recorder::Recorder;
use super::regime::Judge;
use crate::dynamics::clock::Instant;
use crate::dynamics::result::{Arrival, Pursuit, ReleaseIdentity, Side};
use crate::numeric::Scalar;

/// Stroboscopic states beyond two periods of a motion that must have come back.
const MORE: u64 = 12;

/// What a motion is pursued to, and what it has reached.
#[derive(Debug)]
pub(crate) struct Goal<'a> {
    pursuit: Pursuit<'a>,
    reached: Option<Arrival>,
}

impl<'a> Goal<'a> {
    pub fn new(pursuit: Pursuit<'a>) -> Self {
        Self { pursuit, reached: None }
    }

    /// Another stroboscopic state, which `judge` has been told.
    pub fn strobe(&mut self, judge: &Judge, state: (f64, f64)) {
        if self.reached.is_some() {
            return;
        }
        let periods = judge.strobes().seen() - 1;
        if let Some(which) = self.pursuit.known.iter().position(|own| own.is_reached(state)) {
            self.reached = Some(Arrival::Captured { which, periods });
        } else if let Some(which) = self.pursuit.regions.iter().position(|own| own.holds(state)) {
            self.reached = Some(Arrival::Entered { which, periods });
        } else if periods >= self.pursuit.repeats_from {
            let period = judge.strobes().repeats_for(MORE);
            self.reached = period.map(|period| Arrival::Repeats { period, state, periods });
        }
    }
}

impl<T: Scalar, const LEDGER: bool> Recorder<'_, T, LEDGER> {
    /// Whether the motion has reached what it was pursued to.
    #[inline]
    pub fn has_arrived(&self) -> bool {
        self.goal.as_ref().is_some_and(|goal| goal.reached.is_some())
    }

    /// What it has reached.
    pub fn arrival(&mut self) -> Option<Arrival> {
        self.goal.as_mut().and_then(|goal| goal.reached.take())
    }

    /// The mass was released with this identity; whether that is what was looked for.
    pub fn released(&mut self, at: &Instant<T>, identity: ReleaseIdentity) -> bool {
        let periods = self.periods_until(at);
        let Some(goal) = &mut self.goal else { return false };
        match goal.pursuit.releases.checked_sub(1) {
            Some(left) => goal.pursuit.releases = left,
            None => goal.reached = goal.reached.take().or(Some(Arrival::Released { identity, periods })),
        }
        true
    }

    /// The mass rests from `at` on, and will not be released.
    pub fn rests_forever(&mut self, at: &Instant<T>, side: Side) {
        let periods = self.periods_until(at);
        if let Some(goal) = &mut self.goal {
            goal.reached.get_or_insert(Arrival::Rests { side, periods });
        }
    }

    /// The number of the first stroboscopic state from `at` on.
    fn periods_until(&self, at: &Instant<T>) -> u64 {
        self.in_periods(at).ceil().max(0.0) as u64
    }
}
