//! Progress reports, cancellation and the number of threads of a question.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::Error;
use crate::study::Task;
use crate::system::threads::{MAX_THREADS, Pool, processors, spawn};

/// A callback for progress: it gets the number of finished parts and, if it is known, that of all parts. Any
/// thread may call it.
type Report<'a> = &'a (dyn Fn(u64, Option<u64>) + Sync);

/// How a question is run: a callback for its progress, a flag that cancels it, and its number of threads.
///
/// [`Progress::none`] is the default: no reports, no cancellation, one thread per processor. The parts that
/// are counted are cells of a grid, starts, orbits or runs, by the question; questions about one motion do
/// not report. The callback is called by the threads that compute and should return soon. More threads than
/// processors make nothing faster; the answer has the same bits for any number. A number of threads that is
/// 0 or above 1024, or that the system does not grant, is an [`Error::Argument`] named `threads`.
///
/// ```
/// # use interwell_studies as interwell;
/// use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
/// use interwell::questions::{Error, Progress, Simulation, Sweep};
///
/// let simulation = Simulation::preset("nominal-cubic")?;
/// let sweep = Sweep::over("excitation.amplitude_g", 0.5..=1.5, 5);
/// let (stop, cells) = (AtomicBool::new(false), AtomicU64::new(0));
/// let count = |done: u64, all: Option<u64>| {
///     assert_eq!(all, Some(5));
///     cells.fetch_max(done, Ordering::Relaxed);
/// };
/// let progress = Progress::none().reporting_to(&count).stopped_by(&stop).threads(2);
/// sweep.run(&simulation, &progress)?;
/// assert_eq!(cells.load(Ordering::Relaxed), 5);
///
/// stop.store(true, Ordering::Relaxed);
/// assert_eq!(sweep.run(&simulation, &progress), Err(Error::Cancelled));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Progress<'a> {
    report: Option<Report<'a>>,
    stop: &'a AtomicBool,
    threads: Option<usize>,
}

/// The flag of questions that cannot be cancelled; it is never set.
static NEVER: AtomicBool = AtomicBool::new(false);

/// How often the flag is looked at beside work that does not look at it.
const INTERVAL: Duration = Duration::from_millis(20);

/// The thread pool of the last question, kept because starting threads takes longer than answering a short
/// question.
static POOL: Mutex<Option<Pool>> = Mutex::new(None);

impl Progress<'static> {
    /// No reports, no cancellation, and one thread per processor.
    pub fn none() -> Self {
        Self { report: None, stop: &NEVER, threads: None }
    }
}

impl<'a> Progress<'a> {
    /// Calls `report` with 0 at the beginning, and after each finished part with their number. A question
    /// with several phases, such as [`Basins`](super::Basins), counts each of them from 0.
    #[must_use]
    pub fn reporting_to<'b>(self, report: Report<'b>) -> Progress<'b>
    where
        'a: 'b,
    {
        Progress { report: Some(report), ..self }
    }

    /// The question ends with [`Error::Cancelled`] soon after another thread sets `stop`.
    #[must_use]
    pub fn stopped_by<'b>(self, stop: &'b AtomicBool) -> Progress<'b>
    where
        'a: 'b,
    {
        Progress { stop, ..self }
    }

    /// Sets the number of threads, at least 1. The answer is the same to the last bit for any number.
    #[must_use]
    pub fn threads(self, count: usize) -> Self {
        Self { threads: Some(count), ..self }
    }

    /// The flag that cancels the question.
    pub fn stop(&self) -> &'a AtomicBool {
        self.stop
    }

    /// Whether that flag is set.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// A task that counts nothing.
    pub(crate) fn silent(&self) -> Task<'a> {
        Task { tick: &|| (), cancel: self.stop }
    }

    /// The answer of `work`, which does not look at the flag, from a thread of its own.
    pub(crate) fn unless_stopped<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        let (sender, receiver) = channel();
        if !spawn(move || drop(sender.send(work()))) {
            return Err(Error::no_thread());
        }
        while !self.is_stopped() {
            match receiver.recv_timeout(INTERVAL) {
                Ok(answer) => return answer,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        Err(Error::Cancelled)
    }

    /// Runs `work` with a task that counts its parts; `all` is their number, if it is known.
    pub(crate) fn task<R>(&self, all: Option<u64>, work: impl FnOnce(&Task) -> R) -> R {
        let done = AtomicU64::new(0);
        if let Some(report) = self.report {
            report(0, all);
        }
        let tick = || {
            if let Some(report) = self.report {
                report(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            }
        };
        work(&Task { tick: &tick, cancel: self.stop })
    }

    /// Runs `work` with a thread pool and a task that counts its parts, which are `all`.
    pub(crate) fn shared<R>(&self, all: u64, work: impl FnOnce(&Pool, &Task) -> R) -> Result<R, Error> {
        self.pool(|pool| self.task(Some(all), |task| work(pool, task)))
    }

    /// Runs `work` with a thread pool, a task that counts its parts, and a function that it calls with the
    /// number of parts that are left to do, so far as it is known: at the beginning, and whenever it turns
    /// out to be another.
    pub(crate) fn planned<R>(
        &self,
        work: impl FnOnce(&Pool, &Task, &(dyn Fn(u64) + Sync)) -> R,
    ) -> Result<R, Error> {
        let (done, all) = (AtomicU64::new(0), AtomicU64::new(0));
        let report = |done: u64| {
            if let Some(report) = self.report {
                report(done, Some(all.load(Ordering::Relaxed).max(done)));
            }
        };
        let plan = |left: u64| {
            let done = done.load(Ordering::Relaxed);
            all.store(done + left, Ordering::Relaxed);
            report(done);
        };
        let tick = || report(done.fetch_add(1, Ordering::Relaxed) + 1);
        self.pool(|pool| work(pool, &Task { tick: &tick, cancel: self.stop }, &plan))
    }

    pub(crate) fn pool<R>(&self, work: impl FnOnce(&Pool) -> R) -> Result<R, Error> {
        let count = self.threads.unwrap_or_else(processors);
        if !(1..=usize::from(MAX_THREADS)).contains(&count) {
            return Err(Error::argument("threads", count, format!("give 1 to {MAX_THREADS}")));
        }
        let last = POOL.lock().unwrap_or_else(PoisonError::into_inner).take();
        let pool = match last {
            Some(pool) if pool.is_alive() && pool.count() == count => pool,
            last => {
                // dropping a pool would wait for its threads, which a forked process does not have
                std::mem::forget(last.filter(|pool| !pool.is_alive()));
                let fewer = |error| Error::argument("threads", count, format!("{error}; give fewer"));
                Pool::new(count).map_err(fewer)?
            }
        };
        let answer = work(&pool);
        *POOL.lock().unwrap_or_else(PoisonError::into_inner) = Some(pool);
        Ok(answer)
    }
}
