//! Evaluation of the conditions of lessons.

use serde::{Deserialize, Serialize};

use super::Subject;
use crate::dynamics::Summary;
use crate::numeric::extent;
use crate::scene::lesson::{Condition, ResultField, Step};
use crate::scene::{FieldPath, Start};
use crate::study::{SUMMARY_FIELDS, SummaryField};

/// Why there is no verdict.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unjudged {
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// The scene cannot be run: the field at fault, and what is wrong with it.
    #[error("{0}: {1}")]
    Scene(String, String),
}

impl Unjudged {
    pub(super) fn of(field: &str, problem: &str) -> Self {
        Self::Scene(field.to_owned(), problem.to_owned())
    }
}

/// A condition that does not hold, with the value of the field that it names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lack {
    /// The condition; for an `All`, the first part that does not hold.
    pub asked: Condition,
    /// The value of its field; missing if it names none.
    pub found: Value,
}

/// The first condition of the goal of a step that `subject` does not meet; `before` began the step.
pub fn goal_lack(step: &Step, subject: &Subject, before: &Subject) -> Result<Option<Lack>, Unjudged> {
    let Step::Do { goal, .. } = step else { return Ok(None) };
    Judge { subject, before, from: None }.lack(goal)
}

/// Which options of a prediction hold of `subject`; `before` is the scene with which the step began.
pub fn options_that_hold(step: &Step, subject: &Subject, before: &Subject) -> Result<Vec<bool>, Unjudged> {
    let Step::Predict { options, .. } = step else { return Ok(Vec::new()) };
    options.iter().map(|option| holds(&option.holds, subject, before)).collect()
}

pub(super) fn holds(condition: &Condition, subject: &Subject, before: &Subject) -> Result<bool, Unjudged> {
    Judge { subject, before, from: None }.holds(condition)
}

/// The scene, the scene before and, in a condition over starts, the run from the current start.
struct Judge<'a> {
    subject: &'a Subject<'a>,
    before: &'a Subject<'a>,
    from: Option<&'a Summary>,
}

impl Judge<'_> {
    fn holds(&self, condition: &Condition) -> Result<bool, Unjudged> {
        let compare =
            |field: &str, of: &dyn Fn(f64) -> bool| Ok(self.value(field)?.as_number().is_some_and(of));
        match condition {
            Condition::Is(field, text) => Ok(match self.value(field)? {
                Value::Number(number) => text.trim().parse() == Ok(number),
                Value::Word(word) => word == *text,
                Value::Missing => false,
            }),
            Condition::AtLeast(field, bound) => compare(field, &|number| number >= *bound),
            Condition::AtMost(field, bound) => compare(field, &|number| number <= *bound),
            Condition::Above(field, bound) => compare(field, &|number| number > *bound),
            Condition::Below(field, bound) => compare(field, &|number| number < *bound),
            Condition::Between(field, low, high) => compare(field, &|x| (*low..=*high).contains(&x)),
            Condition::Present(field) => Ok(self.value(field)? != Value::Missing),
            Condition::Absent(field) => Ok(self.value(field)? == Value::Missing),
            Condition::All(parts) => self.count(parts).map(|count| count == parts.len()),
            Condition::Any(parts) => self.count(parts).map(|count| count > 0),
            Condition::Not(part) => self.holds(part).map(|holds| !holds),
            Condition::Every(starts, part) => Ok(!self.over_starts(starts, part)?.contains(&false)),
            Condition::ForSome(starts, part) => Ok(self.over_starts(starts, part)?.contains(&true)),
            Condition::Same(field, within, starts) => {
                let name = field.split_once('.').map_or("", |(_, name)| name);
                let runs = self.subject.from(starts)?;
                let values: Option<Vec<f64>> = runs.iter().map(|run| value(run, name).as_number()).collect();
                Ok(values.is_some_and(|values| {
                    let (low, high) = extent(values);
                    high - low <= within * low.abs().max(high.abs())
                }))
            }
        }
    }

    fn lack(&self, condition: &Condition) -> Result<Option<Lack>, Unjudged> {
        if self.holds(condition)? {
            return Ok(None);
        }
        if let Condition::All(parts) = condition {
            let lacks = parts.iter().map(|part| self.lack(part)).collect::<Result<Vec<_>, _>>()?;
            return Ok(lacks.into_iter().flatten().next());
        }
        let found = condition.field().map_or(Ok(Value::Missing), |field| self.value(field))?;
        Ok(Some(Lack { asked: condition.clone(), found }))
    }

    /// Number of these conditions that hold; all are evaluated, so that the runs do not depend on results.
    fn count(&self, parts: &[Condition]) -> Result<usize, Unjudged> {
        let verdicts = parts.iter().map(|part| self.holds(part)).collect::<Result<Vec<_>, _>>()?;
        Ok(verdicts.into_iter().filter(|holds| *holds).count())
    }

    fn over_starts(&self, starts: &[Start], part: &Condition) -> Result<Vec<bool>, Unjudged> {
        let runs = self.subject.from(starts)?;
        runs.iter().map(|run| Judge { from: Some(run), ..*self }.holds(part)).collect()
    }

    fn value(&self, field: &str) -> Result<Value, Unjudged> {
        let (of, name) = field.split_once('.').unwrap_or(("", field));
        Ok(match of {
            "scene" => match FieldPath::new(name).word(self.subject.scene()) {
                Some(text) => text.parse().map_or(Value::Word(text), Value::Number),
                None => Value::Missing,
            },
            "result" => value(self.from.map_or_else(|| self.subject.run(), Ok)?, name),
            "before" => value(self.before.run()?, name),
            "up" => value(&self.subject.walked_to()?[0], name),
            "down" => value(&self.subject.walked_to()?[1], name),
            "walk" => {
                let [up, down] = self.subject.turns()?;
                let number = match name {
                    "up_crosses_from" => up,
                    "down_crosses_to" => down,
                    _ => up.zip(down).map(|(up, down)| up - down),
                };
                number.map_or(Value::Missing, Value::Number)
            }
            "mean" | "error" => {
                let runs = self.subject.over_seeds()?;
                let number = |run: &Summary| value(run, name).as_number().unwrap_or(f64::NAN);
                let (mean, error) = mean(&runs.iter().map(number).collect::<Vec<_>>());
                Value::number(if of == "mean" { mean } else { error })
            }
            _ => Value::Missing,
        })
    }
}

/// The mean of some values and its standard error; NaN if one of them is NaN.
fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (count - 1.0) / count).sqrt())
}

/// Value of a field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
    /// Nothing.
    Missing,
}

impl Value {
    /// A number, missing if it is not finite.
    pub fn number(value: f64) -> Self {
        if value.is_finite() { Self::Number(value) } else { Self::Missing }
    }

    fn as_number(&self) -> Option<f64> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }
}

/// Forcing periods after which the motion repeats; 0 if no period was found.
const PERIOD_MULTIPLE: &str = "period_multiple";

/// The fields of a summary that conditions may name: those of `simulate` and `period_multiple`.
pub fn result_fields() -> Vec<ResultField> {
    let of_summary = SUMMARY_FIELDS.iter().map(|field| ResultField { name: field.name, words: field.words });
    of_summary.chain([ResultField { name: PERIOD_MULTIPLE, words: &[] }]).collect()
}

pub(super) fn value(summary: &Summary, name: &str) -> Value {
    if name == PERIOD_MULTIPLE {
        return Value::Number(summary.period.map_or(0.0, f64::from));
    }
    let field = SummaryField::find(name);
    if let Some(number) = field.and_then(|field| field.number(summary)) {
        return Value::Number(number);
    }
    field.and_then(|field| field.word(summary)).map_or(Value::Missing, |word| Value::Word(word.to_owned()))
}
