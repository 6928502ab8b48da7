//! The free double well beside its separatrix.

use std::f64::consts::SQRT_2;

use super::HardCase;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::UnitWell;
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, unit_well};

pub(super) const SEPARATRIX: HardCase = HardCase {
    name: "separatrix",
    problem: "Unit double well (1 kg, F = x^3 - x), undamped, released at rest at sqrt 2 less and plus 1e-3 to 1e-12 m, \
              for 100 periods: each turn dwells at the barrier top, the longer the nearer.",
    answer: "The period by elliptic integrals; energy is conserved.",
    conditioning: "A step changes the energy by at most d (Fmax L + vmax V) =: q, so after n steps the energy is off by \
                   n q. Beside the separatrix dT/dE grows as 1/E: with s steps a period the k-th return is late by \
                   at most dT/dE s q k (k + 1)/2 + k s d L/V. Where that leaves less than a digit of a period, only the \
                   energy is asked for.",
    find: separatrix,
};

const PERIODS: f64 = 100.0;

const STARTS: [(&str, f64); 8] = [
    ("1e-3 inside", -1e-3),
    ("1e-3 outside", 1e-3),
    ("1e-6 inside", -1e-6),
    ("1e-6 outside", 1e-6),
    ("1e-9 inside", -1e-9),
    ("1e-9 outside", 1e-9),
    ("1e-12 inside", -1e-12),
    ("1e-12 outside", 1e-12),
];

fn separatrix(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    STARTS.iter().map(|(name, distance)| beside(bench, name, *distance)).collect()
}

fn beside(bench: &Bench, name: &'static str, distance: f64) -> Result<Variant, Stopped> {
    // the double that the scene's millimetres become is the one that the answer is for
    let x0 = (SQRT_2 + distance) * 1e3 / 1e3;
    let orbit = UnitWell { x0 };
    let period = crate::numeric::Scalar::to_f64(orbit.period());
    let model = Setup::new(unit_well(), (x0, 0.0), PERIODS * period).model()?;
    let orbit = UnitWell { x0: model.start.0 };
    let period = crate::numeric::Scalar::to_f64(orbit.period());
    let times = [period, PERIODS * period].map(|t| t.min(model.duration));
    let run = bench.run(&model, &times)?;
    let scales = model.scales;
    let steps = run.summary.steps as f64;
    let fastest = (2.0 * (0.25 + orbit.above_barrier())).sqrt();
    let energy_step = STEP_ERROR * (orbit.force().abs() * scales.length + fastest * scales.speed);
    let mut variant = Variant::of(name, &run);
    for ((quantity, k), sample) in
        [("first return", 1.0), ("100th return", PERIODS)].into_iter().zip(&run.samples)
    {
        let each = steps / PERIODS;
        let allowed = orbit.period_slope() * each * energy_step * k * (k + 1.0) / 2.0
            + k * each * STEP_ERROR * scales.time;
        // at rest there, so that the velocity tells how late it is
        let late =
            (sample.v / orbit.force()).abs().max(off(sample.x, orbit.x0, 1.0).sqrt() * f64::EPSILON.sqrt());
        if allowed < 0.1 * period {
            let far = off(sample.x, orbit.x0, 1.0) > 0.1;
            let error = if far { 1.0 } else { late / period };
            variant = variant.number(quantity, error, allowed / period);
        }
    }
    let (x, v) = (run.summary.final_x, run.summary.final_v);
    let energy = 0.5 * v * v + UnitWell::potential(x);
    let error = off(energy, UnitWell::potential(orbit.x0), 0.25);
    Ok(variant.number("energy", error, steps * energy_step / 0.25))
}
