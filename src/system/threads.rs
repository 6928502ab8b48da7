//! Threads.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use rayon::prelude::*;

/// How many processors the program may use; at least 1.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Does `work` on a thread of its own. Whether the system has one to give.
pub fn spawn(work: impl FnOnce() + Send + 'static) -> bool {
    std::thread::Builder::new().name("study".into()).spawn(work).is_ok()
}

/// Lets this thread stand still.
pub fn sleep(time: Duration) {
    std::thread::sleep(time);
}

/// Threads that share the parts of one study.
#[derive(Debug)]
pub struct Pool(rayon::ThreadPool);

/// Why threads cannot be started.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {count} threads: {reason}")]
pub struct NoThreads {
    count: usize,
    reason: String,
}

impl Pool {
    /// So many threads.
    pub fn new(count: usize) -> Result<Self, NoThreads> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        pool.map(Self).map_err(|error| NoThreads { count, reason: error.to_string() })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.current_num_threads()
    }

    /// The results of all parts from 0 to `parts`, in order, or an error of one of them, after which no other
    /// part begins. `state` makes what a thread keeps from part to part.
    pub fn map<S, R: Send, E: Send>(
        &self,
        parts: usize,
        state: impl Fn() -> S + Sync,
        part: impl Fn(&mut S, usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        self.0.install(|| (0..parts).into_par_iter().with_max_len(1).map_init(&state, &part).collect())
    }

    /// The first of the parts from 0 to `parts` for which there is an answer, with it.
    pub fn find_first<S, R: Send>(
        &self,
        parts: u64,
        state: impl Fn() -> S + Sync,
        part: impl Fn(&mut S, u64) -> Option<R> + Sync,
    ) -> Option<R> {
        let all = || (0..parts).into_par_iter().map_init(&state, &part);
        self.0.install(|| all().find_first(Option::is_some).flatten())
    }

    /// Does the same on each thread.
    pub fn everywhere(&self, work: impl Fn() + Sync) {
        self.0.broadcast(|_| work());
    }
}

/// What `work` gives, which is told to stop, by its argument, once `patience` is over.
pub fn within<R>(patience: Duration, work: impl FnOnce(&AtomicBool) -> R) -> R {
    let cancel = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (done, wait) = channel::<()>();
        let cancel = &cancel;
        scope.spawn(move || {
            if wait.recv_timeout(patience) == Err(RecvTimeoutError::Timeout) {
                cancel.store(true, Ordering::Relaxed);
            }
        });
        let found = work(cancel);
        drop(done);
        found
    })
}
