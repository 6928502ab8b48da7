//! Accuracy of the motion on the screen, computed in the background.
//!
//! The error of the path is computed whenever nobody is changing the scene, for the motion since its last
//! change. The results in the view Accuracy are for the scene from its start; they are computed while that
//! view is open.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::app::task::{Background, Each, Question, Wake, progress, told};
use crate::dynamics::{Model, Summary};
use crate::questions::{self, Course, Scheme, StepSize, Tolerances, Trust};
use interwell_studies::study::accuracy::scene::{moment, small_length};

use super::prepared::SharedModel;

/// Initial fixed step in s: a frame of a screen, the usual choice of games.
const FRAME: f64 = 1.0 / 60.0;

/// Length of the next comparison, as a multiple of the time since the run began.
const SPAN_FACTOR: f64 = 2.0;

/// A run of the motion from a live time on; as a question it asks for the settled motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct LiveRun {
    pub model: SharedModel,
    /// The live time in s at which it begins.
    pub from: f64,
}

impl Question for LiveRun {
    const NAME: &'static str = "settled";
    type Part = Summary;

    fn answer(&self, cancel: &AtomicBool, _: Each<Summary>) -> Option<Summary> {
        self.model.simulation().settled(&progress(cancel)).ok()
    }
}

pub struct Accuracy {
    /// The run on the screen; `None` if its error cannot be known.
    run: Option<LiveRun>,
    pub(super) trust: Background<PathQuestion, Trust>,
    /// The selected method of fixed step.
    pub scheme: Scheme,
    /// Its step in s.
    pub step: f64,
    pub(super) tolerances: Background<TolerancesQuestion, Tolerances>,
    pub(super) stepped: Background<StepQuestion, Result<StepSize, String>>,
    /// Whether the user has stopped the computations since the last change.
    pub is_stopped: bool,
}

/// A run, and the time in s for which the error of its path is computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PathQuestion {
    run: LiveRun,
    pub duration: f64,
}

impl Question for PathQuestion {
    const NAME: &'static str = "trust";
    type Part = Trust;

    fn answer(&self, cancel: &AtomicBool, _: Each<Trust>) -> Option<Trust> {
        let simulation = self.run.model.simulation();
        questions::Accuracy::trust(&simulation, Some(self.duration), &progress(cancel)).ok()
    }
}

/// A model whose runs at several tolerances are compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct TolerancesQuestion(pub SharedModel);

impl Question for TolerancesQuestion {
    const NAME: &'static str = "tolerances";
    type Part = Tolerances;

    fn answer(&self, cancel: &AtomicBool, _: Each<Tolerances>) -> Option<Tolerances> {
        questions::Accuracy::tolerances(&self.0.simulation(), &progress(cancel)).ok()
    }
}

/// A model, and a method of fixed step with its step in s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct StepQuestion {
    pub model: SharedModel,
    pub scheme: Scheme,
    pub step: f64,
}

impl Question for StepQuestion {
    const NAME: &'static str = "step size";
    type Part = Result<StepSize, String>;

    fn answer(&self, cancel: &AtomicBool, _: Each<Self::Part>) -> Option<Self::Part> {
        let (simulation, progress) = (self.model.simulation(), progress(cancel));
        told(questions::Accuracy::step_size(&simulation, self.scheme, self.step, &progress))
    }
}

/// In m; a smaller error of the path says no more to a reader than this does.
const NANOMETRE: f64 = 1e-9;

/// The error of the path, or the time up to which the path is reliable, in a few words.
fn short(trust: &Trust, from: f64) -> String {
    match trust.course {
        Course::Kept if trust.error < NANOMETRE => "Path error below 1 nm".to_owned(),
        Course::Kept => format!("Path error {}", small_length(trust.error, trust.travel)),
        Course::Chaotic { until, .. } | Course::Sensitive { until } | Course::Coarse { until } => {
            format!("Path reliable up to {}", moment(from + until))
        }
    }
}

/// The same in full: how it was determined, and whether the regime depends on it.
fn long(trust: &Trust, from: f64) -> String {
    let regime = match (trust.course, trust.same_regime) {
        (Course::Kept, _) => "",
        (_, true) => {
            " This is about the path, the position at each instant: both runs come to the same regime, \
             which does not depend on it."
        }
        (_, false) => " The two runs also come to different regimes, so that the regime depends on it.",
    };
    format!("{}{regime}", trust.long(from))
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
            is_stopped: false,
        }
    }
}

impl Accuracy {
    /// Begins anew with another run, or with `None` if its error cannot be known.
    pub(super) fn begin(&mut self, run: Option<LiveRun>) {
        (self.run, self.is_stopped) = (run, false);
        self.trust.clear();
    }

    /// How long the longest computation has been running; `None` if none is.
    pub fn working(&self) -> Option<Duration> {
        let times = [self.trust.running_for(), self.tolerances.running_for(), self.stepped.running_for()];
        times.into_iter().flatten().max()
    }

    /// Stops all computations; their results stay unknown.
    pub(super) fn stop(&mut self) {
        self.trust.stop();
        self.tolerances.stop();
        self.stepped.stop();
        self.is_stopped = true;
    }

    /// Starts to compute the error of the motion if it is not known up to the live time `now` in s.
    pub(super) fn follow(&mut self, now: f64, wake: &Wake) {
        let Some(run) = &self.run else { return };
        let elapsed = now - run.from;
        // once the runs have diverged they are not compared again
        let agrees = self.trust.answer().is_some_and(|trust| trust.course.until().is_none());
        let duration = match self.trust.question() {
            None => run.model.duration(),
            Some(question) if agrees && elapsed > question.duration => SPAN_FACTOR * elapsed,
            Some(_) => return,
        };
        self.trust.ask(PathQuestion { run: run.clone(), duration }, wake);
    }

    /// The live time in s up to which the path is reliable; `None` if that is not known.
    pub(super) fn trusted_to(&self) -> Option<f64> {
        let (run, trust) = (self.run.as_ref()?, self.trust.newest()?);
        Some(run.from + trust.course.until().unwrap_or(trust.span))
    }

    /// The error of the motion in a few words, and in full.
    pub(super) fn descriptions(&self) -> Option<(String, String)> {
        let from = self.run.as_ref()?.from;
        let trust = self.trust.newest()?;
        // for a run that ended early its end is reported instead
        trust.short(from)?;
        Some((short(trust, from), long(trust, from)))
    }

    /// The cost of each digit, and whether it was computed for `model`.
    pub fn tolerances(&self, model: &Model) -> Option<(&Tolerances, bool)> {
        let same = std::ptr::eq(&*self.tolerances.question()?.0, model);
        Some((self.tolerances.newest()?, same && self.tolerances.answer().is_some()))
    }

    /// The result of the fixed step, and whether it is that of `model`, the present method and step.
    pub fn stepped(&self, model: &Model) -> Option<(&Result<StepSize, String>, bool)> {
        let question = self.stepped.question()?;
        let same = std::ptr::eq(&*question.model, model)
            && (question.scheme, question.step) == (self.scheme, self.step);
        Some((self.stepped.newest()?, same && self.stepped.answer().is_some()))
    }
}
