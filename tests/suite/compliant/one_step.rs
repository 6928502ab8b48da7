//! Impacts of one step against the reference, under forces, damping and drives; and impacts that are not.

use interwell::dynamics::{Model, Outcome, Phase, Request, Run};

use super::*;

/// A number of 0 to 1 for each index, spread evenly in `k` dimensions (Roberts 2018).
fn spread(index: usize, k: i32) -> f64 {
    ((index + 1) as f64 * 1.134_730_384_f64.powi(-k)).fract()
}

/// The mass of 15.2 g on the surface of a stop at 1 mm, moving at `speed` in m/s into it, pressed by `force`
/// in N; `loss` in s/m.
fn touch(speed: f64, loss: f64, force: f64, rest: &str, tolerance: f64) -> Model {
    let duration = 6.0 * 2.9 / speed * (1.25 * 0.0152 * speed * speed / STIFFNESS).powf(0.4);
    model(&format!(
        "mass_g: 15.2, mechanism: Polynomial(coefficients_si: [{}, -70, 3e3, 1e6]), \
         start: At(x_mm: 1, v_m_per_s: {speed}), \
         stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: {STIFFNESS}, loss_s_per_m: {loss}), {rest}, \
         run: (duration_s: {duration}, settle_s: 0, tolerance: {tolerance})",
        -force
    ))
}

/// The reference run at 1e-22.
fn reference(model: &Model, times: &[f64]) -> Run {
    model.run_reference(
        &Request { sample_times: times, events: true, ledger: true, ..Request::default() },
        1e-22,
    )
}

/// Peak force in N, depth in m, RMS velocity in m/s and dissipated energy in J.
fn figures(run: &Run) -> [f64; 4] {
    let summary = &run.summary;
    let (force, depth) = (summary.peak_contact_force.unwrap(), summary.max_abs_x.unwrap() - 1e-3);
    [force, depth, summary.rms_velocity.unwrap(), summary.ledger.unwrap().impact_j]
}

/// One touch, and the separation that follows.
fn first(run: &Run) -> (f64, f64, f64) {
    let [touch, leave] = [EventKind::Contact, EventKind::Separate].map(|kind| of_kind(run, kind)[0]);
    (touch.t, leave.t, leave.v_out)
}

#[test]
fn an_impact_is_one_step_and_as_exact_as_many() {
    let (mut one_step, mut faults) = (0, Vec::new());
    for index in 0..24 {
        let part = |k: i32| spread(index, k);
        let speed = 10.0_f64.powf(2.5 * part(1) - 2.5);
        let loss = if index % 4 == 0 { 0.0 } else { 2.2 * part(2) / speed.max(0.1) };
        // up to as much as makes a slow mass tremble, and outward too
        let force = 0.4 * part(3) - 0.1;
        let rest = format!(
            "damping: Coefficient(c_n_s_per_m: {}), \
             excitation: Sine(frequency_hz: {}, amplitude_g: 0.4, phase_deg: {})",
            0.2 * part(4),
            3.0 + 17.0 * part(5),
            360.0 * part(6)
        );
        let exact = touch(speed, loss, force, &rest, 1e-6);
        let (begin, end, v_out) = first(&reference(&exact, &[]));
        let times: Vec<f64> = (1..10).map(|i| begin + (end - begin) * f64::from(i) / 10.0).collect();
        let exact = reference(&exact, &times);
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            let model = touch(speed, loss, force, &rest, tolerance);
            let run = run_at(&model, &times);
            let what = format!("{index} {speed} {loss} {force} at {tolerance}");
            let mut check = |name: &str, off: f64, bound: f64| {
                if !(off.abs() < bound) {
                    faults.push(format!("{name} off by {off:e}, allowed {bound:e}: {what}"));
                }
            };
            let contacts = of_kind(&run, EventKind::Contact).len() as u64;
            check(
                "steps",
                (run.summary.steps / contacts) as f64,
                if speed < 0.02 || loss * speed > 1.5 { 40.0 } else { 5.0 },
            );
            one_step += u32::from(run.summary.steps < 5 * contacts);
            let bound = 0.1 * tolerance + 2e-14;
            let (_, leave, rebound) = first(&run);
            check("speed", rebound / v_out - 1.0, bound);
            check("time", (leave - end) / (end - begin), bound);
            for (k, (figure, exact)) in figures(&run).into_iter().zip(figures(&exact)).enumerate() {
                // (of the depth 1e-6 of the displacement is left, in doubles)
                let rounding = if k == 1 { 1e-9 } else { 1e-12 };
                check(
                    "figure",
                    if exact == 0.0 { figure } else { figure / exact - 1.0 },
                    tolerance + rounding,
                );
            }
            check("ledger", run.summary.ledger.unwrap().energy_residual, 0.1 * tolerance + 1e-13);
            for (sample, exact) in run.samples.iter().zip(&exact.samples) {
                assert_eq!((sample.phase, sample.t), (Phase::RightStop, exact.t));
                check("sample's speed", (sample.v - exact.v) / speed, tolerance + 1e-11);
                check("sample's place", (sample.x - exact.x) / (speed * (end - begin)), tolerance + 1e-9);
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(one_step > 60, "{one_step}");
}

#[test]
fn what_is_asked_for_within_an_impact_changes_no_bit_of_what_follows() {
    let model = prototype(&["run.duration_s=3", "run.settle_s=1"]);
    let whole = run(&model);
    let (bare, mut times) = (model.run(&Request::default()), Vec::new());
    for pair in whole.events.windows(2).filter(|pair| pair[1].kind == EventKind::Separate) {
        times.extend([0.1, 0.5, 0.8].map(|share| pair[0].t + share * (pair[1].t - pair[0].t)));
    }
    assert!(times.len() > 600, "{}", times.len());
    let seen = run_at(&model, &times);
    assert_eq!(seen.events, whole.events);
    for other in [&bare.summary, &seen.summary] {
        assert_eq!(
            (other.final_x, other.final_v, other.rms_velocity, other.max_abs_x, other.peak_contact_force),
            (
                whole.summary.final_x,
                whole.summary.final_v,
                whole.summary.rms_velocity,
                whole.summary.max_abs_x,
                whole.summary.peak_contact_force
            )
        );
        assert_eq!((other.steps, other.total_impacts), (whole.summary.steps, whole.summary.total_impacts));
    }
    // the window and the run may begin and end within one
    let (touch, leave) =
        (of_kind(&whole, EventKind::Contact)[40].t, of_kind(&whole, EventKind::Separate)[40].t);
    let middle = 0.5 * (touch + leave);
    let cut = run(&prototype(&[&format!("run.duration_s={middle}"), "run.settle_s=0"]));
    assert_eq!((cut.summary.outcome, cut.events.last().unwrap().t), (Outcome::Done, touch));
}

#[test]
fn an_impact_that_reaches_a_break_or_the_barrier_is_followed_in_steps() {
    // A stop behind whose surface the curve's walls begin; and one with the top of the barrier in it, at
    // 1.01 mm.
    let walls = preset(
        "paper",
        &[
            "stops=Hertz(travel_limit_mm: 7.18, stiffness_n_per_m1_5: 1e8, loss_s_per_m: 1)",
            "start=At(x_mm: 7, v_m_per_s: 0.3)",
            "excitation=None",
            "run.duration_s=0.01",
            "run.settle_s=0",
            "run.tolerance=1e-10",
        ],
    );
    let barrier = model(
        "mass_g: 15.2, mechanism: Polynomial(coefficients_si: [0.0242197, -21.9397, -3030, 1e6]),
         stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: 1e6, loss_s_per_m: 1),
         start: At(x_mm: 0, v_m_per_s: 0.3), run: (duration_s: 0.01, settle_s: 0, tolerance: 1e-10)",
    );
    for (model, crossings) in [(walls, 0), (barrier, 2)] {
        let (run, exact) = (run(&model), reference(&model, &[]));
        assert_eq!((run.summary.crossings, exact.summary.crossings), (crossings, crossings));
        assert_eq!((run.summary.total_impacts, exact.summary.total_impacts), (1, 1));
        assert!(run.summary.steps > 8, "{}", run.summary.steps);
        near(run.summary.final_v, exact.summary.final_v, 1e-9 * model.scales().speed);
        near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-9);
    }
}
