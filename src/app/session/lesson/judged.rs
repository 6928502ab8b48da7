//! Questions of a lesson: which option of a prediction holds, and whether a scene does a task.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use super::{Outcome, TaskState};
use crate::app::session::prepared::SceneWithFiles;
use crate::app::task::{Each, Question, Uncompared, progress, told};
use crate::mechanics::Mechanism;
use crate::questions::JudgedStep;
use crate::scene::lesson::{Lesson, LessonDocument};
use crate::scene::{Document, Scene};

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
        let of = |of: &Document| SceneWithFiles::of(of, of.scene.clone());
        let (lesson, begin) = (document.lesson.clone(), of(document.begin(number)));
        Self { lesson, number, begin, scene: of(judged), mechanism: None }
    }

    fn step(&self) -> JudgedStep<'_> {
        let Self { lesson, number, begin, scene, mechanism } = self;
        let scenes = [begin, scene].map(|of| (&*of.scene, &of.files));
        JudgedStep { lesson, number: *number, scenes, mechanism: mechanism.as_ref() }
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
        let options = told(self.judged.0.step().options(&progress(cancel)))?;
        Some(options.map_or_else(Outcome::Unjudged, |options| single_option(&options)))
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
        let lack = told(self.judged.0.step().lack(&progress(cancel)))?;
        Some(lack.map_or_else(TaskState::Unjudged, |lack| lack.map_or(TaskState::Met, TaskState::NotYet)))
    }
}

fn single_option(options: &[bool]) -> Outcome {
    let mut right = options.iter().enumerate().filter(|(_, holds)| **holds).map(|(number, _)| number);
    match (right.next(), right.next()) {
        (Some(option), None) => Outcome::Holds(option),
        _ => Outcome::Unclear,
    }
}
