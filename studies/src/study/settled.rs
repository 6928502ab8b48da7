//! Settled motion of a scene, the time it is waited for, the place of an undriven mass in the landscape, and
//! runs that the threads of a pool take from each other.

use std::cell::RefCell;
use std::sync::atomic::AtomicBool;

use super::Task;
use crate::dynamics::{Model, Outcome, Phase, Request, Run, Sample, Summary};
use crate::system::threads::{Pool, Queue, UnderWay, share_from};

/// Forcing periods beyond the scene's own run for which a motion is followed until it repeats: five times
/// what nearly all transients of the prototype take. Just above a threshold their length is unbounded:
/// without stops, of 40 amplitudes within 1 % of it, five take between 1000 and 4500 periods.
pub(super) const PATIENCE: u32 = 1000;

/// Least number of forcing periods, for sums whose fastest sine is much faster than their common period.
const LEAST_PATIENCE: f64 = 16.0;

/// The time in s up to which a run of `model` is followed until its motion repeats: 1000 periods of
/// its fastest sine beyond its duration, and at least 16 forcing periods.
pub fn followed_until(model: &Model) -> f64 {
    let period = model.forcing_period().unwrap_or(0.0);
    let fastest = period / model.window_periods().1.max(1) as f64;
    model.duration() + (f64::from(PATIENCE) * fastest).max(LEAST_PATIENCE * period)
}

/// Forcing periods of a settled window in place of less than two, with which no repetition can be seen.
const WINDOW: f64 = 8.0;

/// The model with a settled window in which a motion can be seen to repeat, where its drive does.
pub fn widened(model: Model) -> Model {
    match model.forcing_period().filter(|_| model.repeats() && !model.can_settle()) {
        Some(period) => model.with_duration(model.settle() + WINDOW * period, model.settle()),
        None => model,
    }
}

/// A model, and the request that follows its run until it repeats, or up to `until` in s
/// ([`followed_until`]).
pub(super) fn followed<'a>(model: Model, until: Option<f64>) -> (Model, Request<'a>) {
    let model = widened(model);
    let until_settled = until.or(Some(followed_until(&model)));
    (model, Request { until_settled, ..Request::default() })
}

/// Runs `model` for its settled motion, on beyond its duration until the motion repeats, at most up to
/// [`followed_until`]; under an amplitude ramp to the ramp's end, but no longer. `None` if cancelled.
pub fn settled(model: &Model, cancel: &AtomicBool) -> Option<Summary> {
    settled_within(model, None, cancel)
}

/// The same, followed up to a time in s if given.
pub(super) fn settled_within(model: &Model, until: Option<f64>, cancel: &AtomicBool) -> Option<Summary> {
    let model = &widened(model.clone());
    let until_settled = until.or(model.forcing_period().map(|_| followed_until(model)));
    let ramp = until_settled.and_then(|until| model.ramp_end().map(|end| end.min(until)));
    let duration = ramp.map_or(model.duration(), |end| end.max(model.duration()));
    let model = model.with_duration(duration, model.settle());
    let run = model.run(&Request { ledger: true, cancel: Some(cancel), until_settled, ..Request::default() });
    let cancelled = matches!(run.summary.outcome, Outcome::Cancelled { .. });
    (!cancelled).then_some(run.summary)
}

/// Whether a run of `model` gets through its first `seconds`.
pub fn lasts(model: &Model, seconds: f64) -> bool {
    model.with_duration(seconds, 0.0).run(&Request::default()).summary.outcome == Outcome::Done
}

/// Place of an undriven mass at rest or swinging.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// The number of the well that it is in, from the left and from 0.
    pub well: usize,
    /// Force in N that presses it on its stop, where it rests on one.
    pub pressed_n: Option<f64>,
    /// Mechanical energy in J above the lowest place that it can reach there.
    pub energy_j: f64,
    /// Energy in J that lifts it from that place over the lower barrier beside it.
    pub needed_j: f64,
}

/// Where the mass is in the landscape; `None` without a barrier.
pub fn standing(model: &Model, state: &Sample) -> Option<Standing> {
    let curve = &model.mechanism().curve;
    let wells = model.mechanism().landscape.wells();
    let well = wells.iter().position(|well| well.right_top.is_none_or(|top| state.x < top))?;
    let (left, right) = model.stop_positions();
    let lowest = left.map_or(wells[well].x, |stop| stop.max(wells[well].x));
    let floor = curve.potential(right.map_or(lowest, |stop| stop.min(lowest)));
    let tops = [wells[well].left_top, wells[well].right_top];
    let top = tops.into_iter().flatten().map(|top| curve.potential(top)).reduce(f64::min)?;
    Some(Standing {
        well,
        pressed_n: (state.phase != Phase::Free).then(|| curve.force(state.x).abs()),
        energy_j: 0.5 * model.mass() * state.v * state.v + curve.potential(state.x) - floor,
        needed_j: top - floor,
    })
}

/// The answers of `count` runs in order. `model` gives the model and the request of a number, or its answer
/// if there is nothing to run; `answer` reads it off the run. `None` if the task was cancelled.
pub(super) fn shared_runs<'q, R: Send>(
    pool: Option<&Pool>,
    task: &'q Task,
    count: usize,
    model: impl Fn(usize) -> Result<(Model, Request<'q>), R> + Sync,
    answer: impl Fn(&Run) -> R + Sync,
) -> Option<Vec<R>> {
    let queue = Queue::new(count, pool.map_or(1, Pool::count));
    runs_from(pool, task, &|under_way| queue.take(under_way), model, |_, run| answer(run))
}

/// The same of the numbers that `take` gives, as of a [`Queue`]. `answer` also gets the number.
pub(super) fn runs_from<'q, R: Send>(
    pool: Option<&Pool>,
    task: &'q Task,
    take: &(dyn Fn(UnderWay) -> Option<usize> + Sync),
    model: impl Fn(usize) -> Result<(Model, Request<'q>), R> + Sync,
    answer: impl Fn(usize, &Run) -> R + Sync,
) -> Option<Vec<R>> {
    let work = |take: &dyn Fn(UnderWay) -> Option<usize>| {
        let answers = RefCell::new(Vec::new());
        let mut next = |under_way: UnderWay| loop {
            let number = take(under_way).filter(|_| !task.is_cancelled())?;
            match model(number) {
                Ok((model, request)) => {
                    return Some((number, model, Request { cancel: Some(task.cancel), ..request }));
                }
                Err(answer) => answers.borrow_mut().push((number, answer)),
            }
        };
        let mut ended = |number: usize, _: &Model, run: Run| {
            answers.borrow_mut().push((number, answer(number, &run)));
        };
        Model::run_from(&mut next, &mut ended);
        if task.is_cancelled() { Err(()) } else { Ok(answers.into_inner()) }
    };
    share_from(pool, take, work).ok()
}
