//! Recording of a circuit's state: the integral of its square, and its samples.

use super::recorder::Recorder;
use crate::dynamics::clock::Instant;
use crate::dynamics::drive::circuit::Circuit;
use crate::dynamics::series::polynomial;
use crate::dynamics::step::path::{Path, StepView};
use crate::numeric::{GaussLegendre, Scalar, decay};

impl<T: Scalar> Recorder<'_, T> {
    /// The electrical state of a sample in A or V.
    pub(crate) fn electrical(&self, state: T) -> f64 {
        self.model.circuit().map_or(0.0, |circuit| circuit.amount * state.to_f64() / self.unit)
    }

    /// Records the circuit's state over a step, if there is a circuit.
    #[inline(always)]
    pub(crate) fn circuit<P: Path<T>>(
        &mut self,
        step: &StepView<T, P>,
        rule: &GaussLegendre<T>,
        overlap: Option<(T, T)>,
    ) {
        let Some(state) = step.circuit else { return };
        let whole = || polynomial::squared(state, rule, T::zero(), step.length);
        if self.ledger {
            self.whole.circuit.add(whole());
        }
        if let Some((from, to)) = overlap {
            self.settled.circuit.add(polynomial::squared(state, rule, from, to));
        }
    }

    /// Records the circuit's state, which begins at `state`, while the mass stands still. The samples from
    /// index `first` on belong to that time.
    pub(crate) fn circuit_decays(
        &mut self,
        circuit: &Circuit<T>,
        (at, until): (&Instant<T>, &Instant<T>),
        state: T,
        first: usize,
    ) {
        let length = self.clock.between(at, until);
        let rate = circuit.decay + circuit.decay;
        let squared = |from: T, to: T| {
            let begin = state * decay(circuit.decay * from).0;
            begin * begin * (to - from) * decay(rate * (to - from)).1
        };
        if self.ledger {
            self.whole.circuit.add(squared(T::zero(), length));
        }
        if let Some((from, to)) = self.overlap(at, length) {
            self.settled.circuit.add(squared(from, to));
        }
        for i in first..self.samples.len() {
            let into = self.clock.between(at, &self.clock.at(self.samples[i].t)).larger(T::zero());
            self.samples[i].electrical = self.electrical(state * decay(circuit.decay * into).0);
        }
    }
}
