//! Break points of the force curve, where only a located crossing changes the piece.

use std::f64::consts::PI;

use interwell::dynamics::{EventKind, Outcome, Phase};
use interwell::mechanics::{ForceCurve, Piece};
use interwell::scene::Scene;
use interwell_studies::study::accuracy::exact::Corner;

use super::scenes::*;

fn corner(b: f64, outer: f64) -> ForceCurve {
    Corner { at: b, outer }.curve()
}

fn free(x_mm: f64, v: f64, duration: f64) -> Scene {
    scene(polynomial(&[0.0]), at(x_mm, v), duration)
}

#[test]
fn a_corner_crossed_thousands_of_times_keeps_the_energy_and_the_period() {
    let (b, outer) = (0.3_f64, 25.0);
    let v: f64 = 1.0; // at x = 0
    let period = Corner { at: b, outer }.period(v);
    let n = 1500.0;
    let mut s = free(0.0, v, n * period);
    s.run.tolerance = 1e-14;
    let m = model_on(&s, corner(b, outer));
    let r = m.run(&full(&[]));
    let summary = &r.summary;
    assert_eq!(summary.outcome, Outcome::Done);
    // a tenth of the tolerance a step
    let allowed = summary.steps as f64 * 1e-15 * 3.0;
    assert!(summary.final_x.abs() < allowed * period * n / 10.0, "{:e} {allowed:e}", summary.final_x);
    assert!((summary.final_v - v).abs() < allowed, "{:e} {allowed:e}", summary.final_v - v);
    assert!(summary.ledger.unwrap().energy_residual < 1e-12, "{:?}", summary.ledger);
    assert_eq!(summary.total_crossings, 2999 + u64::from(summary.final_x > 0.0));
}

#[test]
fn a_start_on_a_break_with_speed_either_way() {
    let (b, outer) = (0.3_f64, 25.0);
    // outward: in the outer piece at once, back at the break after the closed form, with -v
    let t = Corner { at: b, outer }.time_beyond(0.5);
    let m = model_on(&free(300.0, 0.5, t), corner(b, outer));
    let r = m.run(&full(&[]));
    assert!(
        (r.summary.final_x - b).abs() < 1e-11 && (r.summary.final_v + 0.5).abs() < 1e-11,
        "{:?}",
        r.summary
    );
    // inward: x = sqrt(b^2 + v^2) cos(t + phase)
    let (reach, phase) = ((b * b + 0.25).sqrt(), (0.5_f64).atan2(b));
    let m = model_on(&free(300.0, -0.5, 2.0), corner(b, outer));
    let r = m.run(&full(&[]));
    assert!((r.summary.final_x - reach * (2.0 + phase).cos()).abs() < 1e-11, "{:?}", r.summary);
}

#[test]
fn a_start_at_rest_on_a_break_goes_where_the_force_leads() {
    let (b, outer) = (0.3_f64, 25.0);
    let m = model_on(&free(300.0, 0.0, 1.0), corner(b, outer));
    let r = m.run(&full(&[]));
    assert!((r.summary.final_x - b * 1.0_f64.cos()).abs() < 1e-12, "{:?}", r.summary);
    // and outward, under a constant base acceleration that more than holds the force
    let mut s = free(300.0, 0.0, 0.5);
    s.excitation = constant(-1.3);
    let m = model_on(&s, corner(b, outer));
    let r = m.run(&full(&[]));
    let x = b + (1.3 - b) / outer * (1.0 - (5.0_f64 * 0.5).cos());
    assert!((r.summary.final_x - x).abs() < 1e-12, "{:e} {x:e}", r.summary.final_x);
}

#[test]
fn an_orbit_that_only_touches_a_break_stays_on_its_side() {
    // x = -0.3 cos t touches the break at 0.3 with speed 0
    let m = model_on(&free(-300.0, 0.0, 40.0), corner(0.3, 400.0));
    let r = m.run(&full(&[]));
    assert_eq!(r.summary.outcome, Outcome::Done);
    assert!(r.summary.steps < 200, "{}", r.summary.steps);
    assert!((r.summary.final_x + 0.3 * 40.0_f64.cos()).abs() < 1e-6, "{:e}", r.summary.final_x);
}

#[test]
fn on_a_stop_that_lies_on_a_break_the_inner_piece_holds() {
    // the outer slope of 1e6 N/m would hold it with 1e6 times the stiffness for the rebound
    let mut s = free(300.0, 0.5, 2.0);
    s.stops = right_stop(300.0, 0.5);
    let m = model_on(&s, corner(0.3, 1e6));
    let r = m.run(&full(&[]));
    assert_eq!(r.events[0].kind, EventKind::Impact);
    let (reach, phase) = ((0.09_f64 + 0.0625).sqrt(), 0.25_f64.atan2(0.3));
    assert!((r.summary.final_x - reach * (2.0 + phase).cos()).abs() < 1e-11, "{:?}", r.summary);
    // pressed there by the drive it rests, and is let go where a(t) = -F(0.3)
    let mut s = free(300.0, 0.0, 2.0);
    s.stops = right_stop(300.0, 0.5);
    s.excitation = sine(0.25, 1.0, 270.0);
    let m = model_on(&s, corner(0.3, 1e6));
    let r = m.run(&full(&[1.0]));
    assert_eq!((r.events[0].kind, r.events[0].t), (EventKind::Rest, 0.0));
    let t = 0.3_f64.acos() / (0.5 * PI);
    assert_eq!(r.events[1].kind, EventKind::Release);
    assert!((r.events[1].t - t).abs() < 1e-14, "{} {t}", r.events[1].t);
    assert_eq!(r.samples[0].phase, Phase::Free);
}

#[test]
fn small_flights_beside_a_break_know_of_it() {
    // a break 1 nm inside the stop: rebounds of 1e-5 m/s pass it, the last ones do not
    let d = 0.3 + 1e-9;
    let mut s = free(d * 1e3, -1e-3, 0.5);
    s.stops = right_stop(d * 1e3, 0.7);
    s.excitation = constant(-1.3);
    let m = model_on(&s, corner(0.3, 400.0));
    let r = m.run(&full(&[]));
    let truth = m.run_reference(&full(&[]), 1e-26);
    let rest = |r: &interwell::dynamics::Run| r.events.iter().find(|e| e.kind == EventKind::Rest).unwrap().t;
    assert!((rest(&r) - rest(&truth)).abs() < 1e-12, "{:e}", rest(&r) - rest(&truth));
    assert!(r.summary.total_impacts > 10 && r.summary.chatter_sums == 1);
    // the press is nearly 1 on both sides of the break: about 2 v/(a (1 - e))
    assert!((rest(&r) - 2e-3 / 0.3).abs() < 1e-5, "{}", rest(&r));
}

#[test]
fn leaving_the_known_range_ends_the_run_there_and_then() {
    let flat = Piece { origin: 0.0, coefficients: vec![0.0], potential_at_origin: 0.0 };
    let curve = ForceCurve::from_pieces(vec![flat], vec![], (-1.0, 0.75), false, None).unwrap();
    let times = [0.0, 0.5, 1.5, 1.6, 4.0];
    let m = model_on(&free(0.0, 0.5, 4.0), curve.clone());
    let r = m.run(&full(&times));
    let Outcome::LeftTable { at } = r.summary.outcome else { panic!("{:?}", r.summary) };
    assert!((at - 1.5).abs() < 1e-15 && r.summary.final_x == 0.75 && r.summary.final_v == 0.5);
    assert_eq!(r.samples.iter().map(|p| p.t).collect::<Vec<_>>(), [0.0, 0.5, 1.5]);
    assert_eq!(r.summary.max_abs_x, Some(0.75));
    assert!((r.summary.rms_velocity.unwrap() - 0.5).abs() < 1e-15);
    // a stop at the end of the range is reached first
    let mut s = free(0.0, 0.5, 4.0);
    s.stops = right_stop(750.0, 1.0);
    let r = model_on(&s, curve).run(&full(&[]));
    assert_eq!((r.summary.outcome, r.summary.total_impacts), (Outcome::Done, 1));
    assert!((r.summary.final_x + 0.5).abs() < 1e-15);
}
