//! Kramers' rate: its closed form, where it is left out, and that runs under noise escape at it.

use std::f64::consts::TAU;

use interwell::{Escape, Progress, Simulation};
use interwell_studies::study::{NoKramers, depopulation, kramers_rate};

use super::double_well;
use crate::support::{Draw, near_relative};

fn rate(simulation: &Simulation) -> Option<f64> {
    kramers_rate(simulation.model()).ok()
}

#[test]
fn strong_damping_has_the_closed_form() {
    let mut draw = Draw(1);
    for _ in 0..40 {
        let (damping, height) = (draw.between(0.9, 1.15), draw.between(3.1, 12.0));
        let barrier = 0.5_f64.sqrt();
        let prefactor = ((0.25 * damping * damping + barrier * barrier).sqrt() - 0.5 * damping) / barrier;
        // a turn loses at least 20 k_B T, which changes the rate by less than a thousandth
        let exact = 5.0 * prefactor * f64::exp(-height);
        let found =
            rate(&double_well(damping, height, 1000, 1, "start: At(x_mm: -1, v_m_per_s: 0)")).unwrap();
        near_relative(found, exact, 2e-3);
    }
}

/// The integral of Mel'nikov and Meshkov as it stands, by Simpson's rule.
fn depopulation_as_it_stands(loss: f64) -> f64 {
    const STEPS: u32 = 40_000;
    let end = (60.0 / loss).sqrt().max(1.0);
    let term = |l: f64| {
        let square = l * l + 0.25;
        (-(-loss * square).exp()).ln_1p() / square
    };
    let step = end / f64::from(STEPS);
    let inner: f64 = (1..STEPS).map(|i| f64::from(2 + 2 * (i % 2)) * term(f64::from(i) * step)).sum();
    ((term(0.0) + inner + term(end)) * step / 3.0 * 2.0 / TAU).exp()
}

#[test]
fn weak_damping_lowers_it_by_the_factor_of_melnikov_and_meshkov() {
    for loss in [0.03, 0.3, 1.0, 3.0, 10.0, 40.0] {
        near_relative(depopulation(loss), depopulation_as_it_stands(loss), 1e-8);
    }
    // its limits: the energy lost in a turn, and 1
    near_relative(depopulation(1e-6), 1e-6, 1e-2);
    assert_eq!(depopulation(1e3), 1.0);
    // a turn of the quartic double well loses 16 sqrt(2)/3 of damping rate times barrier over frequency
    let (damping, height) = (0.1_f64, 5.0);
    let loss = 16.0 * 2_f64.sqrt() / 3.0 * damping * height;
    let prefactor = ((0.25 * damping * damping + 0.5_f64).sqrt() - 0.5 * damping) / 0.5_f64.sqrt();
    let found = rate(&double_well(damping, height, 4000, 1, "")).unwrap();
    near_relative(found, depopulation(loss) * 5.0 * prefactor * f64::exp(-height), 1e-9);
}

#[test]
fn it_is_left_out_where_it_does_not_hold() {
    let holds = double_well(1.0, 5.0, 400, 1, "");
    assert!(rate(&holds).is_some());
    let with = |field: &str, value: &str| kramers_rate(holds.with(field, value).unwrap().model());
    let changed = |field: &str, value: &str| with(field, value).ok();
    // stops and another force that leave the wells alone change nothing
    assert_eq!(changed("stops", "Rigid(travel_limit_mm: 1.5, restitution: 0.5)"), rate(&holds));
    for (field, value, fails) in [
        ("damping", "None", NoKramers::Damping),
        ("excitation", "Sine(frequency_hz: 5, amplitude_g: 0.1)", NoKramers::Noise),
        (
            "excitation",
            "Sum([Noise(rms_g: 0.04, low_hz: 0, high_hz: 60, seed: 1), Constant(accel_g: 0.01)])",
            NoKramers::Noise,
        ),
        ("excitation.low_hz", "1", NoKramers::Band),
        ("excitation.high_hz", "20", NoKramers::Height),
        ("excitation.lines", "64", NoKramers::Lines),
        ("excitation.rms_g", "0.06", NoKramers::Height),
        ("stops", "Rigid(travel_limit_mm: 0.9, restitution: 0.5)", NoKramers::Ends),
        ("stops", "Rigid(travel_limit_mm: 1.2, restitution: 0.5)", NoKramers::Ends),
        (
            "transducer",
            "Piezoelectric(coupling_n_per_v: 1e-4, capacitance_nf: 100, load_kohm: 100)",
            NoKramers::Damping,
        ),
        ("mechanism", "Linear(n_per_m: 10)", NoKramers::Barrier),
        // corners at the barrier and at the wells
        (
            "mechanism",
            "Pieces(ends_m: [-inf, -5e-4, 5e-4, inf], pieces: [(origin_m: -1e-3, coefficients_si: [0, 6]), \
             (coefficients_si: [0, -6]), (origin_m: 1e-3, coefficients_si: [0, 6])])",
            NoKramers::Kink,
        ),
    ] {
        assert_eq!(with(field, value), Err(fails), "{field} = {value}");
    }
}

/// Asserts that the interval of the rate of some runs meets the band in which Kramers' rate is right.
#[track_caller]
fn escapes_at_it(simulation: &Simulation, runs: u64, band: (f64, f64)) {
    let question = Escape { runs, ..Escape::default() };
    let table = question.run(simulation, &Progress::none()).unwrap();
    let number = |name: &str| table.numbers(name).unwrap()[0];
    let (low, high) = (number("escape_rate_low_per_s"), number("escape_rate_high_per_s"));
    let kramers = number("kramers_rate_per_s");
    assert_eq!(Some(kramers), rate(simulation));
    let told = format!("{low} to {high}, by Kramers {kramers}");
    assert!(low < band.1 * kramers && high > band.0 * kramers, "{told}");
    // the interval is narrower than the rate, so that another temperature would show
    assert!(high - low < 0.9 * number("escape_rate_per_s"), "{told}");
}

#[test]
fn runs_under_noise_escape_at_it() {
    // Langevin's equation with exactly white noise has 0.92 of the rate at a barrier of 4 k_B T
    escapes_at_it(&double_well(1.0, 4.0, 200, 7, ""), 120, (0.85, 1.05));
    // and 0.91 at a tenth of the damping, where the factor of weak damping is 0.76
    escapes_at_it(&double_well(0.1, 4.0, 1000, 7, ""), 50, (0.82, 1.05));
}
