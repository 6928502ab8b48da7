//! Damping ratio and frequency of free decays, exact and with noise and jitter of known size.

use std::f64::consts::TAU;

use interwell::scene::{Channel, Quantity};
use interwell::study::{Unidentified, damping};

use super::{Noise, SEEDS, covered, holds, number};

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
        for (row, own) in found.rows.numbers("damping_ratio").unwrap().iter().enumerate() {
            assert!((own / xi - 1.0).abs() < 50.0 * bound, "{xi}: row {row}: {own}");
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
    for (own, amplitude) in column("damping_ratio").iter().zip(column("amplitude_m")) {
        let exact = xi + s * amplitude;
        assert!((own / exact - 1.0).abs() < 0.02, "{own} at {amplitude}, not {exact}");
    }
    assert!(
        found.remarks.iter().any(|own| own.contains("changes with the amplitude")),
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
    let still = Channel { values: vec![1.0; times.len()], ..channel };
    assert!(matches!(damping(&times, &still), Err(Unidentified::FewSwings { found: 0 | 1, .. })));
}
