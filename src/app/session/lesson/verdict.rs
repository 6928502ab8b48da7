//! Verdicts on a lesson's scenes, worked out in the background.

use std::sync::atomic::AtomicBool;

use crate::scene::Document;
use crate::scene::lesson::{LessonDocument, Step};
use crate::study::{Lack, Subject, Task, Unjudged};

#[derive(Debug, Clone, PartialEq)]
pub enum TaskState {
    /// The scene is being changed, or has just been changed.
    Moving,
    Judging,
    /// Not met by the present scene, and the first thing that it lacks.
    NotYet(Lack),
    Met,
    /// The scene cannot be judged, and why.
    Unjudged(String),
}

/// Which option of a prediction is right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// It is still being worked out.
    Unknown,
    /// This one.
    Holds(usize),
    /// None or several, which is a fault of the lesson.
    Unclear,
    /// The scene cannot be judged, and why.
    Unjudged(String),
}

/// What a run says about a lesson, or why it says nothing.
pub(super) type Verdict<T> = Result<T, String>;

/// The option that is right.
pub(super) fn only(options: Option<&Verdict<Vec<bool>>>) -> Outcome {
    let all = match options {
        None => return Outcome::Unknown,
        Some(Err(why)) => return Outcome::Unjudged(why.clone()),
        Some(Ok(all)) => all,
    };
    let mut right = all.iter().enumerate().filter_map(|(option, holds)| holds.then_some(option));
    match (right.next(), right.next()) {
        (Some(option), None) => Outcome::Holds(option),
        _ => Outcome::Unclear,
    }
}

/// What `verdict` says about the scene `tried` in a step of a lesson; none where it was cancelled.
pub(super) fn judge<T>(
    document: &LessonDocument,
    number: usize,
    tried: &Document,
    cancel: &AtomicBool,
    verdict: impl FnOnce(&Step, Subject<'_>, &Subject<'_>) -> Result<T, Unjudged>,
) -> Option<Verdict<T>> {
    let (lesson, begin) = (&document.lesson, document.begin(number));
    let task = Task { tick: &|| (), cancel };
    let before = Subject::new(&begin.scene, &begin.files, lesson, &task);
    let subject = Subject::new(&tried.scene, &tried.files, lesson, &task);
    match verdict(&lesson.steps[number], subject, &before) {
        Ok(verdict) => Some(Ok(verdict)),
        Err(Unjudged::Cancelled) => None,
        Err(error) => Some(Err(error.to_string())),
    }
}
