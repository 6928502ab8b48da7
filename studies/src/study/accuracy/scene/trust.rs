//! Error of a run, and the time up to which its path can be trusted.

use std::sync::atomic::AtomicBool;

use super::beside::{Beside, times};
use crate::dynamics::{Model, Outcome, Regime, Request, Run};

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// They stay together.
    Kept,
    /// They part at this time in s, after exponential growth, and a motion without rhythm stays apart: chaos.
    /// Whatever the tolerance, each decimal digit more is good for only `decade` seconds more.
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trust {
    /// Tolerance of the run, and of the one that it was compared with.
    pub tolerances: (f64, f64),
    /// Time in s from the start over which they were compared.
    pub span: f64,
    /// Largest difference of the displacement in m over that time.
    pub error: f64,
    /// Travel in m, peak to peak.
    pub travel: f64,
    /// How the difference develops.
    pub course: Course,
    /// How the run ended: what was compared ends with it.
    pub outcome: Outcome,
    /// Whether both runs come to the same regime.
    pub same_regime: bool,
}

/// Runs `model` twice, at its own tolerance and at a hundredth of it, and compares the displacements.
///
/// The path is trusted until the two differ by [`TRUSTED_SHARE`](super::TRUSTED_SHARE) of the travel. Where
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
    let (finer, better) = better(model, model.tolerance(), &request)?;
    let beside = Beside::new(model, &run.samples, &better.samples);
    let course = match beside.parted() {
        None => Course::Kept,
        Some(until) => {
            let (_, best) = self::better(model, finer, &request)?;
            let next = Beside::new(model, &better.samples, &best.samples).parted();
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

/// The model with a run of another length in s, to judge a motion beyond the run of its scene.
pub fn lasting(model: &Model, duration: f64) -> Model {
    model.with_duration(duration, model.settle())
}

/// A run of `model` that is more accurate than one at `tolerance`, and its tolerance. `None` if cancelled.
pub(super) fn better(model: &Model, tolerance: f64, request: &Request) -> Option<(f64, Run)> {
    let finer = TIGHTER * tolerance;
    let run = if finer < TIGHTEST {
        model.run_reference(request, finer)
    } else {
        model.with_tolerance(finer).run(request)
    };
    finished(run).map(|run| (finer, run))
}

/// The run; `None` if it was cancelled.
pub(super) fn finished(run: Run) -> Option<Run> {
    (!matches!(run.summary.outcome, Outcome::Cancelled { .. })).then_some(run)
}

/// The course of two runs that part at `until` in s; with both tolerances tightened they part at `next`, if
/// at all.
fn parted(model: &Model, beside: &Beside, better: &Run, until: f64, next: Option<f64>) -> Course {
    let Some(next) = next.filter(|next| *next < TIMES * until) else { return Course::Coarse { until } };
    let summary = &better.summary;
    let settles = summary.period.is_some() || summary.regime == Regime::Rest;
    if !model.is_shaken() || settles || !beside.stays_apart() {
        return Course::Sensitive { until };
    }
    // from the decades observed, or from the delay gained by the tighter pair of runs
    let start = ABOVE_START * model.tolerance() * model.scales().length;
    let decades = (beside.limit / start).log10();
    let decade = match beside.reaches(start) {
        Some(t) if decades > 1.0 => (until - t) / decades,
        _ => (next - until).max(0.0) / -TIGHTER.log10(),
    };
    Course::Chaotic { until, decade }
}
