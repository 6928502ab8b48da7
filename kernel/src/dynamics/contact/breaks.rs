//! Transition from one piece of the force curve to the next.

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::End;
use crate::dynamics::motion::Motion;
use crate::dynamics::state::{BY_ACCELERATION, BY_SPEED, HELD, Touch};
use crate::numeric::Scalar;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// The mass passes the break at `end` of its mode.
    pub fn enter_neighbour(&mut self, end: End) {
        self.state.enter(end);
        self.state.touch = Some(Touch { end: end.other(), multiplicity: BY_SPEED });
    }

    /// The mass stands on the break at `end` of its mode with no speed. The first derivative of its
    /// motion that is not 0 (to the rounding of its terms) chooses the side; if all are 0, the mass stays
    /// on this side.
    pub fn balance(&mut self, end: End) {
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
        self.state.touch = Some(Touch { end, multiplicity: HELD });
        for (multiplicity, rate) in (BY_ACCELERATION..).zip(rates) {
            let size = if multiplicity == BY_ACCELERATION { rounding } else { T::zero() };
            if rate > size {
                self.enter_neighbour(end);
                self.state.touch = Some(Touch { end: end.other(), multiplicity });
                return;
            }
            if rate < -size {
                self.state.touch = Some(Touch { end, multiplicity });
                return;
            }
        }
    }
}
