//! The unit double well left to itself: periods, the separatrix, stops.

use std::f64::consts::SQRT_2;

use interwell::dynamics::{EventKind, Phase, Side};
use interwell::numeric::Scalar;
use interwell_studies::study::accuracy::exact::UnitWell;

use crate::support::*;

fn potential(x: f64) -> f64 {
    UnitWell::potential(x)
}

/// Period of the orbit released at rest at x0.
fn period_of(x0: f64) -> f64 {
    UnitWell { x0 }.period().to_f64()
}

fn released_at(x0: f64, duration: f64) -> interwell::dynamics::Model {
    let x_mm = x0 * 1e3;
    unit_well(&format!(
        "start: At(x_mm: {x_mm:?}, v_m_per_s: 0), run: (duration_s: {duration:?}, tolerance: 1e-12)"
    ))
}

#[test]
fn elliptic_periods_have_their_published_digits() {
    // T = 2 K(k) sqrt 2 / x0 within a well and 4 K(k)/sqrt(x0^2 - 1) around both: the digits of the list.
    near(period_of(1.2), 4.6239052218, 5.1e-11);
    near(period_of(1.41), 7.9234358059, 5.1e-11);
    near(period_of(1.42), 15.0844204, 5.1e-8);
    near(period_of(1.5), 9.2236627483, 5.1e-11);
}

#[test]
fn an_orbit_within_a_well_returns_after_its_period() {
    // Released at rest at x0: after every period T the mass is back, at rest, and half a period later it
    // turns at sqrt(2 - x0^2). A time error dt shows as v = -F(x0) dt.
    for (x0, bound) in [(1.2, 1e-12), (1.41, 1e-11)] {
        let period = period_of(x0);
        let periods = 10;
        let run = run_at(&released_at(x0, period * 10.5), &every(0.5 * period, 2 * periods));
        let force = x0 * x0 * x0 - x0;
        for (i, sample) in run.samples.iter().enumerate() {
            let n = 0.5 * (i + 1) as f64;
            if i % 2 == 1 {
                near(sample.v / force, 0.0, bound * n * period);
                near(sample.x, x0, 1e-13 * n);
            } else {
                let turn: f64 = (2.0 - x0 * x0).sqrt();
                near(sample.v / (turn.powi(3) - turn), 0.0, 2.0 * bound * n * period);
                near(sample.x, turn, 1e-12 * n);
            }
        }
        assert_eq!(run.samples.len(), 2 * periods);
        assert_eq!(run.summary.total_crossings, 0);
    }
}

#[test]
fn an_orbit_around_both_wells_crosses_twice_a_period() {
    // Crossings at T/4 + n T/2 into alternate wells, each at the speed sqrt(2 E) to 1e-10 (at
    // x0 = 1.42 a twelfth of the largest). There dT/dx0 is some 300, too.
    for (x0, bound) in [(1.42, 2e-11), (1.5, 5e-12)] {
        let period = period_of(x0);
        let run = run(&released_at(x0, 10.0 * period));
        let crossings = of_kind(&run, EventKind::Crossing);
        assert_eq!(crossings.len(), 20);
        let speed = (2.0 * potential(x0)).sqrt();
        for (n, crossing) in crossings.iter().enumerate() {
            let leftward = n % 2 == 0;
            near_relative(crossing.t, period * (0.25 + 0.5 * n as f64), bound);
            near_relative(crossing.v_in, if leftward { -speed } else { speed }, 1e-10);
            assert_eq!(crossing.v_in, crossing.v_out);
            assert_eq!(crossing.side, if leftward { Side::Left } else { Side::Right });
        }
    }
}

#[test]
fn the_separatrix_is_a_hyperbolic_secant() {
    // Released at sqrt 2: x = sqrt 2 / cosh t, v = -x tanh t. A disturbance grows by e^t.
    let run = run_at(&released_at(SQRT_2, 10.0), &every(0.25, 36));
    for s in &run.samples {
        let exact = SQRT_2 / s.t.cosh();
        near(s.x, exact, 5e-14 * s.t.exp());
        near(s.v, -exact * s.t.tanh(), 1e-13 * s.t.exp());
    }
    assert_eq!(run.samples.len(), 36);
}

#[test]
fn impacts_take_energy_by_a_ladder() {
    // E_n - V(L) = e^(2n) (E_0 - V(L)) with L = 1.2, E_0 = 1, e = 0.85: every impact speed is known, the
    // first six alternate between the stops, and the sixth leaves the mass in one well.
    let (limit, restitution, energy): (f64, f64, f64) = (1.2, 0.85, 1.0);
    let v0 = (2.0 * energy).sqrt();
    let model = unit_well(&format!(
        "stops: Rigid(travel_limit_mm: 1200, restitution: 0.85), start: At(x_mm: 0, v_m_per_s: {v0:?}),
         run: (duration_s: 60, tolerance: 1e-12)"
    ));
    let run = run(&model);
    let impacts = of_kind(&run, EventKind::Impact);
    assert!(impacts.len() > 15, "{}", impacts.len());
    let above = energy - potential(limit);
    for (n, impact) in impacts.iter().enumerate() {
        let speed = restitution.powi(n as i32) * (2.0 * above).sqrt();
        // Rounding of the energy is relative to its largest value, so slow impacts have fewer digits.
        near(impact.v_in.abs() / speed, 1.0, if n < 8 { 1e-12 } else { 3e-13 / (speed * speed) });
        near_relative(impact.v_out, -restitution * impact.v_in, 4e-16);
        let right = if n < 6 { n % 2 == 0 } else { impacts[5].side == Side::Right };
        assert_eq!(impact.side == Side::Right, right, "impact {n}");
        assert_eq!(impact.side == Side::Right, impact.v_in > 0.0);
    }
    assert_eq!(of_kind(&run, EventKind::Crossing).len(), 5);
    let fifth = of_kind(&run, EventKind::Crossing)[4].t;
    assert!(impacts[4].t < fifth && fifth < impacts[5].t);
    // and the energy at the end is that of the last rung
    let e_n = 0.5 * run.summary.final_v.powi(2) + potential(run.summary.final_x);
    near(e_n - potential(limit), restitution.powi(2 * impacts.len() as i32) * above, 1e-13);
}

fn with_stops(limit_mm: f64, start: &str) -> interwell::dynamics::Run {
    let model = unit_well(&format!(
        "stops: Rigid(travel_limit_mm: {limit_mm:?}, restitution: 0.9), start: {start},
         run: (duration_s: 20, tolerance: 1e-12)"
    ));
    run_at(&model, &[0.0, 10.0, 20.0])
}

#[test]
fn inside_the_wells_it_rests_pressed_on_a_stop() {
    // D/x_eq < 1: rest is pressed against the right stop, without an impact, for ever.
    let run = with_stops(900.0, "Rest");
    assert_eq!(run.events.len(), 1);
    let event = run.events[0];
    assert_eq!((event.kind, event.side, event.t), (EventKind::Rest, Side::Right, 0.0));
    assert!(run.samples.iter().all(|s| (s.x, s.v, s.phase) == (0.9, 0.0, Phase::RightStop)));
    assert_eq!(run.summary.rested_share, Some(1.0));
    assert_eq!(run.summary.total_impacts, 0);
}

#[test]
fn outside_the_wells_motion_in_one_well_can_hit() {
    // 1 < D/x_eq < sqrt 2: it rests at the equilibrium, unpressed; an orbit in the well hits where its outer
    // turning point, sqrt(2 - x0^2), lies beyond the stop, at sqrt(2 (V(x0) - V(D))), and not otherwise.
    let still = with_stops(1300.0, "Rest");
    assert!(still.events.is_empty());
    assert!(still.samples.iter().all(|s| (s.x, s.v, s.phase) == (1.0, 0.0, Phase::Free)));

    let gentle = with_stops(1300.0, "At(x_mm: 560, v_m_per_s: 0)"); // turns at 1.29861
    assert!(gentle.events.is_empty());
    let wide = with_stops(1300.0, "At(x_mm: 555, v_m_per_s: 0)"); // would turn at 1.30075
    let impacts = of_kind(&wide, EventKind::Impact);
    assert!(!impacts.is_empty() && impacts.iter().all(|e| e.side == Side::Right));
    let speed = (2.0 * (potential(0.555) - potential(1.3))).sqrt();
    near_relative(impacts[0].v_in, speed, 1e-10); // the speed is a twentieth of those on the way
    assert_eq!(wide.summary.total_crossings, 0);
}

#[test]
fn beyond_root_two_only_motion_over_the_barrier_hits() {
    // D/x_eq > sqrt 2: no orbit within a well reaches the stop, however wide; one over the barrier may.
    let inner = with_stops(1415.0, "At(x_mm: 0.001, v_m_per_s: 0)"); // E = -5e-13, turns at sqrt 2
    assert!(inner.events.is_empty());
    let over = with_stops(1415.0, "At(x_mm: 0, v_m_per_s: 0.06)");
    // it turns at x^2 = 1 + sqrt(1 + 4 E)
    let (energy, turn) = (0.5 * 0.06f64.powi(2), (1.0 + (1.0f64 + 2.0 * 0.06f64.powi(2)).sqrt()).sqrt());
    assert!(turn > 1.415);
    let impacts = of_kind(&over, EventKind::Impact);
    near_relative(impacts[0].v_in, (2.0 * (energy - potential(1.415))).sqrt(), 1e-10);
}
