//! Parts that a scene does not use: they change no bit, and no step allocates.

use allocation_counter::{AllocationInfo, measure};
use interwell::dynamics::{Model, Request};

use crate::by_hand::{End, Problem};
use crate::support::*;

const ONE_WELL: &str = "mechanism=Cubic(linear_n_per_m: 40, cubic_n_per_m3: 816326.530612245)";

#[test]
fn the_general_path_is_the_hand_written_one_bit_for_bit() {
    let (sine, still) = ("excitation.amplitude_g=1.1", "excitation=None");
    let start = (9e-3, -0.125);
    let at = "start=At(x_mm: 9, v_m_per_s: -0.125)";
    for tolerance in ["1e-3", "1e-6", "1e-9", "1e-12"] {
        let tolerance = format!("run.tolerance={tolerance}");
        for well in [&["stops=None"][..], &["stops=None", ONE_WELL]] {
            for (drive, excitation) in [(sine, Some((1.1, 3.0))), (still, None)] {
                let model = preset("nominal-cubic", &[well, &[drive, at, &tolerance]].concat());
                let summary = model.run(&Request::default()).summary;
                let (x, v) = (summary.final_x, summary.final_v);
                let general = End { x, v, steps: summary.steps, crossings: summary.total_crossings };
                let by_hand = Problem::new(&model, excitation, start);
                assert_eq!(general, by_hand.run_counting(), "{well:?} {drive}");
                assert_eq!(End { crossings: 0, ..general }, by_hand.run(), "{well:?} {drive}");
                assert!(general.steps > 100);
            }
        }
    }
}

/// What one run allocates and its steps.
fn allocations(model: &Model, request: &Request) -> (AllocationInfo, u64) {
    let mut steps = 0;
    let info = measure(|| steps = model.run(request).summary.steps);
    (info, steps)
}

#[test]
fn no_step_allocates() {
    // The settled window has the same length in both runs, since what is kept of it to tell the regime grows.
    for changes in [
        &["stops=None", "excitation=None", "start=At(x_mm: 9, v_m_per_s: 0)"][..],
        &["stops=None", "excitation.amplitude_g=1.1"],
        &["stops=None", ONE_WELL],
        &[],
        &["stops.travel_limit_mm=7.5", "stops.restitution=0.9"],
        &["stops=Hertz(travel_limit_mm: 4, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 5)"],
        &["excitation=Sum([Sine(frequency_hz: 3, amplitude_g: 1), Sine(frequency_hz: 7, amplitude_g: 1)])"],
        &["excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 100)"],
        &["excitation=Noise(rms_g: 0.5, low_hz: 1, high_hz: 20, seed: 1, lines: 32)"],
        &["excitation=Chirp(from_hz: 1, to_hz: 6, over_s: 100, amplitude_g: 1)"],
        &["mechanism=Table(path: \"force_dl2.7.csv\")"],
    ] {
        for ledger in [false, true] {
            let request = Request { ledger, ..Request::default() };
            let run = |window: &[&str]| {
                let changes = [changes, window, &["run.recurrence=false"]].concat();
                allocations(&preset("nominal-cubic", &changes), &request)
            };
            let (short, few) = run(&["run.duration_s=20", "run.settle_s=18"]);
            let (long, many) = run(&["run.duration_s=40", "run.settle_s=38"]);
            assert!(many as f64 > 1.4 * few as f64, "{changes:?}: {few} steps, then {many}");
            assert!(
                long.count_total <= short.count_total && long.bytes_total <= short.bytes_total,
                "{changes:?}, ledger {ledger}: {short:?} in {few} steps, {long:?} in {many}"
            );
        }
    }
}

#[test]
fn a_cycle_is_kept_once() {
    // What a run that comes back keeps of its motion is a cycle, however long it lasts.
    let kept = |duration: &str, settle: &str| {
        allocations(&preset("nominal-cubic", &[duration, settle]), &Request::default())
    };
    let (short, steps) = kept("run.duration_s=20", "run.settle_s=18");
    let (long, same) = kept("run.duration_s=4000", "run.settle_s=3998");
    assert!(same < steps + 60, "{steps} steps, then {same}");
    assert!(
        long.count_total <= short.count_total && long.bytes_total <= short.bytes_total,
        "{short:?} {long:?}"
    );
    assert!(short.bytes_total < 100_000, "{short:?}");
}

#[test]
fn what_is_not_kept_takes_no_room() {
    let model = preset("nominal-cubic", &["run.settle_s=9.9", "run.recurrence=false"]);
    let (bare, steps) = allocations(&model, &Request::default());
    assert!(steps > 1000 && bare.count_total < 10 && bare.bytes_total < 1000, "{bare:?} in {steps} steps");
    // Samples take their own room, at once.
    let times = every(0.01, 999);
    let (sampled, _) = allocations(&model, &Request { sample_times: &times, ..Request::default() });
    assert_eq!(sampled.count_total, bare.count_total + 1);
}

#[test]
fn a_motion_that_nobody_watches_is_counted_the_same() {
    // Starts on the top, beside it, on a stop and in a well; free, between stops, on compliant ones, over
    // breaks of the force.
    let times = every(0.07, 140);
    let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
    for start in [(0.0, 0.3), (0.0, -0.3), (1e-6, -0.1), (-4.0, 0.0), (4.0, -1.0), (3.2, 0.01)] {
        for change in [
            "stops=None",
            "stops=Rigid(travel_limit_mm: 4, restitution: 0.36)",
            "stops=Rigid(travel_limit_mm: 4, restitution: 0.95)",
            "stops=Hertz(travel_limit_mm: 4, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 5)",
            "mechanism=Table(path: \"force_dl2.7.csv\")",
        ] {
            for settle in ["run.settle_s=0", "run.settle_s=4.3", "run.settle_s=9.99"] {
                let start = format!("start=At(x_mm: {}, v_m_per_s: {})", start.0, start.1);
                let model = preset("nominal-cubic", &[change, settle, &start, "run.recurrence=false"]);
                let (watched, bare) = (model.run(&request), model.run(&Request::default()));
                let mut expected = watched.summary;
                (expected.cpu_s, expected.ledger) = (bare.summary.cpu_s, None);
                (expected.impact_share, expected.mean_x) = (None, None); // these need the ledger
                assert_eq!(bare.summary, expected, "{change}, {settle}, {start}");
            }
        }
    }
}
