//! Events at the ends of a mode: a stop, a break, the end of the known curve.

mod compliant;
mod rest;
mod rigid;

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{End, EndKind, FAR};
use crate::dynamics::motion::Motion;
use crate::dynamics::result::Outcome;
use crate::dynamics::state::{Contact, Flow, Opening, Touch};
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
            match kind {
                EndKind::Compliant => self.meet(end, outward),
                _ if outward < T::zero() => {
                    self.state.touch = Some(Touch { end, opening: Opening::Speed });
                }
                EndKind::Stop if outward > T::zero() => self.strike(end, outward),
                EndKind::Stop => self.settle(end),
                _ if outward > T::zero() => self.enter_neighbour(end),
                _ => self.balance(end),
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
                // It was released where the contact acceleration is 0 to rounding, and does not leave: it
                // stays at rest.
                self.state.failed_release = Some(self.state.at);
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
                    self.state.touch = Some(Touch { end, opening: Opening::Ignored });
                } else {
                    self.state.turned_back = true;
                    self.enter_neighbour(end);
                    self.state.touch = Some(Touch { end: end.other(), opening: Opening::Acceleration });
                }
            }
            EndKind::Unknown if level.abs() >= T::of(FAR) => {
                return Some(Outcome::NotFinite { at: self.stepper.seconds(&self.state) });
            }
            EndKind::Unknown => return Some(Outcome::LeftTable { at: self.stepper.seconds(&self.state) }),
        }
        None
    }

    /// The mass passes the break at `end` of its mode.
    pub fn enter_neighbour(&mut self, end: End) {
        self.state.enter(end);
        self.state.touch = Some(Touch { end: end.other(), opening: Opening::Speed });
    }

    /// The mass stands on the break at `end` of its mode with no speed. The first derivative of its
    /// motion that is not 0 chooses the side; if all are 0, the mass stays on this side.
    fn balance(&mut self, end: End) {
        let sign = end.sign::<T>();
        let mode = self.stepper.mode(&self.state);
        let (force, _, rounding) = mode.force.value(mode.end(end).0 - mode.origin);
        self.stepper.seed(&self.state);
        let a = &self.stepper.series.a;
        let rates = [-(sign * (force + a[0])), -(sign * a[1]), -(sign * a[2])];
        let rounding = rounding + a[0].abs() * T::of(4.0 * T::EPSILON);
        let (rates, rounding) = match self.stepper.circuit_push() {
            Some(push) => {
                let by_circuit = [push[0], push[1], push[2] * T::of(0.5)];
                let size = push[0].abs() * T::of(4.0 * T::EPSILON);
                (std::array::from_fn(|i| rates[i] - sign * by_circuit[i]), rounding + size)
            }
            None => (rates, rounding),
        };
        self.state.v += T::zero(); // makes a 0 of -0
        let (end, opening) = match first_rate(rates, rounding) {
            Some((opening, outward)) if outward => {
                self.state.enter(end);
                (end.other(), opening)
            }
            Some((opening, _)) => (end, opening),
            None => (end, Opening::Ignored),
        };
        self.state.touch = Some(Touch { end, opening });
    }
}

/// The first nonzero one of an acceleration (known to `rounding`) and its first two derivatives, and whether
/// it is positive.
fn first_rate<T: Scalar>(rates: [T; 3], rounding: T) -> Option<(Opening, bool)> {
    let openings = [Opening::Acceleration, Opening::Jerk, Opening::Snap];
    let sizes = [rounding, T::zero(), T::zero()];
    openings
        .into_iter()
        .zip(rates)
        .zip(sizes)
        .find_map(|((opening, rate), size)| (rate > size || rate < -size).then_some((opening, rate > size)))
}
