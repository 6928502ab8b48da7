//! The answer of a study, part by part, to the newest question.

use std::sync::atomic::AtomicBool;

use crate::app::task::{Job, Wake};

/// The parts of an answer as they come, and those of the question before until there are any.
pub struct Explored<Q, P> {
    question: Option<Q>,
    parts: Vec<P>,
    before: Vec<P>,
    job: Option<Job<P>>,
    is_whole: bool,
    wanted: bool,
}

impl<Q, P> Default for Explored<Q, P> {
    fn default() -> Self {
        let (parts, before) = (Vec::new(), Vec::new());
        Self { question: None, parts, before, job: None, is_whole: false, wanted: false }
    }
}

impl<Q: PartialEq + Clone, P: Send + 'static> Explored<Q, P> {
    /// Asks `question`, to be asked anew in every frame in which a view shows its answer. Where it is new it
    /// is begun as soon as the scene stands `still`; `study` is given it, a flag to look at, and where its
    /// parts go.
    pub fn want(
        &mut self,
        question: &Q,
        still: bool,
        wake: &Wake,
        study: impl FnOnce(&Q, &AtomicBool, &(dyn Fn(P) + Sync)) + Send + 'static,
    ) where
        Q: Send + 'static,
    {
        self.wanted = true;
        let same = self.question.as_ref() == Some(question);
        if same && (self.job.is_some() || self.is_whole) || !still {
            return;
        }
        let old = std::mem::take(&mut self.parts);
        if !same && !old.is_empty() {
            self.before = old;
        }
        self.question = Some(question.clone());
        self.is_whole = false;
        let question = question.clone();
        self.job = Job::start(wake, move |cancel, each| study(&question, cancel, each));
    }

    pub fn poll(&mut self) {
        let Some(job) = &self.job else { return };
        let more = job.take(|part| self.parts.push(part));
        if !self.parts.is_empty() {
            self.before.clear();
        }
        if !more {
            (self.job, self.is_whole) = (None, true);
        }
    }

    /// To be called once a frame: what no view has asked for is not worked out any further.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.wanted) {
            self.job = None;
        }
    }

    /// The parts that are known, and whether they are those of the newest question.
    pub fn parts(&self) -> (&[P], bool) {
        if self.parts.is_empty() && !self.is_whole { (&self.before, false) } else { (&self.parts, true) }
    }

    pub fn question(&self) -> Option<&Q> {
        self.question.as_ref()
    }

    /// Whether more is to come.
    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }

    /// Whether all parts of the newest question are there.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    use super::*;
    use crate::app::task::wait_while;

    const LONG: Duration = Duration::from_secs(20);

    /// Asks for the numbers up to `question`; waits until they are there.
    fn ask(own: &mut Explored<u32, u32>, question: u32) {
        let wake: Wake = Arc::new(|| ());
        own.want(&question, true, &wake, |upto, _, each| (0..*upto).for_each(each));
        wait_while(LONG, || {
            own.poll();
            own.is_running()
        });
    }

    #[test]
    fn the_parts_before_stay_until_new_ones_come() {
        let mut own = Explored::default();
        ask(&mut own, 2);
        assert_eq!((own.parts(), own.is_whole()), ((&[0, 1][..], true), true));
        let wake: Wake = Arc::new(|| ());
        own.want(&3, false, &wake, |_, _, _| panic!("a hand is on the scene"));
        assert_eq!(own.question(), Some(&2));
        own.want(&3, true, &wake, |_, cancel, _| while !cancel.load(Ordering::Relaxed) {});
        assert_eq!((own.parts(), own.is_whole()), ((&[0, 1][..], false), false));
        // nobody looks: it stops, and begins again when somebody does
        own.end_frame();
        assert!(own.is_running());
        own.end_frame();
        assert!(!own.is_running() && !own.is_whole());
        ask(&mut own, 3);
        assert_eq!(own.parts(), (&[0, 1, 2][..], true));
        // an answer without a part is an answer
        ask(&mut own, 0);
        assert_eq!(own.parts(), (&[][..], true));
    }
}
