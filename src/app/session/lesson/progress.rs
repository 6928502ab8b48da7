//! Progress and answers in lessons, kept from one start of the program to the next.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::app::words::lesson::tally;
use crate::scene::lesson::{Lesson, Step};

#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Answer {
    /// The text of the question or task; the answer is dropped if it has changed.
    pub ask: String,
    pub choice: Option<String>,
    /// Votes of a class for the options, in their order; empty without any.
    pub votes: Vec<u32>,
    /// Whether the result of the prediction has been shown, with or without a choice.
    pub shown: bool,
    /// The option that holds, once it is known.
    pub outcome: Option<String>,
    pub met: bool,
    /// The settings with which the task was done, as the command line takes them.
    pub with: String,
}

#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    pub title: String,
    /// Number of the step that was open last.
    pub step: usize,
    pub answers: Vec<Answer>,
    pub done: bool,
}

/// Progress in all lessons, by the name or the path of each.
pub type Records = BTreeMap<String, Progress>;

impl Progress {
    /// Continues from the kept progress of a lesson, with the answers to questions that have not changed. A
    /// completed lesson begins again, and stays marked as done.
    pub(super) fn of(lesson: &Lesson, kept: Option<&Self>) -> Self {
        let old = kept.filter(|kept| !kept.done);
        let answer = |(number, step): (usize, &Step)| {
            let same = old.and_then(|old| old.answers.get(number)).filter(|kept| kept.ask == step.text());
            same.cloned().unwrap_or_else(|| Answer { ask: step.text().to_owned(), ..Answer::default() })
        };
        Self {
            title: lesson.title.clone(),
            step: old.map_or(0, |old| old.step.min(lesson.steps.len().saturating_sub(1))),
            answers: lesson.steps.iter().enumerate().map(answer).collect(),
            done: kept.is_some_and(|kept| kept.done),
        }
    }
}

/// The answers of all lessons as text; `None` if nothing was answered.
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
                let settings = &answer.with;
                let with = if settings.is_empty() { String::new() } else { format!(" with {settings}") };
                let _ = writeln!(text, "  Done{with}");
                continue;
            }
            if answer.votes.iter().any(|votes| *votes > 0) {
                let _ = writeln!(text, "  {}", tally(&answer.votes));
            }
            let _ = writeln!(text, "  I expected: {}", answer.choice.as_deref().unwrap_or("nothing"));
            if let Some(outcome) = &answer.outcome {
                let _ = writeln!(text, "  What holds: {outcome}");
            }
        }
        text.push('\n');
    }
    (!text.is_empty()).then_some(text)
}
