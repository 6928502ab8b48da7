//! Background questions: a question that can be compared, and its answer, which a thread computes in parts.
//!
//! The newest answer stays until it is replaced. A question that is replaced is cancelled, and parts of its
//! answer that come later are dropped. A [`Question`] is data, so that a worker can answer it; work on the
//! user's machine, such as writing a file, is a job, a function.

#[cfg(target_arch = "wasm32")]
mod workers;

use std::ops::Deref;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::questions::{Error, Progress};
use crate::system::clock::WallClock;
use crate::system::threads::{processors, sleep, spawn};

#[cfg(target_arch = "wasm32")]
pub use workers::{Workers, set_workers, take_part};

/// Number of threads for work beside the window: that of all cores but one.
pub fn threads() -> usize {
    processors().saturating_sub(1).max(1)
}

/// How a question beside the window is run: by so many threads, until it is cancelled.
pub fn progress(cancel: &AtomicBool) -> Progress<'_> {
    Progress::none().stopped_by(cancel).threads(threads())
}

/// What came of a question, or why there is no answer; `None` if it was cancelled.
pub fn told<T>(answer: Result<T, Error>) -> Option<Result<T, String>> {
    match answer {
        Err(Error::Cancelled) => None,
        answer => Some(answer.map_err(|error| error.problem())),
    }
}

/// Callback that wakes the window when an answer is ready.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Shortest interval between two wakes of the window while a job runs.
const WAKE_INTERVAL: Duration = Duration::from_millis(40);

/// A question that a thread, or in a web page a worker, answers.
pub trait Question: Clone + PartialEq + Serialize + DeserializeOwned + Send + 'static {
    /// The name of the question in a message.
    const NAME: &'static str;
    /// A part of its answer.
    type Part: Serialize + DeserializeOwned + Send + 'static;

    /// Answers it: passes on parts as they come, and returns the last one, if there is one. Ends early once
    /// `cancel` is set.
    fn answer(&self, cancel: &AtomicBool, each: Each<'_, Self::Part>) -> Option<Self::Part>;

    /// Divides it into at most `count` questions whose parts together are its answer.
    #[cfg(any(test, target_arch = "wasm32"))]
    fn divide(&self, count: usize) -> Vec<Self> {
        let _ = count;
        vec![self.clone()]
    }
}

/// A question or a part of an answer as a message.
#[cfg(any(test, target_arch = "wasm32"))]
pub fn to_message<T: Serialize>(data: &T) -> Result<Vec<u8>, String> {
    postcard::to_allocvec(data).map_err(|error| error.to_string())
}

/// The question or the part of an answer in a message.
#[cfg(any(test, target_arch = "wasm32"))]
pub fn from_message<T: DeserializeOwned>(message: &[u8]) -> Result<T, String> {
    postcard::from_bytes(message).map_err(|error| error.to_string())
}

/// A scene or a part of one in a message: as text, in which fields with their usual values are left out.
pub mod as_text {
    use serde::de::{DeserializeOwned, Error as _};
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<T: Serialize, S: Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
        ron::to_string(value).map_err(S::Error::custom)?.serialize(to)
    }

    pub fn deserialize<'de, T: DeserializeOwned, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
        ron::from_str(&String::deserialize(from)?).map_err(D::Error::custom)
    }
}

/// A part of a question that does not take part in its comparison.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Uncompared<T>(pub T);

impl<T> PartialEq for Uncompared<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A shared value that is compared by its address, not by its content.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Identity<T>(pub Arc<T>);

impl<T> PartialEq for Identity<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> Deref for Identity<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

/// Callback for a part of an answer; it may be called from any thread.
pub type Each<'a, P> = &'a (dyn Fn(P) + Sync);

/// A computation on its own thread. Dropping it cancels the computation.
#[derive(Debug)]
struct Job<P> {
    parts: Receiver<P>,
    cancel: Arc<AtomicBool>,
    begun: WallClock,
    has_parts: bool,
    /// The questions that workers answer; their parts end once they are dropped.
    #[cfg(target_arch = "wasm32")]
    _asked: Vec<workers::Asked>,
}

impl<P: Send + 'static> Job<P> {
    fn new(parts: Receiver<P>, cancel: Arc<AtomicBool>) -> Self {
        Self {
            parts,
            cancel,
            begun: WallClock::start(),
            has_parts: false,
            #[cfg(target_arch = "wasm32")]
            _asked: Vec::new(),
        }
    }

    /// Starts `job`. Returns `None` if the system cannot start a thread.
    fn start(
        wake: &Wake,
        job: impl FnOnce(&AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) -> Option<Self> {
        let (sender, parts) = channel();
        let cancel = Arc::new(AtomicBool::new(false));
        let (flag, wake) = (Arc::clone(&cancel), Arc::clone(wake));
        let last_wake = Mutex::new(WallClock::start());
        let run = move || {
            let send = |part: P| {
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
            if let Some(last) = job(&flag, &send) {
                send(last);
            }
            drop(sender);
            if !flag.load(Ordering::Relaxed) {
                wake();
            }
        };
        spawn(run).then(|| Self::new(parts, cancel))
    }

    /// The parts that have come since the last call, and whether no more will come.
    fn take(&self) -> (Vec<P>, bool) {
        let mut parts = Vec::new();
        loop {
            match self.parts.try_recv() {
                Ok(part) => parts.push(part),
                Err(reason) => return (parts, reason == TryRecvError::Disconnected),
            }
        }
    }
}

impl<P> Drop for Job<P> {
    fn drop(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
    }
}

#[derive(Debug)]
enum Work<P> {
    /// No job is running; the question is begun when a view asks for it.
    Paused,
    Running(Job<P>),
    /// All parts have come, or the user has stopped the job.
    Done,
}

/// A question `Q` and the parts `P` of its answer.
#[derive(Debug)]
pub struct Background<Q, P> {
    question: Option<Q>,
    /// The newest parts: those of the question once the first of them has come, until then the previous ones.
    parts: Vec<P>,
    is_current: bool,
    work: Work<P>,
    /// Computing time of the earlier jobs on the question.
    worked: Duration,
    /// Whether a view of this frame shows the answer.
    is_wanted: bool,
}

impl<Q, P> Default for Background<Q, P> {
    fn default() -> Self {
        Self {
            question: None,
            parts: Vec::new(),
            is_current: false,
            work: Work::Paused,
            worked: Duration::ZERO,
            is_wanted: false,
        }
    }
}

impl<Q: Question> Background<Q, Q::Part> {
    /// Asks a question, and cancels the one before.
    pub fn ask(&mut self, question: Q, wake: &Wake) {
        #[cfg(not(target_arch = "wasm32"))]
        self.ask_job(question, wake, Q::answer);
        #[cfg(target_arch = "wasm32")]
        {
            let job = workers::ask(&question, wake).map(|(asked, parts)| {
                let mut job = Job::new(parts, Arc::default());
                job._asked = asked;
                job
            });
            self.replace(question, job);
        }
    }

    /// Asks a question unless it is answered or being computed; to be called in every frame in which a view
    /// shows the answer. Nothing is begun unless the scene stands `still`.
    pub fn want(&mut self, question: Q, still: bool, wake: &Wake) {
        if self.needs(&question, still) {
            self.ask(question, wake);
        }
    }
}

impl<Q: PartialEq, P: Send + 'static> Background<Q, P> {
    /// Like [`ask`](Self::ask), for a function that answers. `job` is given the question, a cancel flag to
    /// check and a callback for each part; it returns the last part, if there is one.
    pub fn ask_job(
        &mut self,
        question: Q,
        wake: &Wake,
        job: impl FnOnce(&Q, &AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) where
        Q: Clone + Send + 'static,
    {
        let asked = question.clone();
        let job = Job::start(wake, move |cancel, each| job(&asked, cancel, each));
        self.replace(question, job);
    }

    /// Like [`want`](Self::want), for a function that answers as in [`ask_job`](Self::ask_job).
    pub fn want_job(
        &mut self,
        question: Q,
        still: bool,
        wake: &Wake,
        job: impl FnOnce(&Q, &AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) where
        Q: Clone + Send + 'static,
    {
        if self.needs(&question, still) {
            self.ask_job(question, wake, job);
        }
    }

    /// Asks a question that an event of the page will answer: `begin` gets the callback for the answer, if
    /// there is one.
    #[cfg(target_arch = "wasm32")]
    pub fn ask_page(&mut self, question: Q, wake: &Wake, begin: impl FnOnce(Box<dyn FnOnce(Option<P>)>)) {
        let ((sender, parts), wake) = (channel(), Arc::clone(wake));
        self.replace(question, Some(Job::new(parts, Arc::default())));
        begin(Box::new(move |answer| {
            // the receiver is gone once the job is dropped
            answer.map(|answer| sender.send(answer).ok());
            drop(sender);
            wake();
        }));
    }

    /// Whether a wanted question is to be asked.
    fn needs(&mut self, question: &Q, still: bool) -> bool {
        self.is_wanted = true;
        still && (self.is_paused() || self.question.as_ref() != Some(question))
    }

    fn replace(&mut self, question: Q, job: Option<Job<P>>) {
        if self.question.as_ref() != Some(&question) {
            (self.is_current, self.worked) = (false, Duration::ZERO);
        }
        self.question = Some(question);
        self.work = job.map_or(Work::Paused, Work::Running);
    }

    /// Cancels the question and forgets the answer.
    pub fn clear(&mut self) {
        *self = Self { is_wanted: self.is_wanted, ..Self::default() };
    }

    /// Cancels the job until the question is asked again; parts that have come stay.
    pub fn pause(&mut self) {
        self.end_job(Work::Paused);
    }

    /// Cancels the job at the user's request: [`want`](Self::want) does not begin the question again.
    pub fn stop(&mut self) {
        self.end_job(Work::Done);
    }

    fn end_job(&mut self, work: Work<P>) {
        self.poll();
        if self.is_running() {
            (self.worked, self.work) = (self.worked(), work);
        }
    }

    /// Lets [`want`](Self::want) begin the question again after [`stop`](Self::stop).
    pub fn resume(&mut self) {
        if self.is_whole() {
            self.work = Work::Paused;
        }
    }

    /// Receives the parts that have come; to be called once a frame.
    pub fn poll(&mut self) {
        let worked = self.worked();
        let Work::Running(job) = &mut self.work else { return };
        let (parts, is_over) = job.take();
        if !job.has_parts && (is_over || !parts.is_empty()) {
            (job.has_parts, self.is_current) = (true, true);
            self.parts.clear();
        }
        self.parts.extend(parts);
        if is_over {
            (self.worked, self.work) = (worked, Work::Done);
        }
    }

    /// Waits at most `timeout` until no more parts will come. Returns whether there is an answer.
    pub fn wait(&mut self, timeout: Duration) -> bool {
        let clock = WallClock::start();
        self.poll();
        while self.is_running() && clock.elapsed() < timeout {
            sleep(Duration::from_millis(2));
            self.poll();
        }
        self.answer().is_some()
    }

    pub fn mark_wanted(&mut self) {
        self.is_wanted = true;
    }

    /// Pauses the question if no view has asked for it in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.is_wanted) {
            self.pause();
        }
    }

    pub fn question(&self) -> Option<&Q> {
        self.question.as_ref()
    }

    /// The newest parts, and whether they answer the question.
    pub fn parts(&self) -> (&[P], bool) {
        (&self.parts, self.is_current)
    }

    /// The last part of the newest answer, which may be that to an earlier question.
    pub fn newest(&self) -> Option<&P> {
        self.parts.last()
    }

    /// The last part of the answer to the question, once one has come.
    pub fn answer(&self) -> Option<&P> {
        self.newest().filter(|_| self.is_current)
    }

    /// Receives the parts that have come, and removes those that answer the question.
    pub fn take_parts(&mut self) -> Vec<P> {
        self.poll();
        if self.is_current { std::mem::take(&mut self.parts) } else { Vec::new() }
    }

    /// Receives the answer to the question, and removes it.
    pub fn take(&mut self) -> Option<P> {
        self.take_parts().pop()
    }

    pub fn is_paused(&self) -> bool {
        matches!(self.work, Work::Paused)
    }

    /// Whether more parts may come.
    pub fn is_running(&self) -> bool {
        matches!(self.work, Work::Running(_))
    }

    /// Whether all parts have come, or the user has stopped the job.
    pub fn is_whole(&self) -> bool {
        matches!(self.work, Work::Done)
    }

    /// How long the job has been running; `None` if none is.
    pub fn running_for(&self) -> Option<Duration> {
        match &self.work {
            Work::Running(job) => Some(job.begun.elapsed()),
            Work::Paused | Work::Done => None,
        }
    }

    /// Computing time spent on the question so far.
    pub fn worked(&self) -> Duration {
        self.worked + self.running_for().unwrap_or_default()
    }
}
