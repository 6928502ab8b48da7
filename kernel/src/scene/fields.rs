//! Access to a scene's fields by path, and assignment of arguments to them.
//!
//! Paths are compared during the [traversal](super::walk), which skips branches that do not match. Setting a
//! number takes about ten string comparisons and no allocation, which matters for a sweep of a million cells.

use super::arithmetic::{evaluate, is_arithmetic};
use super::data::Scene;
use super::error::clip;
use super::field_table::FieldInfo;
use super::scanner::{Part, overflows};
use super::text::{self, ParseError, TOO_LARGE};
pub(super) use super::walk::{Field, Seen, Slot};
use super::walk::{Fields, Segment, Visitor};
use crate::numeric::number_text;

/// Calls `each` for every field with its path, in the order in which a scene is written.
pub(super) fn for_each(scene: &Scene, each: impl FnMut(&str, Seen<'_>)) {
    struct Each<F> {
        path: String,
        each: F,
    }
    impl<'a, F: FnMut(&str, Seen<'a>)> Visitor<'a> for Each<F> {
        fn field(&mut self, segment: Segment, inner: bool, field: Seen<'a>) -> bool {
            let length = self.path.len();
            let dot = if length == 0 { "" } else { "." };
            self.path.push_str(&format!("{dot}{segment}"));
            (self.each)(&self.path, field);
            if !inner {
                self.path.truncate(length);
            }
            inner
        }
        fn leave(&mut self) {
            self.path.truncate(self.path.rfind('.').unwrap_or(0));
        }
    }
    scene.show(&mut Each { path: String::new(), each });
}

/// Whether every number of a scene is within its range, except those of its mechanism, sweep and hints.
/// Unlike [`for_each`] it builds no paths.
pub(super) fn in_range(scene: &Scene) -> bool {
    struct InRange(bool);
    impl Visitor<'_> for InRange {
        fn field(&mut self, segment: Segment, inner: bool, field: Seen<'_>) -> bool {
            if let Seen::Number(spec, number) = field {
                self.0 &= number.is_none_or(|value| spec.range.contains(value));
            }
            inner && !matches!(segment, Segment::Name("mechanism" | "sweep" | "app"))
        }
        fn leave(&mut self) {}
    }
    let mut all = InRange(true);
    scene.show(&mut all);
    all.0
}

/// The dotted path of a field, split once so that it can be followed many times.
///
/// A study of one's own reads and sets a number of many scenes with it, as a sweep does.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::scene::{Document, FieldPath};
///
/// let mut scene = Document::preset("nominal-cubic")?.scene;
/// let limit = FieldPath::new("stops.travel_limit_mm");
/// assert_eq!(limit.get(&scene), Some(4.0));
/// assert!(limit.set(&mut scene, 2.5)); // the range is checked when the model is built
/// # Ok::<(), interwell::scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldPath {
    parts: Vec<Part>,
}

fn is_same(part: &Part, segment: Segment) -> bool {
    match (part, segment) {
        (Part::Name(part), Segment::Name(name)) => part == name,
        (Part::Index(part), Segment::Index(index)) => *part == index,
        _ => false,
    }
}

impl FieldPath {
    /// Splits a path such as `stops.travel_limit_mm` at its dots. Any text is accepted; whether a scene has
    /// the field is found when the path is followed.
    pub fn new(path: &str) -> Self {
        Self { parts: Part::all_of(path) }
    }

    /// Sets the number at this path without checking its range; returns false if the scene has
    /// no such number.
    #[must_use]
    pub fn set(&self, scene: &mut Scene, value: f64) -> bool {
        let Some(Field::Number(_, slot)) = self.at(scene) else { return false };
        slot.set(value);
        true
    }

    /// The number at this path; `None` if the scene does not have it or leaves it out.
    pub fn get(&self, scene: &Scene) -> Option<f64> {
        match self.seen(scene)? {
            Seen::Number(_, number) => number,
            _ => None,
        }
    }

    /// The value at this path as one word: a number, a text, or the name of a choice; `None` if the scene
    /// does not have it, leaves it out, or has the choice `None`.
    pub fn word(&self, scene: &Scene) -> Option<String> {
        match self.seen(scene)? {
            Seen::Number(_, number) => number.map(number_text),
            Seen::Text(text) => Some(text.to_owned()).filter(|text| !text.is_empty()),
            Seen::Value(value) => value.word(),
        }
    }

    /// The field at this path, to be set; `None` if the scene has no such field.
    pub(super) fn at<'a>(&self, scene: &'a mut Scene) -> Option<Field<'a>> {
        scene.at(&self.parts)
    }

    /// The field at this path, to be read; `None` if the scene has no such field.
    fn seen<'a>(&self, scene: &'a Scene) -> Option<Seen<'a>> {
        struct Seek<'p, 'a> {
            parts: &'p [Part],
            depth: usize,
            found: Option<Seen<'a>>,
        }
        impl<'a> Visitor<'a> for Seek<'_, 'a> {
            fn field(&mut self, segment: Segment, inner: bool, field: Seen<'a>) -> bool {
                if !self.parts.get(self.depth).is_some_and(|part| is_same(part, segment)) {
                    return false;
                }
                if self.depth + 1 < self.parts.len() {
                    self.depth += usize::from(inner);
                    return inner;
                }
                self.found = Some(field);
                false
            }
            fn leave(&mut self) {
                self.depth -= 1;
            }
        }
        let mut seek = Seek { parts: &self.parts, depth: 0, found: None };
        scene.show(&mut seek);
        seek.found
    }
}

/// The row in the table of fields of the number at this path; `None` if the scene does not have it.
pub(super) fn info_of(scene: &Scene, path: &str) -> Option<&'static FieldInfo> {
    match FieldPath::new(path).seen(scene)? {
        Seen::Number(info, _) => Some(info),
        _ => None,
    }
}

/// Whether the number at this path is whole, such as a count or a seed; false if the scene does not have it.
pub fn is_whole(scene: &Scene, path: &str) -> bool {
    info_of(scene, path).is_some_and(|info| info.range.whole)
}

/// The paths of all numbers of a scene, as `--over` takes them. They include optional numbers that are left
/// out, but not the numbers of the scene's `sweep`.
pub fn numeric_fields(scene: &Scene) -> Vec<String> {
    paths(scene, |path, field| matches!(field, Seen::Number(..)) && !path.starts_with("sweep."))
}

/// The paths of all fields of a scene, numbers and other values, as `--set` takes them.
pub fn all_fields(scene: &Scene) -> Vec<String> {
    paths(scene, |_, _| true)
}

fn paths(scene: &Scene, is_listed: fn(&str, Seen<'_>) -> bool) -> Vec<String> {
    let mut paths = Vec::new();
    for_each(scene, |path, field| {
        if is_listed(path, field) {
            paths.push(path.to_owned());
        }
    });
    paths
}

/// Assigns the text `value` to a field; the error is a sentence.
pub(super) fn replace(found: Field<'_>, value: &str) -> Result<(), String> {
    let message = |parse_error: ParseError| format!("`{}`: {}", clip(value), parse_error.problem);
    match found {
        Field::Number(spec, Slot::Required(number)) => {
            *number = unless_overflow(number_in(value, "is not a number", spec)?, value, spec)?;
            Ok(())
        }
        Field::Number(spec, Slot::Optional(number)) => {
            let read = match number_in(value, "is neither a number nor None", spec) {
                Ok(read) => Some(read),
                Err(problem) => text::value(value).map_err(|_| problem)?,
            };
            *number = unless_overflow(read, value, spec)?;
            Ok(())
        }
        Field::Number(spec, Slot::Whole(number)) => {
            let what = "is not a whole number from 0 up";
            *number = match value.trim().parse() {
                Ok(whole) => whole,
                Err(_) if is_arithmetic(value) => {
                    let read = number_in(value, what, spec)?;
                    let problem = || format!("`{}` = {read} {what}; {}", clip(value), spec.remedy);
                    read.to_string().parse().map_err(|_| problem())?
                }
                Err(_) => return Err(no_number(value, what, spec)),
            };
            Ok(())
        }
        Field::Text(text) => {
            let quoted = ["\"", "r\"", "r#"].iter().any(|first| value.starts_with(first));
            *text = if quoted { text::value(value).map_err(message)? } else { value.to_owned() };
            Ok(())
        }
        Field::Value(whole) => {
            text::overflow(value).map_or(Ok(()), |overflow| Err(message(overflow)))?;
            whole.assign(value).map_err(message)
        }
    }
}

/// Reads a number in the notation of RON or Rust (`4`, `.5`, `1e-9`, `-inf`) or arithmetic. `what` is the
/// problem of any other text.
fn number_in(value: &str, what: &str, spec: &FieldInfo) -> Result<f64, String> {
    match value.parse() {
        Ok(plain) => Ok(plain),
        Err(_) if is_arithmetic(value) => {
            evaluate(value).map_err(|problem| format!("`{}`: {}; {}", clip(value), problem.what, spec.remedy))
        }
        Err(_) => text::options().from_str(value).map_err(|_| no_number(value, what, spec)),
    }
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
