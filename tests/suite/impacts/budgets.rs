//! Runs that end early say so; none hangs.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Outcome, Request};
use interwell::scene::{Excitation, Mechanism};

use super::scenes::*;

#[test]
fn a_motion_that_runs_off_to_infinity_ends_and_says_so() {
    for (mechanism, x, v) in [
        (Mechanism::Cubic { linear_n_per_m: 1.0, cubic_n_per_m3: -1.0 }, 1001.0, 0.0),
        (Mechanism::Cubic { linear_n_per_m: -1.0, cubic_n_per_m3: -1.0 }, 0.0, 1e-3),
        (polynomial(&[0.0, 0.0, 1.0]), -1001.0, 0.0),
        (polynomial(&[0.0, 0.0, 0.0, 0.0, 0.0, -3.0]), 500.0, 4.0),
    ] {
        for tolerance in [1e-9, 1e-12, 1e-14] {
            let mut s = scene(mechanism.clone(), at(x, v), 100.0);
            s.run.tolerance = tolerance;
            let r = run(&s);
            let ended = r.summary.outcome.ended_at().unwrap();
            assert!(matches!(r.summary.outcome, Outcome::NotFinite { .. }), "{:?}", r.summary.outcome);
            assert!(ended > 0.1 && ended < 12.0 && r.summary.steps < 1_000_000, "{:?}", r.summary);
        }
    }
}

#[test]
fn a_run_told_to_stop_stops_and_keeps_what_it_has() {
    let s = nominal_scene(1.5, 0.36, sine(3.0, 9.80665, 0.0), 1e8);
    let m = model(&s);
    let cancel = AtomicBool::new(true);
    let times = [0.0, 0.01, 1e7];
    let r = m.run(&Request { sample_times: &times, cancel: Some(&cancel), ..Default::default() });
    let Outcome::Cancelled { at: ended } = r.summary.outcome else { panic!("{:?}", r.summary) };
    assert!(ended < 100.0 && r.summary.steps <= 1024, "{ended} {}", r.summary.steps);
    assert_eq!(r.samples.len(), 2);
    // and one that searches for a release that never comes
    let parts = vec![sine(3.0, 0.5, 0.0), sine(3.0 * 2f64.sqrt(), 0.5, 0.0)];
    let mut s = scene(polynomial(&[-1.0]), at(1000.0, 0.0), 1e9);
    s.stops = right_stop(1000.0, 0.5);
    s.excitation = Excitation::Sum(parts);
    let r = model(&s).run(&Request { cancel: Some(&cancel), ..Default::default() });
    assert!(matches!(r.summary.outcome, Outcome::Cancelled { .. }), "{:?}", r.summary.outcome);
}

#[test]
fn a_billion_seconds_at_rest_cost_nothing() {
    let mut s = nominal_scene(1.5, 0.36, sine(3.0, 0.01, 0.0), 1e9);
    for drive in [sine(3.0, 0.01, 0.0), constant(0.1), Excitation::None] {
        s.excitation = drive;
        let r = run(&s);
        assert_eq!((r.summary.outcome, r.summary.steps), (Outcome::Done, 1));
        assert_eq!((r.summary.final_x, r.summary.rested_share), (1.5e-3, Some(1.0)));
    }
}
