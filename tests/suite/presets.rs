//! Does every built-in scene do what its notes say?
//!
//! The recorded digits are those on which runs at tolerances of 1e-9 and 1e-12 agree. Impacts are counted where
//! they are faster than 10 um/s: how many slower ones are located before the rest of a chatter is summed
//! depends on the tolerance.

use interwell::dynamics::{EventKind, Outcome, Regime, Run, STANDARD_GRAVITY, Side, Summary};
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

use Regime::{Interwell, Intrawell, Irregular, OneWell};

/// All but the two that never repeat.
const KNOWN: [Known; 13] = [
    known("paper", Interwell, Some(1), (30, 600), 0.049_140_721_78, 0.0015),
    known("paper-table", Interwell, Some(1), (30, 600), 0.049_140_721_78, 0.0015),
    known("paper-unconstrained", Intrawell, Some(2), (0, 0), 0.017_347_687_64, 0.007_238_817_224),
    known("paper-ramp", Interwell, None, (1080, 11334), 0.052_495_015_78, 0.0015),
    known("uneven-stops", Interwell, Some(1), (30, 630), 0.051_103_902_06, 0.0017),
    known("walking", Irregular, None, (209, 2004), 0.016_094_163_80, 0.0006),
    known("random-shaking", Irregular, None, (48, 552), 0.011_658_824_57, 0.001),
    known("nominal-cubic", Interwell, Some(1), (30, 660), 0.114_697_633_3, 0.004),
    known("monostable", OneWell, Some(1), (60, 0), 0.065_565_728_46, 0.003_591_152_840),
    known("bouncing-ball", OneWell, None, (0, 52), 0.488_221_014_7, 1.0),
    known("elastic-box", OneWell, None, (0, 25), 0.05, 0.01),
    known("duffing", Interwell, Some(5), (40, 0), 0.423_469_345_5, 1.443_458_460),
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

fn summary(name: &str, changes: &[&str]) -> Summary {
    whole(&run(&preset(name, changes)), 1e-9)
}

/// Drive of the unit well as base motion in g.
fn drive(amplitude: f64) -> String {
    format!("excitation.amplitude_g={:?}", amplitude / STANDARD_GRAVITY)
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
            let own = whole(&run, tolerance);
            assert_eq!((own.regime, own.period), (known.regime, known.period), "{name}");
            assert_eq!((own.crossings, impacts(&run)), (known.crossings, known.impacts), "{name}");
            near_relative(own.rms_velocity.unwrap(), known.rms_velocity, 1e-9);
            near_relative(own.max_abs_x.unwrap(), known.max_abs_x, 1e-9);
        }
    }
}

#[test]
fn the_first_look_needs_help_to_cross() {
    // It rattles without an exact rhythm: over seven lengths, settled windows and tolerances the RMS velocity was 17.0
    // to 17.5 mm/s.
    let own = summary("first-look", &[]);
    assert_eq!((own.regime, own.total_crossings, own.impacts), (Intrawell, 0, 0));
    near(own.rms_velocity.unwrap(), 0.0172, 0.0006);
    near(own.max_abs_x.unwrap(), 7.275e-3, 8e-6);
    near(own.max_abs_x.unwrap() - own.travel.unwrap(), 5.649e-3, 1e-5);
    assert_eq!(summary("first-look", &["excitation.amplitude_g=1.3"]).regime, Irregular);
    let at = |limit: f64| {
        let stops = format!("stops=Rigid(travel_limit_mm: {limit}, restitution: 0.36)");
        summary("first-look", &[&stops])
    };
    let stopped = at(1.5);
    assert_eq!((stopped.regime, stopped.period, stopped.crossings), (Interwell, Some(1), 60));
    near_relative(stopped.rms_velocity.unwrap(), 0.047_933_411, 1e-7);
    assert!(at(1.8).rms_velocity > stopped.rms_velocity && at(1.9).rms_velocity < at(1.8).rms_velocity);
    assert!(at(1.95).regime == Intrawell && at(1.95).releases > 0);
    assert_eq!(at(2.1).regime, Regime::Rest);
}

#[test]
fn chaos_has_averages_that_hold() {
    // The window's 900 periods are one sample of the motion. Over 21 starts the RMS velocity was 0.510 to 0.523,
    // the crossings were 630 to 651; the bounds are some twice as wide.
    let mut finals = Vec::new();
    for change in ["run.tolerance=1e-9", "start.x_mm=1000.000001", "start.x_mm=900", "start.x_mm=1070"] {
        let own = summary("duffing-chaos", &[change]);
        assert_eq!((own.regime, own.period, own.impacts), (Regime::Irregular, None, 0));
        near(own.rms_velocity.unwrap(), 0.5165, 0.013);
        near(own.crossings as f64, 640.0, 25.0);
        near(own.max_abs_x.unwrap(), 1.5363, 0.002);
        finals.push((own.final_x, own.final_v));
    }
    // A millionth of a millimetre: together for some fifteen periods, then apart for good.
    let period = std::f64::consts::TAU / 1.2;
    let strobes = every(period, 60);
    let path =
        |change: &str| run_at(&preset("duffing-chaos", &[change, "run.duration_s=600"]), &strobes).samples;
    let (a, b) = (path("start.x_mm=1000"), path("start.x_mm=1000.000001"));
    let apart: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a.x - b.x).abs()).collect();
    assert!(apart[..13].iter().all(|apart| *apart < 0.01), "{apart:?}");
    assert!(apart[13..30].iter().any(|apart| *apart > 0.1), "{apart:?}");
    assert_ne!(finals[0], finals[1]);
}

#[test]
fn the_older_scenes_do_what_their_notes_say() {
    // paper: rattles without stops; the least shaking that crosses from rest, in steps of 0.01 g, is below the
    // 1.24 g of the unstopped prototype with stops at 2.6 mm and above it from 2.65 mm to 7 mm.
    let paper = |stops: &str, amplitude: f64| {
        summary("paper", &[stops, &format!("excitation.amplitude_g={amplitude}")])
    };
    assert_eq!(paper("stops=None", 1.0).regime, Regime::Intrawell);
    assert_eq!(paper("stops=None", 1.23).total_crossings, 0);
    assert!(paper("stops=None", 1.24).total_crossings > 0);
    assert_eq!(paper("stops.travel_limit_mm=2.6", 1.23).regime, Regime::Interwell);
    for limit in [2.65, 3.0, 4.0, 5.0, 6.0, 6.5, 7.0] {
        let crossings = paper(&format!("stops.travel_limit_mm={limit}"), 1.24).total_crossings;
        assert_eq!(crossings, 0, "{limit}");
    }
    // nominal-cubic: impacts above 1 um/s in ten seconds, at any tolerance
    for change in ["run.tolerance=1e-9", "run.tolerance=1e-12"] {
        let run = run(&preset("nominal-cubic", &[change]));
        let faster = of_kind(&run, EventKind::Impact).iter().filter(|event| event.v_in.abs() > 1e-6).count();
        assert_eq!(faster, 780);
    }
    // elastic-box: the first wall, and what is lost at a restitution of 0.9
    near(run(&preset("elastic-box", &[])).events[0].t, 0.2, 1e-15);
    let lossy = run(&preset("elastic-box", &["stops.restitution=0.9", "run.duration_s=0.5"]));
    near_relative(lossy.events[0].v_out.powi(2) / lossy.events[0].v_in.powi(2), 0.81, 1e-14);
    // duffing: over and back once in five periods
    assert_eq!(summary("duffing", &[]).crossings, 100 / 5 * 2);
}

#[test]
fn without_stops_the_prototype_rattles_up_to_1_23_g() {
    let own = summary("paper-unconstrained", &[]);
    near(own.max_abs_x.unwrap() - own.travel.unwrap(), 5.437_31e-3, 1e-8);
    for hundredths in (4..=123).step_by(7) {
        let change = format!("excitation.amplitude_g={}", f64::from(hundredths) / 100.0);
        assert_eq!(summary("paper-unconstrained", &[&change]).total_crossings, 0, "{change}");
    }
    let crosses = run(&preset("paper-unconstrained", &["excitation.amplitude_g=1.24"]));
    assert!(crosses.events.iter().any(|event| event.kind == EventKind::Crossing && event.t < 10.0));
    let lucky = summary("paper-unconstrained", &["excitation.amplitude_g=1.39"]);
    assert_eq!((lucky.regime, lucky.period), (Regime::Interwell, Some(1)));
    near_relative(lucky.rms_velocity.unwrap(), 0.216, 0.01);
    near(lucky.max_abs_x.unwrap(), 7.873e-3, 1e-5);
}

#[test]
fn the_ramp_frees_then_hops_then_crosses() {
    let ramp = run(&preset("paper-ramp", &[]));
    let of = |kind| ramp.events.iter().filter(move |event| event.kind == kind).map(|event| event.t);
    let amplitude = |t: f64| 2.0 * t / 300.0;
    let released = of(EventKind::Release).next().unwrap();
    let crossed = of(EventKind::Crossing).next().unwrap();
    near(released, 114.746_314_89, 1e-8);
    near(crossed, 119.483_663_13, 1e-8);
    near(amplitude(released), 0.765, 5e-4);
    near(amplitude(crossed), 0.7966, 5e-5);
    assert_eq!(of(EventKind::Release).filter(|t| *t < crossed).count(), 14 + 1);
    // It is let go where the push of the base equals the force of the table at 1.5 mm.
    let push = amplitude(released) * (std::f64::consts::TAU * 3.0 * released).sin();
    near(push, 0.113_753_078_146_880 / (0.0152 * STANDARD_GRAVITY), 1e-9);
    near(push, 0.763, 5e-4);
    // Twice in every one of the 540 periods of the window.
    assert_eq!(ramp.summary.crossings, 2 * 540);
    let open = run(&preset("paper-ramp", &["stops=None"]));
    let crossed = of_kind(&open, EventKind::Crossing)[0].t;
    near(crossed, 186.46, 0.005);
    near(amplitude(crossed), 1.243, 5e-4);
    assert_eq!(open.summary.regime, Regime::Irregular);
}

#[test]
fn stops_only_take_from_one_well() {
    let stopped = summary("monostable", &["stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)"]);
    near_relative(stopped.rms_velocity.unwrap(), 0.041_681_004, 1e-7);
    near_relative(stopped.impact_share.unwrap(), 0.924_629_81, 1e-7);
    for (frequency, swing) in [(12.75, 10.967e-3), (13.0, 2.604e-3)] {
        let change = format!("excitation.frequency_hz={frequency}");
        near(summary("monostable", &[&change]).max_abs_x.unwrap(), swing, 1e-6);
    }
}

#[test]
fn unequal_stops_rebound_differently() {
    let uneven = run(&preset("uneven-stops", &[]));
    // the first impact after each crossing, once settled
    let landings: Vec<_> = uneven
        .events
        .windows(2)
        .filter(|pair| pair[0].t > 5.0 && pair[0].kind == EventKind::Crossing)
        .map(|pair| pair[1])
        .collect();
    assert!(landings.len() >= 29);
    for landing in landings {
        let (v_in, v_out) =
            if landing.side == Side::Left { (-0.229_841, 0.075_848) } else { (0.247_098, -0.096_368) };
        near(landing.v_in, v_in, 1e-6);
        near(landing.v_out, v_out, 1e-6);
    }
    for (right, regime, released) in [
        (1.95, Regime::Interwell, true),
        (2.0, Regime::Intrawell, true),
        (2.1, Regime::Rest, false),
        (2.5, Regime::Rest, false),
    ] {
        let own = summary("uneven-stops", &[&format!("stops.right_mm={right}")]);
        assert_eq!((own.regime, own.releases > 0), (regime, released), "{right}");
    }
}

#[test]
fn a_walk_crosses_over_and_back_in_every_step() {
    let walk = run(&preset("walking", &[]));
    // the count of steps as the record's header has it
    let step = |t: f64| {
        let wander = 0.04 * 11.0 / std::f64::consts::TAU * (1.0 - (std::f64::consts::TAU * t / 11.0).cos());
        (2.0 * t + wander).floor() as usize
    };
    let mut crossings = [0; 120];
    for event in of_kind(&walk, EventKind::Crossing) {
        crossings[step(event.t)] += 1;
    }
    // full pace from 4 to 56 s
    assert_eq!((step(4.0), step(56.0)), (8, 112));
    assert!(crossings[8..112].iter().all(|count| *count == 2), "{crossings:?}");

    let open = summary("walking", &["stops=None"]);
    assert_eq!(open.total_crossings, 0);
    near_relative(open.rms_velocity.unwrap(), 0.005_491_276, 1e-6);
    assert_eq!(summary("walking", &["stops.travel_limit_mm=0.8"]).total_crossings, 1);
    assert_eq!(summary("walking", &["stops.travel_limit_mm=1.5"]).regime, Regime::Rest);
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

#[test]
fn random_shaking_crosses_only_with_stops_until_it_is_strong() {
    let mut largest = [(0, 0); 2];
    for seed in 1..=8 {
        let seed = format!("excitation.seed={seed}");
        let stopped = summary("random-shaking", &[&seed]);
        assert!((48..=64).contains(&stopped.crossings), "{seed}: {}", stopped.crossings);
        let open = summary("random-shaking", &[&seed, "stops=None"]);
        assert_eq!((open.regime, open.total_crossings), (Regime::Intrawell, 0), "{seed}");

        // at 0.5 g the unstopped runs are chaotic for a while: bounds, not digits
        let hard = [&seed[..], "excitation.rms_g=0.5"];
        let (stopped, open) = (
            summary("random-shaking", &hard),
            summary("random-shaking", &[&hard[..], &["stops=None"]].concat()),
        );
        for (run, largest) in [stopped, open].iter().zip(&mut largest) {
            *largest =
                (largest.0.max(run.crossings), largest.1.max((run.rms_velocity.unwrap() * 1e3) as u64));
        }
        assert!(open.crossings >= 1 && stopped.crossings > 3 * open.crossings);
        assert!(open.rms_velocity > stopped.rms_velocity);
    }
    assert_eq!(largest[0], (192, 25));
    assert!((30..=45).contains(&largest[1].0) && (65..=85).contains(&largest[1].1), "{largest:?}");
}

#[test]
fn just_above_grazing_periods_add() {
    let long = ["run.duration_s=5235.987755982988", "run.settle_s=4188.790204786391"];
    let at = |amplitude: f64, more: &[&str]| {
        let amplitude = drive(amplitude);
        run(&preset("period-adding", &[&long[..], &[&amplitude], more].concat()))
    };
    // the smooth orbit reaches the stop between these
    near(at(0.12356, &["stops=None"]).summary.max_abs_x.unwrap(), 1.2, 1e-4);
    assert_eq!(at(0.12356, &[]).summary.impacts, 0);
    assert!(at(0.12358, &["stops=None"]).summary.max_abs_x.unwrap() > 1.2);
    // one impact in every k periods, ever lighter towards grazing
    for (amplitude, period, speed) in [
        (0.1236, 6, 0.006_163),
        (0.1240, 5, 0.021_636),
        (0.1250, 4, 0.033_554),
        (0.1300, 3, 0.068_037),
        (0.1600, 2, 0.169_720),
        (0.1900, 1, 0.143_308),
    ] {
        let run = at(amplitude, &[]);
        assert_eq!(run.summary.period, Some(period), "{amplitude}");
        near(run.summary.impacts as f64, 200.0 / f64::from(period), 1.0);
        near(of_kind(&run, EventKind::Impact).last().unwrap().v_in, speed, 1e-6);
    }
}
