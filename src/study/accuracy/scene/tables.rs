//! Accuracy of a scene as one table.

use super::{StepSize, Tolerances};
use crate::study::Table;
use crate::study::accuracy::OWN;

/// Runs at tolerances and in fixed steps, a row each, in this order. SI; a cell without a value is empty.
///
/// `error_m` is the largest error of the displacement, `trusted_s` up to when the path is off by less than a
/// hundredth of the travel (empty where that is all of the time compared), `compared_s` that time. `late_s`
/// is the median of how late arrivals at a stop are, `latest_s` the one furthest off, over `arrivals` of them
/// in a row.
pub fn scene_table(tolerances: &Tolerances, stepped: &[StepSize]) -> Table {
    let rows: Vec<Row> = tolerances
        .runs
        .iter()
        .map(|run| Row {
            method: OWN,
            numbers: [
                run.tolerance,
                f64::NAN,
                run.error,
                run.trusted.unwrap_or(f64::NAN),
                tolerances.span,
                run.cpu_s,
                run.rms_velocity.unwrap_or(f64::NAN),
                f64::NAN,
                f64::NAN,
            ],
            counts: [Some(run.steps), Some(run.evaluations), Some(run.impacts), None],
            outcome: run.outcome.name(),
        })
        .chain(stepped.iter().map(Row::of_steps))
        .collect();
    Table::new()
        .each("method", &rows, |row| row.method)
        .each("tolerance", &rows, |row| row.numbers[0])
        .each("step_s", &rows, |row| row.numbers[1])
        .each("error_m", &rows, |row| row.numbers[2])
        .each("trusted_s", &rows, |row| row.numbers[3])
        .each("compared_s", &rows, |row| row.numbers[4])
        .each("steps", &rows, |row| row.counts[0])
        .each("evaluations", &rows, |row| row.counts[1])
        .each("cpu_s", &rows, |row| row.numbers[5])
        .each("rms_velocity_m_per_s", &rows, |row| row.numbers[6])
        .each("impacts", &rows, |row| row.counts[2])
        .each("late_s", &rows, |row| row.numbers[7])
        .each("latest_s", &rows, |row| row.numbers[8])
        .each("arrivals", &rows, |row| row.counts[3])
        .each("outcome", &rows, |row| row.outcome)
}

struct Row {
    method: &'static str,
    /// Tolerance, step, error, trusted, compared, CPU, RMS velocity, late, latest.
    numbers: [f64; 9],
    /// Steps, evaluations, impacts, arrivals.
    counts: [Option<u64>; 4],
    outcome: &'static str,
}

impl Row {
    fn of_steps(run: &StepSize) -> Self {
        let late = |of: fn(&super::Lateness) -> f64| run.late.as_ref().map_or(f64::NAN, of);
        Self {
            method: run.scheme.name(),
            numbers: [
                f64::NAN,
                run.step,
                run.error,
                run.trusted.unwrap_or(f64::NAN),
                run.span,
                run.cpu_s.1,
                run.rms_velocity.1.unwrap_or(f64::NAN),
                late(|lateness| lateness.median),
                late(super::Lateness::worst),
            ],
            counts: [
                Some(run.steps.1),
                Some(run.evaluations.1),
                Some(run.impacts.1),
                run.late.map(|late| late.matched as u64),
            ],
            outcome: if run.ended_at.is_some() { "ended_early" } else { "done" },
        }
    }
}
