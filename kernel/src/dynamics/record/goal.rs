//! Goal of a pursued motion: the motion, region or event that ends the pursuit.

use super::regime::Classifier;
use crate::dynamics::result::{Arrival, MapState, Pursuit};

/// Number of stroboscopic states, beyond two periods of the motion, that must also repeat.
const CONFIRMING_STATES: u64 = 12;

#[derive(Debug)]
pub(crate) struct Goal<'a> {
    pursuit: Pursuit<'a>,
    pub reached: Option<Arrival>,
}

impl<'a> Goal<'a> {
    pub fn new(pursuit: Pursuit<'a>) -> Self {
        Self { pursuit, reached: None }
    }

    /// Checks another stroboscopic state, which `classifier` already holds.
    pub fn strobe(&mut self, classifier: &Classifier, state: MapState) {
        if self.reached.is_some() {
            return;
        }
        let periods = classifier.strobes.seen - 1;
        if let Some(which) = self.pursuit.known.iter().position(|known| known.is_reached(state)) {
            self.reached = Some(Arrival::Captured { which, periods });
        } else if let Some(which) =
            self.pursuit.regions.iter().position(|region| region.holds((state.x, state.v)))
        {
            self.reached = Some(Arrival::Entered { which, periods });
        } else if periods >= self.pursuit.repeats_from {
            let period = classifier.strobes.repeats_for(CONFIRMING_STATES);
            self.reached = period.map(|period| Arrival::Repeats { period, state, periods });
        }
    }

    /// A release. It ends the pursuit unless it is one of those to be skipped.
    pub fn release(&mut self, arrival: Arrival) {
        match self.pursuit.releases.checked_sub(1) {
            Some(left) => self.pursuit.releases = left,
            None => self.end(arrival),
        }
    }

    /// Ends the pursuit if it has not ended yet.
    pub fn end(&mut self, arrival: Arrival) {
        self.reached.get_or_insert(arrival);
    }
}
