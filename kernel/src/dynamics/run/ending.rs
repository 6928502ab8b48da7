//! Start and end of a run, and the check whether its numbers are finite and its energy balances.
//!
//! The terms of a ledger are integrated separately, so their sum closes to the tolerance. If it is off by
//! more than that and the rounding of its terms, the computed motion is wrong and the outcome says so. For a
//! run without a ledger (a cell of a sweep) only the numbers are checked to be finite.

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::summary::MAX_ROUNDING;
use crate::dynamics::result::{Ledger, Outcome, Run};
use crate::dynamics::state::{MotionState, Start};
use crate::numeric::Scalar;

/// Permitted residual of a ledger, in tolerances. The largest in tens of thousands of random scenes was 4.
const TOLERANCES: f64 = 100.0;

/// Tolerance below which the residual of a ledger is rounding.
const MIN_TOLERANCE: f64 = 1e-13;
/// Number of roundings of force and displacement that add up in a ledger.
const FORCE_ROUNDINGS: f64 = 16.0;

/// Steps whose errors add up to no more than the tolerance. The errors of an undamped mass between elastic
/// stops all have one sign.
const STEPS_WITHIN_TOLERANCE: f64 = 1000.0;

/// Share of the energy moved that may be missing in a motion so small that the tolerance, which is relative
/// to the scene's scales, does not limit the error further.
const MAX_MISSING_SHARE: f64 = 0.1;

/// Ratio of coupling to the motion's rate above which a circuit nearly locks the mass. The small motion that
/// is left must balance its energy even if it is below the rounding of displacement and force.
const STRONG_COUPLING: f64 = 1e3;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Starts the motion.
    pub fn begin(&mut self) {
        let MotionState { v, circuit, .. } = self.state;
        self.place_at_start();
        let stop_energy = stop_energy(self.record.model, self.stepper.equation, &self.state);
        self.start = Start { v, circuit, mode: self.state.mode, x: self.state.x.to_f64(), stop_energy };
    }

    /// Closes the record.
    pub fn finish(mut self, outcome: Outcome) -> Run {
        self.record.last_strobe(&self.state);
        if outcome == Outcome::Done {
            self.judge();
        }
        let Self { stepper, state, record, steps, start, .. } = self;
        let (model, step_range) = (record.model, record.step_range);
        let speed = (2.0 * record.peak_kinetic).sqrt() / stepper.equation.unit;
        let potential = potential_change(model, stepper.equation, &start, &state);
        let mut run = record.finish(&state, &start, potential, outcome);
        run.summary.steps = steps;
        run.summary.evaluations = stepper.evaluations;
        run.summary.outcome = checked_outcome(model, &run, step_range, speed);
        run
    }
}

/// Change in J of the potential and of the energy in a compliant stop since the start.
fn potential_change<T: Scalar>(
    model: &Model,
    equation: &Equation<T>,
    start: &Start<T>,
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

/// The outcome of a run after the check; `step_range` is the range of the motion in m, `speed` its largest in
/// m/s.
fn checked_outcome(model: &Model, run: &Run, step_range: (f64, f64), speed: f64) -> Outcome {
    let summary = &run.summary;
    if summary.outcome != Outcome::Done {
        return summary.outcome;
    }
    let samples = || run.samples.iter().all(|sample| sample.x.is_finite() && sample.v.is_finite());
    let numbers = [summary.final_x, summary.final_v, summary.travel().unwrap_or(0.0)];
    let averaged = summary.travel().is_none() || summary.rms_velocity.is_some();
    let ledger = summary.ledger.unwrap_or_default();
    let Ledger { work_j, damping_j, impact_j, stored_j, residual_j, energy_residual, .. } = ledger;
    let electrical = [ledger.harvested_j, ledger.coil_j].map(Option::unwrap_or_default);
    let energies =
        [work_j, damping_j, impact_j, stored_j, residual_j, energy_residual, electrical[0], electrical[1]];
    if !(averaged && numbers.into_iter().chain(energies).all(f64::is_finite) && samples()) {
        return Outcome::NotFinite { at: model.duration };
    }
    let moved = residual_j.abs() / energy_residual;
    let strong =
        model.circuit().is_some_and(|circuit| circuit.coupling.abs() * model.scales.time > STRONG_COUPLING);
    if strong && residual_j.abs() > MAX_MISSING_SHARE * moved {
        return Outcome::Inaccurate { residual: energy_residual };
    }
    let missing = residual_j.abs() - rounding(model, step_range, summary.steps);
    if !(missing > 0.0) {
        return Outcome::Done;
    }
    let many = (summary.steps as f64 / STEPS_WITHIN_TOLERANCE).max(1.0);
    let allowed = TOLERANCES * model.tolerance.max(MIN_TOLERANCE) * many;
    let by_tolerance = allowed * (moved + model.mass * model.scales.speed * speed);
    let moves = step_range.1 - step_range.0 > MAX_ROUNDING * model.scales.length;
    match missing > by_tolerance || (moves && missing > MAX_MISSING_SHARE * moved) {
        true => Outcome::Inaccurate { residual: energy_residual },
        false => Outcome::Done,
    }
}

/// Energy in J by which rounding of displacements and forces changes the ledger.
fn rounding(model: &Model, (low, high): (f64, f64), steps: u64) -> f64 {
    let curve = &model.mechanism.curve;
    let largest = |of: &dyn Fn(f64) -> f64| of(low).abs().max(of(high).abs());
    let terms = largest(&|x| curve.stiffness(x) * x) * (high - low) + largest(&|x| curve.force(x) * x);
    // These errors have both signs.
    let many = (steps as f64 / STEPS_WITHIN_TOLERANCE).max(1.0).sqrt();
    FORCE_ROUNDINGS * f64::EPSILON * terms * many
}
