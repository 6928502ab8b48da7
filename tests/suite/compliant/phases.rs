//! Contact as a phase: pressed at rest, trembling, a stop that would have to pull, a break of the curve
//! inside it.

use interwell::dynamics::{Model, Outcome, Phase, Request, Side};
use interwell::numeric::short;
use interwell_studies::study::ended_remedy;

use super::*;

/// A free mass of 1 kg under a constant force towards the right, in N, with a stop at 1 m and what else is
/// given.
fn pressed(force: f64, stop: &str, rest: &str) -> Model {
    model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [{}]), \
         stops: Hertz(travel_limit_mm: 1000, {stop}), {rest}",
        -force
    ))
}

#[test]
fn a_start_at_rest_is_pressed_in_as_deep_as_the_forces_balance() {
    for well in ["", "mechanism=DoubleWell(equilibrium_mm: 7, barrier_mj: 0.5)"] {
        let changes: Vec<&str> =
            [well, "excitation=None"].into_iter().filter(|change| !change.is_empty()).collect();
        let model = prototype(&changes);
        let stop = model.compliant().unwrap();
        let run = run_at(&model, &[0.0, 1.0, 10.0]);
        let depth = run.summary.final_x - 1.5e-3;
        let press = -model.mechanism().curve.force(run.summary.final_x);
        near_relative(stop.stiffness * depth.powf(1.5), press, 1e-10);
        near_relative(run.summary.peak_contact_force.unwrap(), press, 1e-10);
        assert!(depth > 1e-8 && depth < 1e-6);
        assert!(run.summary.outcome == Outcome::Done && run.summary.steps < 10);
        assert!(
            run.samples
                .iter()
                .all(|sample| sample.phase == Phase::RightStop && sample.x == run.summary.final_x)
        );
        assert_eq!((run.summary.rested_share, run.summary.total_impacts), (Some(1.0), 0));
        assert_eq!(run.summary.regime.name(), "rest");
        assert_eq!(run.events.len(), 1);
        assert_eq!((run.events[0].kind, run.events[0].side), (EventKind::Contact, Side::Right));
    }
}

#[test]
fn let_go_on_the_surface_it_sinks_to_its_depth_and_comes_back() {
    // A d - (2/5)(k/m) d^2.5 = 0 at the deepest place; no speed at the start, where d' = 0 is the singular
    // case.
    let (force, stiffness) = (13.0, 1e9);
    let stop = format!("stiffness_n_per_m1_5: {stiffness}, loss_s_per_m: 0");
    for sign in [1.0, -1.0] {
        let start = format!(
            "start: At(x_mm: {}, v_m_per_s: 0), run: (duration_s: 5e-3, settle_s: 0, tolerance: 1e-12)",
            1e3 * sign
        );
        let model = pressed(sign * force, &stop, &start);
        let run = run(&model);
        let depth = (2.5 * force / stiffness).powf(2.0 / 3.0);
        near_relative(run.summary.max_abs_x.unwrap() - 1.0, depth, 1e-8);
        near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-9);
        assert_eq!(run.summary.outcome, Outcome::Done);
    }
}

#[test]
fn trembling_on_a_stop_has_the_frequency_of_its_stiffness() {
    // At rest on it, then the drive adds a push so small that the oscillation is harmonic.
    let model = prototype(&[
        "excitation=Constant(accel_g: 1e-4)",
        "damping=None",
        "stops.loss_s_per_m=0",
        "run.duration_s=0.02",
        "run.settle_s=0",
    ]);
    let stop = model.compliant().unwrap();
    let depth = run(&prototype(&["excitation=None"])).summary.final_x - 1.5e-3;
    let omega = (1.5 * stop.stiffness * depth.sqrt() / model.mass()).sqrt();
    let swing = 2.0 * 9.80665e-4 / omega.powi(2);
    let times: Vec<f64> = (1..=40).map(|i| std::f64::consts::PI * f64::from(i) / omega).collect();
    for (i, sample) in run_at(&model, &times).samples.iter().enumerate() {
        // inward by the whole swing after every odd half period, back after every even one
        let inward = if i % 2 == 0 { swing } else { 0.0 };
        near(sample.x, 1.5e-3 + depth - inward, 2e-3 * swing + 2e-5 * swing * i as f64);
        assert_eq!(sample.phase, Phase::RightStop);
    }
}

#[test]
fn a_stop_that_would_have_to_pull_trails() {
    // The mass is pulled out of the stop faster than the stop can follow: from the speed 1/a on its force
    // would be negative. It is 0, and the mass falls freely until it is out.
    let (pull, speed, loss) = (-4e4, 1.0, 10.0);
    let stop = format!("stiffness_n_per_m1_5: 1e8, loss_s_per_m: {loss}");
    let start = format!(
        "start: At(x_mm: 1000, v_m_per_s: {speed}), run: (duration_s: 2e-3, settle_s: 0, tolerance: 1e-12)"
    );
    let model = pressed(pull, &stop, &start);
    let (_, leave, _, v_out) = contact(&run(&model));
    let times: Vec<f64> = (0..=400).map(|i| leave * f64::from(i) / 400.0).collect();
    let run = run_at(&model, &times);
    assert!(-v_out > 2.0 / loss, "it leaves at {v_out} m/s, faster than the stop follows");
    let mut trailed = 0;
    for pair in run.samples.windows(2).filter(|pair| pair[1].phase != Phase::Free) {
        let acceleration = (pair[1].v - pair[0].v) / (pair[1].t - pair[0].t);
        // never held back on its way out, and free once it is faster than 1/a
        assert!(acceleration <= pull * (1.0 - 1e-6), "{pair:?}");
        if pair[0].v < -1.0 / loss {
            near_relative(acceleration, pull, 1e-6);
            trailed += 1;
        }
    }
    assert!(trailed > 20, "{trailed}");
    near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-11);
    let exact = contact(&model.run_reference(&Request { events: true, ..Request::default() }, 1e-26));
    near_relative(leave, exact.1, 1e-10);
    near_relative(v_out, exact.3, 1e-10);
}

#[test]
fn a_break_of_the_curve_deep_in_a_stop_is_passed_and_passed_back() {
    // The flexures' force turns into a wall at 7.181 mm; a soft stop at 7.17 mm lets the mass through to
    // there.
    let model = preset(
        "paper",
        &[
            "stops=Hertz(travel_limit_mm: 7.17, stiffness_n_per_m1_5: 3e6, loss_s_per_m: 0.5)",
            "excitation=None",
            "start=At(x_mm: 7, v_m_per_s: 0.2)",
            "run.duration_s=0.05",
            "run.settle_s=0",
            "run.tolerance=1e-11",
        ],
    );
    let kink = model.mechanism().landscape.kinks.last().unwrap().x;
    let run = run(&model);
    assert!(
        kink > 7.17e-3 && run.summary.max_abs_x.unwrap() > kink + 1e-5,
        "{kink} {:?}",
        run.summary.max_abs_x
    );
    near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-9);
    let tighter = model.run_reference(&Request::default(), 1e-20).summary;
    near(run.summary.final_x, tighter.final_x, 1e-8 * model.scales().length);
    near(run.summary.final_v, tighter.final_v, 1e-8 * model.scales().speed);
}

#[test]
fn a_break_of_the_curve_next_to_the_surface_is_passed_with_it() {
    let events = |below_mm: f64, tolerance: f64, v: f64| {
        let kink = preset("paper", &[]).mechanism().landscape.kinks.last().unwrap().x;
        let limit = 1e3 * kink - below_mm;
        let stops = format!("Hertz(travel_limit_mm: {limit:?}, stiffness_n_per_m1_5: 1e8, loss_s_per_m: 2)");
        let model = preset(
            "paper",
            &[
                &format!("stops={stops}"),
                &format!("start=At(x_mm: 0, v_m_per_s: {v})"),
                "excitation=Sine(frequency_hz: 5, amplitude_g: 1.4)",
                &format!("run.tolerance={tolerance}"),
                "run.duration_s=0.15",
                "run.settle_s=0",
            ],
        );
        run(&model).events.iter().map(|event| (event.kind, event.side)).collect::<Vec<_>>()
    };
    for v in [0.3, 0.45] {
        let clear = events(1e-3, 1e-9, v);
        assert!(clear.iter().filter(|event| event.0 == EventKind::Contact).count() > 1, "{clear:?}");
        for tolerance in [1e-3, 1e-5, 1e-8] {
            for below_mm in [0.0, 2e-15, 4e-15, 1e-14, 1e-13, 1e-12, 1e-11] {
                assert_eq!(events(below_mm, tolerance, v), clear, "{below_mm} {tolerance} {v}");
            }
        }
    }
}

#[test]
fn a_contact_that_reaches_the_end_of_the_curve_ends_the_run() {
    let changes = [
        "stops=Hertz(travel_limit_mm: 7.9, stiffness_n_per_m1_5: 1, loss_s_per_m: 0)",
        "start=At(x_mm: 7, v_m_per_s: 9)",
    ];
    let run = run(&preset("paper-table", &changes));
    assert_eq!(run.summary.outcome.name(), "left_table");
    assert_eq!(run.events.last().unwrap().kind, EventKind::Contact);
}

#[test]
fn resting_costs_what_is_said_and_a_hopeless_rest_ends_by_the_budget() {
    // Trembling at 1.4 kHz for a second, elastic, and then at 10 MHz for hours.
    let start = |duration: f64| format!("start: At(x_mm: 1000, v_m_per_s: 0), run: (duration_s: {duration})");
    let elastic = "stiffness_n_per_m1_5: 1e9, loss_s_per_m: 0";
    let steps = run(&pressed(13.0, elastic, &start(1.0))).summary.steps;
    assert!(steps > 1000 && steps < 200_000, "{steps}");
    let run = run(&pressed(13.0, "stiffness_n_per_m1_5: 1e21, loss_s_per_m: 0", &start(1e4)));
    assert!(
        matches!(run.summary.outcome, Outcome::StepBudget { .. } | Outcome::ImpactBudget { .. }),
        "{:?}",
        run.summary
    );
}

#[test]
fn a_quiet_rest_is_followed_and_its_small_energies_add_up() {
    // Shaken by less than frees it, the mass follows the drive by a thousandth of the depth: far below the
    // scene's scales, and yet known, since the tolerance of a contact is relative to the energy in it.
    let at = |tolerance: &str| run(&prototype(&["excitation.amplitude_g=0.3", tolerance]));
    let exact = at("run.tolerance=1e-12").summary;
    for (tolerance, bound) in
        [("run.tolerance=1e-3", 1e-2), ("run.tolerance=1e-6", 1e-5), ("run.tolerance=1e-9", 1e-8)]
    {
        let run = at(tolerance);
        near_relative(run.summary.rms_velocity.unwrap(), exact.rms_velocity.unwrap(), bound);
        near(run.summary.ledger.unwrap().energy_residual, 0.0, bound);
        assert_eq!((run.summary.regime.name(), run.summary.rested_share), ("rest", Some(1.0)));
        assert!(run.summary.steps < 100_000, "{}", run.summary.steps);
    }
}

#[test]
fn a_budget_spent_on_contacts_is_said_to_be() {
    let model = |stiffness: &str, tolerance: &str| {
        let stop =
            format!("stops=Hertz(travel_limit_mm: 1.5, stiffness_n_per_m1_5: {stiffness}, loss_s_per_m: 0)");
        prototype(&[&stop, &format!("run.tolerance={tolerance}")])
    };
    let spent = Outcome::StepBudget { at: 1.0, count: 1 };
    let said = ended_remedy(&model("1e21", "1e-3"), spent).unwrap();
    let contact = model("1e21", "1e-3").compliant().unwrap();
    let speed = model("1e21", "1e-3").scales().speed;
    let time = short(contact.contact_time(15.2e-3, speed));
    assert!(
        said.starts_with(&format!("a contact with a stop lasts {time} s at {} m/s", short(speed))),
        "{said}"
    );
    assert!(said.contains("rigid ones (`Rigid`)") && !said.contains("tolerance"), "{said}");
    // of other scenes, a shorter run, and a larger tolerance where its cheaper steps reach the end
    let late = Outcome::StepBudget { at: 9.0, count: 1 };
    let said = |tolerance: &str, outcome| ended_remedy(&model("1e3", tolerance), outcome).unwrap();
    assert_eq!(said("1e-9", spent), "a run of some 1 s would do");
    assert_eq!(said("1e-9", late), "a run of some 9 s or a larger tolerance would do");
    assert_eq!(said("1e-3", late), "a run of some 9 s would do");
    let noise = "excitation=Noise(rms_g: 0.3, low_hz: 1, high_hz: 20, seed: 7, lines: 4096)";
    let lines = "a run of some 1 s or an excitation of fewer lines would do";
    assert_eq!(ended_remedy(&preset("paper", &[noise]), spent).unwrap(), lines);
    let inaccurate = Outcome::Inaccurate { residual: 1.0 };
    assert_eq!(said("1e-9", inaccurate), "use a smaller tolerance");
    assert!(said("1e-14", inaccurate).starts_with("1e-14 is the smallest tolerance"));
    assert_eq!(ended_remedy(&model("1e3", "1e-9"), Outcome::Done), None);
    let runaway = pressed(
        1.0,
        "stiffness_n_per_m1_5: 1, loss_s_per_m: 0",
        "start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: 1)",
    );
    let no_number = Outcome::NotFinite { at: 1.0 };
    assert!(ended_remedy(&runaway, no_number).unwrap().starts_with("smaller numbers in the scene"));
    let open = preset("nominal-cubic", &["stops=None"]);
    assert!(ended_remedy(&open, no_number).unwrap().starts_with("stops, or a force that holds the mass"));
}
