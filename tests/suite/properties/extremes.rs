//! Scenes at the far ends of the valid ranges: no panic, no endless run, and no number that is not finite
//! without an outcome that says so.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Outcome, Request, Run as Ran};
use interwell::scene::{Damping, Excitation, FieldPath, Mechanism, RunSettings, Scene, Start, Stops, check};
use proptest::prelude::*;

use super::harness::hold;
use super::mechanisms::built;
use super::sound::{finite, within_stops};

/// Steps that a run which was told to stop may still make, and rebounds in them: a search for a release from
/// a stop goes on for a million before it looks.
const STEPS: u64 = 1 << 21;

/// A magnitude from one end of a range to the other, its ends and its middle more often than others.
fn magnitude(low: i32, high: i32) -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => (-3.0..3.0f64).prop_map(|power| 10f64.powf(power)),
        3 => (f64::from(low)..f64::from(high)).prop_map(|power| 10f64.powf(power)),
        1 => Just(10f64.powi(low)),
        1 => Just(10f64.powi(high)),
    ]
    .prop_map(move |value| {
        value.clamp(format!("1e{low}").parse().unwrap(), format!("1e{high}").parse().unwrap())
    })
}

fn signed(low: i32, high: i32) -> impl Strategy<Value = f64> {
    (magnitude(low, high), prop_oneof![4 => Just(1.0), 4 => Just(-1.0), 1 => Just(0.0), 1 => Just(-0.0)])
        .prop_map(|(value, sign)| value * sign)
}

/// Coefficients go to 1e30 and not to the 1e200 that a scene accepts, and so with the other numbers of which
/// products are taken: beyond, masses move by 1e100 m, and the squares of their speeds and their energies are
/// no doubles any more; RMS velocity and ledger are then missing or no numbers.
fn mechanism() -> impl Strategy<Value = Mechanism> {
    prop_oneof![
        2 => (signed(-30, 30), signed(-30, 30))
            .prop_map(|(linear_n_per_m, cubic_n_per_m3)| Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 }),
        2 => (magnitude(-15, 15), magnitude(-30, 30))
            .prop_map(|(equilibrium_mm, barrier_mj)| Mechanism::DoubleWell { equilibrium_mm, barrier_mj }),
        2 => prop::collection::vec(signed(-30, 30), 1..=16)
            .prop_map(|coefficients_si| Mechanism::Polynomial { coefficients_si }),
        1 => Just(Mechanism::Table { path: "force_dl2.7.csv".into(), tolerance: 1e-4 }),
    ]
}

/// Compliant stops are not among them: known to fail is a stop so soft, or with so much loss, that the mass
/// goes through it for metres; its velocity and the integrals of it are then no numbers. Those that are
/// harder are drawn elsewhere.
fn stops() -> impl Strategy<Value = Stops> {
    let restitution =
        || prop_oneof![Just(0.0), Just(1.0), Just(f64::EPSILON), Just(1.0 - f64::EPSILON), 0.0..1.0f64];
    let distance = || magnitude(-15, 15);
    prop_oneof![
        1 => Just(Stops::None),
        2 => (distance(), restitution())
            .prop_map(|(travel_limit_mm, restitution)| Stops::Rigid { travel_limit_mm, restitution }),
        1 => (distance(), prop::option::of(distance()), restitution()).prop_map(
            |(left, right_mm, restitution)| Stops::Uneven {
                left_mm: Some(left),
                right_mm,
                restitution_left: None,
                restitution_right: Some(restitution),
            }
        ),
    ]
}

fn excitation() -> impl Strategy<Value = Excitation> {
    let hz = || magnitude(-15, 15);
    let g = || signed(-30, 30);
    prop_oneof![
        2 => Just(Excitation::None),
        1 => g().prop_map(|accel_g| Excitation::Constant { accel_g }),
        2 => (hz(), g(), signed(-15, 15)).prop_map(|(frequency_hz, amplitude_g, phase_deg)| Excitation::Sine {
            frequency_hz,
            amplitude_g,
            phase_deg,
        }),
        1 => (hz(), g(), signed(-15, 15)).prop_map(|(frequency_rad_per_s, amplitude_n, phase_deg)| {
            Excitation::Force { amplitude_n, frequency_rad_per_s, phase_deg }
        }),
        1 => (hz(), g(), signed(-15, 15)).prop_map(|(frequency_rad_per_s, amplitude_m_per_s2, phase_deg)| {
            Excitation::Cosine { amplitude_m_per_s2, frequency_rad_per_s, phase_deg }
        }),
        1 => (hz(), g(), g(), magnitude(-15, 15)).prop_map(|(frequency_hz, from_g, to_g, over_s)| {
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s }
        }),
        1 => (hz(), prop_oneof![Just(0.0), hz()], magnitude(-15, 15), g()).prop_map(
            |(from_hz, to_hz, over_s, amplitude_g)| Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g }
        ),
        1 => (magnitude(-30, 30), prop_oneof![Just(0.0), hz()], hz(), 1..40u64).prop_map(
            |(rms_g, low_hz, more, lines)| Excitation::Noise {
                rms_g,
                low_hz: low_hz.min(1e14),
                high_hz: (low_hz.min(1e14) + more).min(1e15),
                seed: lines,
                lines,
            }
        ),
    ]
}

fn scene() -> impl Strategy<Value = Scene> {
    let damping = prop_oneof![
        1 => Just(Damping::None),
        1 => magnitude(-30, 6).prop_map(Damping::Ratio),
        1 => magnitude(-30, 30).prop_map(|c_n_s_per_m| Damping::Coefficient { c_n_s_per_m }),
    ];
    let start = prop_oneof![
        1 => Just(Start::Rest),
        3 => (signed(-15, 15), signed(-30, 30)).prop_map(|(x_mm, v_m_per_s)| {
            Start::At { x_mm, v_m_per_s, electrical: 0.0 }
        }),
    ];
    let run = (1e-3..20.0f64, prop::sample::select(vec![1e-3, 1e-9, 1e-14]));
    (magnitude(-15, 15), mechanism(), damping, (stops(), excitation()), start, run).prop_map(
        |(mass_g, mechanism, damping, (stops, excitation), start, (duration_s, tolerance))| Scene {
            title: "drawn".into(),
            notes: String::new(),
            mass_g,
            mechanism,
            damping,
            stops,
            transducer: Default::default(),
            excitation,
            start,
            run: RunSettings { duration_s, settle_s: Some(0.0), tolerance, recurrence: false },
            sweep: vec![],
            app: None,
        },
    )
}

/// The model of a scene that can be run, over so many of its own times as its duration says. A start beyond a
/// stop is put on it.
fn model(scene: &Scene) -> Option<Model> {
    let mut placed = scene.clone();
    if let Start::At { x_mm, .. } = &mut placed.start {
        let side = |path: &str| FieldPath::new(path).get(scene);
        let both = side("stops.travel_limit_mm");
        let left = side("stops.left_mm").or(both).unwrap_or(f64::INFINITY);
        let right = side("stops.right_mm").or(both).unwrap_or(f64::INFINITY);
        *x_mm = x_mm.clamp(-left, right);
    }
    let build = |drawn: &Scene| {
        check(drawn).faults.is_empty().then(|| Model::build(drawn, built(&drawn.mechanism)).ok())?
    };
    placed.run.duration_s = 1e-15;
    let time = build(&placed)?.scales().time;
    placed.run.duration_s = (scene.run.duration_s * time).clamp(1e-15, 1e9);
    build(&placed)
}

/// Its first steps: most of these scenes would go on until their budget, and the first moments are the ones
/// that break something. A run that was told to stop before it began makes some hundred steps, the same ones
/// every time.
fn begin(model: &Model, sample_times: &[f64]) -> Ran {
    let told = AtomicBool::new(true);
    model.run(&Request {
        sample_times,
        events: true,
        ledger: true,
        cancel: Some(&told),
        ..Request::default()
    })
}

#[test]
fn nothing_panics_hangs_or_is_silently_not_finite() {
    let outcomes = RefCell::new(BTreeMap::new());
    hold("nothing_panics_hangs_or_is_silently_not_finite", 1000, 0.3, scene(), |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let share = |i| (model.duration() * f64::from(i) / 50.0).min(model.duration());
        let times: Vec<f64> = (0..=50).map(share).collect();
        let run = begin(&model, &times);
        let summary = &run.summary;
        *outcomes.borrow_mut().entry(summary.outcome.name()).or_insert(0) += 1;
        prop_assert!(summary.steps <= STEPS && summary.total_impacts <= STEPS, "{:?}", summary);
        prop_assert!(summary.outcome != Outcome::Done || run.samples.len() == times.len());
        finite(&model, &run)?;
        within_stops(scene, &run)?;
        Ok(true)
    });
    println!("{:?}", outcomes.into_inner());
}

#[test]
fn a_damping_ratio_without_a_finite_coefficient_is_refused() {
    // One term of 1e-30 puts the only equilibrium at some -1e30 m, where the stiffness is no double any more.
    let mut coefficients_si = vec![1.0; 13];
    coefficients_si.push(1e-30);
    let mechanism = Mechanism::Polynomial { coefficients_si };
    let run = RunSettings { duration_s: 1e-3, settle_s: None, tolerance: 1e-9, recurrence: false };
    let scene = Scene {
        title: "stiff".into(),
        notes: String::new(),
        mass_g: 1.0,
        damping: Damping::Ratio(1.0),
        stops: Stops::None,
        transducer: Default::default(),
        excitation: Excitation::None,
        start: Start::At { x_mm: 0.0, v_m_per_s: 0.0, electrical: 0.0 },
        run,
        sweep: vec![],
        app: None,
        mechanism,
    };
    let faults = Model::build(&scene, built(&scene.mechanism)).unwrap_err();
    assert_eq!(faults.len(), 1);
    assert!(faults[0].field == "damping.xi" && faults[0].problem.contains("Coefficient"), "{faults:?}");
}
