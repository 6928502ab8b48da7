//! The stroboscopic map and its derivatives against exact answers.

use std::f64::consts::TAU;

use interwell::dynamics::{EventKind, Multiplier, Outcome, StroboscopicMap};

use crate::support::{model, near, near_relative, preset, run_at, unit_well};

/// A linear oscillator with a natural frequency of 1 rad/s.
fn oscillator(rest: &str) -> interwell::dynamics::Model {
    model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), run: (duration_s: 10, \
         tolerance: 1e-13), {rest}"
    ))
}

#[track_caller]
fn pair(multipliers: Vec<Multiplier>, re: f64, im: f64, bound: f64) {
    near(multipliers[0].re, re, bound);
    near(multipliers[0].im.abs(), im.abs(), bound);
    near(multipliers[1].re, re, bound);
    near(multipliers[1].im, -multipliers[0].im, bound);
}

#[test]
fn multipliers_of_a_linear_oscillator() {
    // exp((-z w +- i w sqrt(1 - z^2)) T)
    for (ratio, frequency, periods) in [(0.0_f64, 0.2, 1_u32), (0.1, 0.2, 1), (0.3, 0.7, 3), (0.02, 1.1, 12)]
    {
        let model = oscillator(&format!(
            "damping: Ratio({ratio}), excitation: Sine(frequency_hz: {frequency}, amplitude_g: 0.02)"
        ));
        let map = model.stroboscopic_map(0.3).unwrap();
        let time = map.period() * f64::from(periods);
        let (passage, jacobian) = map.pass_with_jacobian((0.3, -0.2), periods);
        let angle = time * (1.0 - ratio * ratio).sqrt();
        let size = (-ratio * time).exp();
        pair(
            jacobian.multipliers(passage.determinant.unwrap()),
            size * angle.cos(),
            size * angle.sin(),
            1e-13,
        );
    }
}

#[test]
fn multipliers_of_the_saddle() {
    // x'' = x at the barrier: exp(+-t)
    let well = unit_well("run: (duration_s: 10, tolerance: 1e-13), start: At(x_mm: 0, v_m_per_s: 0)");
    for time in [0.5, 2.0, 7.0] {
        let (passage, jacobian) = StroboscopicMap::over(&well, time).pass_with_jacobian((0.0, 0.0), 1);
        assert_eq!(passage.state, (0.0, 0.0));
        let multipliers = jacobian.multipliers(passage.determinant.unwrap());
        near_relative(multipliers[0].re, time.exp(), 1e-12);
        near_relative(multipliers[1].re, (-time).exp(), 1e-12);
    }
}

#[test]
fn the_map_is_the_run() {
    // from the strobe at this phase to the next
    for (name, changes) in [
        ("paper", &["excitation.amplitude_g=1.3"][..]),
        ("paper-unconstrained", &["excitation.amplitude_g=1.4"]),
        ("paper", &["stops=Hertz(travel_limit_mm: 1.5, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 2)"]),
    ] {
        let model = preset(name, changes);
        for phase in [0.0, 0.35] {
            let map = model.stroboscopic_map(phase).unwrap();
            let times: Vec<f64> = (3..6).map(|n| (f64::from(n) + phase) * map.period()).collect();
            let run = run_at(&model, &times);
            let state = |n: usize| (run.samples[n].x, run.samples[n].v);
            let (passage, _) = map.pass_with_jacobian(state(0), 2);
            let plain = map.pass(state(0), 2);
            let scales = model.scales();
            for passage in [passage, plain] {
                assert_eq!(passage.outcome, Outcome::Done);
                near(passage.state.0, state(2).0, 1e-6 * scales.length);
                near(passage.state.1, state(2).1, 1e-6 * scales.speed);
            }
        }
    }
}

#[test]
fn a_pressed_rest_makes_both_multipliers_zero() {
    let model = preset("paper", &["excitation.amplitude_g=1"]);
    let map = model.stroboscopic_map(0.0).unwrap();
    let (passage, jacobian) = map.pass_with_jacobian((1e-3, 0.05), 1);
    assert!(passage.rests() > 0 && passage.events.iter().any(|event| event.kind == EventKind::Release));
    assert_eq!(passage.determinant, Some(0.0));
    assert!(jacobian.multipliers(0.0).into_iter().all(|multiplier| multiplier.magnitude() == 0.0));
    // every start gives the same strobe to the last bit after the first rest
    let other = map.pass((-0.4e-3, 0.02), 1);
    assert_eq!(map.pass(passage.state, 1).state, map.pass(other.state, 1).state);
}

#[test]
fn a_mass_that_rests_throughout_has_no_derivatives_left() {
    let model = preset("paper", &["excitation.amplitude_g=0.1"]);
    let map = model.stroboscopic_map(0.0).unwrap();
    let (passage, jacobian) = map.pass_with_jacobian((1.5e-3, 0.0), 2);
    assert_eq!((passage.state, passage.events.len()), ((1.5e-3, 0.0), 0));
    assert!(passage.determinant == Some(0.0) && jacobian.is_zero());
}

#[test]
fn a_drive_without_a_period_has_no_map() {
    for drive in [
        "None",
        "Noise(rms_g: 1, low_hz: 1, high_hz: 9, seed: 1)",
        "Chirp(from_hz: 1, to_hz: 9, \
        over_s: 3, amplitude_g: 1)",
        "AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 1, over_s: 5)",
    ] {
        let model = preset("paper", &[&format!("excitation={drive}")]);
        assert!(model.stroboscopic_map(0.0).is_none(), "{drive}");
    }
    let tones =
        "excitation=Sum([Sine(frequency_hz: 2, amplitude_g: 1), Sine(frequency_hz: 3, amplitude_g: 1)])";
    near(preset("paper", &[tones]).stroboscopic_map(0.0).unwrap().period(), 1.0, 1e-15);
}

#[test]
fn the_nearest_miss_is_that_of_the_amplitude() {
    // free swing of an undamped linear oscillator: it turns back at +-0.5
    let swing = |stops: &str| {
        let model = oscillator(&format!("stops: {stops}, start: At(x_mm: 500, v_m_per_s: 0)"));
        StroboscopicMap::over(&model, TAU * 1.25).pass((0.5, 0.0), 1)
    };
    let passage = swing("Uneven(left_mm: 500.5, right_mm: 510, restitution_right: 0.5)");
    near(passage.nearest_miss().unwrap(), 0.5e-3, 1e-12);
    assert_eq!(passage.impacts, 0);
    let passage = swing("Uneven(left_mm: 400, right_mm: 510, restitution_right: 0.5)");
    let impact = passage.events.iter().find(|event| event.kind == EventKind::Impact).unwrap();
    near(impact.v_in, -0.3, 1e-12);
    assert_eq!(swing("None").nearest_miss(), None);
}

#[test]
fn a_motion_that_begins_at_rest_has_missed_no_stop() {
    // the same swing from either side, over less than half of it and over more
    let stops = |left: f64, right: f64| {
        format!("stops: Uneven(left_mm: {left}, right_mm: {right}, restitution_right: 0.5)")
    };
    let nearest = |x: f64, stops: &str, time: f64| {
        let model = oscillator(&format!("{stops}, start: At(x_mm: {}, v_m_per_s: 0)", 1e3 * x));
        let passage = StroboscopicMap::over(&model, time).pass((x, 0.0), 1);
        assert_eq!((passage.outcome, passage.impacts), (Outcome::Done, 0));
        passage.nearest_miss()
    };
    for near in [10.0, 0.5, 1e-6, 0.0] {
        assert_eq!(nearest(0.5, &stops(520.0, 500.0 + near), 3.0), None);
        assert_eq!(nearest(-0.5, &stops(500.0 + near, 520.0), 3.0), None);
        near_relative(nearest(0.5, &stops(520.0, 500.0 + near), 3.3).unwrap(), 0.02, 1e-10);
        near_relative(nearest(-0.5, &stops(500.0 + near, 520.0), 3.3).unwrap(), 0.02, 1e-10);
    }
    // at rest where the forces balance to rounding
    let well = model(
        "mass_g: 1000, mechanism: Cubic(linear_n_per_m: -0.7, cubic_n_per_m3: 1.3), run: (duration_s: 10), \
         stops: Rigid(travel_limit_mm: 1200, restitution: 0.5)",
    );
    let at = (0.7_f64 / 1.3).sqrt();
    for x in [at, -at, at.next_up(), 0.0] {
        assert_eq!(StroboscopicMap::over(&well, 40.0).pass((x, 0.0), 1).nearest_miss(), None);
    }
    // at rest on a stop up to its release
    for amplitude in 2..15 {
        let model = preset("paper", &[&format!("excitation.amplitude_g={}", f64::from(amplitude) * 0.1)]);
        let passage = model.stroboscopic_map(0.0).unwrap().pass((1.5e-3, 0.0), 2);
        assert!(
            passage.nearest_miss().is_none_or(|miss| miss > 1e-6),
            "{amplitude}: {:?}",
            passage.nearest_miss()
        );
    }
}
