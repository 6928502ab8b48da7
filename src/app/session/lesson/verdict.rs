//! Verdicts on the scenes of a lesson, computed in the background.

use std::sync::atomic::AtomicBool;

use crate::scene::Document;
use crate::scene::lesson::{LessonDocument, Step};
use crate::study::{Lack, Subject, Task, Unjudged};

#[derive(Debug, Clone, PartialEq)]
pub enum TaskState {
    /// The user is changing the scene, or has just changed it.
    Moving,
    Judging,
    /// The present scene does not do the task; the first thing that it lacks.
    NotYet(Lack),
    Met,
    /// Why the scene cannot be judged.
    Unjudged(String),
}

/// Which option of a prediction holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// The verdict is still being computed.
    Unknown,
    /// This one.
    Holds(usize),
    /// No option or several, which is a fault of the lesson.
    Unclear,
    /// Why the scene cannot be judged.
    Unjudged(String),
}

/// The verdict of a run, or why there is none.
pub(super) type Verdict<T> = Result<T, String>;

/// The outcome of a prediction, from whether each of its options holds.
pub(super) fn single_option(options: Option<&Verdict<Vec<bool>>>) -> Outcome {
    let all = match options {
        None => return Outcome::Unknown,
        Some(Err(why)) => return Outcome::Unjudged(why.clone()),
        Some(Ok(all)) => all,
    };
    let mut right = all.iter().enumerate().filter(|(_, holds)| **holds).map(|(number, _)| number);
    match (right.next(), right.next()) {
        (Some(option), None) => Outcome::Holds(option),
        _ => Outcome::Unclear,
    }
}

/// The `verdict` on a scene in a step of a lesson; `None` if cancelled.
pub(super) fn judge<T>(
    document: &LessonDocument,
    number: usize,
    judged: &Document,
    cancel: &AtomicBool,
    verdict: impl FnOnce(&Step, Subject<'_>, &Subject<'_>) -> Result<T, Unjudged>,
) -> Option<Verdict<T>> {
    let (lesson, begin) = (&document.lesson, document.begin(number));
    let task = Task { tick: &|| (), cancel };
    let before = Subject::new(&begin.scene, &begin.files, lesson, &task);
    let subject = Subject::new(&judged.scene, &judged.files, lesson, &task);
    match verdict(&lesson.steps[number], subject, &before) {
        Ok(verdict) => Some(Ok(verdict)),
        Err(Unjudged::Cancelled) => None,
        Err(error) => Some(Err(error.to_string())),
    }
}
