//! Settled motion of a scene and how long it is awaited, the well of an undriven mass, and runs that the
//! threads of a pool share.

use std::cell::RefCell;
use std::sync::atomic::AtomicBool;

use super::{Task, finished};
use crate::dynamics::{Model, Outcome, Phase, Request, Run, Sample, Summary};
use crate::system::threads::{Pool, Queue, UnderWay, share_from};

/// Number of forcing periods after the scene's own run in which a motion is awaited to repeat: five times the
/// length of nearly all transients of the prototype. Just above a threshold transients can be arbitrarily
/// long: without stops, five of 40 amplitudes within 1 % of it take between 1000 and 4500 periods.
pub(crate) const PATIENCE: u32 = 1000;

/// Smallest number of forcing periods, for sums of sines whose common period is long beside the fastest sine.
const MIN_PATIENCE: f64 = 16.0;

/// The time in s up to which a run of `model` may continue until its motion repeats: its duration and 1000
/// periods of its fastest sine, at least 16 forcing periods.
pub fn followed_until(model: &Model) -> f64 {
    let period = model.forcing_period().unwrap_or(0.0);
    let fastest = period / model.window_periods().1.max(1) as f64;
    model.duration() + (f64::from(PATIENCE) * fastest).max(MIN_PATIENCE * period)
}

/// Forcing periods of a settled window in place of one of less than two, in which no repetition can be seen.
const WINDOW: f64 = 8.0;

/// The model with a settled window that is long enough to see a repetition, if its drive repeats.
pub fn widened(model: Model) -> Model {
    match model.forcing_period().filter(|_| model.repeats() && !model.can_settle()) {
        Some(period) => model.with_duration(model.settle() + WINDOW * period, model.settle()),
        None => model,
    }
}

/// The model to run and the request to continue the run until it repeats, at most up to `until` in s (by
/// default [`followed_until`]).
pub(crate) fn followed<'a>(model: Model, until: Option<f64>) -> (Model, Request<'a>) {
    let model = widened(model);
    let until_settled = until.or(Some(followed_until(&model)));
    (model, Request { until_settled, ..Request::default() })
}

/// Runs `model` until its motion repeats, at most up to `followed_until`; under an amplitude ramp, to the
/// end of the ramp. `None` if cancelled.
pub fn settled(model: &Model, cancel: &AtomicBool) -> Option<Summary> {
    settled_within(model, None, cancel)
}

/// Like [`settled`], with another limit of time in s if `until` is given.
pub(crate) fn settled_within(model: &Model, until: Option<f64>, cancel: &AtomicBool) -> Option<Summary> {
    let model = &widened(model.clone());
    let until_settled = until.or(model.forcing_period().map(|_| followed_until(model)));
    let ramp = until_settled.and_then(|until| model.ramp_end().map(|end| end.min(until)));
    let duration = ramp.map_or(model.duration(), |end| end.max(model.duration()));
    let model = model.with_duration(duration, model.settle());
    let run = model.run(&Request { ledger: true, cancel: Some(cancel), until_settled, ..Request::default() });
    finished(run).map(|run| run.summary)
}

/// Whether a run of `model` does not end within its first `seconds`.
pub fn lasts(model: &Model, seconds: f64) -> bool {
    model.with_duration(seconds, 0.0).run(&Request::default()).summary.outcome == Outcome::Done
}

/// State of an undriven mass in one of the wells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Index of its well, from the left.
    pub well: usize,
    /// Force in N that presses it on a stop, if it rests on one.
    pub pressed_n: Option<f64>,
    /// Mechanical energy in J above the lowest potential that it can reach in the well.
    pub energy_j: f64,
    /// Energy in J from that potential to the top of the lower barrier of the well.
    pub needed_j: f64,
}

/// The state of the mass in its well; `None` without a barrier between the stops.
pub fn standing(model: &Model, state: &Sample) -> Option<Standing> {
    let curve = &model.mechanism().curve;
    let wells = model.mechanism().landscape.wells();
    let well = wells.iter().position(|well| well.right_top.is_none_or(|top| state.x < top))?;
    let (left, right) = model.stop_positions();
    let lowest = left.map_or(wells[well].x, |stop| stop.max(wells[well].x));
    let floor = curve.potential(right.map_or(lowest, |stop| stop.min(lowest)));
    let tops = [wells[well].left_top, wells[well].right_top];
    let reached = |top: &f64| left.is_none_or(|stop| stop < *top) && right.is_none_or(|stop| *top < stop);
    let tops = tops.into_iter().flatten().filter(reached);
    let top = tops.map(|top| curve.potential(top)).reduce(f64::min)?;
    Some(Standing {
        well,
        pressed_n: (state.phase != Phase::Free).then(|| curve.force(state.x).abs()),
        energy_j: 0.5 * model.mass() * state.v * state.v + curve.potential(state.x) - floor,
        needed_j: top - floor,
    })
}

/// The answers of `count` runs in order. `model` returns the model and the request of a run, or its answer if
/// there is nothing to run; `answer` evaluates the run. `None` if the task was cancelled.
pub(crate) fn shared_runs<'q, R: Send>(
    pool: Option<&Pool>,
    task: &'q Task,
    count: usize,
    model: impl Fn(usize) -> Result<(Model, Request<'q>), R> + Sync,
    answer: impl Fn(&Run) -> R + Sync,
) -> Option<Vec<R>> {
    let queue = Queue::new(count, pool.map_or(1, Pool::count));
    runs_from(pool, task, &|under_way| queue.take(under_way), model, |_, run| answer(run))
}

/// Like [`shared_runs`], for the indices that `take` returns, which `answer` gets too.
pub(crate) fn runs_from<'q, R: Send>(
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
