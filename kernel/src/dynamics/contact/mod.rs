//! Events at the ends of a mode: a stop, a break, the end of the known curve.

mod breaks;
mod compliant;
mod rest;
mod rigid;

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{End, EndKind, FAR};
use crate::dynamics::motion::Motion;
use crate::dynamics::result::Outcome;
use crate::dynamics::state::{BY_ACCELERATION, BY_SPEED, Contact, Flow, HELD, Touch};
use crate::numeric::Scalar;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Starts the motion: a mass that begins on a surface rests, strikes, leaves or passes it.
    pub fn place_at_start(&mut self) {
        if self.stepper.equation.compliant.is_some() && self.start_inside_a_stop() {
            return;
        }
        if self.state.contact != Contact::Free {
            return;
        }
        let mode = self.stepper.mode(&self.state);
        for end in [End::Low, End::High] {
            let (level, kind) = mode.end(end);
            if self.state.x != level || kind == EndKind::Unknown {
                continue;
            }
            let outward = end.sign::<T>() * self.state.v;
            if kind == EndKind::Compliant {
                self.meet(end, outward);
            } else if kind == EndKind::Stop {
                if outward > T::zero() {
                    self.strike(end, outward);
                } else if outward < T::zero() {
                    self.state.touch = Some(Touch { end, multiplicity: BY_SPEED });
                } else {
                    self.settle(end);
                }
            } else if outward > T::zero() {
                self.enter_neighbour(end);
            } else if outward < T::zero() {
                self.state.touch = Some(Touch { end, multiplicity: BY_SPEED });
            } else {
                self.balance(end);
            }
            return;
        }
    }

    /// The mass has reached an end of its mode. `at_once`: the step began at that end and led outward.
    pub fn reach(&mut self, end: End, at_once: bool) -> Flow {
        let outward = end.sign::<T>() * self.state.v;
        let (level, kind) = self.stepper.mode(&self.state).end(end);
        match kind {
            EndKind::Stop if outward > T::zero() => self.strike(end, outward),
            EndKind::Stop if at_once => {
                // It was released where the contact acceleration is 0 to rounding, and does not leave, so the
                // rest goes on.
                self.state.refused = Some(self.state.at);
                self.state.v = T::zero();
                self.begin_rest(end);
            }
            EndKind::Stop => self.settle(end), // a touch without speed is no impact
            EndKind::Compliant if outward > T::zero() || at_once => self.enter_stop(end, outward),
            EndKind::Compliant => self.meet(end, outward),
            EndKind::Break if outward > T::zero() => self.enter_neighbour(end),
            EndKind::Break => {
                // A touch of the break. If rounding makes both sides lead out, the mass stays on this side.
                self.state.v = T::zero();
                if !at_once {
                    self.balance(end);
                } else if self.state.turned_back {
                    self.state.touch = Some(Touch { end, multiplicity: HELD });
                } else {
                    self.state.turned_back = true;
                    self.enter_neighbour(end);
                    self.state.touch = Some(Touch { end: end.other(), multiplicity: BY_ACCELERATION });
                }
            }
            EndKind::Unknown if level.abs() >= T::of(FAR) => {
                return Some(Outcome::NotFinite { at: self.stepper.seconds(&self.state) });
            }
            EndKind::Unknown => return Some(Outcome::LeftTable { at: self.stepper.seconds(&self.state) }),
        }
        None
    }
}
