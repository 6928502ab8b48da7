//! Assignment of arguments to fields: numbers, texts, and choices in RON.

use super::clip::clip;
use super::field_table::FieldInfo;
use super::fields::{Field, Slot};
use super::scanner::overflows;
use super::text::{self, ParseError, TOO_LARGE};

/// Assigns the text `value` to a field; the error is a sentence.
pub(super) fn replace(found: Field<'_>, value: &str) -> Result<(), String> {
    let message = |parse_error: ParseError| format!("`{}`: {}", clip(value), parse_error.problem);
    let written =
        |value: &str| text::options().from_str(value).map_err(|e| message(text::parse_error(value, &e)));
    match found {
        Field::Number(spec, Slot::Required(number)) => {
            let read = parse_number(value).ok_or_else(|| no_number(value, "is not a number", spec))?;
            *number = unless_overflow(read, value, spec)?;
            Ok(())
        }
        Field::Number(spec, Slot::Optional(number)) => {
            let none = || text::options().from_str(value).ok();
            let read = parse_number(value).map(Some).or_else(none);
            let read = read.ok_or_else(|| no_number(value, "is neither a number nor None", spec))?;
            *number = unless_overflow(read, value, spec)?;
            Ok(())
        }
        Field::Number(spec, Slot::Whole(number)) => {
            let whole = value.trim().parse().ok();
            *number = whole.ok_or_else(|| no_number(value, "is not a whole number from 0 up", spec))?;
            Ok(())
        }
        Field::Text(text) => {
            let quoted = ["\"", "r\"", "r#"].iter().any(|first| value.starts_with(first));
            *text = if quoted { written(value)? } else { value.to_owned() };
            Ok(())
        }
        Field::Value(whole) => {
            text::overflow(value).map_or(Ok(()), |overflow| Err(message(overflow)))?;
            whole.assign(value).map_err(|error| message(text::parse_error(value, &error)))
        }
    }
}

/// Parses a number in the notation of RON or Rust: `4`, `.5`, `1e-9`, `-inf`.
fn parse_number(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| text::options().from_str(text).ok())
}

/// Returns `read` unless the text `value` is a decimal that overflows to infinity.
fn unless_overflow<T>(read: T, value: &str, spec: &FieldInfo) -> Result<T, String> {
    match overflows(value) {
        true => Err(format!("`{}` {TOO_LARGE}; {}", clip(value), spec.remedy)),
        false => Ok(read),
    }
}

/// The sentence for a text that is not a number; `what` says what is wrong.
fn no_number(value: &str, what: &str, spec: &FieldInfo) -> String {
    let digits = value.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let unit = digits && value.ends_with(|c: char| c.is_alphabetic() || c == '%');
    let unit = if unit { ": its unit stands in the name of the field" } else { "" };
    format!("`{}` {what}{unit}; {}", clip(value), spec.remedy)
}
