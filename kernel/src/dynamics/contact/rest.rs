//! Rest on a rigid stop, and the release that ends it.

use super::first_rate;
use crate::dynamics::clock::Instant;
use crate::dynamics::drive::{ContactAcceleration, Drive, ReleaseRoot, Span};
use crate::dynamics::equation::End;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::events::Call;
use crate::dynamics::result::Phase;
use crate::dynamics::state::{Contact, Label, MotionState, Opening, Touch};
use crate::dynamics::step::stepper::Stepper;
use crate::numeric::{Scalar, decay};

/// Share of the clock's cycle by which the search for a release skips an instant at which the contact
/// acceleration only touched 0: well above the rounding of a double root, well below any relevant time.
const TOUCH_SKIP: f64 = 1e-6;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// The touch with which a mass that stands at the stop of `end` with no speed leaves it, or `None` if it
    /// is pressed onto the stop. The first nonzero one of the contact acceleration and its derivatives
    /// decides; if all are 0, the mass stays at the stop in free flight.
    pub fn leaves(&mut self, end: End) -> Option<Touch> {
        let rates = self.stepper.contact_acceleration(&self.state, end);
        let rounding = self.stepper.contact_acceleration_rounding(end);
        self.state.v = T::zero();
        match first_rate(rates, rounding) {
            Some((_, pressed)) if pressed => None,
            Some((opening, _)) => Some(Touch { end, opening }),
            None => Some(Touch { end, opening: Opening::Undecided }),
        }
    }

    /// The mass stands at the stop of `end` with no speed: it rests or leaves.
    pub fn settle(&mut self, end: End) {
        self.state.touch = self.leaves(end);
        if self.state.touch.is_some() {
            self.state.contact = Contact::Free;
        } else {
            self.begin_rest(end);
        }
    }

    pub fn begin_rest(&mut self, end: End) {
        self.state.contact = Contact::Resting(end);
        self.report(Call::Rest { at: self.state.at, side: end.side() });
    }

    /// The mass stands still until `until`.
    pub fn stand(&mut self, until: Instant<T>, phase: Phase) {
        let MotionState { at, x, v, circuit: state, .. } = self.state;
        let samples = self.record.samples.len();
        let drive = self.stepper.drive;
        let circuit = drive.circuit();
        self.record.standing_circuit = circuit.map(|circuit| (at, state, circuit.decay));
        self.report(Call::Stand { at, until, state: (x, v), phase });
        if let Some(circuit) = circuit {
            self.record.circuit_decays(circuit, (&at, &until), state, samples);
            let time = self.stepper.clock.between(&at, &until);
            self.state.circuit = state * decay(circuit.decay * time).0;
        }
        self.state.at = until;
    }

    /// A rest on the stop of `end`, up to its release, the end of the drive's segment, or the run's end.
    pub fn rest(&mut self, end: End) {
        let phase = self.state.phase();
        self.steps += 1;
        let until = self.stepper.segment_limit(&self.state);
        let mut from = self.state.at;
        if self.state.failed_release == Some(self.state.at) {
            // The contact acceleration only touched 0 here, to rounding: the search begins after this
            // instant.
            from = self.stepper.clock.advance(&from, self.stepper.clock.period * T::of(TOUCH_SKIP));
        }
        let threshold = self.stepper.equation.stop(end).map_or(T::zero(), |s| s.acceleration);
        let circuit = self.stepper.drive.circuit().map_or(T::zero(), |circuit| {
            let time = self.stepper.clock.between(&self.state.at, &from);
            self.state.circuit * decay(circuit.decay * time).0
        });
        let acceleration = ContactAcceleration { threshold, sign: end.sign::<T>(), circuit };
        let since = self.no_release_since.take().filter(|(segment, _)| *segment == self.state.segment);
        let since = since.map_or(from, |(_, since)| since);
        let span = Span { from, until, segment: self.state.segment, since };
        let Stepper { drive, cursor, .. } = &mut self.stepper;
        let (root, work) = drive.next_release(&span, acceleration, cursor);
        self.stepper.work.add(self.stepper.costs.check + work);
        match root {
            ReleaseRoot::At(root, turn) => {
                self.stand(root, phase);
                self.release(end, Opening::Jerk);
                self.label = turn.filter(|_| self.recurs).map(|turn| Label { end, turn, phase: root.phase });
            }
            ReleaseRoot::NotBefore(later) => {
                self.no_release_since = Some((self.state.segment, since));
                self.stand(later, phase);
            }
            ReleaseRoot::Never => {
                if until == self.stepper.end {
                    self.record.rests_forever(&self.state.at, end.side());
                }
                self.stand(until, phase);
                if self.stepper.pass_segment_end(&mut self.state) {
                    let acceleration = self.stepper.contact_acceleration(&self.state, end)[0];
                    if acceleration < -self.stepper.contact_acceleration_rounding(end) {
                        self.release(end, Opening::Acceleration);
                    }
                }
            }
        }
    }

    fn release(&mut self, end: End, opening: Opening) {
        self.report(Call::Release { at: self.state.at, side: end.side() });
        self.state.contact = Contact::Free;
        self.state.touch = Some(Touch { end, opening });
    }
}
