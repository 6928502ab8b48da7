//! What was chosen, written and done in lessons, kept from one start of the program to the next.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::scene::lesson::{Lesson, Step};

#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Answer {
    /// The question or task; an answer to another one does not count.
    pub ask: String,
    pub choice: Option<String>,
    /// The answer of the prediction has been shown, with or without a choice.
    pub shown: bool,
    /// The option that is right, once that is known.
    pub outcome: Option<String>,
    /// Why, in words of the student.
    pub why: String,
    pub met: bool,
    /// The settings with which it was done, as the command line takes them.
    pub with: String,
}

#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    pub title: String,
    /// The step that was open last.
    pub step: usize,
    /// One for every step.
    pub answers: Vec<Answer>,
    /// The lesson was gone through to its end.
    pub done: bool,
}

/// What was done in all lessons, by the name or the path of each.
pub type Records = BTreeMap<String, Progress>;

impl Progress {
    /// The progress at the opening of a lesson: kept answers to questions that it still asks. A lesson that was
    /// done begins again, and stays done.
    pub(super) fn of(lesson: &Lesson, kept: Option<&Self>) -> Self {
        let old = kept.filter(|kept| !kept.done);
        let answer = |(number, step): (usize, &Step)| {
            let kept = old.and_then(|old| old.answers.get(number)).filter(|kept| kept.ask == step.text());
            kept.cloned().unwrap_or_else(|| Answer { ask: step.text().to_owned(), ..Answer::default() })
        };
        Self {
            title: lesson.title.clone(),
            step: old.map_or(0, |old| old.step.min(lesson.steps.len().saturating_sub(1))),
            answers: lesson.steps.iter().enumerate().map(answer).collect(),
            done: kept.is_some_and(|kept| kept.done),
        }
    }
}

/// The answers of all lessons as text; none where nothing was answered.
pub fn answers_text(records: &Records) -> Option<String> {
    let mut text = String::new();
    for progress in records.values() {
        let answered = |answer: &&Answer| answer.choice.is_some() || answer.shown || answer.met;
        let mut answers = progress.answers.iter().filter(answered).peekable();
        if answers.peek().is_none() {
            continue;
        }
        let done = if progress.done { " (done)" } else { "" };
        let _ = writeln!(text, "{}{done}", progress.title);
        for answer in answers {
            let _ = writeln!(text, "- {}", answer.ask.replace("**", ""));
            if answer.met {
                let with = if answer.with.is_empty() { "" } else { " with " };
                let _ = writeln!(text, "  Done{with}{}", answer.with);
                continue;
            }
            let _ = writeln!(text, "  I expected: {}", answer.choice.as_deref().unwrap_or("nothing"));
            if let Some(outcome) = &answer.outcome {
                let _ = writeln!(text, "  It did: {outcome}");
            }
            if !answer.why.trim().is_empty() {
                let _ = writeln!(text, "  Why: {}", answer.why.trim());
            }
        }
        text.push('\n');
    }
    (!text.is_empty()).then_some(text)
}
