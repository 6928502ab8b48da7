//! Scenes in which an obvious shortcut misleads: coefficients that vanish in a row, a balance on a break, a
//! length scale from next to nothing.

use interwell::dynamics::{EventKind, Outcome};
use interwell::mechanics::{ForceCurve, Piece};
use interwell::numeric::bisect;
use interwell::scene::{Excitation, Mechanism};

use super::scenes::*;

#[test]
fn a_pure_cubic_under_a_constant_acceleration_from_its_flat_middle() {
    // x'' = -x^3 - 1 from rest at 0 stays within [-1.26, 0]; 1e-6 and 1e-10 make one step of 8 time units
    let mut s = scene(Mechanism::Cubic { linear_n_per_m: 0.0, cubic_n_per_m3: 1.0 }, at(0.0, 0.0), 10.0);
    s.excitation = constant(1.0);
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-14] {
        s.run.tolerance = tolerance;
        let r = run(&s);
        assert!(
            (r.summary.final_x + 0.881_506_200_41).abs() < 1e3 * tolerance,
            "{tolerance:e} {:?}",
            r.summary
        );
    }
}

#[test]
fn a_high_power_from_its_flat_middle() {
    for power in [5, 7, 9, 11, 13, 15] {
        let mut c = vec![0.0; power + 1];
        c[power] = 1.0;
        for (v, drive) in [(1.0, Excitation::None), (0.0, constant(1.0)), (0.0, sine(0.1, 1.0, 0.0))] {
            for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
                let mut s = scene(polynomial(&c), at(0.0, v), 10.0);
                s.excitation = drive.clone();
                s.run.tolerance = tolerance;
                let r = run(&s);
                let l = r.summary.ledger.unwrap();
                assert!(l.energy_residual < 1e3 * tolerance, "{power} {v} {tolerance:e} {l:?}");
            }
        }
    }
}

#[test]
fn a_barrier_and_a_wall_of_high_power() {
    // F = -x + x^15 from the barrier top at 0.5 m/s
    let mut c = vec![0.0; 16];
    (c[1], c[15]) = (-1.0, 1.0);
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let mut s = scene(polynomial(&c), at(0.0, 0.5), 10.0);
        s.run.tolerance = tolerance;
        let l = run(&s).summary.ledger.unwrap();
        assert!(l.energy_residual < 1e3 * tolerance, "{tolerance:e} {l:?}");
    }
}

#[test]
fn a_rebound_from_a_stop_where_the_force_is_flat() {
    // F = -1 + (x - 1)^3, stop at 1 m: slope and curvature are 0 at the stop, two terms vanish in a row, and
    // the whole flight of 3 v/a is taken with a constant force
    let mut s = scene(polynomial(&[-2.0, 3.0, -3.0, 1.0]), at(1000.0, -2.0), 3.0);
    s.stops = right_stop(1000.0, 0.5);
    for tolerance in [1e-6, 1e-9, 1e-12] {
        s.run.tolerance = tolerance;
        let r = run(&s);
        assert!(
            (r.summary.final_x - 0.515_432_172_325).abs() < 1e3 * tolerance,
            "{tolerance:e} {:?}",
            r.summary
        );
    }
    // the same by the drive: a', a'', a''' vanish at t = 0
    let mut s = scene(polynomial(&[0.0]), at(1000.0, -1.0), 3.0);
    s.stops = right_stop(1000.0, 0.5);
    s.excitation = Excitation::Sum(vec![constant(-2.0), sine(1.0, 1.0, 90.0), sine(2.0, 0.25, 270.0)]);
    // x' = -1 + 2 t - sin(w t)/w + sin(2 w t)/(8 w), w = 2 pi; the first contact by halving
    let w = std::f64::consts::TAU;
    let gap =
        |t: f64| t - t * t + (1.0 - (w * t).cos()) / (w * w) - (1.0 - (2.0 * w * t).cos()) / (16.0 * w * w);
    let (low, _) = bisect(0.5, 1.5, 60, |t| gap(t) > 0.0);
    s.run.tolerance = 1e-12;
    let t = run(&s).events[0].t;
    assert!((t - low).abs() < 1e-10, "{t} {low}");
}

#[test]
fn a_start_at_an_equilibrium_that_lies_on_a_break_stays_exact() {
    // three ways to write one curve; the sine starts at 0 and pushes off to either side
    for (x, k1, k2) in [(0.007, 80.0, 4000.0), (0.0068, 146.0, 3000.0), (0.3, 7.0, 9.0)] {
        let finals: Vec<f64> = [(0.0, 0.01), (0.0034, 0.0075), (0.001, 0.009), (0.31, 0.7)]
            .iter()
            .map(|(o1, o2)| {
                let piece = |o: f64, k: f64| Piece {
                    origin: o,
                    coefficients: vec![k * (o - x), k],
                    potential_at_origin: 0.0,
                };
                let curve = ForceCurve::from_pieces(
                    vec![piece(*o1, k1), piece(*o2, k2)],
                    vec![x],
                    (-1.0, 1.0),
                    false,
                    None,
                )
                .unwrap();
                let mut s = scene(polynomial(&[0.0]), at(x * 1e3, 0.0), 1.0);
                s.mass_g = 15.2;
                s.excitation = sine(3.0, 1.0, 0.0);
                let r = model_on(&s, curve).run(&full(&[]));
                r.summary.final_x
            })
            .collect();
        for f in &finals {
            assert!((f - finals[2]).abs() < 1e-9, "{finals:?}");
        }
    }
}

#[test]
fn a_ball_with_a_tiny_speed_costs_no_more_than_one_at_rest() {
    // length v^2/a, time v/a: the step is capped at 8 v/a
    let mut s = scene(polynomial(&[9.81]), at(0.0, 1e-6), 5.0);
    s.stops = left_stop(1000.0, 0.8);
    let r = run(&s);
    assert!(r.summary.outcome == Outcome::Done && r.summary.steps < 1000, "{:?}", r.summary);
}

#[test]
fn a_crossing_in_the_first_step_from_the_barrier_top_counts() {
    // leaves the top to the right at 5e-6 m/s, is pushed back over it at t = 0.56 s
    let mut s = scene(polynomial(&[0.0, -1.0, 0.0, 1.0]), at(0.0, 0.05 * 1e-4), 3.0);
    s.excitation = sine(1e-4 / std::f64::consts::TAU, 1.0, 0.0);
    let times = [0.3, 1.0];
    let r = model(&s).run(&full(&times));
    assert!(r.samples[0].x > 0.0 && r.samples[1].x < 0.0);
    assert_eq!(r.summary.total_crossings, 1);
}

#[test]
fn a_press_that_touches_0_under_a_sum_stays_at_rest() {
    let mut s = scene(polynomial(&[0.0]), at(1000.0, 0.0), 3.0);
    s.stops = right_stop(1000.0, 0.5);
    for phase in [90.0, 0.0] {
        s.excitation = Excitation::Sum(vec![constant(-1.0), sine(1.0, 1.0, phase)]);
        let r = run(&s);
        assert!(r.events.len() == 1 && r.events[0].kind == EventKind::Rest, "{phase}: {:?}", r.events);
    }
}

#[test]
fn the_ledger_of_a_motion_that_runs_off_to_infinity_is_relative_to_what_moved() {
    let s = scene(Mechanism::Cubic { linear_n_per_m: 1.0, cubic_n_per_m3: -1.0 }, at(1001.0, 0.0), 100.0);
    let run = run(&s);
    assert!(matches!(run.summary.outcome, Outcome::NotFinite { .. }), "{:?}", run.summary);
    // what is left of two energies of some 1e59 J is their rounding, 1e44 J: much, and next to nothing
    let l = run.summary.ledger.unwrap();
    assert!(l.residual_j.abs() > 1e30 && l.residual_j.is_finite(), "{l:?}");
    assert!(l.energy_residual > 0.0 && l.energy_residual < 1e-12, "{l:?}");
}
