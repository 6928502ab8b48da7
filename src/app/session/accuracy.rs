//! Accuracy of the motion on the screen, worked out in the background.
//!
//! The error of the motion is worked out whenever the scene stands still, from the last change on. What the
//! view Accuracy shows is about the scene from its start, and is computed while that view is open.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Identity, Wake};
use crate::dynamics::Model;
use crate::study::accuracy::methods::Scheme;
use crate::study::accuracy::scene::{
    Course, StepSize, Tolerances, Trust, Unfit, lasting, moment, small_length, step_size, tolerances, trust,
};

use super::ask::LiveRun;

/// The step with which the view begins: a frame of a screen, as games take.
const FRAME: f64 = 1.0 / 60.0;

/// Once the motion has passed the time up to which its error is known, the error is worked out over this many
/// times the time that has passed.
const STRETCH: f64 = 2.0;

/// How accurate the motion is, as far as it is known.
pub struct Accuracy {
    /// The run that moves; none where nothing can be said about it.
    run: Option<LiveRun>,
    /// The error of the run over a time in s.
    trust: Background<(LiveRun, f64), Trust>,
    /// The method of fixed step that the view shows.
    pub scheme: Scheme,
    /// Its step in s.
    pub step: f64,
    /// What each digit costs.
    tolerances: Background<Identity<Model>, Tolerances>,
    /// The scene by a method of fixed step, with a step in s.
    stepped: Background<(Identity<Model>, Scheme, f64), Result<StepSize, Unfit>>,
}

/// The error of the path, or up to when it is to be relied on, in a few words.
fn short(trust: &Trust, from: f64) -> String {
    match trust.course {
        Course::Kept => format!("Path error {}", small_length(trust.error, trust.travel)),
        Course::Chaotic { until, .. } => format!("Chaotic: path reliable up to {}", moment(from + until)),
        Course::Sensitive { until } | Course::Coarse { until } => {
            format!("Path reliable up to {}", moment(from + until))
        }
    }
}

/// What that means, how it is known, and whether the regime depends on it.
fn long(trust: &Trust, from: f64) -> String {
    let about_regime = match (trust.course, trust.same_regime) {
        (Course::Kept, _) => "",
        (_, true) => {
            " This is about the path, where the mass is at an instant: both runs come to the same regime, \
             which does not hang on it."
        }
        (_, false) => " The two runs also come to different regimes, so that the regime hangs on it.",
    };
    format!("{}{about_regime}", trust.long(from))
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            run: None,
            trust: Background::default(),
            scheme: Scheme::RungeKutta4,
            step: FRAME,
            tolerances: Background::default(),
            stepped: Background::default(),
        }
    }
}

impl Accuracy {
    /// Begins with another run, or with none where nothing can be said about it.
    pub(super) fn begin(&mut self, run: Option<LiveRun>) {
        self.run = run;
        self.trust.clear();
    }

    /// The longest time for which something has been worked out; none where nothing is.
    pub(super) fn working(&self) -> Option<Duration> {
        let all = [self.trust.running_for(), self.tolerances.running_for(), self.stepped.running_for()];
        all.into_iter().flatten().max()
    }

    /// Stops what is being worked out.
    pub(super) fn stop(&mut self) {
        self.trust.stop();
        self.tolerances.stop();
        self.stepped.stop();
    }

    /// Whether a person has stopped what the view shows.
    pub fn is_stopped(&self) -> bool {
        self.tolerances.is_whole() && self.tolerances.answer().is_none()
            || self.stepped.is_whole() && self.stepped.answer().is_none()
    }

    pub(super) fn poll(&mut self) {
        self.trust.poll();
        self.tolerances.poll();
        self.stepped.poll();
    }

    /// Has the error of the motion worked out, where it is not known yet up to the live time `now` in s.
    pub(super) fn follow(&mut self, now: f64, wake: &Wake) {
        let Some(run) = &self.run else { return };
        let gone = now - run.from;
        let span = match (self.trust.question(), self.trust.answer()) {
            (None, _) => run.model.0.duration(),
            // once the runs have diverged they are not compared again
            (Some((_, span)), Some(known)) if known.course.until().is_none() && gone > *span => {
                STRETCH * gone
            }
            _ => return,
        };
        self.trust.ask((run.clone(), span), wake, |(run, span), cancel, _| {
            trust(&lasting(&run.model.0, *span), cancel)
        });
    }

    /// The error of the motion in a few words, and in full.
    pub(super) fn words(&self) -> Option<(String, String)> {
        let from = self.run.as_ref()?.from;
        let (trust, _) = self.trust.newest()?;
        // a run that ended early has other things to say
        trust.short(from)?;
        Some((short(trust, from), long(trust, from)))
    }

    /// Asks what digits and steps cost in `model`, in a frame in which the view shows it.
    pub(super) fn want(&mut self, model: &Arc<Model>, still: bool, wake: &Wake) {
        let model = Identity(Arc::clone(model));
        self.tolerances.want(model.clone(), still, wake, |model, cancel, _| tolerances(&model.0, cancel));
        let question = (model, self.scheme, self.step);
        self.stepped.want(question, still, wake, |(model, scheme, step), cancel, _| {
            match step_size(&model.0, *scheme, *step, cancel) {
                Err(Unfit::Cancelled) => None,
                answer => Some(answer),
            }
        });
    }

    pub(super) fn end_frame(&mut self) {
        self.tolerances.end_frame();
        self.stepped.end_frame();
    }

    /// Waits for what is being computed, for `limit` at the longest.
    pub(super) fn wait(&mut self, limit: Duration) {
        self.trust.wait(limit);
        self.tolerances.wait(limit);
        self.stepped.wait(limit);
    }

    /// What each digit costs, and whether that is about `model`.
    pub fn tolerances(&self, model: &Model) -> Option<(&Tolerances, bool)> {
        let (known, is_current) = self.tolerances.newest()?;
        let is_same = std::ptr::eq(&*self.tolerances.question()?.0, model);
        Some((known, is_current && is_same))
    }

    /// The scene by the fixed step, and whether that is about `model` and the present step.
    pub fn stepped(&self, model: &Model) -> Option<(&Result<StepSize, Unfit>, bool)> {
        let (known, is_current) = self.stepped.newest()?;
        let (Identity(of), _, step) = self.stepped.question()?;
        Some((known, is_current && std::ptr::eq(&**of, model) && *step == self.step))
    }

    /// Whether anything is being worked out.
    pub fn is_running(&self) -> bool {
        self.working().is_some()
    }
}
