//! Stops at 0 and on one side of it, against closed forms.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{EventKind, Model, Regime, STANDARD_GRAVITY, Side};
use interwell::mechanics::Mechanism as Built;
use interwell::scene::{Damping, Excitation, Files, Mechanism, Scene, Start, Stops};
use interwell_studies::study::{Onset, Scan, Task, can_cross, inspect, threshold, thresholds};

use super::scenes::*;
use crate::support::{Draw, near};

fn between(left_mm: Option<f64>, right_mm: Option<f64>, restitution: f64) -> Stops {
    Stops::Uneven { left_mm, right_mm, restitution_left: Some(restitution), restitution_right: None }
}

fn linear(n_per_m: f64) -> Mechanism {
    Mechanism::Linear { n_per_m }
}

#[test]
fn a_stop_at_0_halves_the_period_of_a_spring() {
    // a half sine from the stop and back, without loss
    let mut draw = Draw(3);
    for mirrored in [false, true] {
        let (w, x) = (draw.between(0.5, 40.0), draw.between(-0.2, 1.5));
        let side = if mirrored { -1.0 } else { 1.0 };
        let (mass_g, v) = (draw.between(1.0, 2000.0), draw.between(0.1, 2.0));
        let mut s =
            scene(linear(mass_g / 1e3 * w * w), at(side * x.max(0.0) * 1e3 + 0.0, side * v), 20.0 * PI / w);
        s.mass_g = mass_g;
        s.stops = if mirrored { right_stop(0.0, 1.0) } else { left_stop(-0.0, 1.0) };
        let r = model(&s).run(&full(&dense(s.run.duration_s, 700)));
        // x = R sin(w (T - t)) with R sin(w T) = x
        let (radius, first) = (x.max(0.0).hypot(v / w), (PI - (w * x.max(0.0)).atan2(v)) / w);
        assert!(r.events.iter().all(|e| e.kind == EventKind::Impact), "{:?}", r.events);
        assert!((19..=20).contains(&r.events.len()));
        for (i, e) in r.events.iter().enumerate() {
            near(e.t, first + i as f64 * PI / w, 1e-11 / w);
            near(-side * e.v_in, radius * w, 1e-11 * radius * w);
            assert_eq!(e.v_out, -e.v_in);
        }
        for sample in &r.samples {
            near(side * sample.x, radius * (w * (sample.t - first)).sin().abs(), 2e-11 * radius);
            assert!(side * sample.x >= 0.0 && !(sample.x == 0.0 && sample.x.is_sign_negative()));
        }
        assert_eq!((r.summary.total_crossings, r.summary.regime), (0, Regime::OneWell));
    }
}

/// One impact: its time and the speeds before and after it.
type Hit = (f64, f64, f64);

/// Impacts of m x'' = -k x - m a between a left and a right stop in m: arcs of a sine about the equilibrium,
/// each cut at a stop that is found by bisection between two turning points. Up to the first gentle impact.
fn arcs((w, a): (f64, f64), stops: [f64; 2], restitution: f64, start: (f64, f64), end: f64) -> Vec<Hit> {
    let (middle, mut state, mut t) = (-a / (w * w), start, 0.0);
    let mut hits = Vec::new();
    loop {
        // x = middle + R cos(phase + w t)
        let (out, speed) = (state.0 - middle, state.1 / w);
        let (radius, phase) = (out.hypot(speed), (-speed).atan2(out));
        let x = |t: f64| middle + radius * (phase + w * t).cos();
        let mut from = 0.0;
        let hit = (0..4).find_map(|i| {
            // the turning points after now: the phases 0, pi, 2 pi and so on
            let next = ((phase / PI).floor() + 1.0 + f64::from(i)) * PI;
            let to = (next - phase) / w;
            let stop = if next / PI % 2.0 == 0.0 { stops[1] } else { stops[0] };
            let beyond = |t: f64| (x(t) - stop) * (x(to) - middle) > 0.0;
            let (mut low, mut high) = (std::mem::replace(&mut from, to), to);
            if !beyond(high) {
                return None;
            }
            for _ in 0..200 {
                let half = 0.5 * (low + high);
                *(if beyond(half) { &mut high } else { &mut low }) = half;
            }
            Some((high, stop))
        });
        let Some((after, stop)) = hit else { return hits };
        t += after;
        let v_in = -radius * w * (phase + w * after).sin();
        if t > end || v_in.abs() < 0.02 * radius * w {
            return hits;
        }
        hits.push((t, v_in, -restitution * v_in));
        state = (stop, -restitution * v_in);
    }
}

#[test]
fn a_spring_strikes_stops_anywhere_as_arcs_of_a_sine_do() {
    let mut draw = Draw(17);
    let mut seen = 0;
    for case in 0..60 {
        let (mass, w) = (draw.between(0.01, 2.0), draw.between(1.0, 30.0));
        let (place, room) = (draw.between(-1.0, 1.0), draw.between(0.2, 1.2));
        let (low, high) = match case % 4 {
            0 => (place, f64::INFINITY),
            1 => (f64::NEG_INFINITY, place),
            2 => (0.0, room),
            _ => (place, place + room),
        };
        let (restitution, a) = (draw.between(0.5, 1.0), w * w * draw.between(-0.3, 0.3));
        let (from, to) = (low.max(high.min(1.0) - 1.5), high.min(low.max(-1.0) + 1.5));
        let start = (draw.between(from, to), w * draw.between(-1.0, 1.0));
        let mut s = scene(linear(mass * w * w), at(start.0 * 1e3, start.1), 6.0 * TAU / w);
        s.mass_g = mass * 1e3;
        let distance = |x: f64| x.is_finite().then_some(x * 1e3);
        s.stops = between(distance(-low), distance(high), restitution);
        s.excitation = constant(a);
        let m = model(&s);
        let stops = [m.stop_positions().0.unwrap_or(low), m.stop_positions().1.unwrap_or(high)];
        let exact = arcs((w, a), stops, restitution, m.start(), s.run.duration_s);
        let events = m.run(&full(&[])).events;
        let impacts: Vec<_> = events.iter().filter(|e| e.kind == EventKind::Impact).collect();
        assert!(impacts.len() >= exact.len(), "{} of {} in {s:?}", impacts.len(), exact.len());
        // an error grows from impact to impact
        for (found, (t, v_in, v_out)) in impacts.iter().zip(&exact) {
            near(found.t, *t, 1e-8 / w);
            near(found.v_in, *v_in, 1e-8 * w);
            near(found.v_out, *v_out, 1e-8 * w);
        }
        seen += exact.len();
    }
    assert!(seen > 400, "{seen}");
}

#[test]
fn a_mass_rests_on_the_right_unless_it_is_not_held_there() {
    let well = || Mechanism::DoubleWell { equilibrium_mm: 7.0, barrier_mj: 0.5 };
    // stable at 0, and from 10 mm on to either side the force leads away
    let soft = || polynomial(&[0.0, 1.0, 0.0, -1e4]);
    for (mechanism, left, right, rest_mm) in [
        (well(), None, Some(0.0), Some(-7.0)),
        (well(), None, Some(-1.0), Some(-7.0)),
        (well(), Some(5.0), Some(-1.0), Some(-5.0)),
        (well(), Some(5.0), Some(1.0), Some(1.0)),
        (well(), Some(-1.0), Some(3.0), Some(3.0)),
        (well(), Some(0.0), None, Some(7.0)),
        (well(), Some(-9.0), Some(12.0), Some(9.0)),
        (well(), Some(9.0), Some(-8.0), Some(-8.0)),
        (linear(4.0), None, Some(-1.0), Some(-1.0)),
        (linear(4.0), Some(-2.0), None, Some(2.0)),
        (linear(4.0), Some(0.0), None, Some(0.0)),
        (linear(4.0), None, Some(0.0), Some(0.0)),
        (soft(), Some(-12.0), Some(20.0), Some(20.0)),
        (soft(), Some(-12.0), None, None),
        (soft(), None, Some(-12.0), None),
    ] {
        let mut s = scene(mechanism, Start::Rest, 1.0);
        s.stops = between(left, right, 0.5);
        let built = Arc::new(Built::build(&s.mechanism, &Files::default()).unwrap());
        match (rest_mm, Model::build(&s, built)) {
            (Some(mm), Ok(model)) => {
                near(model.start().0, mm / 1e3, 1e-15);
                let end = model.run(&full(&[])).summary.final_x;
                near(end, mm / 1e3, 1e-12);
                assert!(end != 0.0 || end.is_sign_positive());
            }
            (None, Err(faults)) => {
                assert!(faults[0].problem.contains("rests nowhere between the stops"), "{faults:?}");
            }
            (expected, found) => panic!("{left:?} {right:?}: {expected:?} {found:?}"),
        }
    }
}

/// A spring of stiffness k m w0^2 pressed on a stop at the distance s beyond its equilibrium, on a side.
fn pressed(mass: f64, k: f64, s: f64, right: bool, amplitude: f64, frequency: f64) -> Scene {
    let mut pressed = scene(linear(k), Start::Rest, 3.0 / frequency);
    pressed.mass_g = mass * 1e3;
    pressed.damping = Damping::Ratio(0.1);
    pressed.stops = match right {
        true => right_stop(-s * 1e3, 0.3),
        false => left_stop(-s * 1e3, 0.3),
    };
    pressed.excitation = sine(frequency, amplitude, 0.0);
    pressed
}

#[test]
fn a_spring_leaves_a_stop_beyond_its_equilibrium_when_the_push_is_its_force() {
    let mut draw = Draw(5);
    let (never, files) = (AtomicBool::new(false), Files::default());
    for case in 0..12 {
        let (mass, k, s) = (draw.between(0.01, 1.0), draw.between(1.0, 100.0), draw.between(0.01, 0.3));
        let (right, frequency) = (case % 2 == 0, draw.between(0.2, 3.0));
        let holds = k * s / mass;
        let amplitude = holds * draw.between(1.1, 3.0);
        let free = pressed(mass, k, s, right, amplitude, frequency);
        let events = run(&free).events;
        let release = events.iter().find(|e| e.kind == EventKind::Release).unwrap();
        // the base has to accelerate to the right to leave a right stop behind
        let turn = (holds / amplitude).asin() / TAU + if right { 0.0 } else { 0.5 };
        near(release.t, turn / frequency, 1e-10 / frequency);
        assert_eq!(release.side, if right { Side::Right } else { Side::Left });
        let held = run(&pressed(mass, k, s, right, 0.99 * holds, frequency)).summary;
        assert_eq!((held.regime, held.rested_share), (Regime::OneWell, Some(1.0)));
        // in closed form for the right stop, by a scan for the left one
        let (exact, mechanism) = (holds / STANDARD_GRAVITY, model(&free).mechanism().clone());
        let values = (1..=8).map(|i| exact * 0.25 * f64::from(i) + 1e-3 * exact).collect();
        let scan = Scan {
            field: "excitation.amplitude_g".into(),
            values,
            resolution: 1e-4 * exact,
            until_settled: None,
        };
        let task = Task { tick: &|| (), cancel: &never };
        let found = threshold(&free, &mechanism, &files, &scan, Onset::Release, &task).unwrap();
        near(found.value.unwrap(), exact, if right { 1e-12 } else { 1.01e-4 } * exact);
    }
}

#[test]
fn nothing_crosses_a_barrier_that_is_not_between_the_stops() {
    let (never, wells) =
        (AtomicBool::new(false), Mechanism::DoubleWell { equilibrium_mm: 7.0, barrier_mj: 0.5 });
    let task = Task { tick: &|| (), cancel: &never };
    for (left, right, crosses) in [
        (Some(-1.0), Some(9.0), false),
        (Some(0.0), Some(9.0), false),
        (Some(0.001), Some(9.0), true),
        (Some(9.0), Some(0.0), false),
        (None, Some(-2.0), false),
        (None, Some(2.0), true),
    ] {
        let shaken = Excitation::Sine { frequency_hz: 5.0, amplitude_g: 5.0, phase_deg: 0.0 };
        let mut s = scene(wells.clone(), Start::Rest, 8.0);
        (s.mass_g, s.damping, s.excitation) = (15.0, Damping::Ratio(0.02), shaken);
        s.stops = between(left, right, 0.4);
        let model = model(&s);
        let summary = model.run(&full(&[])).summary;
        assert!(summary.total_impacts > 0);
        assert_eq!(summary.total_crossings > 0, crosses, "{left:?} {right:?} {summary:?}");
        assert_eq!(can_cross(&s, model.mechanism()), crosses);
        let words = inspect(&s, &model).join("\n");
        assert_eq!(words.contains("the barrier does not lie between the stops"), !crosses, "{words}");
        if !crosses {
            assert_eq!(thresholds(&s, model.mechanism(), &task), None);
            assert_eq!(summary.regime, Regime::Intrawell);
        }
    }
}

#[test]
fn a_stop_on_a_break_of_the_curve_belongs_to_the_side_of_the_mass() {
    use interwell::scene::ForcePiece;
    // 50 N/m left of x = b and 80 N/m right of it; from the stop on b each side is a spring about b
    for (b, right) in [(-2e-3, true), (-2e-3, false), (0.0, true), (0.0, false), (2e-3, true), (2e-3, false)]
    {
        let piece = |k| ForcePiece { origin_m: b, coefficients_si: vec![0.0, k] };
        let ends_m = vec![f64::NEG_INFINITY, b, f64::INFINITY];
        let mechanism = Mechanism::Pieces { ends_m, pieces: vec![piece(50.0), piece(80.0)], error_n: 0.0 };
        let (k, side) = if right { (50.0_f64, -1.0) } else { (80.0, 1.0) };
        let mut s = scene(mechanism, at(b * 1e3, side * 0.3), 1.0);
        s.stops = if right { right_stop(b * 1e3, 1.0) } else { left_stop(-b * 1e3, 1.0) };
        let events = run(&s).events;
        let half = PI / k.sqrt();
        assert_eq!(events.len(), (1.0 / half) as usize, "{b} {right}");
        for (i, e) in events.iter().enumerate() {
            near(e.t, (i + 1) as f64 * half, 1e-11);
        }
    }
}
