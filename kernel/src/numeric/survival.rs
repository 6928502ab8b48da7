//! Waiting times of which some are cut short: the rate of events, their median, and quantiles of a sample.

use statrs::distribution::{Binomial, ChiSquared, ContinuousCDF, DiscreteCDF};

/// Probability that an interval misses on each of its sides.
const TAIL: f64 = 0.025;

/// A waiting time that ended with the event, or was cut short (right-censored) before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waiting {
    /// Its length, 0 or above.
    pub time: f64,
    /// Whether it ended with the event.
    pub happened: bool,
}

/// A rate per unit of time with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// Events over observed time, the estimate of largest likelihood.
    pub value: f64,
    /// Lower end of the interval; 0 without an event.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Rate {
    /// The rate of `events` seen in a total time `observed` above 0, over all waiting times, including those
    /// that were cut short.
    ///
    /// Method: for exponential waiting times, twice the rate times the observed time is nearly chi-squared.
    /// The interval lies between the 0.025 quantile with 2 r degrees of freedom and the 0.975 quantile with
    /// 2 r + 2, divided by twice the observed time, where r is the number of events (Garwood 1936 for counts;
    /// Epstein and Sobel 1953 and Cox 1953 for waiting times). It covers the rate in at least about 95 % of
    /// samples, whether waiting times are cut short at a given time or all end with the event.
    pub fn of(events: u64, observed: f64) -> Self {
        let quantile = |freedom: u64, share: f64| {
            ChiSquared::new(freedom as f64).map_or(0.0, |law| law.inverse_cdf(share)) / (2.0 * observed)
        };
        Self {
            value: events as f64 / observed,
            low: if events == 0 { 0.0 } else { quantile(2 * events, TAIL) },
            high: quantile(2 * events + 2, 1.0 - TAIL),
        }
    }
}

/// The time at which half of the waiting times have ended with the event, by the estimate of the survival
/// function of Kaplan and Meier (1958); `None` if it does not fall to one half.
pub fn median(waiting: &[Waiting]) -> Option<f64> {
    let mut ordered = waiting.to_vec();
    // at one time, events come before those that are cut short
    ordered.sort_by(|a, b| a.time.total_cmp(&b.time).then(b.happened.cmp(&a.happened)));
    let mut survival = 1.0;
    for (passed, wait) in ordered.iter().enumerate() {
        if wait.happened {
            let at_risk = (ordered.len() - passed) as f64;
            survival *= (at_risk - 1.0) / at_risk;
        }
        // half of an even number may be a rounding above one half
        if survival <= 0.5 + 1e-12 {
            return Some(wait.time);
        }
    }
    None
}

/// Ranks, from 1, of the values of an ascending sample that estimate a quantile and bound it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QuantileRanks {
    /// Rank of the smallest value with at least the share of the sample at or below it.
    pub value: u64,
    /// Rank of the lower end of the 95 % interval; `None` if the sample is too small to have one.
    pub low: Option<u64>,
    /// Rank of the upper end of the 95 % interval; `None` if the sample is too small to have one.
    pub high: Option<u64>,
}

impl QuantileRanks {
    /// The ranks for the quantile at `share`, above 0 and below 1, of a sample of `count` values, at least 1.
    ///
    /// Method: the number of values below the quantile is binomial, whatever the distribution, so that each
    /// end misses the quantile with a probability of at most 0.025 (Thompson 1936; David and Nagaraja 2003,
    /// section 7.1).
    pub fn of(count: u64, share: f64) -> Self {
        let value = ((share * count as f64 - 1e-9).ceil() as u64).clamp(1, count);
        let Ok(law) = Binomial::new(share, count) else { return Self { value, low: None, high: None } };
        let low = (1..=value).rev().find(|rank| law.cdf(rank - 1) <= TAIL);
        let high = (value..=count).find(|rank| 1.0 - law.cdf(rank - 1) <= TAIL);
        Self { value, low, high }
    }
}
