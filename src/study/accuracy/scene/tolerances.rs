//! What does each digit of a scene's run cost?

use std::sync::atomic::AtomicBool;

use super::beside::{Beside, times};
use super::{at_tolerance, shortened};
use super::trust::finished;
use crate::dynamics::{Model, Outcome, Request};
use crate::study::accuracy::precision::median;

/// Tolerances at which a scene is run, beside its own.
pub const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// Tolerance of the run in double-double arithmetic that all are compared with: six decades below the tightest, so that
/// its own error is not seen, and no more, since every decade costs.
const REFERENCE: f64 = 1e-18;

/// A scene's run at one tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtTolerance {
    /// The tolerance.
    pub tolerance: f64,
    /// Largest error of the displacement in m over the time compared.
    pub error: f64,
    /// Up to when in s its path can be trusted; none where that is all of the time compared.
    pub trusted: Option<f64>,
    /// Steps of the whole run.
    pub steps: u64,
    /// Taylor expansions of the whole run.
    pub evaluations: u64,
    /// CPU time in s of the whole run: the median of a few that keep statistics alone.
    pub cpu_s: f64,
    /// RMS velocity in m/s over the scene's settled window; none where the run ended before it.
    pub rms_velocity: Option<f64>,
    /// Impacts of the whole run.
    pub impacts: u64,
    /// How the run ended.
    pub outcome: Outcome,
}

/// A scene's run at several tolerances.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tolerances {
    /// The runs, the loosest tolerance first; the scene's own tolerance is among them.
    pub runs: Vec<AtTolerance>,
    /// Time in s from the start over which they were compared with the reference: the run, but no more than 60 periods.
    pub span: f64,
    /// Travel in m, peak to peak, over that time.
    pub travel: f64,
}

/// Runs `model` at [`TOLERANCES`] and at its own, and compares each with a run in double-double arithmetic.
///
/// The error is the largest of the displacement; that of a chaotic motion is as large as its travel, and then the time up to
/// which the path is trusted is what counts. None where it was cancelled.
pub fn tolerances(model: &Model, cancel: &AtomicBool) -> Option<Tolerances> {
    let compared = shortened(model);
    let times = times(&compared);
    let request = Request { sample_times: &times, cancel: Some(cancel), ..Request::default() };
    let exact = finished(compared.run_reference(&request, REFERENCE))?;
    let mut found = Tolerances::default();
    for tolerance in with_own(model.tolerance) {
        let run = finished(at_tolerance(&compared, tolerance).run(&request))?;
        let beside = Beside::new(model, &run.samples, &exact.samples);
        let whole = at_tolerance(model, tolerance);
        let bare = Request { sample_times: &[], ..request };
        let summary = finished(whole.run(&bare))?.summary;
        (found.span, found.travel) = (beside.span(), beside.travel);
        found.runs.push(AtTolerance {
            tolerance,
            error: beside.error(),
            trusted: beside.parted(),
            steps: summary.steps,
            evaluations: summary.evaluations,
            cpu_s: median(|| whole.run(&bare).summary.cpu_s),
            rms_velocity: summary.rms_velocity,
            impacts: summary.total_impacts,
            outcome: summary.outcome,
        });
    }
    Some(found)
}

/// The tolerances from the loosest to the tightest, the scene's own among them.
fn with_own(own: f64) -> Vec<f64> {
    let mut all = TOLERANCES.to_vec();
    if !all.contains(&own) {
        all.push(own);
    }
    all.sort_by(|a, b| b.total_cmp(a));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_own_tolerance_is_among_them() {
        assert_eq!(with_own(1e-9), TOLERANCES);
        assert_eq!(with_own(1e-14), [1e-3, 1e-6, 1e-9, 1e-12, 1e-14]);
        assert_eq!(with_own(3e-5), [1e-3, 3e-5, 1e-6, 1e-9, 1e-12]);
    }
}
