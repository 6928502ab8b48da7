//! What is the error of a run, and up to when can its path be trusted?

use std::sync::atomic::AtomicBool;

use super::at_tolerance;
use super::beside::{Beside, times};
use crate::dynamics::{Model, Outcome, Regime, Request, Run};

/// How much tighter the tolerance is of the run that a run is compared with.
const TIGHTER: f64 = 1e-2;

/// The tightest tolerance of a run in doubles: what asks for more is computed in double-double arithmetic.
const TIGHTEST: f64 = 1e-14;

/// Decades over which a difference has to be seen growing before it is called exponential.
const LEAST_DECADES: usize = 3;

/// How often two runs have to differ by more than rounding before their growth is looked at, in units of what one step
/// may be wrong by.
const ABOVE_START: f64 = 10.0;

/// What becomes of the difference between a run and a more accurate one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// They stay together.
    Kept,
    /// They part at this time in s, after exponential growth, and a motion without rhythm stays apart: chaos. Whatever
    /// the tolerance, each decimal digit more is good for only `decade` seconds more.
    Chaotic {
        /// Time in s.
        until: f64,
        /// Time in s in which the difference grew tenfold.
        decade: f64,
    },
    /// They part at this time in s after exponential growth, though the motion settles: which of two ways it goes hangs
    /// on next to nothing.
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

    /// The word in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Chaotic { .. } => "chaotic",
            Self::Sensitive { .. } => "sensitive",
            Self::Coarse { .. } => "coarse",
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
}

/// Runs `model` twice, at its own tolerance and at a hundredth of it, and compares the displacements.
///
/// The path is trusted until the two differ by [`TRUSTED_SHARE`](super::TRUSTED_SHARE) of the travel. Whether the way there
/// was exponential is judged by the times at which the difference passed each decade: evenly spaced in time, or in its
/// logarithm as where errors add up. Needs a difference that grew by three decades, so that at tolerances above some 1e-5
/// nothing is called chaotic. A chaotic motion is also shaken, without a period and still apart at the end.
///
/// An estimate and no bound: an error that both runs share is not seen. Below a tolerance of 1e-12 the second run is made
/// in double-double arithmetic, a hundred times as slow. None where it was cancelled.
pub fn trust(model: &Model, cancel: &AtomicBool) -> Option<Trust> {
    let times = times(model);
    let request = Request { sample_times: &times, cancel: Some(cancel), ..Request::default() };
    let own = finished(model.run(&request))?;
    let (finer, better) = better(model, model.tolerance, &request)?;
    let beside = Beside::new(model, &own.samples, &better.samples);
    Some(Trust {
        tolerances: (model.tolerance, finer),
        span: beside.span(),
        error: beside.error(),
        travel: beside.travel,
        course: course(model, &beside, &better),
        outcome: own.summary.outcome,
    })
}

/// The model with a run of another length in s: what follows the run that a scene asks for is as near or far from the truth.
pub fn lasting(model: &Model, duration: f64) -> Model {
    let mut model = model.clone();
    model.duration = duration;
    model
}

/// A run of `model` that is more accurate than one at `tolerance`, and its own tolerance. None where it was cancelled.
pub(super) fn better(model: &Model, tolerance: f64, request: &Request) -> Option<(f64, Run)> {
    let finer = TIGHTER * tolerance;
    let run = if finer < TIGHTEST {
        model.run_reference(request, finer)
    } else {
        at_tolerance(model, finer).run(request)
    };
    finished(run).map(|run| (finer, run))
}

/// A run that was not cancelled.
pub(super) fn finished(run: Run) -> Option<Run> {
    (!matches!(run.summary.outcome, Outcome::Cancelled { .. })).then_some(run)
}

fn course(model: &Model, beside: &Beside, better: &Run) -> Course {
    let Some(until) = beside.parted() else { return Course::Kept };
    let Some(decade) = decade(beside, ABOVE_START * model.tolerance * model.scales.length) else {
        return Course::Coarse { until };
    };
    let summary = &better.summary;
    let settles = summary.period.is_some() || summary.regime == Regime::Rest;
    if model.is_shaken() && !settles && beside.stays_apart() {
        Course::Chaotic { until, decade }
    } else {
        Course::Sensitive { until }
    }
}

/// The time in s in which the difference grew tenfold, where it grew exponentially from `start` in m up to where it is no
/// longer trusted.
fn decade(beside: &Beside, start: f64) -> Option<f64> {
    let levels = (0..).map(|k| beside.limit * 10_f64.powi(-k)).take_while(|level| *level >= start);
    let passed: Vec<f64> = levels.map_while(|level| beside.reaches(level)).collect();
    if passed.len() <= LEAST_DECADES {
        return None;
    }
    let (rate, linear) = fit(&passed);
    let logarithms: Vec<f64> = passed.iter().map(|t| t.max(f64::MIN_POSITIVE).ln()).collect();
    let (_, logarithmic) = fit(&logarithms);
    (linear <= logarithmic).then_some(-rate)
}

/// Slope of the line through values at 0, 1, 2, .. by least squares, and the share of their variance that it leaves.
fn fit(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let mean = values.iter().sum::<f64>() / n;
    let (mut both, mut places, mut all) = (0.0, 0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let (place, value) = (i as f64 - middle, value - mean);
        both += place * value;
        places += place * place;
        all += value * value;
    }
    let slope = both / places;
    (slope, if all > 0.0 { 1.0 - both * slope / all } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_leaves_nothing_and_a_bend_some() {
        let (slope, left) = fit(&[5.0, 4.0, 3.0, 2.0]);
        assert!((slope + 1.0).abs() < 1e-12 && left.abs() < 1e-12);
        let (_, left) = fit(&[1000.0, 100.0, 10.0, 1.0]);
        assert!(left > 0.1, "{left}");
        assert_eq!(fit(&[1.0, 1.0, 1.0]), (0.0, 0.0));
    }
}
