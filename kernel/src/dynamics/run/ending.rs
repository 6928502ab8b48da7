//! Start and end of a run.

use super::balance::{Excursion, checked_outcome};
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::summary::Ending;
use crate::dynamics::result::{Outcome, Run};
use crate::dynamics::state::MotionState;
use crate::numeric::Scalar;

/// The first instant of a run.
pub(crate) struct Initial<T> {
    v: T,
    circuit: T,
    mode: usize,
    /// Displacement in m.
    x: f64,
    /// Energy in J stored in a compliant stop.
    stop_energy: f64,
}

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Starts the motion.
    pub fn begin(&mut self, model: &Model) -> Initial<T> {
        let MotionState { v, circuit, .. } = self.state;
        self.place_at_start();
        let stop_energy = stop_energy(model, self.stepper.equation, &self.state);
        Initial { v, circuit, mode: self.state.mode, x: self.state.x.to_f64(), stop_energy }
    }

    /// Closes the record.
    pub fn finish(self, model: &Model, start: &Initial<T>, outcome: Outcome) -> Run {
        let Self { stepper, state, record, steps, .. } = self;
        let (low, high) = record.places;
        let speed = (2.0 * record.peak_kinetic).sqrt() / stepper.equation.unit;
        let mut run = record.finish(&Ending {
            at: state.at,
            state: (state.x, state.v),
            start_v: start.v,
            circuit: (start.circuit, state.circuit),
            phase: state.phase(),
            segment: state.segment,
            potential: potential_change(model, stepper.equation, start, &state),
            outcome,
        });
        run.summary.steps = steps;
        run.summary.evaluations = stepper.evaluations;
        run.summary.outcome = checked_outcome(model, &run, Excursion { low, high, speed });
        run
    }
}

/// Change in J of the potential and of the energy in a compliant stop since the start.
fn potential_change<T: Scalar>(
    model: &Model,
    equation: &Equation<T>,
    start: &Initial<T>,
    state: &MotionState<T>,
) -> f64 {
    let piece = |mode: usize| &model.mechanism.curve.pieces()[equation.modes[mode].piece];
    let (first, last, x) = (piece(start.mode), piece(state.mode), state.x.to_f64());
    let change = match std::ptr::eq(first, last) {
        true => first.potential_change(start.x, x),
        false => last.potential(x) - first.potential(start.x),
    };
    change + (stop_energy(model, equation, state) - start.stop_energy)
}

/// Energy in J that the pressed compliant stop stores.
fn stop_energy<T: Scalar>(model: &Model, equation: &Equation<T>, state: &MotionState<T>) -> f64 {
    let Some(stop) = &equation.compliant else { return 0.0 };
    stop.stored(state.depth.root).to_f64() * model.mass / (equation.unit * equation.unit)
}
