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
    /// The option that holds, once that is known.
    pub outcome: Option<String>,
    /// Why, in a word of the student's own.
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
    /// A part for every step.
    pub answers: Vec<Answer>,
    /// The lesson was gone through to its end.
    pub done: bool,
}

/// What was done in all lessons, by the name or the path of each.
pub type Records = BTreeMap<String, Progress>;

impl Progress {
    /// Goes on with what was kept of a lesson: answers to what it asks still. A lesson that was done begins
    /// anew, and stays done.
    pub(super) fn of(lesson: &Lesson, kept: Option<&Self>) -> Self {
        let old = kept.filter(|kept| !kept.done);
        let answer = |(number, step): (usize, &Step)| {
            let own = old.and_then(|old| old.answers.get(number)).filter(|own| own.ask == step.text());
            own.cloned().unwrap_or_else(|| Answer { ask: step.text().to_owned(), ..Answer::default() })
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
        let answered = |own: &&Answer| own.choice.is_some() || own.shown || own.met;
        let mut answers = progress.answers.iter().filter(answered).peekable();
        if answers.peek().is_none() {
            continue;
        }
        let done = if progress.done { " (done)" } else { "" };
        let _ = writeln!(text, "{}{done}", progress.title);
        for own in answers {
            let _ = writeln!(text, "- {}", own.ask.replace("**", ""));
            if own.met {
                let with = if own.with.is_empty() { String::new() } else { format!(" with {}", own.with) };
                let _ = writeln!(text, "  Done{with}");
                continue;
            }
            let _ = writeln!(text, "  I expected: {}", own.choice.as_deref().unwrap_or("nothing"));
            if let Some(outcome) = &own.outcome {
                let _ = writeln!(text, "  It did: {outcome}");
            }
            if !own.why.trim().is_empty() {
                let _ = writeln!(text, "  Why: {}", own.why.trim());
            }
        }
        text.push('\n');
    }
    (!text.is_empty()).then_some(text)
}
