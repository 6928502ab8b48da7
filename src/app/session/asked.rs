//! All questions by their names, as they travel to a worker as text, and their answers as text.

use std::sync::atomic::AtomicBool;

use crate::app::task::{Question, from_text, to_text};

use super::accuracy::{LiveRun, PathQuestion, StepQuestion, TolerancesQuestion};
use super::ask::{StopsQuestion, ThresholdsQuestion};
use super::best::Search;
use super::explore::{BasinsQuestion, SpectrumQuestion, WalkQuestion};
use super::lesson::{GoalQuestion, OptionsQuestion};
use super::map::CellsQuestion;
use super::measured::{FitQuestion, MeasuredQuestion};

/// Answers the question of a name in a message, and passes on each part of its answer as text.
pub fn answer(
    name: &str,
    question: &str,
    cancel: &AtomicBool,
    each: &(dyn Fn(String) + Sync),
) -> Result<(), String> {
    macro_rules! answer_as {
        ($($question:ty),+ $(,)?) => {
            match name {
                $(<$question>::NAME => answered::<$question>(question, cancel, each),)+
                _ => Err(format!("no question is called {name}")),
            }
        };
    }
    answer_as!(
        LiveRun,
        PathQuestion,
        TolerancesQuestion,
        StepQuestion,
        ThresholdsQuestion,
        StopsQuestion,
        SpectrumQuestion,
        WalkQuestion,
        BasinsQuestion,
        CellsQuestion,
        Search,
        MeasuredQuestion,
        FitQuestion,
        OptionsQuestion,
        GoalQuestion,
    )
}

fn answered<Q: Question>(
    question: &str,
    cancel: &AtomicBool,
    each: &(dyn Fn(String) + Sync),
) -> Result<(), String> {
    // a part that cannot be written is missing, as it would be without an answer
    let send = |part: Q::Part| to_text(&part).map_or((), each);
    if let Some(last) = from_text::<Q>(question)?.answer(cancel, &send) {
        send(last);
    }
    Ok(())
}
