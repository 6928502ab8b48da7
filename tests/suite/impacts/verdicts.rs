//! Outcomes of runs that are hard to finish: either they are right, or they say what went wrong.

use interwell::dynamics::{Model, Outcome, Request, Run};

use crate::support::{model, near, near_relative, preset, run, run_at};

/// A mass that creeps from the top of its barrier, against a damping that makes every step a thousandth of a
/// second: what it moves is a millionth of the room between the stops, and all of that is error.
const CREEPING: &str = "mass_g: 606, mechanism: DoubleWell(equilibrium_mm: 6850, barrier_mj: 41),
    damping: Coefficient(c_n_s_per_m: 3180), start: At(x_mm: -0.0011, v_m_per_s: 0),
    stops: Hertz(travel_limit_mm: 3.86, stiffness_n_per_m1_5: 1.1e11, loss_s_per_m: 6e11),
    run: (duration_s: 100, tolerance: 1e-6)";

#[test]
fn energy_that_does_not_balance_is_an_outcome() {
    let model = model(CREEPING);
    let listed = run(&model);
    let Outcome::Inaccurate { residual } = listed.summary.outcome else { panic!("{:?}", listed.summary) };
    assert_eq!(residual, listed.summary.ledger.unwrap().energy_residual);
    assert!(residual > 0.1, "{residual}");
    // It has reached its end, and all that was asked for is there.
    let (name, ended) = (listed.summary.outcome.name(), listed.summary.outcome.ended_at());
    assert_eq!((name, ended), ("inaccurate", None));
    assert_eq!(run_at(&model, &[0.0, 50.0, 100.0]).samples.len(), 3);
    // Without a ledger nobody knows.
    assert_eq!(model.run(&Request::default()).summary.outcome, Outcome::Done);
}

#[test]
fn a_motion_far_smaller_than_the_wells_is_no_noise() {
    // Shaken by a billionth of what the wells would need, at rest in one of them: the mass follows as a
    // linear oscillator does, x = a/w^2 long before resonance.
    for (tolerance, bound) in [("1e-3", 0.1), ("1e-6", 1e-2), ("1e-9", 1e-4), ("1e-12", 1e-2)] {
        let changes = [
            "stops=None",
            "excitation=Sine(frequency_hz: 0.1, amplitude_g: 1e-8)",
            "run.duration_s=100",
            "damping=Ratio(0.1)",
            &format!("run.tolerance={tolerance}"),
        ];
        let model = preset("nominal-cubic", &changes);
        let summary = run(&model).summary;
        let stiffness = model.mechanism().damping_stiffness().unwrap();
        let push = 1e-8 * interwell::dynamics::STANDARD_GRAVITY * model.mass();
        let rate = std::f64::consts::TAU * 0.1;
        let factor = 1.0 / (1.0 - rate * rate * model.mass() / stiffness);
        let exact = push / stiffness * factor * rate * std::f64::consts::FRAC_1_SQRT_2;
        near_relative(summary.rms_velocity.unwrap(), exact, bound);
        assert_eq!(summary.outcome, Outcome::Done, "{tolerance}");
    }
}

#[test]
fn stops_far_inside_the_wells_set_the_scale() {
    // Wells kilometres away, or a force so small that it would move the mass by as much: the tolerance is
    // that of the room.
    let rattles = "mass_g: 0.002, mechanism: Cubic(linear_n_per_m: -6e-11, cubic_n_per_m3: 1.3e-4),
        damping: Ratio(0.017), stops: Rigid(travel_limit_mm: 155, restitution: 0.9999999999999999),
        excitation: Constant(accel_g: 325), start: At(x_mm: 0.01, v_m_per_s: 0),
        run: (duration_s: 50, tolerance: 1e-6)";
    let wells = "mass_g: 1000, mechanism: DoubleWell(equilibrium_mm: 1e15, barrier_mj: 1), damping: None,
        stops: Rigid(travel_limit_mm: 1, restitution: 0.8), excitation: Sine(frequency_hz: 3, \
        amplitude_g: 0.1),
        start: At(x_mm: 0.3, v_m_per_s: 0.05), run: (duration_s: 10, tolerance: 1e-6)";
    for (text, room) in [(rattles, 0.155), (wells, 1e-3)] {
        let model = model(text);
        near_relative(model.scales().length, room, 1e-12);
        let coarse = run(&model).summary;
        assert_eq!(coarse.outcome, Outcome::Done);
        assert!(coarse.ledger.unwrap().energy_residual < 1e-7, "{coarse:?}");
        let fine = run(&model.with_tolerance(1e-13)).summary;
        near_relative(coarse.rms_velocity.unwrap(), fine.rms_velocity.unwrap(), 1e-5);
        // of the way that it has gone
        let way = fine.rms_velocity.unwrap() * model.duration();
        near(coarse.final_x, fine.final_x, 1e-5 * way);
    }
}

#[test]
fn the_scales_of_a_room_go_over_into_those_of_the_wells() {
    // From where the room is a hundredth of the length, without a jump; a side that is open leaves them as
    // they are.
    let with = |stops: &str| preset("nominal-cubic", &[&format!("stops={stops}")]).scales();
    let open = with("None");
    let at = |mm: f64| with(&format!("Rigid(travel_limit_mm: {mm:?}, restitution: 0.36)"));
    let reach = open.length * 1e3; // in mm
    assert_eq!(at(0.010_001 * reach), open);
    let below = at(0.009_999 * reach);
    assert!(below != open);
    near_relative(below.length, open.length, 1e-3);
    near_relative(below.speed, open.speed, 1e-3);
    near_relative(at(1e-6 * reach).length, 1e-6 * open.length, 1e-12);
    assert_eq!(with("Uneven(left_mm: 1e-6, restitution_left: 0.36)"), open);
}

#[test]
fn elastic_contacts_keep_their_energy_to_thousandths_of_the_tolerance_each() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let model = model(&format!(
            "mass_g: 1000, mechanism: Cubic(linear_n_per_m: 0.05, cubic_n_per_m3: 0.3), damping: None,
             stops: Hertz(travel_limit_mm: 0.1, stiffness_n_per_m1_5: 4.3e8, loss_s_per_m: 0),
             start: At(x_mm: 0, v_m_per_s: 0.01), run: (duration_s: 3, tolerance: {tolerance:?})"
        ));
        let summary = run(&model).summary;
        let drift = summary.ledger.unwrap().energy_residual / summary.total_impacts as f64;
        assert!(summary.total_impacts > 100 && drift < 1e-2 * tolerance, "{drift:e} of {tolerance:e}");
    }
}

/// Whether every number of a run is finite.
fn finite(run: &Run) -> bool {
    let summary = &run.summary;
    let ledger = summary.ledger.unwrap();
    let energies =
        [ledger.work_j, ledger.damping_j, ledger.impact_j, ledger.stored_j, ledger.energy_residual];
    let window = [summary.rms_velocity, summary.travel(), summary.max_abs_x];
    let samples = run.samples.iter().flat_map(|sample| [sample.x, sample.v]);
    let all = samples.chain(energies).chain([summary.final_x, summary.final_v]);
    all.chain(window.map(|value| value.unwrap_or(f64::NAN))).all(f64::is_finite)
}

#[test]
fn a_run_that_is_done_has_numbers() {
    for text in [
        // a compliant stop with a loss in which the mass sticks, far inside wells beyond the moon
        "mass_g: 2.59, mechanism: DoubleWell(equilibrium_mm: 134421718942.9, barrier_mj: 0.0013359),
         damping: Coefficient(c_n_s_per_m: 0.0049), start: At(x_mm: 1, v_m_per_s: -1),
         stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: 1, loss_s_per_m: 1e10),
         excitation: Chirp(from_hz: 1, to_hz: 10, over_s: 5, amplitude_g: 1),
         run: (duration_s: 1, tolerance: 1e-9)",
        "mass_g: 1, mechanism: Polynomial(coefficients_si: [-1e30, 1, 113.7]), damping: Ratio(1),
         stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: 0.014, loss_s_per_m: 10.9),
         excitation: Constant(accel_g: 1), run: (duration_s: 10)",
        // energies, and squares of speeds, that no double can write
        "mass_g: 1, mechanism: Polynomial(coefficients_si: [1e200]), start: At(x_mm: 0, v_m_per_s: 0),
         run: (duration_s: 1e-6)",
        "mass_g: 1, mechanism: Cubic(linear_n_per_m: -1e-200, cubic_n_per_m3: 1e200), run: (duration_s: 1)",
        "mass_g: 1e15, mechanism: Cubic(linear_n_per_m: -1e-190, cubic_n_per_m3: 1e-200), damping: Ratio(0.1),
         start: At(x_mm: 1e15, v_m_per_s: 1e30), run: (duration_s: 1e9)",
        "mass_g: 15.2, mechanism: Cubic(linear_n_per_m: -40, cubic_n_per_m3: 8.2e5), damping: Ratio(0.02),
         stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: 1e60, loss_s_per_m: 1),
         start: At(x_mm: 0, v_m_per_s: 1), run: (duration_s: 1)",
    ] {
        let model: Model = model(text);
        let times: Vec<f64> = (0..=50).map(|i| model.duration() * f64::from(i) / 50.0).collect();
        let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
        let run = model.run(&request);
        let (outcome, bare) = (run.summary.outcome, model.run(&Request::default()).summary);
        assert!(outcome != Outcome::Done || finite(&run), "{text}\n{:?}", run.summary);
        assert!(bare.outcome != Outcome::Done || bare.rms_velocity.is_some(), "{text}\n{bare:?}");
    }
}
