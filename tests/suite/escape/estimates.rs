//! Rates of events, medians and quantiles from waiting times that are cut short, against their definitions.

use interwell::numeric::{QuantileRanks, Rate, Waiting, median};

use crate::support::{Draw, near_relative};

/// Probability of at most `count` events where `mean` are expected.
fn poisson_up_to(count: u64, mean: f64) -> f64 {
    let (mut log_term, mut sum) = (-mean, 0.0);
    for k in 0..=count {
        sum += f64::exp(log_term);
        log_term += mean.ln() - ((k + 1) as f64).ln();
    }
    sum
}

#[test]
fn the_ends_of_a_rate_are_those_at_which_the_count_has_a_probability_of_a_fortieth() {
    let mut draw = Draw(1);
    for _ in 0..300 {
        let events = (500.0 * draw.unit().powi(3)) as u64;
        let observed = 10_f64.powf(draw.between(-6.0, 9.0));
        let rate = Rate::of(events, observed);
        assert_eq!(rate.value, events as f64 / observed);
        near_relative(poisson_up_to(events, rate.high * observed), 0.025, 1e-6);
        match events {
            0 => assert_eq!(rate.low, 0.0),
            _ => near_relative(1.0 - poisson_up_to(events - 1, rate.low * observed), 0.025, 1e-6),
        }
    }
    // without an event and with one, the quantiles have closed forms
    near_relative(Rate::of(0, 2.0).high, 0.5 * 40_f64.ln(), 1e-6);
    near_relative(Rate::of(1, 2.0).low, -0.5 * 0.975_f64.ln(), 1e-6);
}

#[test]
fn the_interval_of_a_rate_covers_it_in_nineteen_of_twenty_samples() {
    let mut draw = Draw(2);
    let (mut covered, mut below, mut above, mut counts) = (0, 0, 0, [0_u32; 3]);
    const SAMPLES: u32 = 6000;
    for _ in 0..SAMPLES {
        let rate = 10_f64.powf(draw.between(-4.0, 4.0));
        let runs = 1 + (60.0 * draw.unit()) as u32;
        // from nearly all cut short to nearly none
        let within = 10_f64.powf(draw.between(-1.5, 1.0)) / rate;
        let (mut events, mut observed) = (0, 0.0);
        for _ in 0..runs {
            let wait = -(1.0 - draw.unit()).ln() / rate;
            events += u64::from(wait < within);
            observed += wait.min(within);
        }
        let found = Rate::of(events, observed);
        covered += u32::from(found.low <= rate && rate <= found.high);
        below += u32::from(rate < found.low);
        above += u32::from(rate > found.high);
        let kind = if events == 0 { 0 } else { 1 + usize::from(events == u64::from(runs)) };
        counts[kind] += 1;
    }
    // three standard errors of a share of 0.95 are 0.0085, of 0.025 are 0.006
    assert!(f64::from(covered) >= 0.9415 * f64::from(SAMPLES), "{covered} of {SAMPLES}");
    assert!(f64::from(below.max(above)) <= 0.035 * f64::from(SAMPLES), "{below} below, {above} above");
    assert!(counts.iter().all(|count| *count > SAMPLES / 60), "none, some, all escaped: {counts:?}");
}

#[test]
fn the_median_is_that_of_kaplan_and_meier() {
    // remissions in weeks of leukaemia under 6-mercaptopurine (Freireich and others 1963), negative if cut
    // short; the median of the estimate is 23
    let weeks = [6, 6, 6, -6, 7, -9, 10, -10, -11, 13, 16, -17, -19, -20, 22, 23, -25, -32, -32, -34, -35];
    let waiting = |weeks: i32| Waiting { time: f64::from(weeks.abs()), happened: weeks > 0 };
    assert_eq!(median(&weeks.map(waiting)), Some(23.0));
    assert_eq!(median(&[-6, -9, 10].map(waiting)), Some(10.0));
    assert_eq!(median(&[-6, 9, -10].map(waiting)), Some(9.0));
    assert_eq!(median(&[1, 2, 3, -4, -4, -4, -4].map(waiting)), None);
    assert_eq!(median(&[]), None);
    // all at one time of observation: the ordinary median, if half of them are below it
    let mut draw = Draw(3);
    for _ in 0..200 {
        let runs = 1 + (40.0 * draw.unit()) as usize;
        let within = draw.between(0.0, 2.0);
        let mut times: Vec<f64> = (0..runs).map(|_| draw.unit()).collect();
        let all: Vec<Waiting> =
            times.iter().map(|t| Waiting { time: t.min(within), happened: *t < within }).collect();
        times.sort_by(f64::total_cmp);
        let half = times[runs.div_ceil(2) - 1];
        assert_eq!(median(&all), (half < within).then_some(half), "{runs} runs within {within}");
    }
}

/// Probability of at most `count` of `all`, each with the probability `share`.
fn binomial_up_to(count: u64, all: u64, share: f64) -> f64 {
    let mut log_term = all as f64 * (1.0 - share).ln();
    let mut sum = 0.0;
    for k in 0..=count {
        sum += log_term.exp();
        log_term += ((all - k) as f64).ln() - ((k + 1) as f64).ln() + (share / (1.0 - share)).ln();
    }
    sum
}

#[test]
fn the_ranks_of_a_quantile_miss_it_on_each_side_with_at_most_a_fortieth() {
    assert_eq!(QuantileRanks::of(100, 0.5), QuantileRanks { value: 50, low: Some(40), high: Some(61) });
    assert_eq!(QuantileRanks::of(5, 0.5), QuantileRanks { value: 3, low: None, high: None });
    let mut draw = Draw(4);
    for _ in 0..300 {
        let (all, share) = (1 + (300.0 * draw.unit()) as u64, draw.between(0.01, 0.99));
        let ranks = QuantileRanks::of(all, share);
        assert!(ranks.value as f64 >= share * all as f64 - 1e-6);
        assert!(((ranks.value - 1) as f64) < share * all as f64);
        // the largest rank below, and the smallest above, that may be taken
        let missed_low = |rank: u64| binomial_up_to(rank - 1, all, share);
        let missed_high = |rank: u64| 1.0 - binomial_up_to(rank - 1, all, share);
        match ranks.low {
            Some(rank) => {
                assert!(missed_low(rank) <= 0.025 + 1e-9);
                assert!(rank == ranks.value || missed_low(rank + 1) > 0.025 - 1e-9);
            }
            None => assert!(missed_low(1) > 0.025 - 1e-9),
        }
        match ranks.high {
            Some(rank) => {
                assert!(missed_high(rank) <= 0.025 + 1e-9);
                assert!(rank == ranks.value || missed_high(rank - 1) > 0.025 - 1e-9);
            }
            None => assert!(missed_high(all) > 0.025 - 1e-9),
        }
    }
}
