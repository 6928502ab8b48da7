//! Questions of a lesson: which option of a prediction holds, and whether a scene does a task.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use super::{Outcome, TaskState};
use crate::app::session::prepared::SceneWithFiles;
use crate::app::task::{Each, Question, Uncompared};
use crate::mechanics::Mechanism;
use crate::scene::lesson::{Lesson, LessonDocument, Step};
use crate::scene::{Document, Scene};
use interwell_studies::study::{Subject, Task, Unjudged, goal_lack, options_that_hold};

/// A step of a lesson, and the scene that is judged in it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Judged {
    #[serde(with = "crate::app::task::as_text")]
    lesson: Lesson,
    number: usize,
    /// The scene with which the step begins.
    begin: SceneWithFiles,
    scene: SceneWithFiles,
    /// The mechanism of the scene, where it has been built.
    #[serde(skip)]
    pub(super) mechanism: Option<Arc<Mechanism>>,
}

impl Judged {
    pub(super) fn new(document: &LessonDocument, number: usize, judged: &Document) -> Self {
        let of = |of: &Document| SceneWithFiles { scene: of.scene.clone(), files: of.files.clone() };
        let (lesson, begin) = (document.lesson.clone(), of(document.begin(number)));
        Self { lesson, number, begin, scene: of(judged), mechanism: None }
    }

    /// The `verdict`, or why there is none; `None` if cancelled.
    fn judge<T>(
        &self,
        cancel: &AtomicBool,
        verdict: impl FnOnce(&Step, &Subject<'_>, &Subject<'_>) -> Result<T, Unjudged>,
    ) -> Option<Result<T, String>> {
        let (Self { lesson, begin, scene, .. }, task) = (self, Task { tick: &|| (), cancel });
        let before = Subject::new(begin, &begin.files, lesson, &task);
        let subject = Subject::new(scene, &scene.files, lesson, &task);
        let subject = match &self.mechanism {
            Some(mechanism) => subject.with_mechanism(Arc::clone(mechanism)),
            None => subject,
        };
        match verdict(&lesson.steps[self.number], &subject, &before) {
            Err(Unjudged::Cancelled) => None,
            verdict => Some(verdict.map_err(|error| error.to_string())),
        }
    }
}

/// Which option of the prediction in a step holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OptionsQuestion {
    pub(super) number: usize,
    pub(super) judged: Uncompared<Judged>,
}

impl Question for OptionsQuestion {
    const NAME: &'static str = "options";
    type Part = Outcome;

    fn answer(&self, cancel: &AtomicBool, _: Each<Outcome>) -> Option<Outcome> {
        let outcome = self.judged.0.judge(cancel, |step, subject, before| {
            options_that_hold(step, subject, before).map(|options| single_option(&options))
        });
        outcome.map(|outcome| outcome.unwrap_or_else(Outcome::Unjudged))
    }
}

/// Whether the scene does a task, judged by a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GoalQuestion {
    #[serde(with = "crate::app::task::as_text")]
    pub(super) scene: Scene,
    pub(super) judged: Uncompared<Judged>,
}

impl Question for GoalQuestion {
    const NAME: &'static str = "goal";
    type Part = TaskState;

    fn answer(&self, cancel: &AtomicBool, _: Each<TaskState>) -> Option<TaskState> {
        let state = self.judged.0.judge(cancel, |step, subject, before| {
            Ok(goal_lack(step, subject, before)?.map_or(TaskState::Met, TaskState::NotYet))
        });
        state.map(|state| state.unwrap_or_else(TaskState::Unjudged))
    }
}

fn single_option(options: &[bool]) -> Outcome {
    let mut right = options.iter().enumerate().filter(|(_, holds)| **holds).map(|(number, _)| number);
    match (right.next(), right.next()) {
        (Some(option), None) => Outcome::Holds(option),
        _ => Outcome::Unclear,
    }
}
