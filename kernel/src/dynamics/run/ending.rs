//! Start and end of a run.

use super::balance::{Excursion, checked_outcome};
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::Compliant;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::summary::Ending;
use crate::dynamics::result::{Outcome, Run};
use crate::dynamics::state::MotionState;
use crate::numeric::Scalar;

/// The first instant of a run.
pub(crate) struct Initial<T> {
    /// Velocity.
    v: T,
    /// State of the circuit.
    circuit: T,
    /// Mode, displacement in m, and energy in J stored in a compliant stop.
    place: (usize, f64, f64),
}

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Starts the motion.
    pub fn begin(&mut self, model: &Model) -> Initial<T> {
        let MotionState { v, circuit, .. } = self.state;
        self.place_at_start();
        Initial { v, circuit, place: (self.state.mode, self.state.x.to_f64(), self.stop_energy_j(model)) }
    }

    /// Closes the record.
    pub fn finish(self, model: &Model, start: &Initial<T>, outcome: Outcome) -> Run {
        let phase = self.state.phase();
        let (start_v, potential) = (start.v, self.potential_since(model, start.place));
        let unit = self.stepper.equation.unit;
        let (low, high) = self.record.places;
        let reach = Excursion { low, high, speed: (2.0 * self.record.peak_kinetic).sqrt() / unit };
        let mut run = self.record.finish(&Ending {
            at: self.state.at,
            state: (self.state.x, self.state.v),
            start_v,
            circuit: (start.circuit, self.state.circuit),
            phase,
            segment: self.state.segment,
            potential,
            outcome,
        });
        run.summary.steps = self.steps;
        run.summary.evaluations = self.stepper.evaluations;
        run.summary.outcome = checked_outcome(model, &run, reach);
        run
    }

    /// Change in J of the potential and of the energy in a compliant stop, since a start in a mode at
    /// a place.
    fn potential_since(&self, model: &Model, (mode, from, stored): (usize, f64, f64)) -> f64 {
        let piece = |mode: usize| &model.mechanism.curve.pieces()[self.stepper.equation.modes[mode].piece];
        let (first, last, x) = (piece(mode), piece(self.state.mode), self.state.x.to_f64());
        let change = match std::ptr::eq(first, last) {
            true => first.potential_change(from, x),
            false => last.potential(x) - first.potential(from),
        };
        change + (self.stop_energy_j(model) - stored)
    }

    /// Energy in J that the pressed compliant stop stores.
    fn stop_energy_j(&self, model: &Model) -> f64 {
        let unit = self.stepper.equation.unit;
        let stored =
            |stop: &Compliant<T>| stop.stored(self.state.depth.root).to_f64() * model.mass / (unit * unit);
        self.stepper.equation.compliant.as_ref().map_or(0.0, stored)
    }
}
