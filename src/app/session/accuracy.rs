//! Accuracy of the motion on the screen, computed in the background.
//!
//! The error of the path is computed whenever nobody is changing the scene, for the motion since its last
//! change. The results in the view Accuracy are for the scene from its start; they are computed while that
//! view is open.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Latest, Wake};
use crate::dynamics::Model;
use crate::study::accuracy::methods::Scheme;
use crate::study::accuracy::scene::{
    Course, StepSize, Tolerances, Trust, Unfit, lasting, moment, small_length, step_size, tolerances, trust,
};

/// Initial fixed step in s: a frame of a screen, the usual choice of games.
const FRAME: f64 = 1.0 / 60.0;

/// Time for which the error is computed again, as a multiple of the time that the motion has gone on.
const SPAN_FACTOR: f64 = 2.0;

/// Accuracy of the motion, as far as it is known.
pub struct Accuracy {
    /// The model that moves, and the live time in s at which it began; `None` if its error cannot be known.
    origin: Option<(Arc<Model>, f64)>,
    /// The time in s, from there on, for which the error was last requested.
    span: Option<f64>,
    trust: Latest<Trust>,
    /// The selected method of fixed step.
    pub scheme: Scheme,
    /// Its step in s.
    pub step: f64,
    /// Whether a view of this frame shows the cost of digits and steps.
    wanted: bool,
    tolerances_of: Option<Arc<Model>>,
    tolerances: Latest<Tolerances>,
    step_of: Option<(Arc<Model>, Scheme, f64)>,
    stepped: Latest<Result<StepSize, Unfit>>,
    /// Whether the user has stopped the computations.
    stopped: bool,
}

/// The error of the path, or the time up to which the path is reliable, in a few words.
fn short(trust: &Trust, from: f64) -> String {
    match trust.course {
        Course::Kept => format!("Path error {}", small_length(trust.error, trust.travel)),
        Course::Chaotic { until, .. } => format!("Chaotic: path reliable up to {}", moment(from + until)),
        Course::Sensitive { until } | Course::Coarse { until } => {
            format!("Path reliable up to {}", moment(from + until))
        }
    }
}

/// What that means, how it is known, and whether the regime in the sentence beside it depends on it.
fn long(trust: &Trust, from: f64) -> String {
    let regime = match (trust.course, trust.same_regime) {
        (Course::Kept, _) => "",
        (_, true) => {
            " This is about the path, where the mass is at an instant: both runs come to the same regime, \
             which does not hang on it."
        }
        (_, false) => " The two runs also come to different regimes, so that the regime hangs on it.",
    };
    format!("{}{regime}", trust.long(from))
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            origin: None,
            span: None,
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
    /// Begins with another motion: the model that moves from now on and the live time in s, or `None` where
    /// its error cannot be known.
    pub(super) fn begin(&mut self, origin: Option<(Arc<Model>, f64)>) {
        (self.origin, self.span, self.stopped) = (origin, None, false);
        self.trust.clear();
    }

    /// How long the longest computation has been running; `None` if none is.
    pub(super) fn working(&self) -> Option<Duration> {
        let times = [self.trust.running_for(), self.tolerances.running_for(), self.stepped.running_for()];
        times.into_iter().flatten().max()
    }

    /// Stops all computations; what they would have found stays unknown.
    pub(super) fn stop(&mut self) {
        self.trust.stop();
        self.tolerances.stop();
        self.stepped.stop();
        self.stopped = true;
    }

    /// Whether the user has stopped the computations since the last change.
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    pub(super) fn poll(&mut self) {
        self.trust.poll();
        self.tolerances.poll();
        self.stepped.poll();
    }

    /// Starts to compute the error of the motion if it is not known up to the live time `now` in s.
    pub(super) fn follow(&mut self, now: f64, wake: &Wake) {
        let Some((model, from)) = &self.origin else { return };
        let span = match (self.span, self.trust.current()) {
            (None, _) => model.duration(),
            // once the runs have diverged they are not compared again
            (Some(span), Some(trust)) if trust.course.until().is_none() && now - from > span => {
                SPAN_FACTOR * (now - from)
            }
            _ => return,
        };
        let model = Arc::clone(model);
        self.span = Some(span);
        self.trust.ask(wake, move |cancel| trust(&lasting(&model, span), cancel));
    }

    /// The error of the motion in a few words, and in full.
    pub(super) fn descriptions(&self) -> Option<(String, String)> {
        let (_, from) = self.origin.as_ref()?;
        let trust = self.trust.newest()?;
        // for a run that ended early its end is reported instead
        trust.short(*from)?;
        Some((short(trust, *from), long(trust, *from)))
    }

    /// Asks for the cost of digits and steps in `model`; to be called by a view in every frame. Unless the
    /// scene is `still` the answers for an earlier one stay.
    pub(super) fn want(&mut self, model: &Arc<Model>, still: bool, wake: &Wake) {
        self.wanted = true;
        if !still {
            return;
        }
        if !self.tolerances_of.as_ref().is_some_and(|of| Arc::ptr_eq(of, model)) {
            self.tolerances_of = Some(Arc::clone(model));
            let model = Arc::clone(model);
            self.tolerances.ask(wake, move |cancel| tolerances(&model, cancel));
        }
        let (scheme, step) = (self.scheme, self.step);
        let same =
            |of: &(Arc<Model>, Scheme, f64)| Arc::ptr_eq(&of.0, model) && (of.1, of.2) == (scheme, step);
        if !self.step_of.as_ref().is_some_and(same) {
            self.step_of = Some((Arc::clone(model), scheme, step));
            let model = Arc::clone(model);
            self.stepped.ask(wake, move |cancel| match step_size(&model, scheme, step, cancel) {
                Err(Unfit::Cancelled) => None,
                answer => Some(answer),
            });
        }
    }

    /// Stops the computations that no view has asked for in this frame; to be called once a frame.
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

    /// Waits for each computation, at most `timeout`.
    pub(super) fn wait(&mut self, timeout: Duration) {
        self.trust.wait(timeout);
        self.tolerances.wait(timeout);
        self.stepped.wait(timeout);
    }

    /// The cost of each digit, and whether it is that in `model`.
    pub fn tolerances(&self, model: &Model) -> Option<(&Tolerances, bool)> {
        let same = self.tolerances_of.as_ref().is_some_and(|of| std::ptr::eq(&**of, model));
        let known = self.tolerances.newest()?;
        Some((known, same && self.tolerances.current().is_some()))
    }

    /// The result of the fixed step, and whether it is that of `model`, the present method and step.
    pub fn stepped(&self, model: &Model) -> Option<(&Result<StepSize, Unfit>, bool)> {
        let same = self.step_of.as_ref().is_some_and(|(of, scheme, step)| {
            std::ptr::eq(&**of, model) && (*scheme, *step) == (self.scheme, self.step)
        });
        let known = self.stepped.newest()?;
        Some((known, same && self.stepped.current().is_some()))
    }

    /// Whether a computation is running.
    pub fn is_running(&self) -> bool {
        self.trust.is_running() || self.tolerances.is_running() || self.stepped.is_running()
    }
}
