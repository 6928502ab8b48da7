//! Runs that end early: infinite motions, spent budgets, cancelled runs.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Outcome, Request};
use interwell::scene::{Excitation, Mechanism, Stops};

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

/// A noise of 4096 lines, whose steps take hundreds of times as long as those of a sine.
fn many_lines() -> Excitation {
    Excitation::Noise { rms_g: 0.1, low_hz: 1.0, high_hz: 6.0, seed: 1, lines: 4096 }
}

#[test]
fn a_run_told_to_stop_looks_by_work_and_not_by_steps() {
    let told = AtomicBool::new(true);
    let request = Request { cancel: Some(&told), ..Default::default() };
    let mut free = nominal_scene(1.5, 0.36, many_lines(), 1e8);
    free.stops = Stops::None;
    let ended = model(&free).run(&request).summary;
    assert!(matches!(ended.outcome, Outcome::Cancelled { .. }) && ended.steps <= 2, "{ended:?}");
    let together = [model(&free), model(&free)];
    let all = Model::run_together(&together, &request);
    assert!(all.iter().all(|run| run.summary.steps <= 2), "{:?}", all[0].summary);
    // On a stop it looks for its release, some strides of a third of a period of the fastest line at a time.
    let resting = nominal_scene(1.5, 0.36, many_lines(), 1e8);
    let Outcome::Cancelled { at } = model(&resting).run(&request).summary.outcome else { panic!() };
    assert!(at < 50.0 / 6.0, "{at}");
}

#[test]
fn samples_of_a_single_rest_end_with_the_run_that_is_told_to_stop() {
    let mut resting = nominal_scene(1.5, 0.36, many_lines(), 1.0);
    resting.excitation = Excitation::Sum(vec![constant(0.1), many_lines()]);
    let times: Vec<f64> = (0..100_000).map(|i| f64::from(i) * 1e-5).collect();
    let told = AtomicBool::new(true);
    let run =
        model(&resting).run(&Request { sample_times: &times, cancel: Some(&told), ..Default::default() });
    assert!(matches!(run.summary.outcome, Outcome::Cancelled { .. }), "{:?}", run.summary.outcome);
    assert!(run.samples.len() <= 2, "{}", run.samples.len());
}

#[test]
fn a_common_period_is_found_however_many_parts_a_drive_has() {
    // A hundred sines that never free the mass and repeat after ten seconds: known once a common period has
    // passed.
    let sines = (0..100).map(|i| sine(1.0 + 0.1 * f64::from(i), 0.001, 0.0)).collect();
    let resting = nominal_scene(1.5, 0.36, Excitation::Sum(sines), 1e9);
    let run = run(&resting);
    assert_eq!((run.summary.outcome, run.summary.rested_share), (Outcome::Done, Some(1.0)));
    assert!(run.summary.steps < 100, "{}", run.summary.steps);
}
