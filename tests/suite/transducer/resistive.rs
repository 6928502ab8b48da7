//! A coil without inductance: a damping, exactly.

use std::f64::consts::{SQRT_2, TAU};

use interwell::dynamics::{Model, Summary};

use crate::support::*;

/// A linear oscillator of 1 kg, 1 N s/m and 400 N/m, shaken at its resonance with 1 m/s^2, on its steady
/// orbit for ten periods.
fn at_resonance(coil: f64, load: f64, coupling: f64) -> Model {
    let (damping, rate) = (1.0 + coupling * coupling / (coil + load), 20.0);
    let x = 1.0 / (damping * rate);
    model(&format!(
        "mass_g: 1000, mechanism: Cubic(linear_n_per_m: 400, cubic_n_per_m3: 0), \
         damping: Coefficient(c_n_s_per_m: 1), transducer: Electromagnetic(coupling_v_s_per_m: {coupling}, \
         coil_ohm: {coil}, load_ohm: {load}), excitation: Sine(frequency_hz: {}, amplitude_g: {}), \
         start: At(x_mm: {}, v_m_per_s: 0), run: (duration_s: {}, settle_s: 0, tolerance: 1e-13)",
        rate / TAU,
        1.0 / 9.80665,
        x * 1e3,
        10.0 * TAU / rate,
    ))
}

fn load_power(summary: &Summary) -> f64 {
    summary.harvest.unwrap().mean_load_power.unwrap()
}

#[test]
fn the_power_at_resonance_is_the_closed_form() {
    let (coil, load, coupling) = (40.0, 60.0, 5.0);
    let run = run(&at_resonance(coil, load, coupling));
    // the velocity is the acceleration times m over the whole damping
    let v = 1.0 / (1.0 + coupling * coupling / (coil + load));
    let current = coupling * v / (coil + load);
    let harvest = run.summary.harvest.unwrap();
    near_relative(harvest.mean_load_power.unwrap(), 0.5 * load * current * current, 1e-11);
    near_relative(harvest.mean_coil_power.unwrap(), 0.5 * coil * current * current, 1e-11);
    near_relative(harvest.voltage_rms.unwrap(), load * current / SQRT_2, 1e-11);
    let ledger = run.summary.ledger.unwrap();
    let time = run.summary.window.1;
    near_relative(ledger.harvested_j.unwrap() / time, harvest.mean_load_power.unwrap(), 1e-11);
    near_relative(ledger.coil_j.unwrap() / time, harvest.mean_coil_power.unwrap(), 1e-11);
    near_relative(ledger.damping_j / time, 0.5 * v * v, 1e-11);
    assert!(ledger.energy_residual < 1e-12, "{ledger:?}");
}

#[test]
fn the_best_load_is_that_of_the_closed_form() {
    // P = (m a)^2 k^2 R/(2 (c (R + Rc) + k^2)^2) is largest at R = Rc + k^2/c
    let (coil, coupling) = (40.0, 5.0);
    let best = coil + coupling * coupling;
    let power = |load: f64| load_power(&run(&at_resonance(coil, load, coupling)).summary);
    let most = coupling * coupling / (8.0 * (coil + coupling * coupling));
    near_relative(power(best), most, 1e-11);
    for share in [0.99, 1.01] {
        let less = power(share * best) / most - 1.0;
        // -(1/4) (dR/R)^2 up to its third power
        near(less, -0.25e-4, 5e-7);
    }
}

#[test]
fn a_coil_is_the_damping_that_it_adds() {
    let stops = "stops=Rigid(travel_limit_mm: 4, restitution: 0.36)";
    let (coil, load, k) = (40.0, 60.0, 5.0);
    let coupled =
        format!("transducer=Electromagnetic(coupling_v_s_per_m: {k}, coil_ohm: {coil}, load_ohm: {load})");
    for damping in [0.0, 0.01] {
        let change = format!("damping=Coefficient(c_n_s_per_m: {damping})");
        let all = format!("damping=Coefficient(c_n_s_per_m: {})", damping + k * (k / (coil + load)));
        let with = run(&preset("nominal-cubic", &[stops, &change, &coupled]));
        let without = run(&preset("nominal-cubic", &[stops, &all]));
        assert_eq!(with.events, without.events);
        let (a, b) = (&with.summary, &without.summary);
        assert_eq!((a.final_x, a.final_v, a.steps), (b.final_x, b.final_v, b.steps));
        assert!(a.total_impacts > 10);
        let (ledger, all) = (a.ledger.unwrap(), b.ledger.unwrap());
        let taken = ledger.damping_j + ledger.harvested_j.unwrap() + ledger.coil_j.unwrap();
        near_relative(taken, all.damping_j, 1e-14);
        assert_eq!((all.harvested_j, b.harvest), (None, None));
    }
}

#[test]
fn an_open_circuit_does_nothing_to_the_motion() {
    let open = "transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: inf)";
    let (with, without) = (run(&preset("paper", &[open])), run(&preset("paper", &[])));
    assert_eq!(with.events, without.events);
    let harvest = with.summary.harvest.unwrap();
    assert_eq!((harvest.mean_load_power, harvest.mean_coil_power), (Some(0.0), Some(0.0)));
    near_relative(harvest.voltage_rms.unwrap(), 5.0 * with.summary.rms_velocity.unwrap(), 1e-15);
    assert_eq!(with.summary.final_x, without.summary.final_x);
}

#[test]
fn a_short_circuit_heats_the_coil_alone() {
    let short = "transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 0)";
    let run = run(&preset("paper", &[short]));
    let harvest = run.summary.harvest.unwrap();
    assert_eq!((harvest.mean_load_power, harvest.voltage_rms), (Some(0.0), Some(0.0)));
    assert!(harvest.mean_coil_power.unwrap() > 0.0);
}
