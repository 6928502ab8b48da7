//! An electrical state at a stop: it decays in closed form, and its force takes part in the release.

use std::f64::consts::TAU;

use interwell::dynamics::{EventKind, Model, Outcome};
use interwell::numeric::bisect;

use crate::support::*;

/// A mass of 1 kg pressed on the stop at 1 mm with `press` m/s^2, in a drive of 1 Hz.
fn pressed(press: f64, amplitude: f64, transducer: &str, electrical: f64, duration: f64) -> Model {
    model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [{}]), transducer: {transducer}, \
         stops: Rigid(travel_limit_mm: 1, restitution: 0.5), \
         excitation: Sine(frequency_hz: 1, amplitude_g: {}), \
         start: At(x_mm: 1, v_m_per_s: 0, electrical: {electrical}), \
         run: (duration_s: {duration}, settle_s: 0, tolerance: 1e-12)",
        -press,
        amplitude / 9.80665
    ))
}

#[test]
fn at_rest_the_state_decays_in_closed_form() {
    // R = 100 ohm and L = 30 H, C = 3 uF and R = 100 kohm: 0.3 s
    for (transducer, storage) in [
        ("Electromagnetic(coupling_v_s_per_m: 0.5, coil_ohm: 40, load_ohm: 60, inductance_mh: 30000)", 30.0),
        ("Piezoelectric(coupling_n_per_v: 0.5, capacitance_nf: 3000, load_kohm: 100)", 3e-6),
    ] {
        let times = [0.0, 0.1, 0.3, 1.0, 2.5];
        let model = pressed(2.0, 0.5, transducer, 0.25, 2.5);
        let run = run_at(&model, &times);
        assert_eq!(run.summary.rests, 1);
        for (sample, t) in run.samples.iter().zip(times) {
            near_relative(sample.electrical, 0.25 * (-t / 0.3_f64).exp(), 3e-14);
        }
        let ledger = run.summary.ledger.unwrap();
        let taken = 0.5 * storage * 0.0625 * (1.0 - (-5.0 / 0.3_f64).exp());
        near_relative(ledger.harvested_j.unwrap() + ledger.coil_j.unwrap(), taken, 1e-14);
        near_relative(ledger.stored_j, -taken, 1e-14);
        assert!(ledger.energy_residual < 1e-15);
    }
}

/// The first time after which press + push e^(-t/tau) - amplitude sin(2 pi t) is below 0, by small steps and
/// bisection.
fn release(press: f64, push: f64, tau: f64, amplitude: f64, until: f64) -> Option<f64> {
    let net = |t: f64| press + push * (-t / tau).exp() - amplitude * (TAU * t).sin();
    let step = 1e-5;
    let first = (0..(until / step) as usize).find(|i| net((i + 1) as f64 * step) < 0.0)?;
    Some(bisect(first as f64 * step, (first + 1) as f64 * step, 60, |t| net(t) >= 0.0).1)
}

/// The sine drive pulls the mass off the right-hand stop where a_b is positive.
#[test]
fn the_release_is_the_root_of_the_net_force_with_the_electrical_one() {
    let mut released = 0;
    // (k is 1 N/V, so that a voltage u pushes by -u m/s^2)
    for tau in [1e-4, 0.01, 0.1, 0.7, 4.0, 300.0] {
        for push in [-0.99, -0.6, -0.1, 0.2, 0.9, 3.0, 40.0] {
            for amplitude in [0.0, 0.3, 0.99999, 1.00001, 1.4, 7.0] {
                let load = tau / 1e-6;
                let transducer = format!(
                    "Piezoelectric(coupling_n_per_v: 1, capacitance_nf: 1000, load_kohm: {})",
                    load / 1e3
                );
                let model = pressed(1.0, amplitude, &transducer, -push, 3.0);
                let run = run(&model);
                let found = of_kind(&run, EventKind::Release).first().map(|event| event.t);
                let case = format!("tau {tau}, push {push}, amplitude {amplitude}");
                match (found, release(1.0, push, tau, amplitude, 3.0)) {
                    (Some(time), Some(exact)) => {
                        released += 1;
                        // (as a root of the closed form allows)
                        let fall = |t: f64| {
                            (-push / tau * (-t / tau).exp() - amplitude * TAU * (TAU * t).cos()).abs()
                        };
                        let bound = 1e-13 + 1e-14 * (1.0 + push.abs() + amplitude) / fall(exact);
                        assert!((time - exact).abs() < bound, "{case}: {time} {exact}, {bound:e}");
                    }
                    (time, exact) => assert_eq!(time, exact, "{case}"),
                }
            }
        }
    }
    assert!(released > 100, "{released}");
}

#[test]
fn a_dip_of_the_net_force_during_the_decay_is_not_missed() {
    // The push rises towards 0 while the drive falls: they leave a dip below 0 of some milliseconds.
    let (tau, amplitude, press) = (0.05, 1.0, 1.0);
    let transducer = "Piezoelectric(coupling_n_per_v: 1, capacitance_nf: 1000, load_kohm: 50)";
    let least = |push: f64| {
        let net = |t: f64| press + push * (-t / tau).exp() - amplitude * (TAU * t).sin();
        (0..300_000).map(|i| net(f64::from(i) * 1e-6)).fold(f64::INFINITY, f64::min)
    };
    // the push at which the dip just touches 0
    let (low, high) = bisect(-0.9, 0.5, 50, |push| least(push) < 0.0);
    for (push, dips) in [(low - 1e-6, true), (high + 1e-6, false)] {
        let run = run(&pressed(press, amplitude, transducer, -push, 0.3));
        assert_eq!(!of_kind(&run, EventKind::Release).is_empty(), dips, "{push}");
    }
}

#[test]
fn the_flight_after_a_release_is_that_of_an_independent_integration() {
    let (press, push, tau, amplitude) = (1.0, 0.8, 0.1, 1.6);
    let transducer = "Piezoelectric(coupling_n_per_v: 1, capacitance_nf: 1000, load_kohm: 100)";
    let model = pressed(press, amplitude, transducer, -push, 0.45);
    let from = release(press, push, tau, amplitude, 1.0).unwrap();
    assert!(from < 0.3);
    // the classical method of Runge and Kutta in small steps: x'' = press - u - a sin, u' = 1e6 x' - u/tau
    let rates =
        |t: f64, [_, v, u]: [f64; 3]| [v, press - u - amplitude * (TAU * t).sin(), v / 1e-6 - u / tau];
    let until = from + 0.02;
    let run = run_at(&model, &[until]);
    assert_eq!(run.summary.outcome, Outcome::Done);
    let (count, mut state) = (200_000, [1e-3, 0.0, -push * (-from / tau).exp()]);
    let h = (until - from) / f64::from(count);
    for i in 0..count {
        let t = from + f64::from(i) * h;
        let along = |k: [f64; 3], by: f64| std::array::from_fn(|j| state[j] + by * k[j]);
        let a = rates(t, state);
        let b = rates(t + 0.5 * h, along(a, 0.5 * h));
        let c = rates(t + 0.5 * h, along(b, 0.5 * h));
        let d = rates(t + h, along(c, h));
        state = std::array::from_fn(|j| state[j] + h / 6.0 * (a[j] + 2.0 * (b[j] + c[j]) + d[j]));
    }
    let sample = run.samples[0];
    assert!((sample.x - 1e-3).abs() > 1e-9, "{sample:?}");
    near(sample.x, state[0], 1e-13);
    near(sample.v, state[1], 1e-11);
    near(sample.electrical, state[2], 1e-9);
}
