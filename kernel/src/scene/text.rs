//! Reading and writing of scenes as RON text.
//!
//! The extension `implicit_some` is on, so that `settle_s: 5` needs no `Some`. A parse error is reported with
//! its place, its field and, for an unknown name, the known names.
//!
//! Arithmetic is replaced by its value before RON reads the text, wherever a value stands.

use std::borrow::Cow;
use std::ops::Range;

use ron::error::{Error as Ron, SpannedError};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

use super::arithmetic::evaluate;
use super::data::*;
use super::error::clip;
use super::mechanism::Mechanism;
use super::scanner::{Place, Places, Scanner};
use super::stops::Stops;
use super::transducer::Transducer;

/// Largest size of a scene's text: about a thousand times that of a long scene, and still parsed immediately.
pub const MAX_SCENE_BYTES: usize = 4 << 20;

/// Largest depth of brackets, the default of RON; a sum within a sum takes three levels.
const MAX_DEPTH: usize = 128;

pub(super) fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME).with_recursion_limit(MAX_DEPTH)
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct ParseError {
    pub place: Place,
    pub problem: String,
    /// The name of an unknown field, if that is the error.
    pub unknown: Option<String>,
    /// All errors of arithmetic, if the first of them is that error.
    pub wrong: Vec<(Place, String)>,
}

impl ParseError {
    /// An error of the whole text.
    pub(super) fn at_start(problem: impl Into<String>) -> Self {
        Self::new(Place { line: 1, column: 1 }, problem.into())
    }

    fn new(place: Place, problem: String) -> Self {
        Self { place, problem, unknown: None, wrong: Vec::new() }
    }

    /// The text with the unknown field replaced by blanks, so that further errors can be found
    /// at their places.
    pub(super) fn without_unknown(&self, text: &str) -> Option<String> {
        /// A longer text is not parsed again.
        const MAX_LENGTH: usize = 1 << 17;
        let name = self.unknown.as_deref().filter(|_| text.len() <= MAX_LENGTH)?;
        let bytes = Places::of(text).bytes_at(self.place, name)?;
        let after = &text[bytes.end..];
        let comma = after.len() - after.trim_start().strip_prefix(',').map_or(after.len(), str::len);
        let end = bytes.end + comma;
        let blank = text[bytes.start..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' });
        Some(text[..bytes.start].chars().chain(blank).chain(text[end..].chars()).collect())
    }
}

/// Parses a scene without checking ranges.
pub(super) fn parse(text: &str) -> Result<Scene, ParseError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim().is_empty() {
        let problem = "the file is empty; a scene begins with `(title: \"..\", mass_g: 15.2, ..`";
        return Err(ParseError::at_start(problem));
    }
    if is_json(text) {
        let problem = "this is JSON; a scene begins with `(`. The manifest of a sweep is taken by every \
                       command that takes a scene";
        return Err(ParseError::at_start(problem));
    }
    read(text)
}

pub(super) fn read<T: DeserializeOwned>(text: &str) -> Result<T, ParseError> {
    if text.len() > MAX_SCENE_BYTES {
        let problem = format!("{} bytes are more than are read ({MAX_SCENE_BYTES})", text.len());
        return Err(ParseError::at_start(problem));
    }
    let read = value(text)?;
    overflow(text).map_or(Ok(read), Err)
}

/// Reads a RON value whose numbers may be arithmetic.
pub(super) fn value<T: DeserializeOwned>(text: &str) -> Result<T, ParseError> {
    let evaluated = Evaluated::of(text);
    let read = options().from_str(&evaluated.text).map_err(|error| {
        let found = evaluated.parse_error(text, &error);
        // a value that stands alone has no field before it, by which its choices are known
        match choices_of::<T>() {
            Some(known) if found.place.byte(text) == 0 && is_no_choice(&error.code) => {
                ParseError { problem: expected_one_of(known), ..found }
            }
            _ => found,
        }
    });
    match (read, evaluated.wrong.first().cloned()) {
        // an error before a broken expression may be the reason why it was read as an expression
        (Err(error), Some((place, _))) if error.place < place => Err(error),
        (_, Some((place, problem))) => {
            Err(ParseError { wrong: evaluated.wrong, ..ParseError::new(place, problem) })
        }
        (read, None) => read,
    }
}

/// A RON text with its arithmetic replaced by values.
struct Evaluated<'t> {
    text: Cow<'t, str>,
    /// The bytes of each value here, and those of its arithmetic in the text before.
    replaced: Vec<(Range<usize>, Range<usize>)>,
    /// The first errors.
    wrong: Vec<(Place, String)>,
}

impl<'t> Evaluated<'t> {
    fn of(text: &'t str) -> Self {
        /// Largest number of errors.
        const MAX_WRONG: usize = 50;
        let scanned = Scanner::over(text);
        let (mut replaced, mut wrong) = (Vec::new(), Vec::new());
        let (mut values, mut from) = (String::new(), 0);
        for number in scanned.numbers.iter().filter(|number| number.is_arithmetic) {
            let written = &text[number.bytes.clone()];
            let value = evaluate(written).unwrap_or_else(|problem| {
                if wrong.len() < MAX_WRONG {
                    let (path, written) = (clip(&scanned.path(number)), clip(written));
                    let field = if path.is_empty() { path } else { path + ": " };
                    let place = Place::of_byte(text, number.bytes.start + problem.at);
                    wrong.push((place, format!("{field}`{written}`: {}", problem.what)));
                }
                0.0
            });
            values += &text[from..number.bytes.start];
            let begin = values.len();
            // a field of a whole number takes no exponent
            values += &if value.abs() < 1e17 { value.to_string() } else { format!("{value:e}") };
            replaced.push((begin..values.len(), number.bytes.clone()));
            from = number.bytes.end;
        }
        let text = if replaced.is_empty() { text.into() } else { (values + &text[from..]).into() };
        Self { text, replaced, wrong }
    }

    /// The error of RON with its place in the text `before`.
    fn parse_error(&self, before: &str, error: &SpannedError) -> ParseError {
        let place = Place { line: error.span.start.line, column: error.span.start.col };
        if self.replaced.is_empty() {
            return parse_error(before, place, error);
        }
        let at = place.byte(&self.text);
        let count = self.replaced.partition_point(|(value, _)| value.start <= at);
        let Some((value, written)) = count.checked_sub(1).map(|last| &self.replaced[last]) else {
            return parse_error(before, Place::of_byte(before, at), error);
        };
        if at >= value.end {
            let at = written.end + (at - value.end);
            return parse_error(before, Place::of_byte(before, at), error);
        }
        let mut found = parse_error(before, Place::of_byte(before, written.start), error);
        found.problem += &format!("; `{}` is {}", clip(&before[written.clone()]), &self.text[value.clone()]);
        found
    }
}

/// Message about a decimal number that overflows a double.
pub(super) const TOO_LARGE: &str = "is beyond the largest number, 1.8e308";

/// The error for a decimal number that overflows a double; `None` if the text has none.
pub(super) fn overflow(text: &str) -> Option<ParseError> {
    let bytes = Scanner::over(text).overflow()?;
    let place = Place::of_byte(text, bytes.start);
    let field = Places::of(text).last_before(place);
    let field = field.map_or(String::new(), |field| format!("{}: ", clip(&field)));
    let number = clip(&text[bytes]);
    let problem =
        format!("{field}{number} {TOO_LARGE}; write a smaller one, or inf where a field takes that");
    Some(ParseError::new(place, problem))
}

fn parse_error(text: &str, place: Place, error: &SpannedError) -> ParseError {
    let trailing = error.code == Ron::TrailingCharacters;
    let place = token_at(text, place, trailing);
    let named = matches!(
        error.code,
        Ron::NoSuchStructField { .. } | Ron::MissingStructField { .. } | Ron::DuplicateStructField { .. }
    );
    let places = Places::of(text);
    let field = if named || trailing { None } else { places.last_before(place) };
    let problem = match (&error.code, field.as_deref().and_then(choices)) {
        (code, Some(known)) if is_no_choice(code) => expected_one_of(known),
        (Ron::ExpectedComma, _) if is_unit(text, place) => {
            format!("{}; a unit stands in the name of its field, not behind the number", explain(error))
        }
        (Ron::ExpectedFloat, _) => match unnamed(text, place) {
            Some(choice) => format!("{}; this one has no name, write {choice}", explain(error)),
            None => explain(error),
        },
        _ => explain(error),
    };
    let unknown = match &error.code {
        Ron::NoSuchStructField { found, .. } => Some(found.clone()),
        _ => None,
    };
    let problem = field.map_or(problem.clone(), |field| format!("{}: {problem}", clip(&field)));
    ParseError { unknown, ..ParseError::new(place, problem) }
}

/// The correct text if the number at `place` has a name and must not have one, such as `Ratio(0.1)` for
/// `Ratio(xi: 0.1)`.
fn unnamed(text: &str, place: Place) -> Option<String> {
    let (before, named) = split_at(text, place);
    let (_, number) = named.split_once([':', '='])?;
    let number = number.split([')', ',']).next()?.trim();
    number.parse::<f64>().ok()?;
    let outer = before.trim_end().strip_suffix('(')?.trim_end();
    let from = outer.rfind(|c: char| !c.is_alphanumeric()).map_or(0, |end| end + 1);
    (from < outer.len()).then(|| format!("{}({})", clip(&outer[from..]), clip(number)))
}

/// Splits the line of a place at that place.
fn split_at(text: &str, place: Place) -> (&str, &str) {
    let line = text.lines().nth(place.line - 1).unwrap_or_default();
    let at = line.char_indices().nth(place.column - 1).map_or(line.len(), |(at, _)| at);
    line.split_at(at)
}

/// Whether the word at a place follows a number and is not the name of a field.
fn is_unit(text: &str, place: Place) -> bool {
    let (before, word) = split_at(text, place);
    let after = word.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
    before.trim_end().ends_with(|c: char| c.is_ascii_digit() || c == '.')
        && word.starts_with(|c: char| c.is_alphabetic() || c == '%')
        && !after.trim_start().starts_with(':')
}

/// Whether a text begins like JSON, unlike any scene.
pub(super) fn is_json(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with('{')
}

/// The place of the token at or after `place`: the parser's cursor may be on the blanks before it.
fn token_at(text: &str, place: Place, further_lines: bool) -> Place {
    let begin = place.byte(text);
    let blank = text[begin..].find(|c: char| !c.is_whitespace());
    match blank.map(|blank| begin + blank) {
        Some(at) if further_lines || !text[begin..at].contains('\n') => Place::of_byte(text, at),
        _ => place,
    }
}

/// Whether the parser found something else where the name of a choice should stand.
fn is_no_choice(code: &Ron) -> bool {
    matches!(code, Ron::ExpectedIdentifier | Ron::SuggestRawIdentifier(_))
}

fn expected_one_of(known: &[&str]) -> String {
    format!("expected one of {}", names(known))
}

/// The names of the choices of a `T`, if it has choices.
fn choices_of<T: DeserializeOwned>() -> Option<&'static [&'static str]> {
    match options().from_str::<T>("Unknown").err()?.code {
        Ron::NoSuchEnumVariant { expected, .. } => Some(expected),
        _ => None,
    }
}

fn choices(field: &str) -> Option<&'static [&'static str]> {
    match field.split('.').rfind(|part| part.parse::<usize>().is_err())? {
        "mechanism" => choices_of::<Mechanism>(),
        "damping" => choices_of::<Damping>(),
        "stops" | "stops_when_on" => choices_of::<Stops>(),
        "excitation" => choices_of::<Excitation>(),
        "start" => choices_of::<Start>(),
        "transducer" => choices_of::<Transducer>(),
        "layout" => choices_of::<Layout>(),
        _ => None,
    }
}

fn names(known: &[&str]) -> String {
    if known.is_empty() { "none".to_owned() } else { known.join(", ") }
}

/// The message of a parser's error, without its place.
pub(super) fn explain(error: &SpannedError) -> String {
    let inside =
        |outer: &Option<String>| outer.as_ref().map_or(String::new(), |outer| format!(" in {outer}"));
    match &error.code {
        Ron::NoSuchEnumVariant { expected, found, outer } => {
            format!("unknown choice `{}`{}; known: {}", clip(found), inside(outer), names(expected))
        }
        Ron::NoSuchStructField { expected, found, outer } => {
            format!("unknown field `{}`{}; known: {}", clip(found), inside(outer), names(expected))
        }
        Ron::MissingStructField { field, outer } => format!("`{field}` is missing{}", inside(outer)),
        Ron::DuplicateStructField { field, outer } => {
            format!("`{field}` is given twice{}", inside(outer))
        }
        Ron::ExceededRecursionLimit => "brackets nested deeper than in any scene".to_owned(),
        Ron::TrailingCharacters => "nothing may follow the end of the value".to_owned(),
        Ron::Eof => "the text ends in the middle".to_owned(),
        Ron::SuggestRawIdentifier(found) | Ron::InvalidIdentifier(found) => {
            let hint = if found.contains('.') { "" } else { " (a decimal is written with a point)" };
            format!("expected a name, found `{}`{hint}", clip(found))
        }
        Ron::ExpectedComma => "expected a comma before this".to_owned(),
        Ron::ExpectedFloat => "expected a number".to_owned(),
        other => {
            let text = other.to_string();
            let mut chars = text.chars();
            let first = chars.next().map(|c| c.to_lowercase().to_string()).unwrap_or_default();
            clip(&format!("{first}{}", chars.as_str()))
        }
    }
}

/// The scene as RON text that parses back to the same scene.
pub fn write(scene: &Scene) -> Result<String, ron::Error> {
    let config = ron::ser::PrettyConfig::new().escape_strings(false).new_line("\n").compact_arrays(false);
    let text = options().without_recursion_limit().to_string_pretty(scene, config)?;
    Ok(text + "\n")
}
