//! Goal of a pursued motion: the motion, region or event that ends the pursuit.

use super::regime::Classifier;
use crate::dynamics::result::{Arrival, Capture, MapState, Pursuit, ReleaseIdentity, Trail};

/// Number of stroboscopic states, beyond two periods of the motion, that must also repeat.
const CONFIRMING_STATES: u64 = 12;

#[derive(Debug)]
pub(crate) struct Goal<'a> {
    pursuit: Pursuit<'a>,
    /// What ended the pursuit, and the number of the first stroboscopic state after it.
    pub reached: Option<(Arrival, u64)>,
    /// The states so far, unless the pursuit is beside another one.
    pub trail: Trail,
}

impl<'a> Goal<'a> {
    pub fn new(pursuit: Pursuit<'a>) -> Self {
        Self { pursuit, reached: None, trail: Trail::new() }
    }

    /// Checks another stroboscopic state, which `classifier` already holds.
    pub fn strobe(&mut self, classifier: &Classifier, state: MapState) {
        if self.reached.is_some() {
            return;
        }
        let periods = classifier.strobes.seen - 1;
        let Pursuit { known, regions, repeats_from, beside, .. } = self.pursuit;
        match beside {
            // states of a mass at rest may have been skipped
            None => self.trail.resize(periods as usize + 1, rounded(state)),
            Some(beside) if beside.is_left(periods as usize, state) => {
                self.reached = Some((Arrival::Parted, periods));
                return;
            }
            Some(_) => {}
        }
        let is_reached = if beside.is_some() { Capture::holds } else { Capture::is_reached };
        let captured = known.iter().position(|known| is_reached(known, state)).map(Arrival::Captured);
        let entered = || regions.iter().position(|region| region.holds((state.x, state.v)));
        let repeats = || {
            let period = (periods >= repeats_from).then(|| classifier.strobes.repeats_for(CONFIRMING_STATES));
            period.flatten().map(|period| Arrival::Repeats { period, state })
        };
        let arrival = captured.or_else(|| entered().map(Arrival::Entered)).or_else(repeats);
        self.reached = arrival.map(|arrival| (arrival, periods));
    }

    /// A release. It ends the pursuit unless it is one of those to be skipped.
    pub fn release(&mut self, identity: ReleaseIdentity, periods: u64) {
        match self.pursuit.releases.checked_sub(1) {
            Some(left) => self.pursuit.releases = left,
            None => self.end(Arrival::Released(identity), periods),
        }
    }

    /// Ends the pursuit if it has not ended yet.
    pub fn end(&mut self, arrival: Arrival, periods: u64) {
        self.reached.get_or_insert((arrival, periods));
    }
}

fn rounded(MapState { x, v, electrical }: MapState) -> [f32; 3] {
    [x, v, electrical].map(|value| value as f32)
}
