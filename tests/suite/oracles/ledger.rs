//! Energy: drift, closed ledgers, and the reference numbers of two runs.

use interwell::dynamics::{EventKind, Outcome, Regime};

use crate::support::*;

#[test]
fn a_million_elastic_impacts_do_not_drift() {
    // A free mass between perfect stops: the n-th impact at 0.2 + 0.4 n s to 1e-10 of it, with the speed of
    // the start bit for bit.
    let model =
        preset("elastic-box", &["run.duration_s=400000.1", "run.tolerance=1e-9", "run.settle_s=399999.9"]);
    let run = run(&model);
    assert_eq!(run.summary.outcome, Outcome::Done);
    assert_eq!(run.summary.total_impacts, 1_000_000);
    let mut n = 0.0;
    for impact in of_kind(&run, EventKind::Impact) {
        assert_eq!((impact.v_in.abs(), impact.v_out.abs()), (0.05, 0.05));
        assert_eq!(impact.v_in, -impact.v_out);
        near_relative(impact.t, 0.2 + 0.4 * n, 1e-10);
        n += 1.0;
    }
    // at the end the mass has left x = 0 for 0.1 s
    near(run.summary.final_x, 0.005, 1e-10 * 4e5 * 0.05);
    let ledger = run.summary.ledger.unwrap();
    assert_eq!((ledger.impact_j, ledger.stored_j), (0.0, 0.0));
}

#[test]
fn elastic_impacts_over_a_barrier_keep_their_speed() {
    // The unit well between perfect stops, E = 0.1 above the barrier: every impact at sqrt(2 (E - V(D)));
    // what a flight adds to the error is at most the local tolerance, 1e-13, so 2e-9 is left after 2e4 of
    // them.
    let model = unit_well(
        "stops: Rigid(travel_limit_mm: 1200, restitution: 1), start: At(x_mm: 0, \
         v_m_per_s: 0.4472135954999579),
         run: (duration_s: 80000, tolerance: 1e-12)",
    );
    let run = run(&model);
    let speed = (0.2f64 + 2.0 * 0.2016).sqrt();
    let impacts = of_kind(&run, EventKind::Impact);
    assert!(impacts.len() > 20_000, "{}", impacts.len());
    for (n, impact) in impacts.iter().enumerate() {
        near_relative(impact.v_in.abs(), speed, 1e-13 * (n + 10) as f64);
    }
    // from one stop to the other each time, the top passed between
    assert!(run.summary.total_crossings.abs_diff(impacts.len() as u64) <= 1);
    assert!(impacts.windows(2).all(|pair| pair[0].side != pair[1].side));
}

#[test]
fn every_ledger_closes_to_the_tolerance() {
    // work - damping - impact - stored, each integrated on its own, is 0 to the tolerance of the run or to
    // rounding.
    let scenes: [(&str, &[&str]); 15] = [
        ("paper", &[]),
        ("paper", &["stops=None", "excitation.amplitude_g=1.3"]),
        ("paper", &["stops.travel_limit_mm=7.5", "excitation.amplitude_g=1.6"]),
        ("paper-table", &[]),
        ("paper-table", &["stops=None", "excitation.amplitude_g=1.3"]),
        ("nominal-cubic", &[]),
        ("nominal-cubic", &["stops=None", "excitation.amplitude_g=1.1"]),
        ("nominal-cubic", &["stops.travel_limit_mm=7.5", "stops.restitution=0.9"]),
        ("nominal-cubic", &["stops.restitution=0"]),
        ("nominal-cubic", &["stops.restitution=1"]),
        (
            "nominal-cubic",
            &["stops=Uneven(left_mm: 3, right_mm: 6, restitution_left: 0.2, restitution_right: 0.9)"],
        ),
        ("nominal-cubic", &["excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 8)"]),
        ("duffing", &["run.duration_s=200", "run.settle_s=100"]),
        ("bouncing-ball", &[]),
        ("elastic-box", &["stops.restitution=0.9"]),
    ];
    for (name, changes) in scenes {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let tolerance_change = format!("run.tolerance={tolerance:e}");
            let model = preset(name, &[changes, &[&tolerance_change]].concat());
            let summary = run(&model).summary;
            assert_eq!(summary.outcome, Outcome::Done, "{name} {changes:?}");
            let ledger = summary.ledger.unwrap();
            assert!(
                ledger.energy_residual <= tolerance,
                "{name} {changes:?} at {tolerance:e}: {:e}",
                ledger.energy_residual
            );
        }
    }
}

#[test]
fn an_undamped_orbit_keeps_its_energy() {
    // The free double well from 1.5 m, 100 s, some eleven periods and 200 steps: nothing is dissipated, so
    // the residual is the drift of the energy. 8 times the tolerance was measured; a local error of a tenth
    // of it at each step allows 20.
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14] {
        let model = unit_well(&format!(
            "start: At(x_mm: 1500, v_m_per_s: 0), run: (duration_s: 100, tolerance: {tolerance:?})"
        ));
        let ledger = run(&model).summary.ledger.unwrap();
        assert_eq!((ledger.work_j, ledger.damping_j, ledger.impact_j), (0.0, 0.0, 0.0));
        assert!(ledger.energy_residual <= 20.0 * tolerance, "at {tolerance:e}: {ledger:?}");
        let energy = |x: f64, v: f64| 0.5 * v * v + 0.25 * x.powi(4) - 0.5 * x * x;
        let summary = run(&model).summary;
        near(ledger.stored_j, energy(summary.final_x, summary.final_v) - energy(1.5, 0.0), 1e-15);
    }
}

#[test]
fn a_ledger_closes_on_a_motion_that_hardly_leaves_a_well_far_from_the_origin() {
    // A shaking of 7e-8 g about a well at some 0.9 of a length from x = 0: what is moved, 2e-20 J, is far
    // below the rounding of the potential there, and above that of its change.
    let model = model(
        "mass_g: 15.2, mechanism: Polynomial(coefficients_si: [-0.9096988182377469, -83.27071848141118,
         -5878.520094976837, -1224028.5575540755, 0, 28136424637.88236]),
         excitation: Sine(frequency_hz: 3.3333333333333335, amplitude_g: -7.330228290532675e-8),
         run: (duration_s: 0.045, tolerance: 1e-3)",
    );
    let ledger = run(&model).summary.ledger.unwrap();
    assert!(ledger.work_j > 0.0 && ledger.work_j < 1e-19, "{ledger:?}");
    near(ledger.energy_residual, 0.0, 1e-3);
}

#[test]
fn the_reference_numbers_of_a_chattering_run() {
    // P2: cubic well, D = 4 mm, e = 0.36, 1.5 g at 3 Hz, 10 s: RMS velocity 0.114697633346 m/s over 5..10 s,
    // 60 rests and releases after the rest of the start, 780 impacts down to 1e-6 m/s, period 1.
    let run = run(&preset("nominal-cubic", &["run.tolerance=1e-12"]));
    let summary = &run.summary;
    near(summary.rms_velocity.unwrap(), 0.114697633346, 5.5e-13);
    assert_eq!((summary.rests, summary.chatter_sums), (61, 60));
    assert_eq!(of_kind(&run, EventKind::Release).len(), 60);
    let fast = of_kind(&run, EventKind::Impact).iter().filter(|e| e.v_in.abs() > 1e-6).count();
    assert_eq!(fast, 780);
    assert_eq!((summary.regime, summary.period), (Regime::Interwell, Some(1)));
    assert_eq!((summary.crossings, summary.releases), (30, 30));
    assert_eq!((summary.max_abs_x, summary.travel()), (Some(0.004), Some(0.008)));
}

#[test]
fn a_run_without_stops_agrees_with_twice_the_digits() {
    // P1: the cubic well without stops at 1.1 g, 10 s: final state and RMS velocity as in 31 digits, to
    // 1e-12.
    let model = preset("nominal-cubic", &["stops=None", "excitation.amplitude_g=1.1", "run.tolerance=1e-12"]);
    let request = interwell::dynamics::Request::default();
    let (summary, reference) = (model.run(&request).summary, model.run_reference(&request, 1e-27).summary);
    near(summary.final_x, reference.final_x, 1e-12 * 7e-3);
    near(summary.final_v, reference.final_v, 1e-12 * model.scales().speed);
    near_relative(summary.rms_velocity.unwrap(), reference.rms_velocity.unwrap(), 1e-13);
    assert_eq!((summary.crossings, summary.regime), (reference.crossings, Regime::Interwell));
}
