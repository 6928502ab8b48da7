//! Case of the free double well near its separatrix.

use std::f64::consts::SQRT_2;

use super::HardCase;
use crate::numeric::Scalar;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::UnitWell;
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, unit_well};

pub(super) const SEPARATRIX: HardCase = HardCase {
    name: "separatrix",
    problem: "Unit double well (1 kg, F = x^3 - x), undamped, released at rest at sqrt 2 less and plus 1e-3 \
              to 1e-12 m, for 100 periods: each turn dwells at the barrier top, the longer the nearer.",
    answer: "The period by elliptic integrals; energy is conserved.",
    conditioning: "A step changes the energy by at most d (Fmax L + vmax V) =: q, so after n steps the \
                   energy is off by n q. Beside the separatrix dT/dE grows as 1/E: with s steps a period the \
                   k-th return is late by at most dT/dE s q k (k + 1)/2 + k s d L/V. Where that leaves less \
                   than a digit of a period, only the energy is asked for.",
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
    let mut setup = Setup::new(unit_well(), (SQRT_2 + distance, 0.0), 1.0);
    // the answer is for the double to which the scene's millimetres are converted
    let orbit = UnitWell { x0: setup.model()?.start().0 };
    let period = orbit.period().to_f64();
    setup.scene.run.duration_s = PERIODS * period;
    let model = setup.model()?;
    let times = [period, PERIODS * period].map(|t| t.min(model.duration()));
    let run = bench.run(&model, &times)?;
    let scales = model.scales();
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
        // the mass is at rest there, so that its velocity measures how late it is, unless the phase is lost
        let late = (sample.v / orbit.force()).abs();
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
