//! Progress, cancellation and threads of a question.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::Error;
use crate::study::Task;
use crate::system::threads::{Pool, processors};

/// Called with the number of parts that are done, and of all parts where it is known; from any thread.
type Watch<'a> = &'a (dyn Fn(u64, Option<u64>) + Sync);

/// How a question is worked on: who is told of its progress, who may stop it, and how many threads it has.
///
/// ```
/// use std::sync::atomic::AtomicBool;
/// use interwell_studies::questions::Progress;
///
/// let stop = AtomicBool::new(false);
/// let shown = |done: u64, all: Option<u64>| eprintln!("{done} of {all:?}");
/// let progress = Progress::none().told_to(&shown).stopped_by(&stop).threads(2);
/// ```
#[derive(Clone, Copy)]
pub struct Progress<'a> {
    watch: Option<Watch<'a>>,
    stop: &'a AtomicBool,
    threads: Option<usize>,
}

/// A flag that nobody sets.
static NEVER: AtomicBool = AtomicBool::new(false);

/// The pool of the last question, kept since threads take longer to start than a short question to answer.
static POOL: Mutex<Option<Pool>> = Mutex::new(None);

impl Progress<'static> {
    /// Nobody is told, nobody stops it, and all processors work on it.
    pub fn none() -> Self {
        Self { watch: None, stop: &NEVER, threads: None }
    }
}

impl<'a> Progress<'a> {
    /// Tells `watch` of each part that is done.
    #[must_use]
    pub fn told_to<'b>(self, watch: Watch<'b>) -> Progress<'b>
    where
        'a: 'b,
    {
        Progress { watch: Some(watch), ..self }
    }

    /// The question ends with [`Error::Cancelled`] soon after another thread sets `stop`.
    #[must_use]
    pub fn stopped_by<'b>(self, stop: &'b AtomicBool) -> Progress<'b>
    where
        'a: 'b,
    {
        Progress { stop, ..self }
    }

    /// Works on this many threads. The answer has the same bits for any number.
    #[must_use]
    pub fn threads(self, count: usize) -> Self {
        Self { threads: Some(count), ..self }
    }

    pub(super) fn stop(&self) -> &'a AtomicBool {
        self.stop
    }

    /// Works on a task whose parts are counted; `all` is their number, if it is known.
    pub(super) fn task<R>(&self, all: Option<u64>, work: impl FnOnce(&Task) -> R) -> R {
        let done = AtomicU64::new(0);
        let tick = || {
            if let Some(watch) = self.watch {
                watch(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            }
        };
        work(&Task { tick: &tick, cancel: self.stop })
    }

    /// Works with a pool of threads.
    pub(super) fn pool<R>(&self, work: impl FnOnce(&Pool) -> R) -> Result<R, Error> {
        let count = self.threads.unwrap_or_else(processors).max(1);
        let kept = POOL.lock().unwrap_or_else(PoisonError::into_inner).take();
        let pool = match kept {
            Some(pool) if pool.is_alive() && pool.count() == count => pool,
            kept => {
                // threads that are not there cannot be ended
                std::mem::forget(kept.filter(|pool| !pool.is_alive()));
                Pool::new(count).map_err(|error| Error::argument("threads", count, error))?
            }
        };
        let answer = work(&pool);
        *POOL.lock().unwrap_or_else(PoisonError::into_inner) = Some(pool);
        Ok(answer)
    }
}
