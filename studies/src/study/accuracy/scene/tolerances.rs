//! Cost of each digit of a scene's run.

use std::sync::atomic::AtomicBool;

use super::beside::{Beside, times};
use super::trust::{better, finished};
use crate::dynamics::{Model, Outcome, Request};
use crate::study::accuracy::methods::Statistics;
use crate::study::accuracy::precision::median;

/// Tolerances at which a scene is run, beside its own.
pub const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// A scene's run at one tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
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
#[derive(Debug, Clone, PartialEq, Default)]
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
    let (_, exact) = better(model, tightest, &request)?;
    let mut found = Tolerances::default();
    for tolerance in all {
        let trial = model.with_tolerance(tolerance);
        let run = finished(trial.run(&request))?;
        let cpu_s = median(|| trial.run(&bare).summary.cpu_s);
        let beside = Beside::new(model, &run.samples, &exact.samples);
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
