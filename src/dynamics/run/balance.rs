//! Verdict on a run that has reached its end: whether its numbers are finite, and whether its energy
//! balances.
//!
//! A ledger whose terms are integrated each by itself closes to the tolerance. Where it does not, by more
//! than rounding makes of its terms, the motion is not one of the scene's: the outcome says so. A run without
//! a ledger (a cell of a sweep) is only asked whether its numbers are finite.

use crate::dynamics::model::Model;
use crate::dynamics::result::{Ledger, Outcome, Run};

/// The residual of a ledger that is allowed, in tolerances. The most of tens of thousands of drawn scenes was
/// 4.
const TOLERANCES: f64 = 100.0;

/// The tolerance below which rounding is all that a ledger shows, and the roundings of force and place that
/// add up in it.
const FINEST: f64 = 1e-13;
const PLACES: f64 = 16.0;

/// Steps whose errors add up to no more than the tolerance: those of an undamped mass between elastic stops
/// all err to one side.
const MANY_STEPS: f64 = 1000.0;

/// The share of the energy moved that may be missing of a motion so small that the tolerance, which is
/// relative to the scene's scales, does not hold it to more. Below this share of the length scale nothing has
/// moved.
const MISSING: f64 = 0.1;
const STILL: f64 = 1e-12;

/// A circuit whose coupling is this many times as fast as the motion holds the mass fast. What little moves
/// then is what is asked for, be it below the rounding of displacement and force.
const STRONG: f64 = 1e3;

/// Range and largest speed of a motion, in m and m/s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Excursion {
    pub low: f64,
    pub high: f64,
    pub speed: f64,
}

/// The outcome of a run that ended with the one that it has.
pub(super) fn judged(model: &Model, run: &Run, reach: Excursion) -> Outcome {
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
    let strong = model.circuit().is_some_and(|circuit| circuit.coupling.abs() * model.scales.time > STRONG);
    if strong && residual_j.abs() > MISSING * moved {
        return Outcome::Inaccurate { residual: energy_residual };
    }
    let missing = residual_j.abs() - rounding(model, reach, summary.steps);
    if !(missing > 0.0) {
        return Outcome::Done;
    }
    let many = (summary.steps as f64 / MANY_STEPS).max(1.0);
    let allowed = TOLERANCES * model.tolerance.max(FINEST) * many;
    let by_tolerance = allowed * (moved + model.mass * model.scales.speed * reach.speed);
    let moves = reach.high - reach.low > STILL * model.scales.length;
    match missing > by_tolerance || (moves && missing > MISSING * moved) {
        true => Outcome::Inaccurate { residual: energy_residual },
        false => Outcome::Done,
    }
}

/// What the rounding of places and forces makes of an energy, in J.
fn rounding(model: &Model, Excursion { low, high, .. }: Excursion, steps: u64) -> f64 {
    let curve = &model.mechanism.curve;
    let largest = |of: &dyn Fn(f64) -> f64| of(low).abs().max(of(high).abs());
    let terms = largest(&|x| curve.stiffness(x) * x) * (high - low) + largest(&|x| curve.force(x) * x);
    // They err to either side.
    let many = (steps as f64 / MANY_STEPS).max(1.0).sqrt();
    PLACES * f64::EPSILON * terms * many
}
