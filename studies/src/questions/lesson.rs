//! The check of lessons.

use super::{Error, Progress};
use crate::scene::lesson::LessonDocument;
use crate::study::{LessonReport, Unjudged, check_lesson};

/// Runs lessons, and reports whether their tasks and predictions hold.
#[doc(hidden)]
pub fn check_lessons(lessons: &[LessonDocument], progress: &Progress) -> Result<Vec<LessonReport>, Error> {
    let task = progress.silent();
    let reports = progress.pool(|pool| {
        pool.map(lessons.len(), || (), |(), number| check_lesson(&lessons[number], Some(pool), &task))
    })?;
    reports.map_err(|error| match error {
        Unjudged::Cancelled => Error::Cancelled,
        Unjudged::Scene { .. } => {
            Error::Failed { scene: "a scene of the lesson".to_owned(), problem: error.to_string() }
        }
    })
}
