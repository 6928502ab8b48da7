//! Runs that are completed from a repeated cycle, against the same runs integrated to the end.

use interwell::dynamics::{Ledger, Model, Outcome, Request, Run, Summary};
use interwell_studies::study::{Read, SUMMARY_FIELDS};

use super::support::*;

/// Differences that the order of a sum and the mirroring of half a cycle leave, relative to the scales.
const ROUNDING: f64 = 1e-12;

/// A run with everything listed, and one with nothing.
fn both(model: &Model, times: &[f64]) -> [Run; 2] {
    let all = Request { sample_times: times, events: true, ledger: true, ..Request::default() };
    [model.run(&all), model.run(&Request::default())]
}

fn close(a: f64, b: f64, size: f64) -> bool {
    a == b || (a - b).abs() <= ROUNDING * size.abs()
}

fn close_options(a: Option<f64>, b: Option<f64>, size: f64) -> bool {
    a.zip(b).map_or(a == b, |(a, b)| close(a, b, size))
}

/// Fields that may differ: what the integration took.
const MAY_DIFFER: [&str; 2] = ["steps", "evaluations"];

/// Every other field of two summaries of one model.
fn same_summary(model: &Model, a: &Summary, b: &Summary) {
    let moved = a.ledger.map_or(0.0, |ledger: Ledger| {
        [ledger.work_j, ledger.damping_j, ledger.impact_j, ledger.stored_j]
            .iter()
            .map(|term| term.abs())
            .sum()
    });
    for field in SUMMARY_FIELDS.iter().filter(|field| !MAY_DIFFER.contains(&field.name)) {
        let size = match field.name {
            name if name.ends_with("_m_per_s") => model.scales().speed,
            name if name.ends_with("_m") => model.scales().length,
            name if name.ends_with("_s") => model.duration(),
            name if name.ends_with("_j") => moved,
            _ => 1.0,
        };
        let same = match field.read {
            Read::Number(of) => close_options(of(a), of(b), size),
            Read::Count(of) => of(a) == of(b),
            Read::Word(of) => of(a) == of(b),
            Read::Flag(of) => of(a) == of(b),
        };
        assert!(same, "{}: {a:?}\n{b:?}", field.name);
    }
}

fn same_motion(model: &Model, a: &Run, b: &Run) {
    let (length, speed) = (model.scales().length, model.scales().speed);
    assert_eq!((a.samples.len(), a.events.len()), (b.samples.len(), b.events.len()));
    for (a, b) in a.samples.iter().zip(&b.samples) {
        assert!(close(a.x, b.x, length) && close(a.v, b.v, speed), "{a:?} {b:?}");
        assert_eq!((a.t, a.base_accel), (b.t, b.base_accel));
        assert_eq!(a.phase, b.phase);
    }
    for (a, b) in a.events.iter().zip(&b.events) {
        assert!(close(a.t, b.t, model.duration()), "{a:?} {b:?}");
        assert_eq!((a.kind, a.side), (b.kind, b.side));
        assert!(close(a.v_in, b.v_in, speed) && close(a.v_out, b.v_out, speed), "{a:?} {b:?}");
    }
}

/// Compares a scene with and without; whether its cycle came back.
fn compare(scene: &str, changes: &[&str]) -> bool {
    let with = |flag: bool| {
        let flag = format!("run.recurrence={flag}");
        let changes: Vec<&str> = changes.iter().copied().chain([flag.as_str()]).collect();
        let model = preset(scene, &changes);
        let times = every(model.duration() / 311.7, 312);
        let runs = both(&model, &times);
        (model, runs)
    };
    let ((model, on), (_, off)) = (with(true), with(false));
    for (on, off) in on.iter().zip(&off) {
        same_summary(&model, &on.summary, &off.summary);
        same_motion(&model, on, off);
    }
    on[1].summary.steps < off[1].summary.steps
}

/// Cells of a map of travel limits and amplitudes whose cycle came back, after comparing all.
fn compare_map(scene: &str, changes: &[&str], limits: &[f64], amplitudes: &[f64]) -> usize {
    let mut returned = 0;
    for limit in limits {
        for amplitude in amplitudes {
            let limit = format!("stops.travel_limit_mm={limit}");
            let amplitude = format!("excitation.amplitude_g={amplitude}");
            let changes: Vec<&str> =
                changes.iter().copied().chain([limit.as_str(), amplitude.as_str()]).collect();
            returned += usize::from(compare(scene, &changes));
        }
    }
    returned
}

fn steps(from: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| ((from + step * i as f64) * 1e6).round() / 1e6).collect()
}

#[test]
fn a_map_of_stops_and_amplitudes() {
    let limits = steps(0.5, 0.75, 10);
    let amplitudes = steps(0.1, 0.1, 20);
    let returned = compare_map("nominal-cubic", &["run.duration_s=6"], &limits, &amplitudes);
    assert!(returned > 100, "{returned}");
}

#[test]
fn plastic_and_lively_stops_and_other_phases() {
    for changes in [
        ["stops.restitution=0", "run.settle_s=1.234"],
        ["stops.restitution=0.8", "run.settle_s=0"],
        ["run.tolerance=1e-4", "excitation.phase_deg=77.7"],
        ["run.tolerance=1e-12", "excitation.frequency_hz=2.3"],
    ] {
        let changes = [&["run.duration_s=7.7"], &changes[..]].concat();
        let returned =
            compare_map("nominal-cubic", &changes, &[1.0, 2.5, 4.0, 5.5], &[0.8, 1.1, 1.4, 1.7, 2.0]);
        assert!(returned >= 4, "{changes:?} {returned}");
    }
}

#[test]
fn flexures() {
    let returned = compare_map("paper", &["run.duration_s=6"], &[1.0, 2.0, 4.0], &[0.9, 1.2, 1.5, 1.9]);
    assert!(returned > 4, "{returned}");
}

#[test]
fn uneven_stops_have_no_mirror_image() {
    let mut returned = 0;
    for amplitude in steps(0.4, 0.2, 8) {
        let amplitude = format!("excitation.amplitude_g={amplitude}");
        returned += usize::from(compare("uneven-stops", &["run.duration_s=8", &amplitude]));
    }
    assert!(returned > 3, "{returned}");
}

#[test]
fn sums_that_repeat() {
    let sine = |f: f64, a: f64| format!("Sine(frequency_hz: {f}, amplitude_g: {a})");
    let mut returned = Vec::new();
    for (sum, repeats) in [
        (format!("[{}, {}]", sine(3.0, 1.4), sine(9.0, 0.2)), true),
        (format!("[{}, {}]", sine(3.0, 1.4), sine(6.0, 0.2)), true),
        (format!("[{}, Constant(accel_g: 0.1)]", sine(3.0, 1.4)), true),
        (format!("[{}, {}]", sine(3.0, 1.4), sine(2.5, 0.3)), true),
        // an end to the growth, and none within the run
        ("[AmplitudeRamp(frequency_hz: 3, from_g: 0.2, to_g: 1.5, over_s: 1.3)]".to_owned(), true),
        ("[AmplitudeRamp(frequency_hz: 3, from_g: 0.2, to_g: 1.5, over_s: 13)]".to_owned(), false),
        // no common measure
        (format!("[{}, {}]", sine(3.0, 1.4), sine(std::f64::consts::E, 0.2)), false),
        (
            format!("[{}, Noise(rms_g: 0.01, low_hz: 1, high_hz: 6, seed: 1, lines: 20)]", sine(3.0, 1.4)),
            false,
        ),
    ] {
        let excitation = format!("excitation=Sum({sum})");
        let came_back = compare("nominal-cubic", &["run.duration_s=11.1", &excitation]);
        returned.push((sum, came_back, repeats));
    }
    assert!(returned.iter().all(|(_, came_back, repeats)| came_back == repeats), "{returned:#?}");
}

#[test]
fn the_labels_of_others_are_not_taken() {
    // Compliant stops, and no drive: nothing comes back by a label.
    let hertz = "stops=Hertz(travel_limit_mm: 4, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 0.5)";
    assert!(!compare("nominal-cubic", &["run.settle_s=0.5", "run.duration_s=1", hertz]));
    assert!(!compare("bouncing-ball", &[]));
    assert!(!compare("elastic-box", &[]));
}

#[test]
fn the_budgets_bound_work_and_not_the_length_of_a_run() {
    // 26 impacts a cycle for some 1e5 cycles: more than may be made one by one, and nothing to multiply.
    let long = ["run.duration_s=33000", "run.settle_s=1000"];
    let on = preset("nominal-cubic", &long).run(&Request::default()).summary;
    let off = preset("nominal-cubic", &[&long[..], &["run.recurrence=false"]].concat());
    let off = off.run(&Request::default()).summary;
    assert_eq!((on.outcome.name(), off.outcome.name()), ("done", "impact_budget"));
    assert!(matches!(off.outcome, Outcome::ImpactBudget { count: 2_000_000, .. }), "{off:?}");
    assert!(on.total_impacts > 2_500_000 && on.steps < 1000, "{on:?}");
}

#[test]
fn a_billion_seconds_that_come_back_are_done() {
    for scene in ["paper", "nominal-cubic", "uneven-stops"] {
        let model = preset(scene, &["run.duration_s=1e9", "run.settle_s=5"]);
        let minute = preset(scene, &["run.duration_s=60", "run.settle_s=5"]);
        let bare = model.run(&Request::default()).summary;
        // a sample at the end, without all the laps before it
        let times = [1.0, 999_999_999.25];
        let sampled = model.run(&Request { sample_times: &times, ledger: true, ..Request::default() });
        let minute = minute.run(&Request::default()).summary;
        assert_eq!((bare.outcome.name(), sampled.summary.outcome.name()), ("done", "done"), "{scene}");
        assert_eq!((sampled.samples.len(), sampled.summary.total_impacts), (2, bare.total_impacts));
        assert!(bare.steps < minute.steps + 60, "{} {}", bare.steps, minute.steps);
        let rate = |of: &Summary, duration: f64| of.impacts as f64 / (duration - 5.0);
        assert!((rate(&bare, 1e9) / rate(&minute, 60.0) - 1.0).abs() < 0.05, "{scene}");
    }
}

#[test]
fn laps_that_are_told_again_for_a_list_are_work() {
    // A list of all events would not fit: it ends with the impacts that one run may make.
    let model = preset("paper", &["run.duration_s=1e9", "run.settle_s=5"]);
    let run = model.run(&Request { events: true, ..Request::default() });
    let Outcome::ImpactBudget { count, at } = run.summary.outcome else { panic!("{:?}", run.summary) };
    assert!((2_000_000..2_001_000).contains(&count), "{count}");
    let listed = of_kind(&run, interwell::dynamics::EventKind::Impact).len() as u64;
    assert!(listed.abs_diff(count) < 1000, "{count} of {listed}");
    assert!(run.events.last().is_some_and(|event| event.t <= at));
}

#[test]
fn a_day_costs_what_a_minute_does() {
    let steps = |duration: f64| {
        let changes = [format!("run.duration_s={duration}"), "stops.restitution=0".to_owned()];
        preset("nominal-cubic", &[&changes[0], &changes[1]]).run(&Request::default()).summary.steps
    };
    assert!(steps(86_400.0) < steps(60.0) + 60, "{} {}", steps(86_400.0), steps(60.0));
}

#[test]
fn a_run_without_stops_is_untouched() {
    let with = |flag: &str| preset("nominal-cubic", &["stops=None", flag]);
    let [on, off] = ["run.recurrence=true", "run.recurrence=false"].map(|flag| run(&with(flag)));
    same_bits(&on, &off);
}
