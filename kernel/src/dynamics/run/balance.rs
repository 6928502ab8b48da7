//! Check of a run that has reached its end: whether its numbers are finite and its energy balances.
//!
//! The terms of a ledger are integrated separately, so their sum closes to the tolerance. If it is off by
//! more than that and the rounding of its terms, the computed motion is wrong and the outcome says so. For a
//! run without a ledger (a cell of a sweep) only the numbers are checked to be finite.

use crate::dynamics::model::Model;
use crate::dynamics::result::{Ledger, Outcome, Run};

/// Permitted residual of a ledger, in tolerances. The largest in tens of thousands of random scenes was 4.
const TOLERANCES: f64 = 100.0;

/// Tolerance below which the residual of a ledger is rounding.
const MIN_TOLERANCE: f64 = 1e-13;
/// Roundings of force and displacement that add up in a ledger.
const FORCE_ROUNDINGS: f64 = 16.0;

/// Steps whose errors add up to no more than the tolerance. The errors of an undamped mass between elastic
/// stops all have one sign.
const STEPS_WITHIN_TOLERANCE: f64 = 1000.0;

/// Share of the energy moved that may be missing in a motion so small that the tolerance, which is relative
/// to the scene's scales, does not limit the error further.
const MAX_MISSING_SHARE: f64 = 0.1;
/// Share of the length scale below which nothing has moved.
const STILL: f64 = 1e-12;

/// Ratio of coupling to the motion's rate above which a circuit holds the mass fast. The small motion that is
/// left must balance its energy even if it is below the rounding of displacement and force.
const STRONG_COUPLING: f64 = 1e3;

/// Range and largest speed of a motion, in m and m/s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Excursion {
    pub low: f64,
    pub high: f64,
    pub speed: f64,
}

/// The outcome of a run after this check.
pub(super) fn checked_outcome(model: &Model, run: &Run, reach: Excursion) -> Outcome {
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
    let missing = residual_j.abs() - rounding(model, reach, summary.steps);
    if !(missing > 0.0) {
        return Outcome::Done;
    }
    let many = (summary.steps as f64 / STEPS_WITHIN_TOLERANCE).max(1.0);
    let allowed = TOLERANCES * model.tolerance.max(MIN_TOLERANCE) * many;
    let by_tolerance = allowed * (moved + model.mass * model.scales.speed * reach.speed);
    let moves = reach.high - reach.low > STILL * model.scales.length;
    match missing > by_tolerance || (moves && missing > MAX_MISSING_SHARE * moved) {
        true => Outcome::Inaccurate { residual: energy_residual },
        false => Outcome::Done,
    }
}

/// Energy in J by which rounding of displacements and forces changes the ledger.
fn rounding(model: &Model, Excursion { low, high, .. }: Excursion, steps: u64) -> f64 {
    let curve = &model.mechanism.curve;
    let largest = |of: &dyn Fn(f64) -> f64| of(low).abs().max(of(high).abs());
    let terms = largest(&|x| curve.stiffness(x) * x) * (high - low) + largest(&|x| curve.force(x) * x);
    // These errors have both signs.
    let many = (steps as f64 / STEPS_WITHIN_TOLERANCE).max(1.0).sqrt();
    FORCE_ROUNDINGS * f64::EPSILON * terms * many
}
