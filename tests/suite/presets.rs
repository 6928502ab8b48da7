//! Recorded results of every built-in scene; the numbers of its notes are held elsewhere.
//!
//! The recorded digits are those on which runs at tolerances of 1e-9 and 1e-12 agree. Impacts are counted
//! where they are faster than 10 um/s: how many slower ones are located before the rest of a chatter is
//! summed depends on the tolerance.

use interwell::dynamics::{EventKind, Outcome, Regime, Request, Run, STANDARD_GRAVITY, Summary};
use interwell::mechanics::Mechanism;
use interwell::scene::PRESETS;

use crate::support::*;

/// What a scene as it stands is known to do over its settled window; impacts are over the whole run.
struct Known {
    name: &'static str,
    regime: Regime,
    period: Option<u32>,
    crossings: u64,
    impacts: usize,
    rms_velocity: f64,
    max_abs_x: f64,
}

const fn known(
    name: &'static str,
    regime: Regime,
    period: Option<u32>,
    counts: (u64, usize),
    rms_velocity: f64,
    max_abs_x: f64,
) -> Known {
    Known { name, regime, period, crossings: counts.0, impacts: counts.1, rms_velocity, max_abs_x }
}

use Regime::{Crossing, Interwell, Intrawell, OneWell};

/// All but the two that never repeat.
const KNOWN: [Known; 18] = [
    known("paper", Interwell, Some(1), (30, 600), 0.049_494_877_83, 0.0015),
    known("paper-table", Interwell, Some(1), (30, 600), 0.049_140_721_78, 0.0015),
    known("paper-unconstrained", Intrawell, Some(1), (0, 0), 0.017_170_973_36, 0.007_239_045_314),
    known("paper-ramp", Crossing, None, (1080, 11966), 0.052_607_007_00, 0.0015),
    known("uneven-stops", Interwell, Some(1), (30, 630), 0.051_828_258_00, 0.0017),
    known("walking", Crossing, None, (211, 2022), 0.016_279_666_40, 0.0006),
    known("random-shaking", Crossing, None, (85, 937), 0.015_280_332_87, 0.001),
    known("balanced", Interwell, Some(1), (60, 0), 0.106_992_269_4, 0.006_798_103_290),
    known("magnet", Interwell, Some(1), (60, 0), 0.123_181_595_2, 0.007_482_460_996),
    known("harvester", Interwell, Some(1), (30, 600), 0.046_627_864_30, 0.0015),
    known("nominal-cubic", Interwell, Some(1), (30, 660), 0.114_697_633_3, 0.004),
    known("monostable", OneWell, Some(1), (60, 0), 0.065_565_728_46, 0.003_591_152_840),
    known("bouncing-ball", OneWell, None, (0, 52), 0.488_221_014_7, 1.0),
    known("elastic-box", OneWell, None, (0, 25), 0.05, 0.01),
    known("duffing", Interwell, Some(5), (40, 0), 0.423_469_345_5, 1.443_458_460),
    known("duffing-cascade", Intrawell, Some(4), (0, 0), 0.427_491_292_4, 1.400_760_188_5),
    known("impact-oscillator", OneWell, Some(1), (240, 600), 0.458_346_788_6, 1.0),
    known("period-adding", Intrawell, Some(4), (0, 75), 0.182_484_741_4, 1.2),
];

/// The impacts of the whole run that are faster than 10 um/s.
fn impacts(run: &Run) -> usize {
    run.events.iter().filter(|event| event.kind == EventKind::Impact && event.v_in.abs() > 1e-5).count()
}

/// The run's statistics, once it is seen to be whole and its energy to add up.
#[track_caller]
fn whole(run: &Run, tolerance: f64) -> Summary {
    assert_eq!(run.summary.outcome, Outcome::Done);
    let ledger = run.summary.ledger.unwrap();
    assert!(ledger.energy_residual <= tolerance, "{ledger:?}");
    run.summary
}

#[test]
fn every_scene_does_what_is_recorded_of_it() {
    // The largest difference between the two tolerances was 2e-10 of an RMS velocity.
    let repeats = |name: &str| !["first-look", "duffing-chaos"].contains(&name);
    for preset_ in PRESETS.iter().filter(|preset| repeats(preset.name)) {
        let name = preset_.name;
        let known = KNOWN.iter().find(|known| known.name == name).unwrap_or_else(|| panic!("{name}"));
        for (tolerance, change) in [(1e-9, "run.tolerance=1e-9"), (1e-12, "run.tolerance=1e-12")] {
            let run = run(&preset(name, &[change]));
            let summary = whole(&run, tolerance);
            assert_eq!((summary.regime, summary.period), (known.regime, known.period), "{name}");
            assert_eq!((summary.crossings, impacts(&run)), (known.crossings, known.impacts), "{name}");
            near_relative(summary.rms_velocity.unwrap(), known.rms_velocity, 1e-9);
            near_relative(summary.max_abs_x.unwrap(), known.max_abs_x, 1e-9);
        }
    }
}

#[test]
fn the_ramp_lets_go_where_the_push_equals_the_force() {
    let model = preset("paper-ramp", &[]);
    let ramp = run(&model);
    let released = of_kind(&ramp, EventKind::Release)[0].t;
    near(released, 103.413_146_21, 1e-8);
    near(of_kind(&ramp, EventKind::Crossing)[0].t, 107.827_700_24, 1e-8);
    let push = 2.0 * released / 300.0 * (std::f64::consts::TAU * 3.0 * released).sin();
    let force = model.mechanism().curve.force(1.5e-3);
    near(push, -force / (model.mass() * STANDARD_GRAVITY), 1e-9);
}

#[test]
fn flexures_in_31_digits() {
    for name in ["paper", "uneven-stops", "random-shaking"] {
        let short = ["run.settle_s=0", "run.duration_s=4"];
        let reference = preset(name, &short);
        let request = Request { events: true, ..Default::default() };
        let reference = reference.run_reference(&request, 1e-26);
        for tolerance in [1e-6_f64, 1e-9, 1e-12] {
            let found =
                run(&preset(name, &[&short[..], &[&format!("run.tolerance={tolerance:e}")]].concat()));
            assert_eq!(
                (found.summary.crossings, impacts(&found)),
                (reference.summary.crossings, impacts(&reference))
            );
            let rms = |run: &Run| run.summary.rms_velocity.unwrap();
            near_relative(rms(&found), rms(&reference), tolerance.max(1e-13));
            let crossings = |run: &Run| of_kind(run, EventKind::Crossing);
            assert!(crossings(&found).len() == crossings(&reference).len() && !crossings(&found).is_empty());
            for (crossing, reference) in crossings(&found).iter().zip(crossings(&reference)) {
                near(crossing.t, reference.t, tolerance.max(1e-12));
            }
        }
    }
}

#[test]
fn two_models_of_one_prototype() {
    // Beams against the solid model of `paper-table`. Not the same physics: near the middle a wide strip that
    // cannot curl is stiffer by up to 1 / (1 - poisson^2); the solid model's wells lie 0.3 mm nearer to the
    // middle, so that a comparison of forces near the wells says nothing.
    let [beams, solid] = ["paper", "paper-table"].map(|name| preset(name, &[]).mechanism().clone());
    let force = |mechanism: &Mechanism, x: f64| mechanism.curve.force(x);
    let most = |reach: i32, mechanism: &Mechanism| {
        let apart = (0..=reach).map(|i| f64::from(i) * 1e-5).map(|x| force(mechanism, x) - force(&solid, x));
        apart.fold(0.0_f64, |most, apart| most.max(apart.abs()))
    };
    near(most(550, &beams), 12.9e-3, 2e-4);
    // Strips that cannot curl at all: within 5 mN as far as 2 mm.
    let wide = preset("paper", &["mechanism.plane_strain=true"]).mechanism().clone();
    near(most(200, &wide), 4.8e-3, 2e-4);
    let barrier = |mechanism: &Mechanism| mechanism.landscape.barrier.unwrap().from_right_j;
    near_relative(barrier(&beams), barrier(&solid), 0.015);
    let hardest =
        |mechanism: &Mechanism| mechanism.landscape.extrema.iter().fold(0.0_f64, |most, e| most.max(e.force));
    near_relative(hardest(&beams), hardest(&solid), 0.04);
    let kink = |mechanism: &Mechanism| mechanism.landscape.kinks.last().unwrap().x;
    near(kink(&beams), kink(&solid), 1e-6);
    // The least shaking, in steps of 0.01 g, that frees the mass and that carries it across.
    for (limit, beams, solid) in [
        (1.0, [0.48, 0.49], [0.54, 0.56]),
        (1.5, [0.69, 0.72], [0.77, 0.80]),
        (2.0, [0.89, 0.93], [0.97, 1.02]),
        (3.0, [1.19, 1.26], [1.27, 1.35]),
        (4.0, [1.32, 1.45], [1.37, 1.51]),
        (5.0, [1.24, 1.47], [1.21, 1.48]),
    ] {
        for (name, [frees, crosses]) in [("paper", beams), ("paper-table", solid)] {
            let at = |amplitude: f64| {
                let limit = format!("stops.travel_limit_mm={limit}");
                run(&preset(name, &[&limit, &format!("excitation.amplitude_g={amplitude}")])).summary
            };
            assert_eq!((at(frees - 0.01).releases, at(crosses - 0.01).crossings), (0, 0), "{name} {limit}");
            assert!(at(frees).releases > 0 && at(crosses).crossings > 0, "{name} {limit}");
        }
        for i in 0..2 {
            near_relative(beams[i], solid[i], 0.13);
        }
    }
}

#[test]
fn the_walk_is_the_formula_of_its_header() {
    use std::f64::consts::TAU;
    let text = interwell::scene::TABLES.iter().find(|table| table.name == "walking.csv").unwrap().text;
    let mut count = 0;
    for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let (t, accel) = line.split_once(',').unwrap();
        let (t, accel): (f64, f64) = (t.parse().unwrap(), accel.parse().unwrap());
        let p = TAU * (2.0 * t + 2.0 * 0.02 * 11.0 / TAU * (1.0 - (TAU * t / 11.0).cos()));
        let w = ((t - 2.0) / 2.0).min((58.0 - t) / 2.0).clamp(0.0, 1.0);
        let steps = 0.4 * p.sin() - 0.1 * (2.0 * p).cos() - 0.1 * (3.0 * p).cos();
        let sides = 0.014 * (p / 2.0).sin() + 0.040 * (1.5 * p).sin();
        near(accel, STANDARD_GRAVITY * w * (steps + sides), 0.5001e-4);
        count += 1;
    }
    assert_eq!(count, 6001);
}
