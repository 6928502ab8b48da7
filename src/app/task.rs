//! Background computations.
//!
//! A [`Background`] is a question with its answer: what is asked, the job that works it out, the parts that
//! have come, and the answer to the question before. Dropped, or asked something else, it cancels the job.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::system::clock::WallClock;
use crate::system::threads::{Pool, processors, sleep, spawn};

/// Threads for a computation that uses all cores but one, which stays for the window; none where the system
/// has no threads to give.
pub fn pool() -> Option<Pool> {
    Pool::new(processors().saturating_sub(1).max(1)).ok()
}

/// Wakes the window when an answer is there.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Shortest time between two wakes of the window by a job that runs.
const WAKE_EVERY: Duration = Duration::from_millis(40);

/// A shared value that equals itself alone, whatever it contains: part of a question about it.
#[derive(Debug)]
pub struct Identity<T>(pub Arc<T>);

impl<T> Clone for Identity<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Identity<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Takes a part of an answer from any thread.
pub type Each<'a, P> = &'a (dyn Fn(P) + Sync);

/// A computation on a separate thread. Dropped, it is cancelled.
#[derive(Debug)]
struct Job<P> {
    parts: Receiver<P>,
    cancel: Arc<AtomicBool>,
    begun: WallClock,
}

impl<P: Send + 'static> Job<P> {
    /// Starts `job`; none where the system has no thread to give.
    fn start(
        wake: &Wake,
        job: impl FnOnce(&AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) -> Option<Self> {
        let (sender, parts) = channel();
        let cancel = Arc::new(AtomicBool::new(false));
        let (flag, wake, begun) = (Arc::clone(&cancel), Arc::clone(wake), WallClock::start());
        let last_wake = Mutex::new(begun);
        let run = move || {
            let each = |part: P| {
                // nobody listens where the job was dropped
                if sender.send(part).is_err() {
                    return;
                }
                if let Ok(mut last_wake) = last_wake.try_lock()
                    && last_wake.elapsed() > WAKE_EVERY
                {
                    *last_wake = WallClock::start();
                    wake();
                }
            };
            if let Some(last) = job(&flag, &each) {
                each(last);
            }
            drop(sender);
            if !flag.load(Ordering::Relaxed) {
                wake();
            }
        };
        spawn(run).then_some(Self { parts, cancel, begun })
    }

    /// The parts that have come, and whether they are the last ones.
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
    /// There is no job, and the question is begun again where it is asked again.
    Paused,
    Running(Job<P>),
    /// Nothing more comes.
    Done,
}

/// An answer that comes in parts.
pub trait Answer<P> {
    /// Adds parts that have come after `worked` of work.
    fn add(&mut self, parts: Vec<P>, worked: Duration);

    /// Whether it is shown in place of `before`, the answer to another question.
    fn replaces(&self, before: &Self) -> bool;
}

/// All parts. Where each part is a whole answer, the last one is the best.
impl<P> Answer<P> for Vec<P> {
    fn add(&mut self, mut parts: Vec<P>, _: Duration) {
        self.append(&mut parts);
    }

    fn replaces(&self, before: &Self) -> bool {
        !self.is_empty() || before.is_empty()
    }
}

/// A question that is answered in the background: `Q` is what is asked, `P` a part of its answer, and `A`
/// what the parts add up to.
#[derive(Debug)]
pub struct Background<Q, P, A = Vec<P>> {
    /// The question, and its answer as far as it has come.
    asked: Option<(Q, A)>,
    /// The answer to an earlier question, until that to the present one replaces it.
    before: Option<A>,
    work: Work<P>,
    /// Time that earlier jobs have worked on the question.
    worked: Duration,
    /// Count of changes of what is shown.
    version: u64,
    /// Whether a view shows the answer in this frame.
    is_wanted: bool,
}

impl<Q, P, A> Default for Background<Q, P, A> {
    fn default() -> Self {
        let (work, worked) = (Work::Paused, Duration::ZERO);
        Self { asked: None, before: None, work, worked, version: 0, is_wanted: false }
    }
}

impl<Q: PartialEq, P: Send + 'static, A: Answer<P>> Background<Q, P, A> {
    /// Replaces the question; `answer` is what is known of its answer. No job is begun.
    pub fn set(&mut self, question: Q, answer: A) {
        let is_same = self.question() == Some(&question);
        let old = self.asked.take().filter(|_| !is_same).map(|asked| asked.1);
        let before = self.before.take().or(old);
        self.before = before.filter(|before| !answer.replaces(before));
        self.asked = Some((question, answer));
        (self.work, self.worked) = (Work::Paused, Duration::ZERO);
        self.version += 1;
    }

    /// Begins a job that adds to the answer. It is given a flag that says when to stop, and where its parts
    /// go; it returns the last part, if there is one.
    pub fn resume(
        &mut self,
        wake: &Wake,
        job: impl FnOnce(&AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) {
        self.work = Job::start(wake, job).map_or(Work::Paused, Work::Running);
    }

    /// Forgets the question and all answers.
    pub fn clear(&mut self) {
        *self = Self { version: self.version + 1, is_wanted: self.is_wanted, ..Self::default() };
    }

    /// Cancels the job; asked again, the question is begun again.
    pub fn pause(&mut self) {
        self.halt(Work::Paused);
    }

    /// Cancels the job; only another question is begun.
    pub fn stop(&mut self) {
        self.halt(Work::Done);
    }

    fn halt(&mut self, work: Work<P>) {
        self.poll();
        if self.is_running() {
            (self.worked, self.work) = (self.worked(), work);
        }
    }

    /// Lets a question be begun again that was stopped, or whose job has ended.
    pub fn again(&mut self) {
        if self.is_whole() {
            self.work = Work::Paused;
        }
    }

    /// Takes in what has come. To be called once a frame.
    pub fn poll(&mut self) {
        let worked = self.worked();
        let (Work::Running(job), Some((_, answer))) = (&self.work, &mut self.asked) else { return };
        let (parts, is_done) = job.take();
        if !parts.is_empty() {
            answer.add(parts, worked);
            self.version += 1;
        }
        self.before.take_if(|before| is_done || answer.replaces(before));
        if is_done {
            (self.worked, self.work) = (worked, Work::Done);
        }
    }

    /// Waits until nothing more comes, for `limit` at the longest. Whether nothing more comes.
    pub fn wait(&mut self, limit: Duration) -> bool {
        let clock = WallClock::start();
        self.poll();
        while self.is_running() && clock.elapsed() < limit {
            sleep(Duration::from_millis(2));
            self.poll();
        }
        self.is_whole()
    }

    /// Says that a view shows the answer in this frame.
    pub fn mark_wanted(&mut self) {
        self.is_wanted = true;
    }

    /// Pauses what no view has shown in this frame.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.is_wanted) {
            self.pause();
        }
    }

    pub fn question(&self) -> Option<&Q> {
        self.asked.as_ref().map(|asked| &asked.0)
    }

    /// The answer to the present question, as far as it has come.
    pub fn so_far(&self) -> Option<&A> {
        self.asked.as_ref().map(|asked| &asked.1)
    }

    /// The answer to be shown, and whether it is that to the present question.
    pub fn shown(&self) -> Option<(&A, bool)> {
        self.before.as_ref().map(|before| (before, false)).or(self.so_far().map(|answer| (answer, true)))
    }

    pub fn version(&self) -> u64 {
        self.version
    }

    pub fn is_paused(&self) -> bool {
        matches!(self.work, Work::Paused)
    }

    pub fn is_running(&self) -> bool {
        matches!(self.work, Work::Running(_))
    }

    /// Whether nothing more comes: all of the answer is there, or the job was stopped.
    pub fn is_whole(&self) -> bool {
        matches!(self.work, Work::Done)
    }

    /// The time that has been worked on the question.
    pub fn worked(&self) -> Duration {
        match &self.work {
            Work::Running(job) => self.worked + job.begun.elapsed(),
            Work::Paused | Work::Done => self.worked,
        }
    }

    /// The time that has been worked on the question; none where no job runs.
    pub fn running_for(&self) -> Option<Duration> {
        self.is_running().then(|| self.worked())
    }
}

impl<Q: Clone + PartialEq + Send + 'static, P: Send + 'static> Background<Q, P> {
    /// Asks `question`; a job under way is cancelled. The new job is as in [`resume`](Self::resume).
    pub fn ask(
        &mut self,
        question: Q,
        wake: &Wake,
        job: impl FnOnce(&Q, &AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) {
        self.set(question.clone(), Vec::new());
        self.resume(wake, move |cancel, each| job(&question, cancel, each));
    }

    /// Asks `question`, in a frame in which a view shows its answer, where that is neither known nor worked
    /// out. Where the scene does not stand `still`, nothing is begun.
    pub fn want(
        &mut self,
        question: Q,
        still: bool,
        wake: &Wake,
        job: impl FnOnce(&Q, &AtomicBool, Each<P>) -> Option<P> + Send + 'static,
    ) {
        self.mark_wanted();
        if still && (self.is_paused() || self.question() != Some(&question)) {
            self.ask(question, wake, job);
        }
    }

    /// The best answer to the present question so far.
    pub fn answer(&self) -> Option<&P> {
        self.so_far()?.last()
    }

    /// The answer to be shown, and whether it is that to the present question.
    pub fn newest(&self) -> Option<(&P, bool)> {
        let (parts, is_current) = self.shown()?;
        Some((parts.last()?, is_current))
    }

    /// The parts to be shown, and whether they are those of the present question.
    pub fn parts(&self) -> (&[P], bool) {
        let (parts, is_current) = self.shown().map_or((&[][..], false), |(parts, of)| (&parts[..], of));
        (parts, is_current && (self.is_whole() || !parts.is_empty()))
    }

    /// Takes in what has come and hands over the answer to the present question.
    pub fn take(&mut self) -> Option<P> {
        self.poll();
        self.asked.as_mut()?.1.pop()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(20);

    fn wake() -> Wake {
        Arc::new(|| ())
    }

    fn until_set(flag: &AtomicBool) {
        while !flag.load(Ordering::Relaxed) {
            sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn dropped_or_asked_something_else_it_cancels_the_job() {
        let (sender, cancelled) = channel();
        let mut background = Background::<u32, ()>::default();
        for question in 1..=2 {
            let sender = sender.clone();
            background.ask(question, &wake(), move |question, cancel, _| {
                until_set(cancel);
                sender.send(*question).ok();
                None
            });
        }
        assert_eq!(cancelled.recv_timeout(LONG), Ok(1));
        drop(background);
        assert_eq!(cancelled.recv_timeout(LONG), Ok(2));
    }

    #[test]
    fn the_answer_before_is_shown_until_there_is_another() {
        let mut background = Background::default();
        background.ask(1, &wake(), |_, _, _| Some(10));
        assert!(background.wait(LONG));
        assert_eq!((background.answer(), background.newest()), (Some(&10), Some((&10, true))));
        let (sender, gate) = channel::<()>();
        background.ask(2, &wake(), move |_, _, _| gate.recv().ok().map(|()| 20));
        assert_eq!((background.answer(), background.newest()), (None, Some((&10, false))));
        sender.send(()).unwrap();
        assert!(background.wait(LONG));
        assert_eq!(background.newest(), Some((&20, true)));
        assert_eq!((background.take(), background.take()), (Some(20), None));
        // a job that panics leaves no answer
        background.ask(3, &wake(), |_, _, _| std::panic::resume_unwind(Box::new("stop")));
        assert!(background.wait(LONG));
        assert_eq!((background.parts(), background.newest()), ((&[][..], true), None));
    }

    #[test]
    fn parts_come_while_a_view_wants_them() {
        let count = |count: &u32, _: &AtomicBool, each: Each<u32>| {
            (0..*count).for_each(each);
            None
        };
        let mut background = Background::default();
        assert_eq!(background.parts(), (&[][..], false));
        background.want(2, true, &wake(), count);
        assert!(background.wait(LONG));
        assert_eq!(background.parts(), (&[0, 1][..], true));
        background.want(3, false, &wake(), |_, _, _| panic!("a hand is on the scene"));
        assert_eq!(background.question(), Some(&2));
        let gate = Arc::new(AtomicBool::new(false));
        let passed = Arc::clone(&gate);
        background.want(3, true, &wake(), move |_, cancel, each| {
            until_set(&passed);
            each(7);
            until_set(cancel);
            None
        });
        assert_eq!((background.parts(), background.is_whole()), ((&[0, 1][..], false), false));
        gate.store(true, Ordering::Relaxed);
        while background.parts() != (&[7][..], true) {
            background.poll();
        }
        // no view wants it: it is paused, and begun again for a view that does
        background.end_frame();
        assert!(background.is_running());
        background.end_frame();
        assert!(background.is_paused());
        background.want(3, true, &wake(), count);
        assert!(background.wait(LONG));
        assert_eq!(background.parts(), (&[0, 1, 2][..], true));
        // stopped, it is begun again only where it is told to
        background.want(4, true, &wake(), |_, cancel, _| {
            until_set(cancel);
            None
        });
        background.stop();
        background.want(4, true, &wake(), |_, _, _| panic!("it was stopped"));
        assert!(background.is_whole() && background.running_for().is_none());
        background.again();
        background.want(4, true, &wake(), count);
        assert!(background.wait(LONG));
        assert_eq!(background.parts(), (&[0, 1, 2, 3][..], true));
    }
}
