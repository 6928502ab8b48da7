//! Starts on stops, touches, plastic and elastic impacts, narrow gaps.

use interwell::dynamics::{EventKind, Outcome, Phase, Regime, Run, Side};
use interwell::scene::Excitation;

use super::scenes::*;
use crate::properties::sound::assert_sound;

fn kinds(run: &Run) -> Vec<(EventKind, Side)> {
    run.events.iter().map(|e| (e.kind, e.side)).collect()
}

#[test]
fn a_start_on_a_stop_moving_outward_is_an_impact_at_0() {
    // free mass, stops at +-1 m, e = 0.5: hits at 0, and the other stop 2/0.5 = 4 s later
    let mut s = scene(polynomial(&[0.0]), at(1000.0, 1.0), 5.0);
    s.stops = rigid(1000.0, 0.5);
    let r = run(&s);
    assert_eq!(kinds(&r), [(EventKind::Impact, Side::Right), (EventKind::Impact, Side::Left)]);
    assert_eq!((r.events[0].t, r.events[0].v_in, r.events[0].v_out), (0.0, 1.0, -0.5));
    assert!((r.events[1].t - 4.0).abs() < 1e-14);
    assert!((r.summary.final_x - (-1.0 + 0.25)).abs() < 1e-14);
}

#[test]
fn a_start_on_a_stop_moving_inward_or_pulled_inward_is_no_event() {
    let mut s = scene(polynomial(&[0.0]), at(-1000.0, 0.25), 4.0);
    s.stops = rigid(1000.0, 0.5);
    let r = run(&s);
    assert!(r.events.is_empty(), "{:?}", r.events);
    assert!(r.summary.final_x.abs() < 1e-15);
    // pulled: F = +2 N accelerates to the left, off the right stop
    let mut s = scene(polynomial(&[2.0]), at(1000.0, 0.0), 1.0);
    s.stops = right_stop(1000.0, 0.5);
    let r = run(&s);
    assert!(r.events.is_empty(), "{:?}", r.events);
    assert!(r.summary.final_x.abs() < 1e-15 && (r.summary.final_v + 2.0).abs() < 1e-15);
}

#[test]
fn a_start_pressed_on_a_stop_is_a_rest_at_0() {
    let mut s = scene(polynomial(&[2.0]), at(-1000.0, 0.0), 1.0);
    s.stops = rigid(1000.0, 0.5);
    let r = run(&s);
    assert_eq!(kinds(&r), [(EventKind::Rest, Side::Left)]);
    assert_eq!((r.events[0].t, r.events[0].v_in, r.events[0].v_out), (0.0, 0.0, 0.0));
    assert_eq!((r.summary.final_x, r.summary.regime), (-1.0, Regime::OneWell));
    assert_eq!(r.summary.rested_share, Some(1.0));
}

#[test]
fn a_plastic_impact_that_is_not_pressed_leaves_at_once() {
    // x'' = -x from x = 0 at 1 m/s meets a stop at 0.5 m at t = pi/6 and swings back from there at rest
    let mut s = scene(polynomial(&[0.0, 1.0]), at(0.0, 1.0), 3.0);
    s.stops = right_stop(500.0, 0.0);
    let r = run(&s);
    let hit = r.events.iter().find(|e| e.kind == EventKind::Impact).unwrap();
    let t = std::f64::consts::FRAC_PI_6;
    assert!((hit.t - t).abs() < 1e-12 && (hit.v_in - t.cos()).abs() < 1e-12 && hit.v_out == 0.0);
    assert!(r.events.iter().all(|e| e.kind != EventKind::Rest), "{:?}", r.events);
    assert!((r.summary.final_x - 0.5 * (3.0 - t).cos()).abs() < 1e-11, "{:e}", r.summary.final_x);
}

#[test]
fn a_plastic_impact_that_is_pressed_rests_at_the_same_instant() {
    let mut s = scene(polynomial(&[9.81]), at(0.0, 0.0), 2.0);
    s.stops = left_stop(1000.0, 0.0);
    let r = run(&s);
    assert_eq!(kinds(&r), [(EventKind::Impact, Side::Left), (EventKind::Rest, Side::Left)]);
    let fall = (2.0_f64 / 9.81).sqrt();
    assert!((r.events[0].t / fall - 1.0).abs() < 1e-14 && r.events[0].t == r.events[1].t);
    assert!(r.events[0].v_out == 0.0 && r.events[0].v_out.is_sign_positive());
    assert!((r.summary.rested_share.unwrap() - (2.0 - fall) / 2.0).abs() < 1e-14);
}

#[test]
fn the_ball_never_falls_through_the_floor() {
    let mut s = scene(polynomial(&[9.81]), at(0.0, 0.0), 40.0);
    s.stops = left_stop(1000.0, 0.97);
    let times = dense(40.0, 40_000);
    let m = model(&s);
    let r = m.run(&full(&times));
    assert_eq!((r.samples.len(), r.summary.outcome), (times.len(), Outcome::Done));
    assert_sound(&s, &m, &r, 1.0);
    assert!(r.summary.total_impacts > 300 && r.summary.chatter_sums == 1, "{:?}", r.summary);
    assert_eq!(r.samples.last().unwrap().phase, Phase::LeftStop);
}

#[test]
fn an_excursion_of_a_tenth_of_a_nanometre_inside_a_step_is_an_impact() {
    // x = sin t passes 1 - 1e-10 at the speed sqrt(2e-10); a step spans a good part of the half wave
    let mut s = scene(polynomial(&[0.0, 1.0]), at(0.0, 1.0), 3.0);
    s.stops = right_stop(1000.0 * (1.0 - 1e-10), 1.0);
    let r = run(&s);
    let hits: Vec<_> = r.events.iter().filter(|e| e.kind == EventKind::Impact).collect();
    assert_eq!(hits.len(), 1, "{:?}", r.events);
    assert!((hits[0].v_in / 2e-10_f64.sqrt() - 1.0).abs() < 1e-3, "{:e}", hits[0].v_in);
}

#[test]
fn grazing_a_stop_neither_loops_nor_bends_the_orbit() {
    for (beyond, impacts) in [(1e-12, 0..=0), (0.0, 0..=1), (-1e-12, 1..=1)] {
        let mut s = scene(polynomial(&[0.0, 1.0]), at(0.0, 1.0), 3.0);
        s.run.tolerance = 1e-14;
        s.stops = right_stop(1000.0 * (1.0 + beyond), 1.0);
        let m = model(&s);
        let r = m.run(&full(&[]));
        assert_eq!(r.summary.outcome, Outcome::Done);
        assert!(r.summary.steps < 30, "{}", r.summary.steps);
        assert!(impacts.contains(&r.summary.total_impacts), "{beyond:e}: {:?}", r.events);
        assert!(r.summary.rests == 0);
        // an elastic touch of speed u turns the phase by 2 u, u = sqrt(2e-12) at most
        assert!((r.summary.final_x - 3.0_f64.sin()).abs() < 3.0 * 1.5e-6, "{:e}", r.summary.final_x);
        assert!(m.run(&full(&[3.0])).samples[0].x == r.summary.final_x);
    }
}

#[test]
fn opposite_impacts_within_one_natural_step_are_all_found() {
    // stops 2 um apart, 1 m/s, elastic: a hit every 2 us, the first after 1 us
    let mut s = scene(polynomial(&[0.0]), at(0.0, 1.0), 0.01);
    s.stops = rigid(0.001, 1.0);
    let r = run(&s);
    let hits: Vec<_> = r.events.iter().filter(|e| e.kind == EventKind::Impact).collect();
    assert_eq!(hits.len(), 5000);
    for (i, e) in hits.iter().enumerate() {
        assert_eq!(e.side, if i % 2 == 0 { Side::Right } else { Side::Left });
        let t = (2 * i + 1) as f64 * 1e-6;
        assert!((e.t - t).abs() < 1e-15, "{i}: {:e} {t:e}", e.t);
    }
    // and on the curve of the prototype, shaken
    let mut s = nominal_scene(0.001, 0.9, sine(3.0, 5.0, 90.0), 1.0);
    s.start = at(0.0, 0.0);
    let m = model(&s);
    let times = dense(1.0, 5000);
    let r = m.run(&full(&times));
    assert!(r.summary.total_impacts > 200 && r.summary.rests >= 6, "{:?}", r.summary);
    assert_sound(&s, &m, &r, 1e3);
}

#[test]
fn both_wells_beyond_one_stop() {
    // F = (x - 2)^3 - (x - 2): wells at 1 and 3 m, barrier at 2 m; right stop at 0.5 m
    let mut s = scene(polynomial(&[-6.0, 11.0, -6.0, 1.0]), interwell::scene::Start::Rest, 10.0);
    s.stops = right_stop(500.0, 0.5);
    let r = run(&s);
    assert_eq!(kinds(&r), [(EventKind::Rest, Side::Right)]);
    assert_eq!((r.summary.final_x, r.summary.regime), (0.5, Regime::Rest));
    // thrown to the left it comes back, chatters and rests
    s.start = at(500.0, -1.0);
    let r = run(&s);
    assert_eq!((r.summary.final_x, r.summary.regime), (0.5, Regime::Intrawell));
    assert_eq!(r.events.last().unwrap().kind, EventKind::Rest);
    // on the outer side of a stop to the left of the barrier all is open
    s.stops = left_stop(500.0, 0.5);
    s.start = at(1000.0, 0.0);
    assert_eq!(run(&s).summary.regime, Regime::Rest);
}

#[test]
fn one_sided_and_uneven_stops_keep_their_own_restitution() {
    let mut s = scene(polynomial(&[0.0]), at(0.0, 8.0), 3.0);
    s.stops = interwell::scene::Stops::Uneven {
        left_mm: Some(500.0),
        right_mm: Some(1000.0),
        restitution_left: Some(0.25),
        restitution_right: Some(0.5),
    };
    let r = run(&s);
    let v: Vec<f64> = r.events.iter().filter(|e| e.kind == EventKind::Impact).map(|e| e.v_out).collect();
    assert_eq!(v, [-4.0, 1.0, -0.5]);
    assert!((r.events[1].t - (0.125 + 0.375)).abs() < 1e-15);
    s.stops = left_stop(500.0, 0.25);
    let r = run(&s);
    assert!(r.events.is_empty() && r.summary.final_x == 24.0, "{:?}", r.summary);
}

#[test]
fn a_stop_at_the_equilibrium_is_touched_by_the_sign_of_the_first_rate() {
    // no force at the stop: a drive that grows to the right pulls the mass off at once, one that grows to
    // the left presses it until half a period is past
    let mut s = scene(polynomial(&[0.0, -1.0, 0.0, 1.0]), interwell::scene::Start::Rest, 1.0);
    s.stops = rigid(1000.0, 0.5);
    s.excitation = sine(1.0, 1.0, 0.0);
    let r = run(&s);
    assert!(r.events.first().is_none_or(|e| e.kind == EventKind::Impact && e.t > 0.1), "{:?}", r.events);
    s.excitation = sine(1.0, -1.0, 0.0);
    let r = run(&s);
    assert_eq!((r.events[0].kind, r.events[0].t), (EventKind::Rest, 0.0));
    assert_eq!(r.events[1].kind, EventKind::Release);
    assert!((r.events[1].t - 0.5).abs() < 1e-15, "{:e}", r.events[1].t);
    s.excitation = Excitation::None;
    let r = run(&s);
    assert_eq!((r.summary.final_x, r.summary.regime), (1.0, Regime::Rest));
}

#[test]
fn a_stop_at_the_force_maximum() {
    // the slope of the press is 0 there, its curvature decides the small flights
    let at_maximum = 7.0 / 3.0_f64.sqrt();
    let s = nominal_scene(at_maximum, 0.36, sine(3.0, 1.6 * 9.80665, 0.0), 4.0);
    let m = model(&s);
    let r = m.run(&full(&dense(4.0, 4000)));
    assert_sound(&s, &m, &r, 1e3);
    assert!(r.summary.rests >= 20 && r.summary.releases >= 20, "{:?}", r.summary);
}

#[test]
fn a_start_at_the_barrier_top_is_no_crossing() {
    let mut s = scene(polynomial(&[0.0, -1.0, 0.0, 1.0]), at(0.0, 0.0), 20.0);
    let r = run(&s);
    assert_eq!((r.summary.final_x, r.summary.total_crossings, r.summary.regime), (0.0, 0, Regime::Rest));
    // with speed it leaves, turns at sqrt 2 or beyond and comes back over: one crossing a half turn
    s.start = at(0.0, 0.5);
    let r = run(&s);
    assert_eq!((r.events[0].kind, r.events[0].side), (EventKind::Crossing, Side::Left));
    assert!((r.events[0].v_in + 0.5).abs() < 1e-11);
    // a sine that starts at 0 pushes it off to the left
    s.start = at(0.0, 0.0);
    s.excitation = sine(0.05, 0.1, 0.0);
    let times = [0.1, 0.2];
    let r = model(&s).run(&full(&times));
    let rate = std::f64::consts::TAU * 0.05 * 0.1;
    for (p, t) in r.samples.iter().zip(times) {
        // x = -j t^3/6 (1 + (1 - w^2) t^2/20 + ..)
        let w = std::f64::consts::TAU * 0.05;
        let x = -rate * t.powi(3) / 6.0 * (1.0 + (1.0 - w * w) * t * t / 20.0);
        assert!((p.x / x - 1.0).abs() < 3e-6, "{:e} {x:e}", p.x);
    }
    assert!(r.events.first().is_none_or(|e| e.side == Side::Right), "{:?}", r.events);
}

#[test]
fn a_stop_in_a_piece_with_an_origin_of_its_own_is_never_passed_by_rounding() {
    // |x| never beyond the stop to the last bit, and the reach is the stop's own number
    // The table has pieces everywhere, the flexures only beyond their kink at 7.18 mm.
    let table = [1.7, 2.3, 3.1, 6.9].map(|limit| ("paper-table", limit));
    let flexures = [1.7, 7.2, 7.3, 7.7].map(|limit| ("paper", limit));
    for (name, limit) in table.into_iter().chain(flexures) {
        let m = crate::support::preset(
            name,
            &[&format!("stops.travel_limit_mm={limit}"), "excitation.amplitude_g=1.8"],
        );
        let r = crate::support::run_at(&m, &crate::support::every(0.0007, 14_000));
        assert_eq!(r.summary.max_abs_x, Some(limit / 1e3));
        assert!(r.samples.iter().all(|s| s.x.abs() <= limit / 1e3));
    }
}
