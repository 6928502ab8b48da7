//! Background computations.
//!
//! A job is a value: dropped, it is cancelled. [`Latest`] asks again and again for the same kind of
//! answer and shows the newest; an answer to an older question is thrown away.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::system::clock::WallClock;
use crate::system::threads::{Pool, processors, sleep, spawn};

/// Threads for a computation that uses all cores but one, which stays for the window; none where the system
/// has no threads to give.
pub fn pool() -> Option<Pool> {
    Pool::new(processors().saturating_sub(1).max(1)).ok()
}

/// Lets `take` take in what comes until it says that nothing more will, at most so long.
pub fn wait_while(most: Duration, mut take: impl FnMut() -> bool) {
    let clock = WallClock::start();
    while take() && clock.elapsed() < most {
        sleep(Duration::from_millis(2));
    }
}

/// Wakes the window when an answer is there.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// How often at most a job wakes the window while it runs.
const WAKE_EVERY: Duration = Duration::from_millis(40);

/// A computation on a thread of its own whose answer comes in parts, from any thread that it uses.
#[derive(Debug)]
pub struct Job<T> {
    parts: Receiver<T>,
    cancel: Arc<AtomicBool>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts `job`, which looks at the flag that it is given and hands its parts over one by one; none where
    /// the system has no thread to give.
    pub fn start(
        wake: &Wake,
        job: impl FnOnce(&AtomicBool, &(dyn Fn(T) + Sync)) + Send + 'static,
    ) -> Option<Self> {
        let (sender, parts) = channel();
        let cancel = Arc::new(AtomicBool::new(false));
        let (flag, wake) = (Arc::clone(&cancel), Arc::clone(wake));
        let last = Mutex::new(WallClock::start());
        let run = move || {
            let each = |part: T| {
                // nobody listens where the job was dropped
                if sender.send(part).is_err() {
                    return;
                }
                if let Ok(mut last) = last.try_lock()
                    && last.elapsed() > WAKE_EVERY
                {
                    *last = WallClock::start();
                    wake();
                }
            };
            job(&flag, &each);
            drop(sender);
            if !flag.load(Ordering::Relaxed) {
                wake();
            }
        };
        spawn(run).then_some(Self { parts, cancel })
    }

    /// Waits for the next part, at most so long; `Err` where none will come any more.
    fn wait(&self, most: Duration) -> Result<Option<T>, ()> {
        match self.parts.recv_timeout(most) {
            Ok(part) => Ok(Some(part)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(()),
        }
    }

    /// Takes what has come, and says whether more may come.
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
    /// When the question under way was asked.
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
    /// Asks anew; a question under way is dropped.
    pub fn ask(&mut self, wake: &Wake, job: impl FnOnce(&AtomicBool) -> Option<T> + Send + 'static) {
        self.generation += 1;
        self.job = Job::start(wake, move |cancel, each| {
            if let Some(answer) = job(cancel) {
                each(answer);
            }
        });
        self.since = Some(WallClock::start());
    }

    /// Forgets question and answer.
    pub fn clear(&mut self) {
        self.generation += 1;
        (self.job, self.answer) = (None, None);
    }

    /// Drops the question under way; an answer that is there stays.
    pub fn stop(&mut self) {
        self.job = None;
    }

    /// Takes in an answer that has come. Whether one has.
    pub fn poll(&mut self) -> bool {
        let Some(job) = &self.job else { return false };
        let mut answer = None;
        let more = job.take(|own| answer = Some(own));
        if answer.is_none() && more {
            return false;
        }
        self.finish(answer);
        true
    }

    /// Takes in an answer that has come and hands it over, if it is one to the present question.
    pub fn take(&mut self) -> Option<T> {
        self.poll();
        let present = self.generation;
        self.answer.take_if(|answer| answer.0 == present).map(|answer| answer.1)
    }

    fn finish(&mut self, answer: Option<T>) {
        self.job = None;
        if let Some(answer) = answer {
            self.answer = Some((self.generation, answer));
        }
    }

    /// Waits for the answer to the present question, at most so long. Whether it is there.
    pub fn wait(&mut self, most: Duration) -> bool {
        match self.job.as_ref().map(|job| job.wait(most)) {
            Some(Ok(Some(answer))) => self.finish(Some(answer)),
            Some(Err(())) => self.finish(None),
            Some(Ok(None)) | None => {}
        }
        self.current().is_some()
    }

    /// The answer to the present question, once it is there.
    pub fn current(&self) -> Option<&T> {
        self.answer.as_ref().filter(|answer| answer.0 == self.generation).map(|answer| &answer.1)
    }

    /// The newest answer, be it to an older question.
    pub fn newest(&self) -> Option<&T> {
        self.answer.as_ref().map(|answer| &answer.1)
    }

    /// For how long an answer has been worked on; none where none is.
    pub fn running_for(&self) -> Option<Duration> {
        self.since.filter(|_| self.is_running()).map(|since| since.elapsed())
    }

    /// Whether an answer is being worked on.
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
    fn dropped_it_is_cancelled() {
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
    fn parts_come_until_nobody_listens() {
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
