//! Distance between two runs of the same scene.

use crate::dynamics::{Model, Sample};

/// A path is trusted until it is off by this share of the motion's travel: less than is seen in a plot.
pub const TRUSTED_SHARE: f64 = 0.01;

/// Samples in a period of the drive or in one of small oscillations, whichever is shorter.
const PER_PERIOD: f64 = 40.0;
/// Least and largest number of samples of a whole run.
const SAMPLES: (f64, f64) = (2_000.0, 40_000.0);

/// Least travel, as a share of the scene's length, with which differences are compared: a motion that has
/// died away is not judged by its rounding.
const LEAST_TRAVEL: f64 = 1e-3;

/// The last share of the compared time, over which two runs that parted are compared again.
const END: f64 = 0.1;

/// Even times in s at which two runs of `model` are compared, ascending from 0 to its duration.
pub(super) fn times(model: &Model) -> Vec<f64> {
    let swing = model.natural_time();
    let fastest = model.forcing_period().map_or(swing, |period| period.min(swing));
    let count = (model.duration() / fastest * PER_PERIOD).clamp(SAMPLES.0, SAMPLES.1).floor();
    (0..=count as u32).map(|i| (model.duration() * (f64::from(i) / count)).min(model.duration())).collect()
}

/// How two runs differ.
#[derive(Debug, Clone, Default)]
pub(super) struct Beside {
    /// Times in s that both runs reached.
    times: Vec<f64>,
    /// The largest difference of the displacement in m up to each of these times.
    worst: Vec<f64>,
    /// The largest difference in m in the last part of the time.
    at_end: f64,
    /// Travel in m, peak to peak, of the run that the other is compared with.
    pub travel: f64,
    /// Difference in m beyond which the run is not trusted.
    pub limit: f64,
}

impl Beside {
    /// `samples` beside `better`, both sampled at the same times as far as each of them came.
    pub fn new(model: &Model, samples: &[Sample], better: &[Sample]) -> Self {
        let mut found = Self::default();
        let (mut low, mut high, mut worst) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        let last = samples.len().min(better.len());
        let from_end = (last as f64 * (1.0 - END)) as usize;
        for (i, (sample, better)) in samples.iter().zip(better).enumerate() {
            let apart = (sample.x - better.x).abs();
            worst = worst.max(apart);
            (low, high) = (low.min(better.x), high.max(better.x));
            found.times.push(better.t);
            found.worst.push(worst);
            if i >= from_end {
                found.at_end = found.at_end.max(apart);
            }
        }
        found.travel = (high - low).max(0.0);
        found.limit = TRUSTED_SHARE * found.travel.max(LEAST_TRAVEL * model.scales().length);
        found
    }

    /// The time in s up to which both runs came.
    pub fn span(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The largest difference in m.
    pub fn error(&self) -> f64 {
        self.worst.last().copied().unwrap_or(0.0)
    }

    /// The time in s at which the difference has first reached `level` in m; `None` if it never does.
    pub fn reaches(&self, level: f64) -> Option<f64> {
        let first = self.worst.partition_point(|worst| *worst < level);
        self.times.get(first).copied()
    }

    /// Time in s up to which the run is trusted; `None` if that is all of the time compared.
    pub fn parted(&self) -> Option<f64> {
        self.reaches(self.limit)
    }

    /// Whether they are still apart at the end.
    pub fn stays_apart(&self) -> bool {
        self.at_end >= self.limit
    }
}
