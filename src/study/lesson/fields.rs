//! Fields of runs that conditions of lessons may name.

use crate::dynamics::{Outcome, Place, Regime, Summary};
use crate::scene::lesson::ResultField;
use crate::study::fields::{Read, SUMMARY_FIELDS, SummaryField};

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
    let of_summary = SUMMARY_FIELDS.iter().map(|field| ResultField { name: field.name, words: words(field) });
    of_summary.chain([ResultField { name: PERIOD_MULTIPLE, words: &[] }]).collect()
}

/// The words that a field may be; empty for a number.
fn words(field: &SummaryField) -> &'static [&'static str] {
    const REGIMES: &[&str] = &[
        Regime::Rest.name(),
        Regime::Intrawell.name(),
        Regime::Interwell.name(),
        Regime::Irregular.name(),
        Regime::Crossing.name(),
    ];
    const SIDES: &[&str] = &[Place::Left.name(), Place::Right.name(), Place::Both.name()];
    match (field.read, field.name) {
        (Read::Word(_), "regime") => REGIMES,
        (Read::Word(_), "side") => SIDES,
        (Read::Word(_), _) => Outcome::NAMES,
        (Read::Flag(_), _) => &["true", "false"],
        (Read::Number(_) | Read::Count(_), _) => &[],
    }
}

/// The field called `name` of a summary.
pub(super) fn value(summary: &Summary, name: &str) -> Value {
    if name == PERIOD_MULTIPLE {
        return Value::Number(summary.period.map_or(0.0, f64::from));
    }
    let count = |value: u64| Value::Number(value as f64);
    let word = |text: &str| if text.is_empty() { Value::Missing } else { Value::Word(text.to_owned()) };
    match SummaryField::find(name).map(|field| field.read) {
        Some(Read::Number(of)) => of(summary).map_or(Value::Missing, Value::number),
        Some(Read::Count(of)) => of(summary).map_or(Value::Missing, count),
        Some(Read::Word(of)) => word(of(summary)),
        Some(Read::Flag(of)) => {
            of(summary).map_or(Value::Missing, |flag| word(if flag { "true" } else { "false" }))
        }
        None => Value::Missing,
    }
}
