//! Scenes of every kind: how they are shaken, damped, stopped and started.

use std::sync::Arc;

use interwell::dynamics::Model;
use interwell::scene::{Damping, Excitation, Mechanism, Record, RunSettings, Scene, Start, Stops, check};
use proptest::prelude::*;
use proptest::strategy::Union;

use super::mechanisms::{built, mechanism};
use super::units::Units;

/// The model of a scene; none where the scene asks for what its mechanism does not have (a place to rest at,
/// a stiffness, a start on the curve), which it must say in words.
pub fn model(scene: &Scene) -> Option<Model> {
    let checked = check(scene);
    assert!(checked.faults.is_empty(), "{:?}", checked.faults);
    match Model::build(scene, built(&scene.mechanism)) {
        Ok(model) => Some(model),
        Err(faults) => {
            assert!(!faults.is_empty() && faults.iter().all(|fault| !fault.problem.is_empty()));
            None
        }
    }
}

/// Distances of the stops as they are written, and their restitutions; an open side is infinitely far.
fn written(stops: &Stops) -> [(f64, f64); 2] {
    let (limits, restitutions) = (stops.limits_mm(), stops.restitutions());
    [0, 1].map(|side| (limits[side].unwrap_or(f64::INFINITY), restitutions[side].unwrap_or(1.0)))
}

/// The same with the distances in m.
pub fn distances(stops: &Stops) -> [(f64, f64); 2] {
    written(stops).map(|(mm, restitution)| (mm / 1e3, restitution))
}

/// Whether a rigid stop takes no energy.
pub fn elastic(stops: &Stops) -> bool {
    let rigid = !matches!(stops, Stops::Hertz { .. });
    rigid && written(stops).iter().any(|stop| stop.0.is_finite() && stop.1 == 1.0)
}

pub fn restitution() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), Just(0.36), 0.0..0.97f64]
}

fn distance() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => 0.05..2.0f64,
        2 => 1e-4..2e-3f64,
        1 => (0.5..6.0f64).prop_map(|power| 10f64.powf(power)), // beyond any curve that ends
    ]
}

pub fn rigid_stops() -> impl Strategy<Value = Stops> {
    let side = || prop::option::of(distance());
    let given = || prop::option::of(restitution());
    prop_oneof![
        2 => (distance(), restitution())
            .prop_map(|(travel_limit_mm, restitution)| Stops::Rigid { travel_limit_mm, restitution }),
        1 => (side(), distance(), any::<bool>(), given(), restitution()).prop_map(
            |(other, one, swap, left, right)| {
                let (left_mm, right_mm) = if swap { (Some(one), other) } else { (other, Some(one)) };
                Stops::Uneven { left_mm, right_mm, restitution_left: left, restitution_right: Some(right) }
            }
        ),
    ]
}

/// Point contacts that a mass with a speed of 1 presses in by 10^-3.5 to 10^-0.5.
fn hertz() -> impl Strategy<Value = Stops> {
    let depth = (-3.5..-0.5f64).prop_map(|power| 10f64.powf(power));
    (distance(), depth, prop_oneof![Just(0.0), 0.01..6.0f64]).prop_map(
        |(travel_limit_mm, depth, loss_s_per_m)| Stops::Hertz {
            travel_limit_mm,
            stiffness_n_per_m1_5: Some(1.25 * depth.powf(-2.5)),
            loss_s_per_m,
            radius_mm: None,
            young_gpa: None,
            poisson: None,
            yield_gpa: None,
        },
    )
}

pub fn stops() -> impl Strategy<Value = Stops> {
    prop_oneof![2 => Just(Stops::None), 8 => rigid_stops(), 2 => hertz()]
}

fn amplitude() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 8 => -4.0..4.0f64, 1 => -1e-6..1e-6f64]
}

fn frequency() -> impl Strategy<Value = f64> {
    prop_oneof![10 => 0.05..1.0f64, 1 => 1.0..30.0f64, 1 => 1e-4..0.05f64]
}

fn phase() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(90.0), Just(180.0), Just(270.0), -400.0..400.0f64]
}

/// One sine, in natural units.
pub fn sine() -> impl Strategy<Value = Excitation> {
    (frequency(), amplitude(), phase()).prop_map(|(frequency_hz, amplitude_g, phase_deg)| Excitation::Sine {
        frequency_hz,
        amplitude_g,
        phase_deg,
    })
}

/// One cosine of the base or of a force, in natural units.
pub fn cosine() -> impl Strategy<Value = Excitation> {
    let rate = frequency().prop_map(|frequency| std::f64::consts::TAU * frequency);
    (rate, amplitude(), phase(), any::<bool>()).prop_map(|(frequency_rad_per_s, a, phase_deg, force)| {
        match force {
            true => Excitation::Force { amplitude_n: a, frequency_rad_per_s, phase_deg },
            false => Excitation::Cosine { amplitude_m_per_s2: a, frequency_rad_per_s, phase_deg },
        }
    })
}

fn record() -> impl Strategy<Value = Excitation> {
    let rows = prop::collection::vec((0.01..1.5f64, prop_oneof![1 => Just(0.0), 3 => -4.0..4.0f64]), 2..12);
    (-1.0..1.0f64, rows).prop_map(|(begin, rows)| {
        let mut at = begin;
        let (times, accelerations) = rows
            .into_iter()
            .map(|(later, a)| {
                at += later;
                (at, a)
            })
            .unzip();
        let record = Some(Arc::new(Record::new(times, accelerations)));
        Excitation::Recorded { path: "record.csv".into(), record }
    })
}

fn part() -> Union<BoxedStrategy<Excitation>> {
    let over = || prop_oneof![3 => 0.1..12.0f64, 1 => 1e-3..0.1f64, 1 => 12.0..1e3f64];
    let ramp =
        (frequency(), amplitude(), amplitude(), over()).prop_map(|(frequency_hz, from_g, to_g, over_s)| {
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s }
        });
    let chirp = (prop_oneof![Just(0.0), frequency()], frequency(), over(), amplitude()).prop_map(
        |(from_hz, to_hz, over_s, amplitude_g)| Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g },
    );
    let noise = (0.0..2.0f64, 0.0..1.0f64, 0.01..4.0f64, any::<u32>(), prop_oneof![Just(1), 2..24u64])
        .prop_map(|(rms_g, low_hz, more, seed, lines)| Excitation::Noise {
            rms_g,
            low_hz,
            high_hz: low_hz + more,
            seed: u64::from(seed),
            lines,
        });
    Union::new_weighted(vec![
        (2, Just(Excitation::None).boxed()),
        (2, (-2.0..2.0f64).prop_map(|accel_g| Excitation::Constant { accel_g }).boxed()),
        (6, sine().boxed()),
        (2, cosine().boxed()),
        (2, ramp.boxed()),
        (2, chirp.boxed()),
        (1, noise.boxed()),
        (2, record().boxed()),
    ])
}

/// What shakes a scene, in natural units.
pub fn excitation() -> impl Strategy<Value = Excitation> {
    prop_oneof![5 => part(), 1 => prop::collection::vec(part(), 0..5).prop_map(Excitation::Sum)]
}

fn damping() -> impl Strategy<Value = Damping> {
    prop_oneof![
        2 => Just(Damping::None),
        1 => prop_oneof![Just(0.0), 0.0..2.0f64].prop_map(Damping::Ratio),
        3 => prop_oneof![4 => 0.0..1.0f64, 1 => 1.0..20.0f64]
            .prop_map(|c_n_s_per_m| Damping::Coefficient { c_n_s_per_m }),
    ]
}

/// Where a scene starts: at rest, or between the stops, on one of them, in the middle, in a well.
fn start(share: f64, v: f64, stops: &Stops, units: Units, mechanism: &Mechanism) -> Start {
    let [left, right] = written(stops).map(|(d, _)| d);
    let (low, high) = ((-left).max(right.min(0.0) - 1.5), right.min((-left).max(0.0) + 1.5));
    let x = match share {
        s if s < 0.08 => return Start::Rest,
        s if s < 0.15 => low,
        s if s > 0.9 => high,
        s if (0.48..0.5).contains(&s) => 0.0,
        s if (0.5..0.52).contains(&s) => match mechanism {
            Mechanism::DoubleWell { equilibrium_mm, .. } => equilibrium_mm / (units.length * 1e3),
            _ => 1.0,
        },
        s => low + (high - low) * (s - 0.15) / 0.75,
    };
    units.start((x.clamp(low, high), v))
}

/// A tolerance that a scene accepts.
pub fn tolerance() -> impl Strategy<Value = f64> {
    prop::sample::select(vec![1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12, 1e-14])
}

fn run() -> impl Strategy<Value = RunSettings> {
    let settle = prop_oneof![
        3 => Just(None),
        1 => Just(Some(0.0)),
        2 => (0.0..1.0f64).prop_map(Some),
        1 => Just(Some(1.0)),
    ];
    (prop_oneof![3 => 3.0..12.0f64, 1 => 1e-3..3.0f64], settle, tolerance(), any::<bool>()).prop_map(
        |(duration_s, settle, tolerance, recurrence)| RunSettings {
            duration_s,
            settle_s: settle.map(|share| share * duration_s),
            tolerance,
            recurrence,
        },
    )
}

/// A scene between stops of this kind, shaken like this.
pub fn scene_with(
    stops: impl Strategy<Value = Stops>,
    excitation: impl Strategy<Value = Excitation>,
) -> impl Strategy<Value = Scene> {
    let speed = prop_oneof![4 => Just(0.0), 6 => -2.0..2.0f64, 1 => -1e-6..1e-6f64];
    let state = (0.0..1.0f64, speed);
    (mechanism(), stops, excitation, damping(), state, run()).prop_map(
        |((mechanism, units), natural_stops, excitation, damping, (share, speed), run)| {
            let elastic = elastic(&natural_stops);
            // An elastic rebound that is pressed and damped has no end before its budget, and a slow one
            // makes a million impacts.
            let damping = if elastic { Damping::None } else { damping };
            let speed = if elastic && speed.abs() < 1e-3 { 0.0 } else { speed };
            Scene {
                title: "drawn".into(),
                notes: String::new(),
                mass_g: units.mass_g(),
                start: start(share, speed, &natural_stops, units, &mechanism),
                mechanism,
                damping: units.damping(damping),
                stops: units.stops(natural_stops),
                transducer: Default::default(),
                excitation: units.excitation(&excitation),
                run: RunSettings {
                    duration_s: units.seconds(run.duration_s),
                    settle_s: run.settle_s.map(|settle| units.seconds(settle)),
                    ..run
                },
                sweep: vec![],
                app: None,
            }
        },
    )
}

/// Any scene that ends within some thousand steps.
pub fn scene() -> impl Strategy<Value = Scene> {
    scene_with(stops(), excitation())
}
