//! State of a circuit along a step of free flight.

use super::settings::{RESIDUAL, ROUNDINGS};
use super::stepper::Stepper;
use crate::dynamics::drive::Drive;
use crate::dynamics::series::{natural_steps, polynomial};
use crate::numeric::{Scalar, fast_log2};

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
    /// Coefficients of the circuit's state that belong to those of the motion; `None` without a circuit.
    #[inline(always)]
    pub fn circuit_series(&self) -> Option<&[T]> {
        self.drive.circuit_state(&self.cursor).map(|state| &state[..self.series.known - 1])
    }

    /// The circuit's state at time `t` into the step.
    #[inline(always)]
    pub fn circuit_at(&self, t: T) -> Option<T> {
        self.circuit_series().map(|state| polynomial::value(state, t))
    }

    /// Effect of the circuit on a mass that moves little, as a stiffness over mass: the square of
    /// the coupling.
    #[inline(always)]
    pub fn circuit_stiffness(&self) -> Option<T> {
        self.drive.circuit().map(|circuit| circuit.coupling * circuit.coupling)
    }

    /// The longest step whose first neglected term in the circuit's state stays below the tolerance.
    #[inline(always)]
    pub fn circuit_step(&self) -> Option<f64> {
        let (circuit, state) = (self.drive.circuit()?, self.circuit_series()?);
        let (s, order) = (&self.settings, self.series.known - 1);
        // (as for the velocity, whose coefficient k - 1 is k times that of the displacement)
        let coefficient = |k: usize| [state[k - 1].magnitude() / k as f64];
        let scale = fast_log2(circuit.scale.to_f64());
        let [step] = natural_steps(order, coefficient, &[scale], s.tolerance_log2, &[s.longest]);
        Some(step)
    }

    /// Whether the polynomial of the state satisfies the circuit's equation at time `h` into the step, where
    /// the velocity is `v`, within tolerance and rounding.
    #[inline(always)]
    pub fn circuit_holds(&self, h: T, v: T) -> bool {
        let Some((circuit, state)) = self.drive.circuit().zip(self.circuit_series()) else { return true };
        let residual = polynomial::slope(state, h) + circuit.decay * polynomial::value(state, h);
        let residual = (residual - circuit.coupling * v).abs() * h;
        let allowed = T::of(RESIDUAL * state.len() as f64 * self.settings.tolerance) * circuit.scale;
        if residual <= allowed {
            return true;
        }
        // larger than permitted: it may be rounding
        let (mut size, mut power) = (T::zero(), T::of(1.0));
        for (k, c) in state.iter().enumerate() {
            size += c.abs() * power * (T::whole(k) + circuit.decay * h);
            power = power * h;
        }
        let size = size + (circuit.coupling * v * h).abs();
        residual <= size * T::of(T::EPSILON * ROUNDINGS)
    }
}
