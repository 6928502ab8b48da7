//! Sampling of a record: its usual step, the scatter of the steps, and its gaps.

use serde::{Deserialize, Serialize};

use crate::numeric::short;

/// Smallest length of a gap, in usual steps.
const GAP: f64 = 5.0;

/// Sampling of a record, with times in s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Number of samples.
    pub samples: usize,
    /// First and last time.
    pub span: (f64, f64),
    /// The usual step: the median of all steps.
    pub step: f64,
    /// Standard deviation of the steps about their mean, without gaps.
    pub jitter: f64,
    /// The gaps in order of time: the last time before each, and its length. A gap is a step longer than five
    /// usual steps.
    pub gaps: Vec<(f64, f64)>,
}

impl Timing {
    /// The sampling at at least two increasing times in s.
    pub fn of(times: &[f64]) -> Self {
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        let step = match middle < steps.len() {
            true => *steps.select_nth_unstable_by(middle, f64::total_cmp).1,
            false => f64::NAN,
        };
        let gaps = times.windows(2).filter(|pair| pair[1] - pair[0] > GAP * step);
        let gaps = gaps.map(|pair| (pair[0], pair[1] - pair[0])).collect();
        steps.retain(|length| *length <= GAP * step);
        let count = steps.len().max(1) as f64;
        let mean = steps.iter().sum::<f64>() / count;
        let jitter = (steps.iter().map(|length| (length - mean).powi(2)).sum::<f64>() / count).sqrt();
        let span = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
        Self { samples: times.len(), span, step, jitter, gaps }
    }

    /// Whether a step of this length in s is a gap.
    pub fn is_gap(&self, length: f64) -> bool {
        length > GAP * self.step
    }

    /// The first of the longest gaps: the last time before it, and its length.
    pub fn longest_gap(&self) -> Option<(f64, f64)> {
        self.gaps.iter().copied().rev().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The sampling in one line.
    pub fn describe(&self) -> String {
        let Self { samples, span: (from, to), step, jitter, .. } = *self;
        let [from, to, rate] = [from, to, 1.0 / step].map(short);
        let mut text = format!("{samples} samples from {from} to {to} s, {rate} a second");
        // times are rounded decimals: a jitter below a thousandth of a step is rounding
        if jitter > 1e-3 * step {
            text += &format!(", steps scatter by {} % (standard deviation)", short(100.0 * jitter / step));
        }
        text += &match (self.gaps.len(), self.longest_gap()) {
            (_, None) => ", no gaps".to_owned(),
            (1, Some((at, length))) => format!(", a gap of {} s after {} s", short(length), short(at)),
            (n, Some((at, length))) => {
                format!(", {n} gaps, the longest of {} s after {} s", short(length), short(at))
            }
        };
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_jitter_and_gaps_are_found() {
        // steps of 1 ms, alternately 0.1 ms late and early, with a gap of 20 ms
        let late = |i: u32| if i % 2 == 1 { 1e-4 } else { 0.0 };
        let times: Vec<f64> =
            (0..100).map(|i| 1e-3 * f64::from(i) + late(i) + if i < 50 { 0.0 } else { 0.019 }).collect();
        let timing = Timing::of(&times);
        assert_eq!((timing.samples, timing.gaps.len()), (100, 1));
        assert!((timing.jitter - 1e-4).abs() < 1e-7, "{timing:?}");
        let (at, length) = timing.longest_gap().unwrap();
        assert!((at - 0.0491).abs() < 1e-12 && (length - 0.0199).abs() < 1e-12, "{timing:?}");
        let text = timing.describe();
        assert!(
            text.starts_with("100 samples from 0 to 0.1181 s") && text.contains("a gap of 0.0199 s"),
            "{text}"
        );
        let even: Vec<f64> = (0..11).map(|i| f64::from(i) / 10.0).collect();
        assert_eq!(Timing::of(&even).describe(), "11 samples from 0 to 1 s, 10 a second, no gaps");
    }
}
