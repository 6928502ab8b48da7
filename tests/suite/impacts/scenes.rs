//! Scenes made from their parts, for the tests of impacts.

use std::sync::Arc;

use interwell::dynamics::{Model, Request, Run, STANDARD_GRAVITY};
use interwell::mechanics::{ForceCurve, Mechanism as Built};
use interwell::scene::{Damping, Excitation, Files, Mechanism, RunSettings, Scene, Start, Stops, check};

/// A scene of 1 kg without damping, stops and drive.
pub fn scene(mechanism: Mechanism, start: Start, duration_s: f64) -> Scene {
    Scene {
        title: "t".into(),
        notes: String::new(),
        mass_g: 1000.0,
        mechanism,
        damping: Damping::None,
        stops: Stops::None,
        transducer: Default::default(),
        excitation: Excitation::None,
        start,
        run: RunSettings { duration_s, settle_s: Some(0.0), tolerance: 1e-12, recurrence: false },
        sweep: vec![],
        app: None,
    }
}

pub fn polynomial(coefficients_si: &[f64]) -> Mechanism {
    Mechanism::Polynomial { coefficients_si: coefficients_si.to_vec() }
}

/// The cubic of the prototype's size: wells at 7 mm.
pub fn nominal() -> Mechanism {
    Mechanism::Cubic { linear_n_per_m: -40.0, cubic_n_per_m3: 40.0 / 49e-6 }
}

/// The prototype's mass on the nominal cubic between stops, shaken by a sine, at rest at first.
pub fn nominal_scene(limit_mm: f64, restitution: f64, drive: Excitation, duration_s: f64) -> Scene {
    let mut s = scene(nominal(), Start::Rest, duration_s);
    s.mass_g = 15.2;
    s.damping = Damping::Ratio(0.023);
    s.stops = rigid(limit_mm, restitution);
    s.excitation = drive;
    s
}

pub fn rigid(travel_limit_mm: f64, restitution: f64) -> Stops {
    Stops::Rigid { travel_limit_mm, restitution }
}

pub fn right_stop(right_mm: f64, restitution: f64) -> Stops {
    Stops::Uneven {
        left_mm: None,
        right_mm: Some(right_mm),
        restitution_left: None,
        restitution_right: Some(restitution),
    }
}

pub fn left_stop(left_mm: f64, restitution: f64) -> Stops {
    Stops::Uneven {
        left_mm: Some(left_mm),
        right_mm: None,
        restitution_left: Some(restitution),
        restitution_right: None,
    }
}

pub fn at(x_mm: f64, v_m_per_s: f64) -> Start {
    Start::At { x_mm, v_m_per_s, electrical: 0.0 }
}

/// A sine of an amplitude in m/s^2.
pub fn sine(frequency_hz: f64, amplitude: f64, phase_deg: f64) -> Excitation {
    Excitation::Sine { frequency_hz, amplitude_g: amplitude / STANDARD_GRAVITY, phase_deg }
}

/// A constant acceleration in m/s^2.
pub fn constant(acceleration: f64) -> Excitation {
    Excitation::Constant { accel_g: acceleration / STANDARD_GRAVITY }
}

pub fn model(scene: &Scene) -> Model {
    let checked = check(scene);
    assert!(checked.faults.is_empty(), "{:?}", checked.faults);
    let mechanism = Built::build(&scene.mechanism, &Files::default()).unwrap();
    Model::build(scene, Arc::new(mechanism)).unwrap()
}

/// The same on a curve given piece by piece.
pub fn model_on(scene: &Scene, curve: ForceCurve) -> Model {
    let checked = check(scene);
    assert!(checked.faults.is_empty(), "{:?}", checked.faults);
    Model::build(scene, Arc::new(Built::new(curve))).unwrap()
}

pub fn full(times: &[f64]) -> Request<'_> {
    Request { sample_times: times, events: true, ledger: true, ..Request::default() }
}

pub fn run(scene: &Scene) -> Run {
    model(scene).run(&full(&[]))
}

/// `n` + 1 times from 0 to the end.
pub fn dense(duration: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|i| (duration * i as f64 / n as f64).min(duration)).collect()
}
