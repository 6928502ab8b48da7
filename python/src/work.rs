//! Work without the interpreter's lock, that Ctrl-C ends.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use interwell_studies::questions::{Error, Progress};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::raised;

/// How often signals are looked for and progress is told.
const INTERVAL: Duration = Duration::from_millis(50);

/// Stack of the working thread in bytes.
const STACK: usize = 16 << 20;

/// Parts whose number is not known.
const UNKNOWN: u64 = u64::MAX;

/// How a question is worked on.
#[derive(Default)]
pub struct Way {
    /// Threads; by default all processors.
    pub threads: Option<usize>,
    /// Called with the parts that are done and all of them, or None.
    pub progress: Option<Py<PyAny>>,
}

/// Answers a question on a thread of its own, while this one looks for signals and tells of progress.
pub fn work<T: Send>(
    py: Python<'_>,
    way: &Way,
    question: impl FnOnce(&Progress) -> Result<T, Error> + Send,
) -> PyResult<T> {
    work_calling(py, way, &|_| f64::NAN, |progress, _| question(progress))
}

/// What the thread that answers a question sends.
enum Message<T> {
    /// It wants the value of the function here.
    Call(f64),
    Answer(thread::Result<Result<T, Error>>),
}

/// Answers a question that calls a function of Python. The function is called on this thread, on which Ctrl-C
/// ends it.
pub fn work_calling<T: Send>(
    py: Python<'_>,
    way: &Way,
    function: &(dyn Fn(f64) -> f64 + Sync),
    question: impl FnOnce(&Progress, &dyn Fn(f64) -> f64) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let (done, all) = (AtomicU64::new(0), AtomicU64::new(UNKNOWN));
    let watch = |now: u64, of: Option<u64>| {
        // calls come from several threads, and in each phase of a question they count from 1
        let of = of.unwrap_or(UNKNOWN);
        if all.swap(of, Ordering::Relaxed) == of {
            done.fetch_max(now, Ordering::Relaxed);
        } else {
            done.store(now, Ordering::Relaxed);
        }
    };
    let told = |py: Python<'_>| -> PyResult<()> {
        py.check_signals()?;
        if let Some(progress) = &way.progress {
            let of = Some(all.load(Ordering::Relaxed)).filter(|of| *of != UNKNOWN);
            progress.call1(py, (done.load(Ordering::Relaxed), of))?;
        }
        Ok(())
    };
    let (watch, stopped, threads) = (&watch, &stop, way.threads);
    let (answer, interrupted) = py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = channel();
            let (replies, replied) = channel();
            let job = move || {
                let progress = Progress::none().reporting_to(watch).stopped_by(stopped);
                let progress = threads.map_or(progress, |count| progress.threads(count));
                let call = |at: f64| {
                    drop(sender.send(Message::Call(at)));
                    replied.recv().unwrap_or(f64::NAN)
                };
                let answer = catch_unwind(AssertUnwindSafe(|| question(&progress, &call)));
                drop(sender.send(Message::Answer(answer)));
            };
            let started = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, job);
            if started.is_err() {
                return (Ok(Err(Error::no_thread())), None);
            }
            let mut interrupted = None;
            loop {
                match receiver.recv_timeout(INTERVAL) {
                    Ok(Message::Call(at)) => drop(replies.send(function(at))),
                    Ok(Message::Answer(answer)) => return (answer, interrupted),
                    Err(RecvTimeoutError::Disconnected) => return (Err(Box::new(()) as _), interrupted),
                    Err(RecvTimeoutError::Timeout) if interrupted.is_some() => {}
                    Err(RecvTimeoutError::Timeout) => {
                        interrupted = Python::attach(|py| told(py).err());
                        stop.store(interrupted.is_some(), Ordering::Relaxed);
                    }
                }
            }
        })
    });
    if let Some(error) = interrupted {
        return Err(error);
    }
    let answer = finished(py, answer)?;
    if way.progress.is_some() {
        told(py)?;
    }
    Ok(answer)
}

/// Answers a question that takes milliseconds at most on this thread.
pub fn work_here<T: Send>(
    py: Python<'_>,
    question: impl FnOnce(&Progress) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let answer = py.detach(|| catch_unwind(AssertUnwindSafe(|| question(&Progress::none()))));
    finished(py, answer)
}

fn finished<T>(py: Python<'_>, answer: thread::Result<Result<T, Error>>) -> PyResult<T> {
    match answer {
        Ok(answer) => answer.map_err(|error| raised(py, &error)),
        Err(_) => Err(PyRuntimeError::new_err(
            "a fault of interwell itself: the message is on standard error; please report it",
        )),
    }
}
