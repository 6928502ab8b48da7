//! Background jobs, and the newest answer to a question that changes.
//!
//! Dropping a [`Job`] cancels it. [`Latest`] keeps the newest answer; a question that is replaced before its
//! answer has come is cancelled.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::system::clock::WallClock;
use crate::system::threads::{Pool, processors, sleep, spawn};

/// A pool of threads for all cores but one, which is left to the window. Returns `None` if the system cannot
/// start threads.
pub fn pool() -> Option<Pool> {
    Pool::new(processors().saturating_sub(1).max(1)).ok()
}

/// Calls `take` every 2 ms until it returns false, for at most `timeout`.
pub fn wait_while(timeout: Duration, mut take: impl FnMut() -> bool) {
    let clock = WallClock::start();
    while take() && clock.elapsed() < timeout {
        sleep(Duration::from_millis(2));
    }
}

/// Callback that wakes the window when an answer is ready.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Shortest interval between two wakes of the window while a job runs.
const WAKE_INTERVAL: Duration = Duration::from_millis(40);

/// A computation on its own thread whose answer comes in parts, from any thread that it uses.
#[derive(Debug)]
pub struct Job<T> {
    parts: Receiver<T>,
    cancel: Arc<AtomicBool>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts `job`, which is given a cancel flag to check and a callback for each part of its answer.
    /// Returns `None` if the system cannot start a thread.
    pub fn start(
        wake: &Wake,
        job: impl FnOnce(&AtomicBool, &(dyn Fn(T) + Sync)) + Send + 'static,
    ) -> Option<Self> {
        let (sender, parts) = channel();
        let cancel = Arc::new(AtomicBool::new(false));
        let (flag, wake) = (Arc::clone(&cancel), Arc::clone(wake));
        let last_wake = Mutex::new(WallClock::start());
        let run = move || {
            let send = |part: T| {
                // the receiver is gone once the job is dropped
                if sender.send(part).is_err() {
                    return;
                }
                if let Ok(mut last_wake) = last_wake.try_lock()
                    && last_wake.elapsed() > WAKE_INTERVAL
                {
                    *last_wake = WallClock::start();
                    wake();
                }
            };
            job(&flag, &send);
            drop(sender);
            if !flag.load(Ordering::Relaxed) {
                wake();
            }
        };
        spawn(run).then_some(Self { parts, cancel })
    }

    /// Waits at most `timeout` for the next part; `Err` if no more will come.
    fn wait(&self, timeout: Duration) -> Result<Option<T>, ()> {
        match self.parts.recv_timeout(timeout) {
            Ok(part) => Ok(Some(part)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(()),
        }
    }

    /// Passes the parts that have come to `each`. Returns whether more may come.
    pub fn take(&self, mut each: impl FnMut(T)) -> bool {
        loop {
            match self.parts.try_recv() {
                Ok(part) => each(part),
                Err(TryRecvError::Empty) => return true,
                Err(TryRecvError::Disconnected) => return false,
            }
        }
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
    }
}

/// The newest answer to a question that changes.
#[derive(Debug)]
pub struct Latest<T> {
    generation: u64,
    job: Option<Job<T>>,
    /// When the current question was asked.
    since: Option<WallClock>,
    /// The answer and the generation of its question.
    answer: Option<(u64, T)>,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self { generation: 0, job: None, since: None, answer: None }
    }
}

impl<T: Send + 'static> Latest<T> {
    /// Asks a new question, and cancels the current one.
    pub fn ask(&mut self, wake: &Wake, job: impl FnOnce(&AtomicBool) -> Option<T> + Send + 'static) {
        self.generation += 1;
        self.job = Job::start(wake, move |cancel, each| {
            if let Some(answer) = job(cancel) {
                each(answer);
            }
        });
        self.since = Some(WallClock::start());
    }

    /// Cancels the question and forgets the answer.
    pub fn clear(&mut self) {
        self.generation += 1;
        (self.job, self.answer) = (None, None);
    }

    /// Cancels the question; an answer that has come is kept.
    pub fn stop(&mut self) {
        self.job = None;
    }

    /// Stores the answer if it has come. Returns whether the job has ended, with or without an answer.
    pub fn poll(&mut self) -> bool {
        let Some(job) = &self.job else { return false };
        let mut answer = None;
        let more = job.take(|part| answer = Some(part));
        if answer.is_none() && more {
            return false;
        }
        self.finish(answer);
        true
    }

    /// Removes and returns the answer to the current question, if it has come.
    pub fn take(&mut self) -> Option<T> {
        self.poll();
        let current = self.generation;
        self.answer.take_if(|answer| answer.0 == current).map(|answer| answer.1)
    }

    fn finish(&mut self, answer: Option<T>) {
        self.job = None;
        if let Some(answer) = answer {
            self.answer = Some((self.generation, answer));
        }
    }

    /// Waits at most `timeout` for the answer to the current question. Returns whether it has come.
    pub fn wait(&mut self, timeout: Duration) -> bool {
        match self.job.as_ref().map(|job| job.wait(timeout)) {
            Some(Ok(Some(answer))) => self.finish(Some(answer)),
            Some(Err(())) => self.finish(None),
            Some(Ok(None)) | None => {}
        }
        self.current().is_some()
    }

    /// The answer to the current question, once it has come.
    pub fn current(&self) -> Option<&T> {
        self.answer.as_ref().filter(|answer| answer.0 == self.generation).map(|answer| &answer.1)
    }

    /// The newest answer, which may belong to an older question.
    pub fn newest(&self) -> Option<&T> {
        self.answer.as_ref().map(|answer| &answer.1)
    }

    /// How long the job has been running; `None` if none is.
    pub fn running_for(&self) -> Option<Duration> {
        self.since.filter(|_| self.is_running()).map(|since| since.elapsed())
    }

    /// Whether an answer is being computed.
    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(20);

    fn wake() -> Wake {
        Arc::new(|| ())
    }

    #[test]
    fn dropping_a_job_cancels_it() {
        let (sender, seen) = channel();
        let job = Job::<()>::start(&wake(), move |cancel, _| {
            while !cancel.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(1));
            }
            sender.send(()).ok();
        });
        drop(job.unwrap());
        assert!(seen.recv_timeout(LONG).is_ok());
    }

    #[test]
    fn an_answer_to_an_older_question_is_not_current() {
        let mut latest = Latest::default();
        latest.ask(&wake(), |_| Some(1));
        assert!(latest.wait(LONG));
        assert_eq!(latest.current(), Some(&1));
        let (sender, gate) = channel::<()>();
        latest.ask(&wake(), move |_| gate.recv().ok().map(|()| 2));
        assert_eq!((latest.current(), latest.newest()), (None, Some(&1)));
        sender.send(()).unwrap();
        assert!(latest.wait(LONG));
        assert_eq!(latest.current(), Some(&2));
        latest.ask(&wake(), |_| None::<i32>);
        assert!(!latest.wait(LONG) && !latest.is_running());
        assert_eq!(latest.newest(), Some(&2));
    }

    #[test]
    fn parts_come_until_the_job_is_dropped() {
        let (sender, seen) = channel();
        let job = Job::start(&wake(), move |cancel: &AtomicBool, each: &(dyn Fn(u32) + Sync)| {
            each(1);
            each(2);
            while !cancel.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(1));
            }
            each(3);
            sender.send(()).ok();
        })
        .unwrap();
        let mut parts = Vec::new();
        while parts.len() < 2 {
            assert!(job.take(|part| parts.push(part)));
        }
        assert_eq!(parts, [1, 2]);
        drop(job);
        assert!(seen.recv_timeout(LONG).is_ok());
        let short = Job::start(&wake(), |_: &AtomicBool, each: &(dyn Fn(u32) + Sync)| each(4)).unwrap();
        let mut last = 0;
        while short.take(|part| last = part) {}
        assert_eq!(last, 4);
    }

    #[test]
    fn a_job_that_panics_leaves_no_answer() {
        let mut latest: Latest<i32> = Latest::default();
        latest.ask(&wake(), |_| std::panic::resume_unwind(Box::new("stop")));
        assert!(!latest.wait(LONG) && !latest.is_running());
    }
}
