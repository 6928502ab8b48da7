//! Values of fields from arguments: numbers, texts, and choices in RON.

use super::clip::clip;
use super::fields::{Field, Slot};
use super::ranges::Spec;
use super::scanner::is_beyond;
use super::text::{self, BEYOND, Refusal};

/// Replaces a field from its text; the error is a sentence.
pub(super) fn replace(found: Field<'_>, value: &str) -> Result<(), String> {
    let refused = |refusal: Refusal| format!("`{}`: {}", clip(value), refusal.problem);
    let written =
        |value: &str| text::options().from_str(value).map_err(|e| refused(text::refusal(value, &e)));
    match found {
        Field::Number(spec, Slot::Required(number)) => {
            let read = parse_number(value).ok_or_else(|| no_number(value, "is not a number", spec))?;
            *number = as_written(read, value, spec)?;
            Ok(())
        }
        Field::Number(spec, Slot::Optional(number)) => {
            let none = || text::options().from_str(value).ok();
            let read = parse_number(value).map(Some).or_else(none);
            let read = read.ok_or_else(|| no_number(value, "is neither a number nor None", spec))?;
            *number = as_written(read, value, spec)?;
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
            text::beyond(value).map_or(Ok(()), |beyond| Err(refused(beyond)))?;
            whole.assign(value).map_err(|error| refused(text::refusal(value, &error)))
        }
    }
}

/// A number as RON writes it or as Rust does: `4`, `.5`, `1e-9`, `-inf`.
fn parse_number(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| text::options().from_str(text).ok())
}

/// What was read of a value; none of one that is infinite and not written so.
fn as_written<T>(read: T, value: &str, spec: &Spec) -> Result<T, String> {
    match is_beyond(value) {
        true => Err(format!("`{}` {BEYOND}; {}", clip(value), spec.remedy)),
        false => Ok(read),
    }
}

/// The sentence for a text that is not `what`.
fn no_number(value: &str, what: &str, spec: &Spec) -> String {
    let digits = value.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let unit = digits && value.ends_with(|c: char| c.is_alphabetic() || c == '%');
    let unit = if unit { ": its unit stands in the name of the field" } else { "" };
    format!("`{}` {what}{unit}; {}", clip(value), spec.remedy)
}
