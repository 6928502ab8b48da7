//! Accuracy of the motion on the screen, worked out in the background.
//!
//! The error of the motion is worked out whenever the scene stands still, from where the motion was when it
//! was changed last. What the view Accuracy shows is of the scene from its start, and is computed while that
//! view is open.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Latest, Wake};
use crate::dynamics::Model;
use crate::study::accuracy::methods::Scheme;
use crate::study::accuracy::scene::{
    Course, StepSize, Tolerances, Trust, Unfit, lasting, moment, small_length, step_size, tolerances, trust,
};

/// The step that is looked at first: a frame of a screen, as games take.
const FRAME: f64 = 1.0 / 60.0;

/// By how much the time is stretched over which the error is known, once the motion has gone on beyond it.
const STRETCH: f64 = 2.0;

/// How accurate the motion is, as far as it is known.
pub struct Accuracy {
    /// What moves, and the live time in s at which it began; none where nothing can be said.
    origin: Option<(Arc<Model>, f64)>,
    /// The time in s from there over which its error was asked.
    asked: Option<f64>,
    trust: Latest<Trust>,
    /// The method of fixed step that is looked at.
    pub scheme: Scheme,
    /// Its step in s.
    pub step: f64,
    /// Whether a view of this frame shows what digits and steps cost.
    wanted: bool,
    tolerances_of: Option<Arc<Model>>,
    tolerances: Latest<Tolerances>,
    step_of: Option<(Arc<Model>, Scheme, f64)>,
    stepped: Latest<Result<StepSize, Unfit>>,
    /// A person has stopped what was being worked out.
    stopped: bool,
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

/// What that means, how it is known, and whether the sentence beside it hangs on it.
fn long(trust: &Trust, from: f64) -> String {
    let hangs = match (trust.course, trust.same_regime) {
        (Course::Kept, _) => "",
        (_, true) => {
            " This is about the path, where the mass is at an instant: both runs come to the same regime, \
             which does not hang on it."
        }
        (_, false) => " The two runs also come to different regimes, so that the regime hangs on it.",
    };
    format!("{}{hangs}", trust.long(from))
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            origin: None,
            asked: None,
            trust: Latest::default(),
            scheme: Scheme::RungeKutta4,
            step: FRAME,
            wanted: false,
            tolerances_of: None,
            tolerances: Latest::default(),
            step_of: None,
            stepped: Latest::default(),
            stopped: false,
        }
    }
}

impl Accuracy {
    /// Another motion: what moves from now on and the live time in s, or none where nothing can be said of
    /// it.
    pub(super) fn begin(&mut self, origin: Option<(Arc<Model>, f64)>) {
        (self.origin, self.asked, self.stopped) = (origin, None, false);
        self.trust.clear();
    }

    /// For how long something has been worked out; none where nothing is.
    pub(super) fn working(&self) -> Option<Duration> {
        let all = [self.trust.running_for(), self.tolerances.running_for(), self.stepped.running_for()];
        all.into_iter().flatten().max()
    }

    /// Leaves what is being worked out unknown.
    pub(super) fn stop(&mut self) {
        self.trust.stop();
        self.tolerances.stop();
        self.stepped.stop();
        self.stopped = true;
    }

    /// Whether a person has stopped it since the last change.
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    pub(super) fn poll(&mut self) {
        self.trust.poll();
        self.tolerances.poll();
        self.stepped.poll();
    }

    /// Has the error of the motion worked out, where it is not known yet up to the live time `now` in s.
    pub(super) fn follow(&mut self, now: f64, wake: &Wake) {
        let Some((model, from)) = &self.origin else { return };
        let span = match (self.asked, self.trust.current()) {
            (None, _) => model.duration(),
            // once the runs have diverged they are not compared again
            (Some(asked), Some(known)) if known.course.until().is_none() && now - from > asked => {
                STRETCH * (now - from)
            }
            _ => return,
        };
        let model = Arc::clone(model);
        self.asked = Some(span);
        self.trust.ask(wake, move |cancel| trust(&lasting(&model, span), cancel));
    }

    /// The error of the motion in a few words, and in full.
    pub(super) fn words(&self) -> Option<(String, String)> {
        let (_, from) = self.origin.as_ref()?;
        let trust = self.trust.newest()?;
        // a run that ended early has other things to say
        trust.short(*from)?;
        Some((short(trust, *from), long(trust, *from)))
    }

    /// Asks, for a view, what digits and steps cost in `model`; to be asked anew in every frame. Where a hand
    /// still changes the scene, what is known of an earlier one has to do.
    pub(super) fn want(&mut self, model: &Arc<Model>, still: bool, wake: &Wake) {
        self.wanted = true;
        if !still {
            return;
        }
        if !self.tolerances_of.as_ref().is_some_and(|own| Arc::ptr_eq(own, model)) {
            self.tolerances_of = Some(Arc::clone(model));
            let model = Arc::clone(model);
            self.tolerances.ask(wake, move |cancel| tolerances(&model, cancel));
        }
        let (scheme, step) = (self.scheme, self.step);
        let same =
            |own: &(Arc<Model>, Scheme, f64)| Arc::ptr_eq(&own.0, model) && (own.1, own.2) == (scheme, step);
        if !self.step_of.as_ref().is_some_and(same) {
            self.step_of = Some((Arc::clone(model), scheme, step));
            let model = Arc::clone(model);
            self.stepped.ask(wake, move |cancel| match step_size(&model, scheme, step, cancel) {
                Err(Unfit::Cancelled) => None,
                answer => Some(answer),
            });
        }
    }

    /// To be called once a frame: what no view has asked for is not worked out any further.
    pub fn end_frame(&mut self) {
        if std::mem::take(&mut self.wanted) {
            return;
        }
        if self.tolerances.is_running() {
            self.tolerances.stop();
            self.tolerances_of = None;
        }
        if self.stepped.is_running() {
            self.stepped.stop();
            self.step_of = None;
        }
    }

    /// Waits for what is being computed, at most so long.
    pub(super) fn wait(&mut self, most: Duration) {
        self.trust.wait(most);
        self.tolerances.wait(most);
        self.stepped.wait(most);
    }

    /// What each digit costs, and whether that is of `model`.
    pub fn tolerances(&self, model: &Model) -> Option<(&Tolerances, bool)> {
        let same = self.tolerances_of.as_ref().is_some_and(|own| std::ptr::eq(&**own, model));
        let known = self.tolerances.newest()?;
        Some((known, same && self.tolerances.current().is_some()))
    }

    /// What the fixed step makes of the scene, and whether that is of `model` and the present step.
    pub fn stepped(&self, model: &Model) -> Option<(&Result<StepSize, Unfit>, bool)> {
        let same =
            self.step_of.as_ref().is_some_and(|own| std::ptr::eq(&*own.0, model) && own.2 == self.step);
        let known = self.stepped.newest()?;
        Some((known, same && self.stepped.current().is_some()))
    }

    /// Whether anything is being worked out.
    pub fn is_running(&self) -> bool {
        self.trust.is_running() || self.tolerances.is_running() || self.stepped.is_running()
    }
}
