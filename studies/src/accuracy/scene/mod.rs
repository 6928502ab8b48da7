//! Accuracy of the run of one scene, and its cost.
//!
//! Three questions, each a function of a model: the error of its run and the time up to which its path can be
//! trusted (`trust`); the cost of every digit (`tolerances`); and the effect of a fixed step, as used in
//! games and small applets (`step_size`). Nothing here needs an exact answer: the error is the difference
//! from a far more accurate run.

mod step_size;
mod trust;
mod words;

pub use step_size::{Lateness, StepSize, TRUE_TOLERANCE, Unfit, step_size};
pub use trust::{AtTolerance, Course, TOLERANCES, TRUSTED_SHARE, Tolerances, Trust, tolerances, trust};
pub use words::{duration, length_mm, moment, small_length, step_name};

use super::OWN;
use crate::study::Table;

/// Runs at tolerances and in fixed steps, a row each, in this order, with the columns of
/// [`Accuracy`](crate::questions::Accuracy).
pub fn scene_table(tolerances: &Tolerances, stepped: &[StepSize]) -> Table {
    let runs = &tolerances.runs;
    let mut table = Table::new()
        .each("method", runs, |_| OWN)
        .each("tolerance", runs, |run| run.tolerance)
        .each("step_s", runs, |_| f64::NAN)
        .each("error_m", runs, |run| run.error)
        .each("trusted_s", runs, |run| run.trusted)
        .each("compared_s", runs, |_| tolerances.span)
        .each("steps", runs, |run| Some(run.statistics.steps))
        .each("evaluations", runs, |run| Some(run.statistics.evaluations))
        .each("cpu_s", runs, |run| run.statistics.cpu_s)
        .each("rms_velocity_m_per_s", runs, |run| run.statistics.rms_velocity)
        .each("impacts", runs, |run| Some(run.statistics.impacts))
        .each("late_s", runs, |_| f64::NAN)
        .each("latest_s", runs, |_| f64::NAN)
        .each("arrivals", runs, |_| None::<u64>)
        .each("outcome", runs, |run| run.outcome.name());
    let outcome = |run: &StepSize| if run.stepped.ended_at.is_some() { "ended_early" } else { "done" };
    let in_steps = Table::new()
        .each("method", stepped, |run| run.scheme.name())
        .each("tolerance", stepped, |_| f64::NAN)
        .each("step_s", stepped, |run| run.step)
        .each("error_m", stepped, |run| run.error)
        .each("trusted_s", stepped, |run| run.trusted)
        .each("compared_s", stepped, |run| run.span)
        .each("steps", stepped, |run| Some(run.stepped.steps))
        .each("evaluations", stepped, |run| Some(run.stepped.evaluations))
        .each("cpu_s", stepped, |run| run.stepped.cpu_s)
        .each("rms_velocity_m_per_s", stepped, |run| run.stepped.rms_velocity)
        .each("impacts", stepped, |run| Some(run.stepped.impacts))
        .each("late_s", stepped, |run| run.late.map(|late| late.median))
        .each("latest_s", stepped, |run| run.late.as_ref().map(Lateness::worst))
        .each("arrivals", stepped, |run| run.late.map(|late| late.matched as u64))
        .each("outcome", stepped, outcome);
    table.append(&in_steps);
    table
}
