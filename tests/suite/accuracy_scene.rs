//! Accuracy of a scene: known figures of fixed steps, errors that are known otherwise, and chaos that is
//! called so.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::Model;
use interwell_studies::study::accuracy::methods::Scheme;
use interwell_studies::study::accuracy::scene::{
    Course, Lateness, StepSize, TOLERANCES, TRUSTED_SHARE, Tolerances, Trust, Unfit, duration, length_mm,
    moment, scene_table, small_length, step_name, step_size, tolerances, trust,
};

use crate::support::*;

fn stepped(model: &Model, scheme: Scheme, step: f64) -> StepSize {
    step_size(model, scheme, step, &AtomicBool::new(false)).unwrap()
}

fn trusted(model: &Model) -> Trust {
    trust(model, &AtomicBool::new(false)).unwrap()
}

fn at_tolerances(model: &Model) -> Tolerances {
    tolerances(model, &AtomicBool::new(false)).unwrap()
}

#[test]
fn fixed_steps_arrive_late_and_count_too_many_impacts() {
    // The figures of a small applet on the nominal cubic between stops at 4 mm, measured elsewhere: at 1/60 s
    // 14 ms late and an RMS velocity 38 % too high, at 1/600 s every arrival 0.55 ms late and 3120 impacts.
    let model = preset("nominal-cubic", &[]);
    let coarse = stepped(&model, Scheme::RungeKutta4, 1.0 / 60.0);
    let late = coarse.late.unwrap();
    assert_eq!((late.matched, late.of), (60, 60));
    near(late.median, 14e-3, 0.5e-3);
    near(coarse.rms_error().unwrap(), 0.38, 0.01);
    let fine = stepped(&model, Scheme::RungeKutta4, 1.0 / 600.0);
    let late = fine.late.unwrap();
    assert_eq!((late.matched, late.of), (60, 60));
    near(late.earliest, 0.55e-3, 0.01e-3);
    near(late.latest, 0.55e-3, 0.01e-3);
    assert_eq!(fine.stepped.impacts, 3120);
    assert!((700..900).contains(&fine.exact.impacts), "{}", fine.exact.impacts);
    // whatever the scheme, a step of 10 us is off by as much in time
    for scheme in Scheme::ALL {
        let late = stepped(&model, scheme, 1e-5).late.unwrap();
        assert!(late.matched == 60 && late.worst().abs() < 1.1e-5 && late.median > 0.0, "{late:?}");
    }
    let words = coarse.sentences().join(" ");
    for part in ["Impacts arrive 14 ms late", "impacts counted where there are", "RMS velocity 38 % too high"]
    {
        assert!(words.contains(part), "{words}");
    }
}

#[test]
fn early_and_late_are_counted_and_more_impacts_are_explained() {
    let paper = stepped(&preset("paper", &[]), Scheme::RungeKutta4, 1.0 / 60.0);
    let late = paper.late.unwrap();
    assert!(
        late.early > 0 && late.early < late.matched && late.earliest < 0.0 && late.latest > 0.0,
        "{late:?}"
    );
    let words = paper.sentences().join(" ");
    assert!(words.starts_with(&format!("Of the first {} impacts after a flight", late.matched)), "{words}");
    assert!(words.contains(&format!("and {} early, by up to", late.early)), "{words}");
    // shorter steps count more impacts, and nearly all of what is too many are hops
    let model = preset("nominal-cubic", &[]);
    let [coarse, fine] = [1.0 / 240.0, 1.0 / 600.0].map(|step| stepped(&model, Scheme::RungeKutta4, step));
    assert!(fine.stepped.impacts > coarse.stepped.impacts && fine.hops > coarse.hops);
    for report in [&coarse, &fine] {
        assert!(
            report.hops <= report.stepped.impacts
                && report.hops + report.exact.impacts > report.stepped.impacts,
            "{report:?}"
        );
        let words = report.sentences().join(" ");
        assert!(
            words.contains(&format!("{} of them are hops of a mass that truly rests", report.hops)),
            "{words}"
        );
    }
    // without rest there is nothing to explain
    let box_ = stepped(&preset("elastic-box", &[]), Scheme::RungeKutta4, 1.0 / 60.0);
    assert!(box_.hops == 0 && !box_.sentences().join(" ").contains("hops"));
}

#[test]
fn the_drawn_paths_are_those_of_the_runs() {
    let model = preset("nominal-cubic", &[]);
    let run = stepped(&model, Scheme::RungeKutta4, 1.0 / 600.0);
    assert_eq!((run.span, run.drawn), (10.0, 1.0));
    assert_eq!((run.ghost.len(), run.stepped.steps), (601, 6000));
    for path in [&run.truth, &run.ghost] {
        assert!(path.is_sorted_by(|a, b| a.0 <= b.0));
        assert_eq!((path[0].0, path[path.len() - 1].0), (0.0, 1.0));
        assert!(path.iter().all(|point| point.1.abs() <= 4e-3 + 1e-12));
    }
    // a stop is touched by both
    for path in [&run.truth, &run.ghost] {
        assert!(path.iter().any(|point| point.1 == -4e-3));
    }
}

#[test]
fn an_error_is_estimated_that_is_known_otherwise() {
    // Against double-double arithmetic: the estimate is the error, give or take.
    for name in ["paper", "nominal-cubic", "monostable", "walking", "random-shaking"] {
        let model = preset(name, &[]);
        let trust = trusted(&model);
        assert_eq!(trust.course, Course::Kept, "{name}");
        assert_eq!((trust.tolerances, trust.span), ((1e-9, 1e-9 * 1e-2), model.duration()), "{name}");
        assert!(trust.error > 0.0 && trust.error < 1e-4 * trust.travel, "{name} {trust:?}");
        let words = trust.short(0.0).unwrap();
        assert!(words.starts_with("Error about ") && words.ends_with(" mm"), "{words}");
        let (words, span) = (trust.long(0.0), model.duration());
        assert!(words.ends_with(&format!("mm over {span:.0} s from the start.")), "{words}");
    }
    let model = preset("paper", &[]);
    let error = |model: &Model| trusted(model).error;
    let exact = at_tolerances(&preset("paper", &["run.tolerance=1e-14"]));
    let tolerances = |found: &Tolerances| found.runs.iter().map(|run| run.tolerance).collect::<Vec<_>>();
    assert_eq!(tolerances(&exact), [1e-3, 1e-6, 1e-9, 1e-12, 1e-14]);
    assert_eq!(tolerances(&at_tolerances(&model)), TOLERANCES);
    let known = exact.runs.iter().find(|run| run.tolerance == 1e-9).unwrap().error;
    assert!((0.5..2.0).contains(&(error(&model) / known)), "{} {known}", error(&model));
    // at the end of the doubles, too
    let least = error(&preset("paper", &["run.tolerance=1e-14"]));
    assert!(least > 0.0 && least < 1e-16, "{least:e}");
}

#[test]
fn chaos_is_called_chaos_and_nothing_else_is() {
    let chaos = trusted(&preset("duffing-chaos", &["run.duration_s=1000"]));
    let Course::Chaotic { until, decade } = chaos.course else { panic!("{chaos:?}") };
    // the largest Lyapunov exponent is some 0.1 to 0.2 /s
    assert!((50.0..200.0).contains(&until) && (5.0..30.0).contains(&decade), "{chaos:?}");
    assert!(chaos.short(0.0).unwrap().starts_with("Chaotic: trust it up to about "));
    assert!(chaos.short(1000.0).unwrap().ends_with(&format!("{:.0} s", 1000.0 + until)));
    assert!(matches!(trusted(&preset("first-look", &[])).course, Course::Chaotic { .. }));
    // whatever the tolerance, and a tolerance that is only too large is none
    for tolerance in ["1e-3", "1e-5", "1e-7", "1e-12"] {
        let judged = trusted(&preset(
            "duffing-chaos",
            &["run.duration_s=1000", &format!("run.tolerance={tolerance}")],
        ));
        assert!(matches!(judged.course, Course::Chaotic { .. }), "{tolerance}: {judged:?}");
    }
    let coarse = trusted(&preset("paper-unconstrained", &["run.tolerance=1e-3"]));
    assert!(!matches!(coarse.course, Course::Chaotic { .. }), "{coarse:?}");
    // the time for which a path is good grows by the digits, not with them
    let runs = at_tolerances(&preset("first-look", &[])).runs;
    let trust: Vec<f64> = runs.iter().map(|run| run.trusted.unwrap()).collect();
    assert!(trust.is_sorted() && trust[3] < 6.0 * trust[0], "{trust:?}");
    let rms: Vec<f64> = runs.iter().map(|run| run.statistics.rms_velocity.unwrap()).collect();
    assert!(rms.iter().all(|value| (value / rms[3] - 1.0).abs() < 0.1), "{rms:?}");
    // a rhythm is none
    assert_eq!(trusted(&preset("duffing", &[])).course, Course::Kept);
}

#[test]
fn on_the_hill_it_is_sensitive_and_not_chaotic() {
    // Released with the energy of the barrier: it stands on the top for as long as its digits last, then
    // falls to a side.
    let top = unit_well(
        "start: At(x_mm: 1414.2135623730951, v_m_per_s: 0), run: (duration_s: 100, settle_s: 0, \
         tolerance: 1e-9)",
    );
    let trust = trusted(&top);
    assert!(matches!(trust.course, Course::Sensitive { until } if until > 5.0 && until < 40.0), "{trust:?}");
    // errors that add up are no chaos either: an undamped swing in a fine well, slowly out of step
    let swing = unit_well(
        "start: At(x_mm: 1300, v_m_per_s: 0), run: (duration_s: 20000, settle_s: 0, tolerance: 1e-3)",
    );
    let trust = trusted(&swing);
    assert!(matches!(trust.course, Course::Coarse { .. } | Course::Kept), "{trust:?}");
}

#[test]
fn digits_cost_time() {
    let model = preset("paper", &["run.tolerance=1e-7"]);
    let found = at_tolerances(&model);
    let tolerances: Vec<f64> = found.runs.iter().map(|run| run.tolerance).collect();
    assert_eq!(tolerances, [1e-3, 1e-6, 1e-7, 1e-9, 1e-12]);
    assert!(found.runs.is_sorted_by(|a, b| a.error > b.error && a.statistics.steps <= b.statistics.steps));
    assert!(found.runs.iter().all(|run| run.trusted.is_none() && run.statistics.cpu_s > 0.0));
    assert!(found.runs[0].error < TRUSTED_SHARE * found.travel);
    assert_eq!(found.span, 10.0);
    let stepped = stepped(&model, Scheme::VelocityVerlet, 1e-3);
    let table = scene_table(&found, &[stepped]);
    assert_eq!(table.rows(), 6);
    assert!(table.numbers("step_s").unwrap()[..5].iter().all(|step| step.is_nan()));
    assert_eq!(table.numbers("step_s").unwrap()[5], 1e-3);
}

#[test]
fn what_does_not_fit_is_said() {
    let soft =
        preset("paper", &["stops=Hertz(travel_limit_mm: 1.5, stiffness_n_per_m1_5: 1e7, loss_s_per_m: 0.5)"]);
    let none = AtomicBool::new(false);
    assert_eq!(step_size(&soft, Scheme::RungeKutta4, 1e-3, &none), Err(Unfit::Compliant));
    let stopped = AtomicBool::new(true);
    let model = preset("walking", &[]);
    assert_eq!(step_size(&model, Scheme::RungeKutta4, 1e-5, &stopped), Err(Unfit::Cancelled));
    // the whole of a long run is not gone through in the smallest steps
    let long = preset("duffing-chaos", &[]);
    let run = stepped(&long, Scheme::SemiImplicitEuler, 1e-4);
    assert!(run.span < 2001.0 && run.span > 1000.0 && run.stepped.steps <= 20_000_000, "{}", run.span);
    // steps that are too long for a wall
    let run = stepped(&preset("first-look", &[]), Scheme::RungeKutta4, 1.0 / 60.0);
    assert!(run.stepped.ended_at.is_some() && run.sentences()[0].starts_with("It flew apart"), "{run:?}");
}

#[test]
fn numbers_are_short_and_have_their_unit() {
    assert_eq!(
        [0.014, 5.5e-4, 3.2, 0.137, 9.96e-3, 4e-6, 0.0].map(duration),
        ["14 ms", "0.55 ms", "3.2 s", "137 ms", "10 ms", "4.0 µs", "0 µs"]
    );
    assert_eq!([2e-12, 3.4e-5, 0.0042].map(length_mm), ["2e-9", "0.034", "4.2"]);
    assert_eq!(small_length(0.0, 2e-3), "below 1e-15 mm");
    assert_eq!([0.12, 0.97, 4.21, 171.0].map(moment), ["120 ms", "1.0 s", "4.2 s", "171 s"]);
    let steps = [1.0 / 60.0, 1.0 / 600.0, 1.0 / 30.0, 1e-3, 0.01, 1e-5].map(step_name);
    assert_eq!(steps, ["1/60 s", "1/600 s", "1/30 s", "1.0 ms", "10 ms", "10 µs"]);
}

#[test]
fn lateness_says_which_way() {
    let late = Lateness { median: 0.014, earliest: 0.013, latest: 0.017, matched: 60, early: 0, of: 60 };
    assert_eq!(late.words(), "Impacts arrive 14 ms late (worst 17 ms).");
    // both ways each is counted: a median would hide the other
    let mixed = Lateness { earliest: -0.02, matched: 3, early: 1, ..late };
    assert_eq!(
        mixed.words(),
        "Of the first 3 impacts after a flight 2 arrive late, by up to 17 ms, and 1 early, by up to 20 \
         ms; then it takes another course."
    );
    let early = Lateness { median: -0.01, earliest: -0.02, latest: -0.01, early: 60, ..late };
    assert_eq!(early.words(), "Impacts arrive 10 ms early (worst 20 ms).");
    let few = Lateness { earliest: -0.003, early: 1, ..late };
    assert_eq!(few.words(), "Impacts arrive 14 ms late (worst 17 ms), 1 of 60 up to 3.0 ms early.");
}
