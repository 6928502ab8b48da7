//! Quasi-static motion on a compliant stop: a mass that no longer rings follows its load until it is let go.

use interwell::dynamics::{EventKind, Model, Outcome, Request, Run};

use super::*;

/// Tolerances of the runs that are compared with the reference.
const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// Some instants up to `end` in s at which states are compared.
fn instants(end: f64) -> Vec<f64> {
    (1..60).map(|i| end * f64::from(i) / 60.0).collect()
}

/// The run of a model at some instants, in some 31 digits.
fn exact(model: &Model, times: &[f64]) -> Run {
    let request = Request { events: true, sample_times: times, ..Request::default() };
    model.run_reference(&request, 1e-19)
}

/// The largest deviations of displacement in m and velocity in m/s from the reference.
fn deviations(run: &Run, exact: &Run) -> (f64, f64) {
    assert_eq!(run.samples.len(), exact.samples.len());
    run.samples.iter().zip(&exact.samples).fold((0.0, 0.0), |(x, v): (f64, f64), (sample, exact)| {
        (x.max((sample.x - exact.x).abs()), v.max((sample.v - exact.v).abs()))
    })
}

#[test]
fn a_load_that_grows_slowly_is_followed_to_the_release() {
    // No ringing at the start, where the amplitude is 0. The mass follows the drive by a micrometre per
    // second until it is let go near 0.74 s.
    let ramp = "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 1.5)";
    let model = prototype(&[ramp, "run.duration_s=0.76", "run.settle_s=0"]);
    let times = instants(0.7);
    let exact = exact(&model, &times);
    let release = of_kind(&exact, EventKind::Separate)[0].t;
    assert!(release > 0.7, "{release}");
    // (a step in contact is held to the speed that the energy in the stop makes, a hundredth of the scene's)
    let bounds = [(1e-12, 1e-8), (5e-15, 5e-11), (5e-18, 5e-14), (2e-18, 5e-17)];
    for (i, tolerance) in TOLERANCES.into_iter().enumerate() {
        let run = run_at(&model.with_tolerance(tolerance), &times);
        let (x, v) = deviations(&run, &exact);
        assert!(x < bounds[i].0 && v < bounds[i].1, "{tolerance} {x} {v}");
        near(of_kind(&run, EventKind::Separate)[0].t, release, 1e-3 * tolerance);
        near(run.summary.ledger.unwrap().energy_residual, 0.0, tolerance.max(1e-11));
        assert!(run.summary.steps < [200, 900, 1800, 2400][i], "{tolerance} {}", run.summary.steps);
    }
}

#[test]
fn a_stop_of_any_stiffness_is_followed_once_its_ringing_is_dead() {
    for (stop, most_steps) in [
        ("stiffness_n_per_m1_5: 1e6, loss_s_per_m: 20", 400),
        ("radius_mm: 5, young_gpa: 69, loss_s_per_m: 40", 2500),
        ("stiffness_n_per_m1_5: 1e11, loss_s_per_m: 400", 2500),
    ] {
        let changes = [
            &format!("stops=Hertz(travel_limit_mm: 1.5, {stop})"),
            "excitation.amplitude_g=0.5",
            "run.duration_s=0.6",
            "run.settle_s=0.1",
        ];
        let model = prototype(&changes);
        let times = instants(0.6);
        let exact = exact(&model, &times);
        for tolerance in TOLERANCES {
            let run = run_at(&model.with_tolerance(tolerance), &times);
            let (x, v) = deviations(&run, &exact);
            assert_eq!((run.events.len(), exact.events.len()), (1, 1));
            near(x / model.scales().length, 0.0, 1e-4 * tolerance + 4e-16);
            near(v / model.scales().speed, 0.0, 1e-3 * tolerance);
            let rms = |run: &Run| run.summary.rms_velocity.unwrap();
            near_relative(rms(&run), rms(&exact), tolerance.max(1e-11));
            assert!(run.summary.steps < most_steps, "{stop} {tolerance} {}", run.summary.steps);
        }
    }
}

#[test]
fn a_long_rest_costs_steps_by_its_load_and_not_by_its_ringing() {
    // Five hundred thousand periods of the ringing; a forcing period takes some tens of steps.
    let run = run(&prototype(&[
        "excitation.amplitude_g=0.3",
        "run.tolerance=1e-6",
        "run.duration_s=300",
        "run.settle_s=290",
    ]));
    assert_eq!((run.summary.outcome, run.summary.regime.name()), (Outcome::Done, "rest"));
    assert!(run.summary.steps < 40 * 3 * 300, "{}", run.summary.steps);
    near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-6);
}
