//! Fields of runs that conditions of lessons may name.

use crate::dynamics::Summary;
use crate::scene::lesson::ResultField;
use crate::study::fields::{SUMMARY_FIELDS, SummaryField};

/// Value of a field.
#[derive(Debug, Clone, PartialEq)]
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
}

/// Forcing periods after which the motion repeats, 0 where no period was found.
const PERIOD_MULTIPLE: &str = "period_multiple";

/// The fields of a summary that conditions may name: those of `simulate` and `period_multiple`.
pub fn result_fields() -> Vec<ResultField> {
    let of_summary = SUMMARY_FIELDS.iter().map(|field| ResultField { name: field.name, words: field.words });
    of_summary.chain([ResultField { name: PERIOD_MULTIPLE, words: &[] }]).collect()
}

/// The field called `name` of a summary.
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
