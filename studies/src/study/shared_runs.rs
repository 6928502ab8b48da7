//! Runs that the threads of a pool take from each other, many at once where the processor can.

use std::cell::RefCell;

use super::Task;
use crate::dynamics::{Model, Request, Run};
use crate::system::threads::{Pool, Queue, UnderWay, share_from};

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
