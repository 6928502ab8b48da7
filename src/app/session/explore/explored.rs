//! Answer of a study to the newest question, part by part.

use std::sync::atomic::AtomicBool;

use crate::app::task::{Job, Wake};

/// The parts of an answer as they come, and those of the previous answer until the first one comes.
pub struct Explored<Q, P> {
    question: Option<Q>,
    parts: Vec<P>,
    previous: Vec<P>,
    job: Option<Job<P>>,
    is_whole: bool,
    wanted: bool,
}

impl<Q, P> Default for Explored<Q, P> {
    fn default() -> Self {
        let (parts, previous) = (Vec::new(), Vec::new());
        Self { question: None, parts, previous, job: None, is_whole: false, wanted: false }
    }
}

impl<Q: PartialEq + Clone, P: Send + 'static> Explored<Q, P> {
    /// Asks `question`; to be called in every frame in which a view shows the answer. A new question is begun
    /// once the scene stands `still`; `study` gets the question, a cancel flag to check, and a callback for
    /// each part.
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
            self.previous = old;
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
            self.previous.clear();
        }
        if !more {
            (self.job, self.is_whole) = (None, true);
        }
    }

    /// Stops the study if no view has asked for it in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.wanted) {
            self.job = None;
        }
    }

    /// The known parts, and whether they belong to the newest question.
    pub fn parts(&self) -> (&[P], bool) {
        if self.parts.is_empty() && !self.is_whole { (&self.previous, false) } else { (&self.parts, true) }
    }

    pub fn question(&self) -> Option<&Q> {
        self.question.as_ref()
    }

    /// Whether more parts may come.
    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }

    /// Whether all parts of the newest answer have come.
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

    /// Asks for the numbers up to `question`, and waits for all of them.
    fn ask(explored: &mut Explored<u32, u32>, question: u32) {
        let wake: Wake = Arc::new(|| ());
        explored.want(&question, true, &wake, |upto, _, each| (0..*upto).for_each(each));
        wait_while(LONG, || {
            explored.poll();
            explored.is_running()
        });
    }

    #[test]
    fn the_previous_parts_stay_until_new_ones_come() {
        let mut explored = Explored::default();
        ask(&mut explored, 2);
        assert_eq!((explored.parts(), explored.is_whole()), ((&[0, 1][..], true), true));
        let wake: Wake = Arc::new(|| ());
        explored.want(&3, false, &wake, |_, _, _| panic!("the scene is being changed"));
        assert_eq!(explored.question(), Some(&2));
        explored.want(&3, true, &wake, |_, cancel, _| while !cancel.load(Ordering::Relaxed) {});
        assert_eq!((explored.parts(), explored.is_whole()), ((&[0, 1][..], false), false));
        // a study that no view asks for stops, and begins again when a view asks
        explored.end_frame();
        assert!(explored.is_running());
        explored.end_frame();
        assert!(!explored.is_running() && !explored.is_whole());
        ask(&mut explored, 3);
        assert_eq!(explored.parts(), (&[0, 1, 2][..], true));
        // an answer may have no parts
        ask(&mut explored, 0);
        assert_eq!(explored.parts(), (&[][..], true));
    }
}
