//! Error of a run against a more accurate one, how long its path can be trusted, and the cost of its digits.

use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::accuracy::methods::{Statistics, path};
use crate::accuracy::precision::median;
use crate::dynamics::{Model, Outcome, Regime, Request, Run};
use crate::numeric::elementary;
use crate::study::finished;

/// A path is trusted until its error exceeds this share of the travel, which is too small to see in a plot.
pub const TRUSTED_SHARE: f64 = 0.01;

/// Samples in a period of the drive or in one of small oscillations, whichever is shorter.
const PER_PERIOD: f64 = 40.0;
/// Least and largest number of samples of a whole run.
const SAMPLES: (f64, f64) = (2_000.0, 40_000.0);

/// Least travel, as a share of the scene's length, with which differences are compared, so that a motion that
/// has died away is not judged by its rounding errors.
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
    /// Times in s that both runs reached, each with the largest difference of the displacement in m so far.
    worst: Vec<(f64, f64)>,
    /// The largest difference in m in the last part of the time.
    at_end: f64,
    /// Travel in m, peak to peak, of the run that the other is compared with.
    pub travel: f64,
    /// Difference in m beyond which the run is not trusted.
    pub limit: f64,
}

impl Beside {
    /// A path beside a better one, both at the same times as far as each of them came.
    pub fn new(model: &Model, path: &[(f64, f64)], better: &[(f64, f64)]) -> Self {
        let mut found = Self::default();
        let (mut low, mut high, mut worst) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        let last = path.len().min(better.len());
        let from_end = (last as f64 * (1.0 - END)) as usize;
        for (i, ((_, x), (t, better))) in path.iter().zip(better).enumerate() {
            let apart = (x - better).abs();
            worst = worst.max(apart);
            (low, high) = (low.min(*better), high.max(*better));
            found.worst.push((*t, worst));
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
        self.worst.last().map_or(0.0, |last| last.0)
    }

    /// The largest difference in m.
    pub fn error(&self) -> f64 {
        self.worst.last().map_or(0.0, |last| last.1)
    }

    /// The time in s at which the difference has first reached `level` in m; `None` if it never does.
    pub fn reaches(&self, level: f64) -> Option<f64> {
        let first = self.worst.partition_point(|(_, worst)| *worst < level);
        self.worst.get(first).map(|(t, _)| *t)
    }

    /// Time in s up to which the run is trusted; `None` if that is all of the time compared.
    pub fn parted(&self) -> Option<f64> {
        self.reaches(self.limit)
    }
}

/// Tolerance of the comparison run as a share of that of the run.
const TIGHTER: f64 = 1e-2;

/// The tightest tolerance of a run in doubles; tighter ones are run in double-double arithmetic.
const TIGHTEST: f64 = 1e-14;

/// Differences grow exponentially if a hundredth of the tolerance extends the trusted time by less than this
/// factor. Where errors only add up, the factor is ten or more.
const TIMES: f64 = 5.0;

/// The growth of a difference is measured from this many times the error of one step on.
const ABOVE_START: f64 = 10.0;

/// How the difference between a run and a more accurate one develops.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Course {
    /// They stay together.
    Kept,
    /// They part at this time in s after exponential growth, and stay apart since the motion has no period:
    /// chaos. At any tolerance one more decimal digit extends the trusted time by only `decade` seconds.
    Chaotic {
        /// Time in s.
        until: f64,
        /// Time in s in which the difference grew tenfold.
        decade: f64,
    },
    /// They part at this time in s after exponential growth, though the motion settles: which of two ways it
    /// goes depends on tiny differences.
    Sensitive {
        /// Time in s.
        until: f64,
    },
    /// They part at this time in s because the tolerance is too large.
    Coarse {
        /// Time in s.
        until: f64,
    },
}

impl Course {
    /// Time in s up to which the path can be trusted; `None` if that is all of the time compared.
    pub fn until(self) -> Option<f64> {
        match self {
            Self::Kept => None,
            Self::Chaotic { until, .. } | Self::Sensitive { until } | Self::Coarse { until } => Some(until),
        }
    }
}

/// The error of a run, known by its change against a tighter tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// Tolerance of the run, and of the run that it was compared with.
    pub tolerances: (f64, f64),
    /// Time in s from the start over which they were compared.
    pub span: f64,
    /// Largest difference of the displacement in m over that time.
    pub error: f64,
    /// Travel in m, peak to peak.
    pub travel: f64,
    /// How the difference develops.
    pub course: Course,
    /// How the run ended; the comparison ends with it.
    pub outcome: Outcome,
    /// Whether both runs come to the same regime.
    pub same_regime: bool,
}

/// Runs `model` twice, at its own tolerance and at a hundredth of it, and compares the displacements.
///
/// The path is trusted until the two differ by [`TRUSTED_SHARE`] of the travel. Where
/// they part, a third run with a hundredth of that tolerance shows whether a tighter tolerance helps, which
/// it does not where differences grow exponentially. The motion is called chaotic only if it is also shaken,
/// has no period, and the runs are still apart at the end.
///
/// This is an estimate, not a bound: an error common to both runs is not seen. A run with a tolerance below
/// 1e-14 is made in double-double arithmetic, a hundred times as slow. `None` if cancelled.
pub fn trust(model: &Model, cancel: &AtomicBool) -> Option<Trust> {
    let times = times(model);
    let request = Request { sample_times: &times, cancel: Some(cancel), ..Request::default() };
    let run = finished(model.run(&request))?;
    let (finer, better) = more_accurate(model, model.tolerance(), &request)?;
    let beside = Beside::new(model, &path(&run), &path(&better));
    let course = match beside.parted() {
        None => Course::Kept,
        Some(until) => {
            let (_, best) = more_accurate(model, finer, &request)?;
            let next = Beside::new(model, &path(&better), &path(&best)).parted();
            parted(model, &beside, &better, until, next)
        }
    };
    Some(Trust {
        tolerances: (model.tolerance(), finer),
        span: beside.span(),
        error: beside.error(),
        travel: beside.travel,
        course,
        outcome: run.summary.outcome,
        same_regime: run.summary.regime == better.summary.regime,
    })
}

/// A run of `model` that is more accurate than one at `tolerance`, and its tolerance. `None` if cancelled.
fn more_accurate(model: &Model, tolerance: f64, request: &Request) -> Option<(f64, Run)> {
    let finer = TIGHTER * tolerance;
    let run = if finer < TIGHTEST {
        model.run_reference(request, finer)
    } else {
        model.with_tolerance(finer).run(request)
    };
    finished(run).map(|run| (finer, run))
}

/// The course of two runs that part at `until` in s; with tighter tolerances they part at `next`, if at all.
fn parted(model: &Model, beside: &Beside, better: &Run, until: f64, next: Option<f64>) -> Course {
    let Some(next) = next.filter(|next| *next < TIMES * until) else { return Course::Coarse { until } };
    let summary = &better.summary;
    let settles = summary.period.is_some() || summary.regime == Regime::Rest;
    let stay_apart = beside.at_end >= beside.limit;
    if !model.is_shaken() || settles || !stay_apart {
        return Course::Sensitive { until };
    }
    // from the decades observed, or from the delay gained by the tighter pair of runs
    let start = ABOVE_START * model.tolerance() * model.scales().length;
    let decades = elementary::log10(beside.limit / start);
    let decade = match beside.reaches(start) {
        Some(t) if decades > 1.0 => (until - t) / decades,
        _ => (next - until).max(0.0) / -elementary::log10(TIGHTER),
    };
    Course::Chaotic { until, decade }
}

/// Tolerances at which a scene is run, beside its own.
pub const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// A scene's run at one tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AtTolerance {
    /// The tolerance.
    pub tolerance: f64,
    /// Largest error of the displacement in m.
    pub error: f64,
    /// Time in s up to which its path can be trusted; `None` if that is all of the time compared.
    pub trusted: Option<f64>,
    /// Its numbers; the CPU time is the median of a few runs that keep statistics alone.
    pub statistics: Statistics,
    /// How the run ended.
    pub outcome: Outcome,
}

/// A scene's run at several tolerances.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tolerances {
    /// The runs, the loosest tolerance first; the scene's own tolerance is among them.
    pub runs: Vec<AtTolerance>,
    /// Time in s from the start over which they were compared.
    pub span: f64,
    /// Travel in m, peak to peak.
    pub travel: f64,
}

/// Runs `model` at [`TOLERANCES`] and at its own, and compares each with a run whose tolerance is a hundredth
/// of the tightest of them (in double-double arithmetic where that is below 1e-14).
///
/// The error is the largest of the displacement; that of a chaotic motion is as large as its travel, and then
/// the time up to which the path is trusted is what counts. `None` if cancelled.
pub fn tolerances(model: &Model, cancel: &AtomicBool) -> Option<Tolerances> {
    let times = times(model);
    let request = Request { sample_times: &times, cancel: Some(cancel), ..Request::default() };
    let bare = Request { sample_times: &[], ..request };
    let mut all = TOLERANCES.to_vec();
    if !all.contains(&model.tolerance()) {
        all.push(model.tolerance());
        all.sort_by(|a, b| b.total_cmp(a));
    }
    let tightest = all.last().copied().unwrap_or(model.tolerance());
    let (_, exact) = more_accurate(model, tightest, &request)?;
    let mut found = Tolerances::default();
    for tolerance in all {
        let trial = model.with_tolerance(tolerance);
        let run = finished(trial.run(&request))?;
        let cpu_s = median(|| trial.run(&bare).summary.cpu_s);
        let beside = Beside::new(model, &path(&run), &path(&exact));
        (found.span, found.travel) = (beside.span(), beside.travel);
        found.runs.push(AtTolerance {
            tolerance,
            error: beside.error(),
            trusted: beside.parted(),
            statistics: Statistics { cpu_s, ..Statistics::from(&run.summary) },
            outcome: run.summary.outcome,
        });
    }
    Some(found)
}
