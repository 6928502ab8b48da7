//! Runs that share their steps: each is the run that it would be alone, to the last bit, in any number of
//! lanes.

use std::io::Write as _;

use interwell::dynamics::{Model, Request, Run, Summary};

use super::support::*;

/// The summaries of runs, the time that they took left out, as texts: these tell 0 from -0 and have a text
/// for NaN.
fn bare(runs: &[Run]) -> Vec<String> {
    runs.iter()
        .map(|run| {
            let mut summary: Summary = run.summary;
            summary.cpu_s = 0.0;
            format!("{summary:?}")
        })
        .collect()
}

fn alone(models: &[Model]) -> Vec<String> {
    bare(&models.iter().map(|model| model.run(&Request::default())).collect::<Vec<_>>())
}

/// The summaries of models run together, and of each alone.
fn compare(models: &[Model]) {
    let together = Model::run_together(models, &Request::default());
    assert_eq!(bare(&together), alone(models));
    assert!(together.iter().all(|run| run.samples.is_empty() && run.events.is_empty()));
}

fn models(scene: &str, all: &[&str], each: impl IntoIterator<Item = String>) -> Vec<Model> {
    each.into_iter().map(|change| preset(scene, &[all, &[change.as_str()]].concat())).collect()
}

fn amplitudes(count: usize) -> impl Iterator<Item = String> {
    (0..count).map(|i| format!("excitation.amplitude_g={}", 0.1 * i as f64))
}

#[test]
fn maps_with_and_without_stops() {
    for (scene, all) in [
        ("nominal-cubic", &["stops=None", "run.duration_s=5", "run.settle_s=2.345"][..]),
        ("nominal-cubic", &["run.duration_s=6"]),
        ("nominal-cubic", &["run.duration_s=6", "run.recurrence=false", "excitation.phase_deg=123"]),
        ("nominal-cubic", &["stops.travel_limit_mm=6.5", "run.tolerance=1e-4", "excitation.phase_deg=90"]),
        ("paper", &["run.duration_s=3", "run.settle_s=1"]),
        ("paper", &["stops=None", "run.duration_s=3", "run.settle_s=1", "run.tolerance=1e-12"]),
        ("uneven-stops", &["run.duration_s=5"]),
        ("monostable", &["run.duration_s=5", "run.settle_s=1"]),
    ] {
        compare(&models(scene, all, amplitudes(21)));
    }
}

/// Other tolerances, drives, stops, curves and lengths; some that cannot share their steps at all.
fn unlike() -> Vec<Model> {
    let mut all = Vec::new();
    for (i, changes) in [
        &["stops=None"][..],
        &["run.tolerance=1e-6"],
        &["excitation=None"],
        &["mechanism=Cubic(linear_n_per_m: -20, cubic_n_per_m3: 1e6)"],
        &["mechanism=Polynomial(coefficients_si: [0, -40, 100, 8e5])"],
        &["excitation=Noise(rms_g: 0.5, low_hz: 1, high_hz: 9, seed: 3, lines: 20)"],
        &["stops=Hertz(travel_limit_mm: 4, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 0.5)"],
        &["excitation.amplitude_g=0"],
        &["excitation.frequency_hz=0.31"],
        &["start=At(x_mm: 1, v_m_per_s: 0.3)"],
        &["mass_g=150"],
    ]
    .iter()
    .enumerate()
    {
        for seconds in [1, 4] {
            let length = format!("run.duration_s={}", seconds as f64 + 0.01 * i as f64);
            all.push(preset("nominal-cubic", &[&["run.settle_s=0.7", length.as_str()], *changes].concat()));
        }
    }
    all
}

#[test]
fn models_that_have_little_in_common() {
    let mut all = unlike();
    compare(&all);
    all.reverse();
    compare(&all);
    compare(&all[..1]);
    compare(&[]);
}

#[test]
fn a_curve_that_ends_and_one_of_several_pieces() {
    let table = |amplitude: f64| format!("excitation.amplitude_g={amplitude}");
    let each = [0.5, 1.0, 1.5, 2.0, 3.0, 6.0, 12.0].map(table);
    compare(&models("paper-table", &["stops=None", "run.duration_s=3", "run.settle_s=1"], each.clone()));
    compare(&models("paper", &["stops.travel_limit_mm=7.17", "run.duration_s=3", "run.settle_s=1"], each));
}

#[test]
fn stops_near_and_far_with_every_kind_of_rebound() {
    let all = ["run.duration_s=7", "run.settle_s=2.9", "run.tolerance=1e-6"];
    for (restitution, amplitude) in [("0", 0.9), ("0.36", 1.3), ("0.36", 1.9), ("0.8", 1.1), ("1", 0.6)] {
        let (restitution, amplitude) =
            (format!("stops.restitution={restitution}"), format!("excitation.amplitude_g={amplitude}"));
        let changes = [&all[..], &[restitution.as_str(), amplitude.as_str()]].concat();
        let limits = (0..37).map(|i| format!("stops.travel_limit_mm={}", 0.5 + 0.25 * i as f64));
        compare(&models("nominal-cubic", &changes, limits));
    }
}

/// Registers of four and of eight numbers, two a column where they hold eight, and those that every processor
/// has.
#[test]
fn the_same_bits_in_4_8_and_16_lanes() {
    let settings = ["run.duration_s=7", "run.settle_s=2.9", "run.tolerance=1e-6"];
    let limits = (0..37).map(|i| format!("stops.travel_limit_mm={}", 0.5 + 0.25 * f64::from(i)));
    let free = ["stops=None", "run.duration_s=3", "run.settle_s=1"];
    let all = [unlike(), models("nominal-cubic", &settings, limits), models("paper", &free, amplitudes(21))]
        .concat();
    let alone = alone(&all);
    for width in [4, 8, 16] {
        match Model::run_all_in_lanes(&all, width) {
            Some(runs) => assert_eq!(bare(&runs), alone, "{width} lanes"),
            // past the capture of what passing tests print
            None => writeln!(std::io::stderr(), "skipped: no {width} lanes on this processor").unwrap(),
        }
    }
    assert!(Model::run_all_in_lanes(&all, 4).is_some(), "every processor has 4 lanes");
    assert!(Model::run_all_in_lanes(&all, 5).is_none());
}
