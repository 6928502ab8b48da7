//! Damping ratio and frequency of free decays, exact and with noise and jitter of known size.

use std::f64::consts::{PI, TAU};

use interwell::scene::{Channel, Quantity};
use interwell_studies::study::{Unidentified, damping};

use super::{Noise, SEEDS, covered, hold_95_of_100, holds, number};
use crate::cli::{column, headless};
use crate::properties::harness::multiplied;

const OFFSET: f64 = 3.2e-3;
const AMPLITUDE: f64 = 1e-3;
const HERTZ: f64 = 7.0;

/// A decay of damping ratio `xi` over `duration` s, with times off by `jitter` steps and values off by
/// `noise` m, each a standard deviation.
fn decay(xi: f64, rate: f64, duration: f64, (jitter, noise): (f64, f64), seed: u64) -> (Vec<f64>, Channel) {
    let mut random = Noise::new(seed);
    let natural = TAU * HERTZ;
    let damped = natural * (1.0 - xi * xi).sqrt();
    let mut times = Vec::new();
    let mut values = Vec::new();
    for i in 0..(rate * duration) as u32 {
        let t = f64::from(i) / rate;
        // sampled late, and written down as if in time
        let late = t + jitter / rate * random.next();
        times.push(t);
        let swing = (-xi * natural * late).exp() * (damped * late + 0.4).cos();
        values.push(OFFSET + AMPLITUDE * swing + noise * random.next());
    }
    (times, Channel { quantity: Quantity::Displacement, column: "x_m".into(), values })
}

#[test]
fn without_noise_ratio_and_frequency_have_their_digits() {
    for (xi, rate) in [(0.023, 1000.0), (0.002, 400.0), (0.1, 2000.0), (0.023, 137.0)] {
        let (times, channel) = decay(xi, rate, 4.0, (0.0, 0.0), 0);
        let found = damping(&times, &channel).unwrap();
        let ratio = number(&found, "damping_ratio");
        let bound = if rate < 200.0 { 2e-4 } else { 2e-6 };
        assert!((ratio.value / xi - 1.0).abs() < bound, "{xi}: {ratio:?}");
        let natural = number(&found, "natural_frequency_hz");
        assert!((natural.value / HERTZ - 1.0).abs() < bound, "{xi}: {natural:?}");
        let damped = number(&found, "frequency_hz");
        assert!((damped.value / (HERTZ * (1.0 - xi * xi).sqrt()) - 1.0).abs() < bound, "{xi}: {damped:?}");
        // row by row the ratio is the same, and the amplitude that of the decay
        for (row, of_row) in found.rows.numbers("damping_ratio").unwrap().iter().enumerate() {
            assert!((of_row / xi - 1.0).abs() < 50.0 * bound, "{xi}: row {row}: {of_row}");
            let column = |name: &str| found.rows.numbers(name).unwrap()[row];
            let middle = 0.5 * (column("from_s") + column("to_s"));
            let exact = AMPLITUDE * (1.0 - xi * xi).sqrt() * (-xi * TAU * HERTZ * middle).exp();
            assert!((column("amplitude_m") / exact - 1.0).abs() < 2e-3, "{xi}: row {row}");
        }
    }
}

#[test]
fn with_noise_and_jitter_the_intervals_hold_the_ratio_in_95_of_100_records() {
    for (xi, noise, jitter) in [(0.023, 2e-5, 0.0), (0.023, 5e-6, 0.2), (0.008, 5e-5, 0.1)] {
        let (mut ratios, mut frequencies, mut rows, mut all) = (0, 0, 0, 0);
        for seed in 0..SEEDS {
            let (times, channel) = decay(xi, 500.0, 3.0, (jitter, noise), seed);
            let found = damping(&times, &channel).unwrap();
            let ratio = number(&found, "damping_ratio");
            assert!((ratio.value / xi - 1.0).abs() < 0.1, "{ratio:?}");
            ratios += u64::from(holds(ratio, xi));
            let damped = HERTZ * (1.0 - xi * xi).sqrt();
            frequencies += u64::from(holds(number(&found, "frequency_hz"), damped));
            let column = |name: &str| found.rows.numbers(name).unwrap();
            let ends = column("damping_ratio_low").iter().zip(column("damping_ratio_high"));
            rows += ends.clone().filter(|(low, high)| (**low..=**high).contains(&xi)).count();
            all += ends.count();
        }
        covered(ratios, &format!("the ratio {xi} under noise {noise} and jitter {jitter}"));
        covered(frequencies, "the frequency");
        let share = rows as f64 / all as f64;
        assert!((0.91..0.985).contains(&share), "{share} of {all} rows hold the ratio");
    }
}

/// What limits a record to a range about its mean.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Limit {
    None,
    Upper,
    Both,
}

/// The longest run of `true` that has a `false` on either side.
fn longest_inner_run(flags: &[bool]) -> usize {
    let runs: Vec<usize> = flags.split(|flag| !flag).map(<[bool]>::len).collect();
    runs.iter().skip(1).take(runs.len().saturating_sub(2)).copied().max().unwrap_or(0)
}

/// A decay drawn at random: rate, length, damping ratio, noise, mean and limit; the ratio, its frequency and
/// the undamped one; the samples of the longest flat top.
fn drawn(random: &mut Noise, limit: Limit) -> ((Vec<f64>, Channel), [f64; 3], usize) {
    let (samples, cycles) = (random.of_any_size(24.0, 500.0), random.between(4.0, 50.0));
    let (xi, noise) = (random.of_any_size(1.5e-3, 0.15), random.of_any_size(1e-6, 3e-2));
    let (phase, mean, level) =
        (random.between(0.0, TAU), random.between(-5.0, 5.0), random.between(0.35, 0.97));
    let natural = HERTZ / (1.0 - xi * xi).sqrt();
    let times: Vec<f64> = (0..(samples * cycles) as u32).map(|i| f64::from(i) / (samples * HERTZ)).collect();
    let swing = |t: f64| (-xi * TAU * natural * t).exp() * (TAU * HERTZ * t + phase).cos();
    let largest = times.iter().map(|t| swing(*t).abs()).fold(0.0, f64::max);
    let (low, high) = match limit {
        Limit::None => (f64::NEG_INFINITY, f64::INFINITY),
        Limit::Upper => (f64::NEG_INFINITY, level * largest),
        Limit::Both => (-level * largest, level * largest),
    };
    let free: Vec<f64> = times.iter().map(|t| swing(*t) + noise * random.next()).collect();
    let values = free.iter().map(|x| AMPLITUDE * (mean + x.clamp(low, high))).collect();
    let cut: Vec<bool> = free.iter().map(|x| !(low..=high).contains(x)).collect();
    let channel = Channel { quantity: Quantity::Displacement, column: "x_m".into(), values };
    ((times, channel), [xi, HERTZ, natural], longest_inner_run(&cut))
}

#[test]
fn the_intervals_hold_the_truth_of_any_decay_clipped_or_not() {
    for limit in [Limit::None, Limit::Upper, Limit::Both] {
        let mut random = Noise::new(11);
        let most = multiplied(40) as usize;
        let (mut hits, mut found) = ([0; 4], 0);
        while found < most {
            let ((times, channel), [xi, damped, natural], flat) = drawn(&mut random, limit);
            let answer = match damping(&times, &channel) {
                Ok(answer) => answer,
                // too few swings beside those that are clipped
                Err(Unidentified::FewSwings { .. } | Unidentified::Clipped { .. }) => continue,
                Err(other) => panic!("{other}"),
            };
            found += 1;
            let clipped = answer.remarks.iter().any(|remark| remark.contains("clipped"));
            // of a top of one or two samples alone it is not known
            let right = if flat > 2 { clipped } else { limit != Limit::None || !clipped };
            assert!(right, "{flat} samples: {:?}", answer.remarks);
            let rate = xi * TAU * natural;
            let exact = [xi, damped, natural, rate];
            let names = ["damping_ratio", "frequency_hz", "natural_frequency_hz", "decay_per_s"];
            for (hits, (name, exact)) in hits.iter_mut().zip(names.into_iter().zip(exact)) {
                *hits += usize::from(holds(number(&answer, name), exact));
            }
        }
        for (hits, what) in hits.into_iter().zip(["ratio", "frequency", "natural frequency", "decay"]) {
            hold_95_of_100(hits, found, &format!("{what}, limits {limit:?}"));
        }
    }
}

#[test]
fn a_rounded_record_is_not_taken_for_a_clipped_one() {
    let mut random = Noise::new(2);
    for _ in 0..40 {
        let ((times, mut channel), ..) = drawn(&mut random, Limit::None);
        let step = AMPLITUDE * random.of_any_size(1e-4, 1e-2);
        channel.values.iter_mut().for_each(|value| *value = (*value / step).round() * step);
        if let Ok(found) = damping(&times, &channel) {
            assert!(!found.remarks.iter().any(|remark| remark.contains("clipped")), "{:?}", found.remarks);
        }
    }
}

#[test]
fn a_decay_across_a_kink_has_the_decay_of_its_damping_coefficient() {
    // two springs that meet at the rest position, and the same damper: over each half the swing is a sine,
    // and all swings are alike
    let (inner, outer, rate) = (TAU * 15.0, TAU * 81.0, 2.18);
    let half = [inner, outer].map(|natural: f64| PI / (natural * natural - rate * rate).sqrt());
    for step in [1e-4, 5e-4] {
        let position = |t: f64| {
            let (period, (mut since, mut speed)) = (half[0] + half[1], (t, 0.1));
            let whole = (since / period).floor();
            since -= whole * period;
            speed *= (-rate * whole * period).exp();
            let (side, length, begin) =
                if since < half[1] { (1.0, half[1], 0.0) } else { (-1.0, half[0], half[1]) };
            let damped = PI / length;
            let within = since - begin;
            side * speed * (-rate * since).exp() * (damped * within).sin() / damped
        };
        let times: Vec<f64> = (0..(1.5 / step) as u32).map(|i| f64::from(i) * step).collect();
        let values = times.iter().map(|t| 7e-3 + position(*t)).collect();
        let channel = Channel { quantity: Quantity::Displacement, column: "x_m".into(), values };
        let found = damping(&times, &channel).unwrap();
        let bound = if step < 2e-4 { 1e-3 } else { 2e-2 };
        assert!((number(&found, "decay_per_s").value / rate - 1.0).abs() < bound, "{:?}", found.summary);
        let frequency = 1.0 / (half[0] + half[1]);
        assert!(
            (number(&found, "frequency_hz").value / frequency - 1.0).abs() < bound,
            "{:?}",
            found.summary
        );
    }
}

#[test]
fn a_decay_of_the_prototype_without_stops_has_rows_over_its_amplitude() {
    let folder = tempfile::tempdir().unwrap();
    let [record, rows] = ["decay.csv", "rows.csv"].map(|name| folder.path().join(name));
    let scene =
        "simulate paper --set stops=None --set excitation=None --set run.duration_s=3 --dt 0.0005 --quiet";
    let mut command = headless(scene);
    command.args(["--set", "start=At(x_mm: 7.2, v_m_per_s: 0)", "--out"]).arg(&record).assert().success();
    let mut command = headless("identify --of damping");
    let said = command.arg(&record).arg("--out").arg(&rows).assert().success().get_output().stderr.clone();
    let said = String::from_utf8(said).unwrap();
    assert!(
        said.contains("change with the amplitude") && said.contains("means over the amplitudes"),
        "{said}"
    );
    let rows = std::fs::read_to_string(rows).unwrap();
    let numbers = |name: &str| -> Vec<f64> {
        column(&rows, name).into_iter().map(|number| number.parse().unwrap()).collect()
    };
    // small swings stay beyond the kink, larger ones last longer; c/(2 m) is what `check` has of this scene
    let (frequencies, rates) = (numbers("frequency_hz"), numbers("decay_per_s"));
    let last = rates.len() - 1;
    assert!(frequencies[0] < 36.0 && (frequencies[last] - 81.61).abs() < 0.01, "{frequencies:?}");
    assert!((rates[last] - 0.06631 / (2.0 * 0.0152)).abs() < 2e-3, "{rates:?}");
}

#[test]
fn the_rows_follow_a_ratio_that_grows_with_the_amplitude() {
    // a' = -w (xi a + s a^2): each row has the ratio xi + s a of its amplitude
    let (xi, s, w) = (0.01, 20.0, TAU * HERTZ);
    let times: Vec<f64> = (0..4000).map(|i| f64::from(i) * 1e-3).collect();
    let amplitude = |t: f64| xi / ((xi / AMPLITUDE + s) * (xi * w * t).exp() - s);
    let values = times.iter().map(|t| amplitude(*t) * (w * t).cos()).collect();
    let channel = Channel { quantity: Quantity::Displacement, column: "x_m".into(), values };
    let found = damping(&times, &channel).unwrap();
    let column = |name: &str| found.rows.numbers(name).unwrap();
    for (ratio, amplitude) in column("damping_ratio").iter().zip(column("amplitude_m")) {
        let exact = xi + s * amplitude;
        assert!((ratio / exact - 1.0).abs() < 0.02, "{ratio} at {amplitude}, not {exact}");
    }
    assert!(
        found.remarks.iter().any(|remark| remark.contains("with the amplitude by more than the intervals")),
        "{:?}",
        found.remarks
    );
}

#[test]
fn what_is_no_decay_is_refused() {
    let (times, channel) = decay(0.023, 40.0, 3.0, (0.0, 0.0), 0);
    assert!(matches!(damping(&times, &channel), Err(Unidentified::Sparse { .. })));
    let (times, channel) = decay(0.023, 500.0, 3.0, (0.0, 1e-3), 0);
    assert!(matches!(damping(&times, &channel), Err(Unidentified::FewSwings { .. })));
    let (mut times, channel) = decay(0.01, 500.0, 3.0, (0.0, 0.0), 0);
    times.iter_mut().filter(|t| **t > 1.0).for_each(|t| *t += 0.5);
    assert!(matches!(damping(&times, &channel), Err(Unidentified::Uneven { .. })));
    let (times, mut channel) = decay(0.01, 500.0, 3.0, (0.0, 0.0), 0);
    times
        .iter()
        .zip(&mut channel.values)
        .filter(|sample| *sample.0 > 1.0)
        .for_each(|sample| *sample.1 += AMPLITUDE);
    assert!(matches!(
        damping(&times, &channel),
        Err(Unidentified::Moved { .. } | Unidentified::Uneven { .. })
    ));
    let (times, mut channel) = decay(0.01, 500.0, 1.0, (0.0, 0.0), 0);
    channel.values.iter_mut().for_each(|value| *value = value.min(OFFSET + 0.3 * AMPLITUDE));
    assert!(matches!(damping(&times, &channel), Err(Unidentified::Clipped { .. })));
    let still = Channel { values: vec![1.0; times.len()], ..channel };
    assert!(matches!(damping(&times, &still), Err(Unidentified::FewSwings { found: 0 | 1, .. })));
}
