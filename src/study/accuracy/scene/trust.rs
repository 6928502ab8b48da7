//! Error of a run, and the time up to which its path can be trusted.

use std::sync::atomic::AtomicBool;

use super::beside::{Beside, times};
use crate::dynamics::{Model, Outcome, Regime, Request, Run};

/// How much tighter the tolerance is of the run that a run is compared with.
const TIGHTER: f64 = 1e-2;

/// The tightest tolerance of a run in doubles: what asks for more is computed in double-double arithmetic.
const TIGHTEST: f64 = 1e-14;

/// Where errors add up, a hundredth of the tolerance is good for ten times the time and more; where a
/// difference grows exponentially, for a few decades' time more. Between the two.
const TIMES: f64 = 5.0;

/// A difference is first looked at where it is so many times what one step may be wrong by.
const ABOVE_START: f64 = 10.0;

/// What becomes of the difference between a run and a more accurate one.
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
    /// goes hangs on next to nothing.
    Sensitive {
        /// Time in s.
        until: f64,
    },
    /// They part at this time in s since the tolerance is too large.
    Coarse {
        /// Time in s.
        until: f64,
    },
}

impl Course {
    /// Up to when in s the path can be trusted; none where that is all of the time compared.
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
    /// What becomes of the difference.
    pub course: Course,
    /// How the run ended: what was compared ends with it.
    pub outcome: Outcome,
    /// Whether both runs come to the same regime.
    pub same_regime: bool,
}

/// Runs `model` twice, at its own tolerance and at a hundredth of it, and compares the displacements.
///
/// The path is trusted until the two differ by [`TRUSTED_SHARE`](super::TRUSTED_SHARE) of the travel. Where
/// they part, a third run with a hundredth of that tolerance says whether it would help: not so where
/// differences grow exponentially, and the second run is good for little longer. A chaotic motion is also
/// shaken, without a period and still apart at the end.
///
/// An estimate and no bound: an error that both runs share is not seen. A run with a tolerance below
/// 1e-14 is made in double-double arithmetic, a hundred times as slow. None where it was cancelled.
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
            parted(model, &beside, &better, (until, next))
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

/// The model with a run of another length in s: what follows the run that a scene asks for is as near or far
/// from the truth.
pub fn lasting(model: &Model, duration: f64) -> Model {
    model.with_duration(duration, model.settle())
}

/// A run of `model` that is more accurate than one at `tolerance`, and its own tolerance. None where it was
/// cancelled.
pub(super) fn better(model: &Model, tolerance: f64, request: &Request) -> Option<(f64, Run)> {
    let finer = TIGHTER * tolerance;
    let run = if finer < TIGHTEST {
        model.run_reference(request, finer)
    } else {
        model.with_tolerance(finer).run(request)
    };
    finished(run).map(|run| (finer, run))
}

/// A run that was not cancelled.
pub(super) fn finished(run: Run) -> Option<Run> {
    (!matches!(run.summary.outcome, Outcome::Cancelled { .. })).then_some(run)
}

/// What becomes of two runs that part at the first of `times` in s, where with both tolerances tightened they
/// would part at the second, if at all.
fn parted(model: &Model, beside: &Beside, better: &Run, times: (f64, Option<f64>)) -> Course {
    let until = times.0;
    let Some(next) = times.1.filter(|next| *next < TIMES * until) else { return Course::Coarse { until } };
    let summary = &better.summary;
    let settles = summary.period.is_some() || summary.regime == Regime::Rest;
    if !model.is_shaken() || settles || !beside.stays_apart() {
        return Course::Sensitive { until };
    }
    // over the decades that were seen, or from one pair of runs to the next
    let start = ABOVE_START * model.tolerance() * model.scales().length;
    let decades = (beside.limit / start).log10();
    let decade = match beside.reaches(start) {
        Some(t) if decades > 1.0 => (until - t) / decades,
        _ => (next - until).max(0.0) / -TIGHTER.log10(),
    };
    Course::Chaotic { until, decade }
}
