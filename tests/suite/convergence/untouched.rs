//! Bits of a run under samples, events, ledgers and stops that are never reached.

use std::fmt::Debug;

use interwell::dynamics::{Model, Request, Run};

use crate::support::*;

/// Scenes of every kind: chaos, stops, pieces, sums, ramps, a free fall.
fn scenes() -> Vec<Model> {
    let long = "run.duration_s=300";
    vec![
        preset("duffing", &[long, "run.settle_s=100"]),
        preset("nominal-cubic", &[]),
        preset("nominal-cubic", &["stops=None", "excitation.amplitude_g=1.1"]),
        preset("nominal-cubic", &["stops.travel_limit_mm=7.5", "stops.restitution=0.9"]),
        preset(
            "nominal-cubic",
            &["excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 7)"],
        ),
        preset(
            "nominal-cubic",
            &["excitation=Sum([Sine(frequency_hz: 3, amplitude_g: 1), Sine(frequency_hz: 7, \
                 amplitude_g: 1)])"],
        ),
        preset("paper", &[]),
        preset("paper-table", &[]),
        preset("bouncing-ball", &[]),
        preset("elastic-box", &[]),
    ]
}

/// The flexures of `paper`.
const PROTOTYPE: &str = "mechanism=Flexures(preload_mm: 2.7, thickness_mm: 0.1, young_gpa: 190, \
                         parallel: (count: 2, length_mm: 26, width_mm: 20), \
                         buckling: (count: 1, length_mm: 27.7, width_mm: 6.8))";

#[test]
fn a_stop_never_reached_changes_no_bit() {
    // The unstopped run against stops far out, just outside the largest excursion, and on one side only:
    // every sample and every figure of the summary.
    for changes in [
        &["excitation.amplitude_g=1.1"][..],
        &["excitation.amplitude_g=0.3"],
        &["excitation=None", "start=At(x_mm: 3, v_m_per_s: 0.4)"],
        &["excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 7)"],
        &["mechanism=Table(path: \"force_dl2.7.csv\")", "excitation.amplitude_g=1.3"],
        &[PROTOTYPE, "excitation.amplitude_g=1.3"],
    ] {
        let with = |stops: &str| {
            let stops = format!("stops={stops}");
            preset("nominal-cubic", &[changes, &["run.settle_s=0", &stops]].concat())
        };
        let times = every(0.0173, 570);
        let open = run_at(&with("None"), &times);
        assert!(open.samples.len() == 570 && open.summary.travel().unwrap() > 1e-3);
        let reach_mm = open.summary.max_abs_x.unwrap() * 1e3;
        let table = changes[0].starts_with("mechanism");
        let just = format!("Rigid(travel_limit_mm: {:?}, restitution: 0.36)", reach_mm * (1.0 + 1e-9));
        let far = "Rigid(travel_limit_mm: 1e6, restitution: 0.5)";
        let near = format!("Uneven(left_mm: {:?}, restitution_left: 0.1)", reach_mm * (1.0 + 1e-6));
        for stops in [&just, far, &near] {
            if table && stops == far {
                continue; // beyond the curve
            }
            same_bits(&open, &run_at(&with(stops), &times));
        }
    }
}

/// All that concerns the motion in a summary.
fn motion(run: &Run) -> impl PartialEq + Debug {
    let s = &run.summary;
    let counts = [
        s.crossings,
        s.impacts,
        s.releases,
        s.total_crossings,
        s.total_impacts,
        s.rests,
        s.steps,
        s.evaluations,
    ];
    (s.final_x, s.final_v, s.rms_velocity, counts, s.period, s.regime, s.range, s.max_abs_x)
}

#[test]
fn watching_changes_no_bit() {
    // Samples, events and ledger on or off: the motion is the same to the last bit, and so is each record.
    for model in scenes() {
        let plain = model.run(&Request::default());
        let times = every(model.duration() / 997.0, 997);
        let few: Vec<f64> = times.iter().step_by(83).copied().collect();
        let full = run_at(&model, &times);
        for (sample_times, events, ledger) in [
            (&[][..], false, true),
            (&[], true, false),
            (&few, false, false),
            (&few, true, true),
            (&times, true, true),
        ] {
            let run = model.run(&Request { sample_times, events, ledger, ..Request::default() });
            assert_eq!(motion(&run), motion(&plain));
            assert_eq!(run.summary.ledger, full.summary.ledger.filter(|_| ledger));
            if events {
                assert_eq!(run.events, full.events);
            }
            let expected = full.samples.iter().filter(|s| sample_times.contains(&s.t));
            assert!(run.samples.iter().eq(expected));
            assert_eq!(run.samples.len(), sample_times.len());
        }
    }
}

#[test]
fn the_settled_window_changes_no_bit_of_the_motion() {
    // Where statistics begin is no concern of the trajectory.
    let times = every(0.0173, 570);
    let with = |settle: &str| run_at(&preset("nominal-cubic", &[&format!("run.settle_s={settle}")]), &times);
    let base = with("5");
    for settle in ["0", "None", "1.2345", "9.99", "10"] {
        let other = with(settle);
        assert_eq!(other.samples, base.samples);
        assert_eq!(other.events, base.events);
        assert_eq!(other.summary.steps, base.summary.steps);
    }
}

#[test]
fn a_shorter_run_is_the_beginning_of_a_longer_one() {
    // Until the last step the duration is no concern of the trajectory either: events and samples to the last
    // bit.
    let times = every(0.0173, 570);
    let with = |duration: f64| {
        let model = preset("nominal-cubic", &[&format!("run.duration_s={duration:?}")]);
        let times: Vec<f64> = times.iter().copied().filter(|t| *t <= duration).collect();
        run_at(&model, &times)
    };
    let (short, long) = (with(6.0), with(10.0));
    let whole = long.events.iter().take_while(|e| e.t < 5.9).count();
    assert!(whole > 500);
    assert_eq!(short.events[..whole], long.events[..whole]);
    let sampled = times.iter().take_while(|t| **t < 5.9).count();
    assert_eq!(short.samples[..sampled], long.samples[..sampled]);
}

#[test]
fn the_recurrence_flag_changes_no_bit_of_the_path() {
    // With `recurrence` on or off: the same samples, events and figures, where no half of a cycle is
    // mirrored.
    let times = every(0.0173, 570);
    let with = |flag: bool| run_at(&preset("uneven-stops", &[&format!("run.recurrence={flag}")]), &times);
    let (on, off) = (with(true), with(false));
    assert!(on.summary.steps < off.summary.steps / 4);
    assert!(on.samples == off.samples && on.events == off.events);
    assert_eq!((on.summary.final_x, on.summary.final_v), (off.summary.final_x, off.summary.final_v));
    // A sum of laps and a sum of steps round differently.
    near_relative(on.summary.rms_velocity.unwrap(), off.summary.rms_velocity.unwrap(), 1e-15);
}
