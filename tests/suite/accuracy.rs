//! The accuracy study: its hard cases, and the orders of the other methods.

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use interwell::dynamics::{Model, Request};
use interwell_studies::study::Task;
use interwell_studies::study::accuracy::methods::{Scheme, dormand_prince, fixed_step};
use interwell_studies::study::accuracy::{
    Check, HARD_CASES, Report, Selection, Stopped, Variant, accuracy, description, names,
};

use crate::support::*;

fn free() -> AtomicBool {
    AtomicBool::new(false)
}

#[test]
fn every_hard_case_holds() {
    // Each quantity of each variant within what the case's conditioning allows.
    let cancel = free();
    let task = Task { tick: &|| (), cancel: &cancel };
    let mut checks = 0;
    for case in HARD_CASES {
        for variant in case.find(&task).unwrap() {
            assert!(!variant.checks.is_empty(), "{} {}", case.name, variant.name);
            for (quantity, check) in &variant.checks {
                // CSV writes words as they are
                assert!([variant.name, quantity].iter().all(|word| !word.contains([',', '"'])), "{quantity}");
                assert!(check.passes(), "{} {} {quantity}: {check:?}", case.name, variant.name);
                if let Check::Error { allowed, .. } = check {
                    // a case that allows anything shows nothing
                    assert!(*allowed < 0.1, "{} {} {quantity}: {check:?}", case.name, variant.name);
                }
                checks += 1;
            }
        }
    }
    assert!(checks > 120, "{checks}");
}

#[test]
fn names_are_distinct_and_each_selects_its_own() {
    let all: Vec<&str> = names().collect();
    assert_eq!(all.iter().collect::<HashSet<_>>().len(), all.len());
    for name in &all {
        assert!(Selection::of(&[(*name).to_owned()]).unwrap().parts() >= 1);
    }
    assert!(Selection::of(&["separatrices".to_owned()]).unwrap_err().contains("separatrix"));
}

#[test]
fn each_name_is_described() {
    for name in names() {
        let text = description(name);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0] == name && lines[1].starts_with("  "), "{text}");
        let labels: Vec<&str> = lines[2..].iter().filter_map(|line| line.split(':').next()).collect();
        let is_case = HARD_CASES.iter().any(|case| case.name == name);
        let expected: &[&str] = if is_case { &["  Answer", "  Digits allowed"] } else { &["  Error"] };
        assert_eq!(labels, expected, "{name}");
    }
    assert_eq!(description("separatrices"), "");
}

#[test]
fn progress_is_told_part_by_part() {
    let selection = Selection::of(&["grazing".to_owned(), "p1".to_owned(), "shock".to_owned()]).unwrap();
    let (cancel, ticks) = (free(), AtomicU64::new(0));
    let tick = || {
        ticks.fetch_add(1, Ordering::Relaxed);
    };
    let report = accuracy(&selection, &Task { tick: &tick, cancel: &cancel }).unwrap();
    assert_eq!(ticks.into_inner(), selection.parts());
    assert_eq!(report.cases.iter().map(|case| case.0).collect::<Vec<_>>(), ["grazing", "shock"]);
    // the program's own method reaches all digits and follows its tolerance, the others as theirs allow
    let best = |method: &str| {
        let points = report.points.iter().filter(|point| point.method == method);
        points.map(|point| point.error).fold(f64::INFINITY, f64::min)
    };
    assert!(best("Taylor series") < 1e-14 && best("RK4") < 1e-11 && best("Dormand-Prince 5(4)") < 1e-11);
    assert!(best("velocity Verlet") < 1e-6 && best("semi-implicit Euler") < 1e-4);
    assert!(best("semi-implicit Euler") > best("velocity Verlet"));
    let table = report.table();
    let checks: usize =
        report.cases.iter().flat_map(|case| &case.1).map(|variant| variant.checks.len()).sum();
    assert_eq!(table.rows(), report.points.len() + checks);
    assert_eq!(report.cost_table().rows(), 5);
    assert_eq!(report.case_table().rows(), 4);
}

#[test]
fn what_falls_short_is_named() {
    let variant =
        |name, check| Variant { name, steps: 1, evaluations: 1, cpu_s: 0.0, checks: vec![("x", check)] };
    let number = |error| Check::Error { error, allowed: 1e-9 };
    let variants = vec![
        variant("good", number(1e-10)),
        variant("bad", number(1e-8)),
        variant("no number", number(f64::NAN)),
        variant("no fact", Check::Fact(false)),
        variant("fact", Check::Fact(true)),
    ];
    let report = Report { points: Vec::new(), cases: vec![("case", variants)] };
    let short: Vec<&str> = report.shortfalls().iter().map(|short| short.1).collect();
    assert_eq!(short, ["bad", "no number", "no fact"]);
    let digits = number(1e-8);
    near(digits.digits_allowed().unwrap(), 9.0, 1e-12);
    near(digits.digits_reached().unwrap(), 8.0, 1e-12);
    assert_eq!(number(f64::NAN).digits_reached(), Some(0.0));
}

#[test]
fn a_cancelled_study_stops() {
    let cancel = AtomicBool::new(true);
    let task = Task { tick: &|| (), cancel: &cancel };
    assert_eq!(accuracy(&Selection::of(&[]).unwrap(), &task), Err(Stopped::Cancelled));
    for case in HARD_CASES {
        assert_eq!(case.find(&task), Err(Stopped::Cancelled), "{}", case.name);
    }
}

/// A damped oscillator under a sine, all smooth: what an order of convergence shows on.
fn smooth() -> Model {
    model(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), damping: Coefficient(c_n_s_per_m: 0.1),
         excitation: Sine(frequency_hz: 0.2, amplitude_g: 0.1), start: At(x_mm: 1000, v_m_per_s: 0),
         run: (duration_s: 10, settle_s: 0, tolerance: 1e-12)",
    )
}

#[test]
fn the_schemes_have_their_orders() {
    // Error of the final displacement and of the RMS velocity by steps of 1/50 and 1/100 s: halved once,
    // twice, four times.
    let model = smooth();
    let exact = run(&model).summary;
    for (scheme, order) in
        [(Scheme::SemiImplicitEuler, 1.0), (Scheme::VelocityVerlet, 2.0), (Scheme::RungeKutta4, 4.0)]
    {
        let at = |step: f64| fixed_step(&model, scheme, step, &Request::default()).statistics;
        let (coarse, fine) = (at(0.02), at(0.01));
        assert_eq!((coarse.steps, fine.steps), (500, 1000));
        let error = |x: f64| (x - exact.final_x).abs();
        near((error(coarse.final_x) / error(fine.final_x)).log2(), order, 0.1);
        // the trapezoids of the RMS velocity are of second order
        let rms = |s: f64| (s / exact.rms_velocity.unwrap() - 1.0).abs();
        let (coarse, fine) = (coarse.rms_velocity.unwrap(), fine.rms_velocity.unwrap());
        near((rms(coarse) / rms(fine)).log2(), order.min(2.0), 0.1);
    }
}

#[test]
fn clamp_and_bounce_is_of_first_order_in_the_times_of_impacts_whatever_the_scheme() {
    // The elastic ball: the first hit of the floor is seen up to one step late and never early.
    let model = preset("bouncing-ball", &["stops.restitution_left=0.8"]);
    let hit = (2.0f64 / 9.81).sqrt();
    for scheme in Scheme::ALL {
        for step in [1e-2, 1e-3, 1e-4] {
            let keep = Request { events: true, ..Request::default() };
            let run = fixed_step(&model, scheme, step, &keep);
            let late = run.impacts[0].t - hit;
            // the Euler step falls a little ahead of the ball: half a step of its speed
            let early = if scheme == Scheme::SemiImplicitEuler { -0.6 * step } else { -1e-12 };
            assert!(late > early && late <= step, "{} {step:e}: {late:e}", scheme.name());
            assert_eq!(run.impacts[0].v_out, -0.8 * run.impacts[0].v_in);
            assert_eq!(run.impacts.len() as u64, run.statistics.impacts);
        }
    }
}

#[test]
fn the_adaptive_method_follows_its_tolerance_and_locates_impacts() {
    let model = smooth();
    let exact = run(&model).summary;
    let error = |tolerance: f64| {
        let found = dormand_prince(&model, tolerance, &Request::default()).statistics;
        let x = (found.final_x - exact.final_x).abs();
        x.max((found.rms_velocity.unwrap() / exact.rms_velocity.unwrap() - 1.0).abs())
    };
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        assert!(error(tolerance) < 20.0 * tolerance, "{tolerance:e}: {:e}", error(tolerance));
    }
    // P2 to 1e-10: the impacts above 1 cm/s, the crossings and the RMS velocity are those of the program
    let model = preset("nominal-cubic", &["run.tolerance=1e-12"]);
    let (adaptive, exact) =
        (dormand_prince(&model, 1e-12, &Request { events: true, ..Request::default() }), run(&model));
    let hard = |impacts: &[interwell::dynamics::Event]| -> Vec<_> {
        impacts.iter().filter(|e| e.v_in.abs() > 1e-2).map(|e| (e.t, e.side)).collect()
    };
    let exact_impacts = of_kind(&exact, interwell::dynamics::EventKind::Impact);
    let (a, b) = (hard(&adaptive.impacts), hard(&exact_impacts));
    assert!(a.len() == b.len() && a.len() > 200);
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a.1, b.1);
        near(a.0, b.0, 1e-10);
    }
    assert_eq!(adaptive.statistics.crossings, exact.summary.total_crossings);
    near_relative(adaptive.statistics.rms_velocity.unwrap(), exact.summary.rms_velocity.unwrap(), 1e-10);
}

#[test]
fn points_lie_on_the_path_and_end_with_it() {
    // For the view of a step's effect: as many points as were asked for, ascending, inside the stops.
    let model = preset("paper", &[]);
    let times = every(0.01, 1000);
    let keep = Request { sample_times: &times, events: true, ..Request::default() };
    for run in [fixed_step(&model, Scheme::RungeKutta4, 1e-4, &keep), dormand_prince(&model, 1e-8, &keep)] {
        assert_eq!(run.path.iter().map(|point| point.0).collect::<Vec<_>>(), times);
        assert!(run.path.iter().all(|point| point.1.abs() <= 1.5e-3 + 1e-15));
        assert_eq!(run.path.last().unwrap().1, run.statistics.final_x);
        assert_eq!(run.statistics.ended_at, None);
    }
}

#[test]
fn a_run_that_leaves_the_curve_or_is_told_to_stop_says_so() {
    // 20 m/s outward: the flexures' curve ends a millimetre on
    let model = preset("paper", &["stops=None", "start=At(x_mm: 7, v_m_per_s: 20)"]);
    for run in [
        fixed_step(&model, Scheme::VelocityVerlet, 1e-5, &Request::default()),
        dormand_prince(&model, 1e-8, &Request::default()),
    ] {
        let ended = run.statistics.ended_at.unwrap();
        assert!(ended < 1e-3, "{ended}");
        assert_eq!(run.statistics.rms_velocity, None);
    }
    let cancel = AtomicBool::new(true);
    let keep = Request { cancel: Some(&cancel), ..Request::default() };
    let run = fixed_step(&smooth(), Scheme::RungeKutta4, 1e-6, &keep);
    assert!(run.statistics.ended_at.is_some_and(|t| t < 0.1));
    let run = dormand_prince(&preset("duffing-chaos", &[]), 1e-10, &keep);
    assert!(run.statistics.ended_at.is_some());
}
