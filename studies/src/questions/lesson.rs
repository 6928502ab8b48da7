//! Lessons: their check, and the judgement of a step.

use std::sync::Arc;

use super::{Error, Progress};
use crate::mechanics::Mechanism;
use crate::scene::lesson::{Lesson, LessonDocument, Step};
use crate::scene::{Files, Scene};
use crate::study::{Lack, LessonReport, Said, Subject, Unjudged, check_lesson, goal_lack, options_that_hold};

/// Runs lessons, and reports whether their tasks and predictions hold.
#[doc(hidden)]
pub fn check_lessons(lessons: &[LessonDocument], progress: &Progress) -> Result<Vec<LessonReport>, Error> {
    let task = progress.silent();
    let reports = progress.pool(|pool| {
        pool.map(lessons.len(), || (), |(), number| check_lesson(&lessons[number], Some(pool), &task))
    })?;
    Ok(reports?)
}

impl From<Unjudged> for Error {
    fn from(error: Unjudged) -> Self {
        match error {
            Unjudged::Cancelled => Self::Cancelled,
            Unjudged::Scene { .. } => {
                Self::Failed { scene: "a scene of the lesson".to_owned(), problem: Said::new(error) }
            }
        }
    }
}

/// A step of a lesson, and the scene that is judged in it.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct JudgedStep<'a> {
    /// The lesson.
    pub lesson: &'a Lesson,
    /// Number of the step, from 0.
    pub number: usize,
    /// The scenes with which the step begins and that is judged, each with its files.
    pub scenes: [(&'a Scene, &'a Files); 2],
    /// The mechanism of the second one, where it has been built.
    pub mechanism: Option<&'a Arc<Mechanism>>,
}

impl JudgedStep<'_> {
    /// Which options of its prediction hold.
    pub fn options(&self, progress: &Progress) -> Result<Vec<bool>, Error> {
        self.judged(progress, options_that_hold)
    }

    /// What the scene lacks for the goal of its task.
    pub fn lack(&self, progress: &Progress) -> Result<Option<Lack>, Error> {
        self.judged(progress, goal_lack)
    }

    fn judged<T>(
        &self,
        progress: &Progress,
        verdict: impl FnOnce(&Step, &Subject<'_>, &Subject<'_>) -> Result<T, Unjudged>,
    ) -> Result<T, Error> {
        let (lesson, task) = (self.lesson, progress.silent());
        let [before, mut subject] =
            self.scenes.map(|(scene, files)| Subject::new(scene, files, lesson, &task));
        if let Some(mechanism) = self.mechanism {
            subject = subject.with_mechanism(Arc::clone(mechanism));
        }
        Ok(verdict(&lesson.steps[self.number], &subject, &before)?)
    }
}
