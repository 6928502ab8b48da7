//! Any scene: what must hold of every run, whatever it does.

use interwell::dynamics::{Event, EventKind, Model, Outcome, Phase, Request, Run, Side};
use interwell::scene::{Damping, Excitation, Mechanism, Scene, Start, Stops};
use proptest::prelude::*;

use super::scenes::*;

fn sign(side: Side) -> f64 {
    match side {
        Side::Left => -1.0,
        Side::Right => 1.0,
    }
}

/// Distances of the stops in m and their restitutions; an open side is infinitely far.
fn stop_distances(stops: &Stops) -> [(f64, f64); 2] {
    let metres = |mm: Option<f64>| mm.map_or(f64::INFINITY, |mm| mm / 1e3);
    match *stops {
        Stops::None => [(f64::INFINITY, 1.0); 2],
        Stops::Rigid { travel_limit_mm, restitution } => [(travel_limit_mm / 1e3, restitution); 2],
        Stops::Hertz { .. } => panic!("these tests are of rigid stops"),
        Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } => {
            let left = restitution_left.or(restitution_right).unwrap_or(1.0);
            let right = restitution_right.or(restitution_left).unwrap_or(1.0);
            [(metres(left_mm), left), (metres(right_mm), right)]
        }
    }
}

/// Everything that must hold of a run of a scene, sampled or not.
pub fn assert_sound(scene: &Scene, model: &Model, run: &Run, ledger_factor: f64) {
    let [left, right] = stop_distances(&scene.stops);
    for s in &run.samples {
        assert!(s.x >= -left.0 && s.x <= right.0, "beyond a stop: {s:?}");
        match s.phase {
            Phase::Free => {}
            Phase::LeftStop => assert!(s.x == -left.0 && s.v == 0.0, "{s:?}"),
            Phase::RightStop => assert!(s.x == right.0 && s.v == 0.0, "{s:?}"),
        }
    }
    let mut resting: Option<Side> = None;
    let mut crossed: Option<Side> = None;
    let mut before = 0.0;
    for e in &run.events {
        assert!(e.t >= before && e.t <= scene.run.duration_s * (1.0 + 1e-15), "out of order: {e:?}");
        before = e.t;
        match e.kind {
            EventKind::Impact => {
                assert!(resting.is_none(), "an impact while at rest: {e:?}");
                let restitution = if e.side == Side::Left { left.1 } else { right.1 };
                assert!(e.v_in * sign(e.side) > 0.0, "not outward: {e:?}");
                assert!(e.v_out == -(restitution * e.v_in), "{restitution} {e:?}");
            }
            EventKind::Rest => {
                assert!(resting.is_none(), "rests twice: {e:?}");
                resting = Some(e.side);
            }
            EventKind::Release => {
                assert!(resting == Some(e.side), "released from {resting:?}: {e:?}");
                resting = None;
            }
            EventKind::Contact | EventKind::Separate => panic!("these stops are rigid: {e:?}"),
            EventKind::Crossing => {
                assert!(resting.is_none(), "crosses while at rest: {e:?}");
                assert!(crossed != Some(e.side), "enters the same well twice: {e:?}");
                assert!(e.v_in == e.v_out);
                crossed = Some(e.side);
            }
        }
    }
    if let Some((first, start)) =
        run.events.iter().find(|e| e.kind == EventKind::Crossing).zip(match scene.start {
            Start::At { x_mm, .. } => Some(x_mm / 1e3),
            Start::Rest => None,
        })
    {
        let level = model.mechanism.landscape.crossing_position().unwrap();
        assert!((start - level) * sign(first.side) <= 0.0, "{first:?} from {start}, barrier at {level}");
    }
    let summary = &run.summary;
    let count = |kind| run.events.iter().filter(|e| e.kind == kind).count() as u64;
    assert_eq!(summary.total_impacts, count(EventKind::Impact));
    assert_eq!(summary.total_crossings, count(EventKind::Crossing));
    assert_eq!(summary.rests, count(EventKind::Rest));
    // Counted without being listed they are as many.
    let unlisted = model.run(&Request::default()).summary;
    assert_eq!((unlisted.crossings, unlisted.total_crossings), (summary.crossings, summary.total_crossings));
    // Closed relative to what was moved, or, where that is far below the scene's own scales, to those.
    let ledger = summary.ledger.unwrap();
    let allowed = ledger_factor * model.tolerance;
    let scale = model.mass * model.scales.speed * model.scales.speed;
    assert!(
        ledger.energy_residual <= allowed || ledger.residual_j.abs() <= allowed * scale,
        "energy {:e} at {:e}: {ledger:?}",
        ledger.energy_residual,
        model.tolerance
    );
}

pub fn mirrored(scene: &Scene) -> Scene {
    fn drive(e: &Excitation) -> Excitation {
        match e {
            Excitation::None => Excitation::None,
            Excitation::Constant { accel_g } => Excitation::Constant { accel_g: -accel_g },
            Excitation::Sine { frequency_hz, amplitude_g, phase_deg } => Excitation::Sine {
                frequency_hz: *frequency_hz,
                amplitude_g: -amplitude_g,
                phase_deg: *phase_deg,
            },
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s } => Excitation::AmplitudeRamp {
                frequency_hz: *frequency_hz,
                from_g: -from_g,
                to_g: -to_g,
                over_s: *over_s,
            },
            Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g } => Excitation::Chirp {
                from_hz: *from_hz,
                to_hz: *to_hz,
                over_s: *over_s,
                amplitude_g: -amplitude_g,
            },
            Excitation::Sum(parts) => Excitation::Sum(parts.iter().map(drive).collect()),
            Excitation::Noise { .. } | Excitation::Recorded { .. } => unreachable!("not drawn here"),
        }
    }
    let mut m = scene.clone();
    if let Mechanism::Polynomial { coefficients_si } = &mut m.mechanism {
        coefficients_si.iter_mut().step_by(2).for_each(|c| *c = -*c);
    }
    if let Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } = &mut m.stops {
        std::mem::swap(left_mm, right_mm);
        std::mem::swap(restitution_left, restitution_right);
    }
    if let Start::At { x_mm, v_m_per_s } = &mut m.start {
        *x_mm = -*x_mm;
        *v_m_per_s = -*v_m_per_s;
    }
    m.excitation = drive(&scene.excitation);
    m
}

pub fn assert_mirrored(a: &Run, b: &Run) {
    assert_eq!(a.samples.len(), b.samples.len());
    for (p, q) in a.samples.iter().zip(&b.samples) {
        assert!(p.x == -q.x && p.v == -q.v && p.base_accel == -q.base_accel, "{p:?} {q:?}");
        assert!((p.phase == Phase::Free) == (q.phase == Phase::Free), "{p:?} {q:?}");
    }
    let flat = |e: &Event| (e.t, e.kind, sign(e.side), e.v_in, e.v_out);
    assert_eq!(a.events.len(), b.events.len());
    for (p, q) in a.events.iter().zip(&b.events) {
        let (t, kind, side, v_in, v_out) = flat(q);
        assert_eq!(flat(p), (t, kind, -side, -v_in, -v_out));
    }
    assert_eq!(a.summary.rms_velocity, b.summary.rms_velocity);
    let reach = |r: &Run| r.summary.max_abs_x.unwrap_or(0.0);
    assert!((reach(a) - reach(b)).abs() <= 1e-13 * reach(a), "{:e} {:e}", reach(a), reach(b));
    assert_eq!((a.summary.steps, a.summary.final_x), (b.summary.steps, -b.summary.final_x));
    let (p, q) = (a.summary.ledger.unwrap(), b.summary.ledger.unwrap());
    assert_eq!((p.work_j, p.damping_j, p.impact_j), (q.work_j, q.damping_j, q.impact_j));
}

fn mechanism() -> impl Strategy<Value = Mechanism> {
    prop_oneof![
        2 => (prop_oneof![-3.0..-0.05f64, 0.05..0.5f64], 0.3..2.0f64)
            .prop_map(|(linear_n_per_m, cubic_n_per_m3)| Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 }),
        2 => (300.0..1500.0f64, 50.0..500.0f64)
            .prop_map(|(equilibrium_mm, barrier_mj)| Mechanism::DoubleWell { equilibrium_mm, barrier_mj }),
        1 => (-2.0..2.0f64, prop_oneof![-2.0..-0.1f64, 0.1..2.0f64], -2.0..2.0f64, -2.0..2.0f64)
            .prop_map(|(c0, c1, c2, c3)| polynomial(&[c0, c1, c2, c3, 0.0, 1.0])),
        1 => prop_oneof![
            Just(polynomial(&[0.0])),
            (-2.0..2.0f64).prop_map(|c| polynomial(&[c])),
            (0.1..4.0f64).prop_map(|c| polynomial(&[0.0, c])),
        ],
    ]
}

fn restitution() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), Just(0.36), 0.0..0.97f64]
}

fn stops() -> impl Strategy<Value = Stops> {
    let distance = || prop_oneof![3 => 50.0..2000.0f64, 1 => 0.1..2.0f64];
    prop_oneof![
        1 => Just(Stops::None),
        4 => (distance(), restitution()).prop_map(|(d, e)| rigid(d, e)),
        2 => (prop::option::of(distance()), prop::option::of(distance()), restitution(), restitution())
            .prop_map(|(left_mm, right_mm, l, r)| match (left_mm, right_mm) {
                (None, None) => Stops::None,
                _ => Stops::Uneven {
                    left_mm,
                    right_mm,
                    restitution_left: Some(l),
                    restitution_right: Some(r),
                },
            }),
    ]
}

fn a_sine() -> impl Strategy<Value = Excitation> {
    let phase = prop_oneof![Just(0.0), Just(90.0), Just(180.0), Just(270.0), -400.0..400.0f64];
    let amplitude = prop_oneof![Just(0.0), -4.0..4.0f64];
    (0.05..1.0f64, amplitude, phase).prop_map(|(f, a, p)| sine(f, a, p))
}

fn drive() -> impl Strategy<Value = Excitation> {
    let ramp = (0.05..1.0f64, -0.4..0.4f64, -0.4..0.4f64, 0.1..12.0f64).prop_map(|(f, a, b, over_s)| {
        Excitation::AmplitudeRamp { frequency_hz: f, from_g: a, to_g: b, over_s }
    });
    prop_oneof![
        1 => Just(Excitation::None),
        1 => (-2.0..2.0f64).prop_map(constant),
        4 => a_sine(),
        2 => ramp.clone(),
        2 => (-1.0..1.0f64, a_sine(), a_sine(), ramp).prop_map(|(c, s, t, r)| {
            Excitation::Sum(vec![constant(c), s, t, r])
        }),
    ]
}

/// A start inside the stops, on one of them, or on the middle.
fn place(stops: &Stops, mechanism: &Mechanism, share: f64, speed: f64) -> Start {
    let (left, right) = match *stops {
        Stops::None => (None, None),
        Stops::Rigid { travel_limit_mm, .. } => (Some(travel_limit_mm), Some(travel_limit_mm)),
        Stops::Hertz { .. } => panic!("these tests are of rigid stops"),
        Stops::Uneven { left_mm, right_mm, .. } => (left_mm, right_mm),
    };
    let (low, high) = (-left.unwrap_or(1500.0), right.unwrap_or(1500.0));
    let x = match share {
        s if s < 0.1 => low,
        s if s > 0.9 => high,
        s if (0.48..0.52).contains(&s) => match mechanism {
            Mechanism::DoubleWell { equilibrium_mm, .. } if *equilibrium_mm < high => *equilibrium_mm,
            _ => 0.0,
        },
        s => low + (high - low) * (s - 0.1) / 0.8,
    };
    at(x.clamp(low, high), speed)
}

fn any_scene() -> impl Strategy<Value = Scene> {
    let speed = prop_oneof![2 => Just(0.0), 3 => -2.0..2.0f64, 1 => -1e-6..1e-6f64];
    (mechanism(), stops(), drive(), 0.0..1.0f64, speed, prop_oneof![Just(0.0), 0.0..1.0f64], 0..4usize)
        .prop_map(|(mechanism, stops, excitation, share, speed, c, tolerance)| {
            let start = place(&stops, &mechanism, share, speed);
            let flat = matches!(&mechanism, Mechanism::Polynomial { coefficients_si: c } if c.len() == 1);
            let mut s = scene(mechanism, start, 10.0);
            let elastic = stop_distances(&stops).iter().any(|s| s.1 == 1.0);
            // an elastic rebound that is pressed and damped has no end before its budget
            s.damping = Damping::Coefficient { c_n_s_per_m: if elastic { 0.0 } else { c } };
            if let (true, Start::At { v_m_per_s, .. }) = (elastic || flat, &mut s.start) {
                // nor has one that makes a million impacts a second
                *v_m_per_s = if v_m_per_s.abs() < 1e-3 { 0.0 } else { *v_m_per_s };
            }
            s.stops = stops;
            s.excitation = excitation;
            s.run.settle_s = Some(2.5);
            s.run.tolerance = [1e-3, 1e-6, 1e-9, 1e-12][tolerance];
            s
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, max_shrink_iters: 20_000,
        ..ProptestConfig::with_cases(std::env::var("PROPTEST_CASES").map_or(300, |n| n.parse().unwrap())) })]

    #[test]
    fn any_scene_runs_soundly(scene in any_scene()) {
        let times = dense(scene.run.duration_s, 500);
        let m = model(&scene);
        let run = m.run(&full(&times));
        let elastic = stop_distances(&scene.stops).iter().any(|s| s.1 == 1.0);
        match run.summary.outcome {
            Outcome::Done => {
                prop_assert_eq!(run.samples.len(), times.len());
                prop_assert!(elastic || run.summary.steps < 200_000, "{} steps", run.summary.steps);
            }
            Outcome::ImpactBudget { .. } => prop_assert!(elastic),
            other => prop_assert!(false, "{:?}", other),
        }
        assert_sound(&scene, &m, &run, 100.0);
        // (the barrier of a curve that is not odd is a root, and known to rounding alone)
        if !matches!(&scene.mechanism, Mechanism::Polynomial { coefficients_si } if coefficients_si.len() > 2) {
            assert_mirrored(&run, &model(&mirrored(&scene)).run(&full(&times)));
        }
    }
}
