//! Places of the fields in a scene's text.
//!
//! serde keeps no positions. In a text that RON accepts, the [scanner](super::scanner) finds every field by
//! the same path as the traversal in `fields`. In any other text it finds some of the fields, which is enough
//! to name the field near which a parser stopped.

use std::ops::Range;

use super::scanner::{Found, Part, Scanner};

/// A place in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Place {
    /// The place of the character at byte `at`.
    pub(super) fn of_byte(text: &str, at: usize) -> Self {
        let before = &text.as_bytes()[..at];
        let line_start = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let is_continuation = |byte: &u8| (0x80..=0xBF).contains(byte);
        Self {
            line: 1 + before.iter().filter(|byte| **byte == b'\n').count(),
            column: 1 + before[line_start..].iter().filter(|byte| !is_continuation(byte)).count(),
        }
    }

    /// The byte at this place, or the end of its line if that is shorter.
    pub(super) fn byte(self, text: &str) -> usize {
        let line_start = text.split_inclusive('\n').take(self.line.saturating_sub(1)).map(str::len).sum();
        let line = text[line_start..].split('\n').next().unwrap_or_default();
        line_start + line.char_indices().nth(self.column.saturating_sub(1)).map_or(line.len(), |(at, _)| at)
    }
}

/// The fields of a text with their places, in the order of the text.
///
/// Each field stores only the index of the field around it and the last part of its path. Whole paths could
/// exceed the memory for a hostile text of a few megabytes with long names around a million fields.
#[derive(Debug, Clone)]
pub struct Places<'t> {
    text: &'t str,
    fields: Vec<Found>,
}

impl<'t> Places<'t> {
    /// Scans a text.
    pub fn of(text: &'t str) -> Self {
        Self { text, fields: Scanner::over(text).found }
    }

    /// The place of a field, or of the innermost field around it that the text has.
    pub fn find(&self, path: &str) -> Option<Place> {
        let parts = Part::all_of(path);
        let find = |parts: &[Part]| self.fields.iter().find(|field| self.is_at(field, parts));
        let field = (1..=parts.len()).rev().find_map(|length| find(&parts[..length]))?;
        Some(Place::of_byte(self.text, field.at))
    }

    /// The bytes of the field called `name` that begins at a place, including its value.
    pub(super) fn bytes_at(&self, place: Place, name: &str) -> Option<Range<usize>> {
        let at = place.byte(self.text);
        let is_name = |part: &Part| matches!(part, Part::Name(part) if part == name);
        let field = self.fields.iter().find(|field| field.at == at && is_name(&field.part))?;
        Some(field.at..field.end)
    }

    /// The path of the last field that begins at or before a place.
    pub fn last_before(&self, place: Place) -> Option<String> {
        let at = place.byte(self.text);
        let last = self.fields.iter().rev().find(|field| field.at <= at)?;
        let outwards = std::iter::successors(Some(last), |field| field.around.map(|i| &self.fields[i]));
        let mut parts: Vec<String> = outwards
            .map(|field| match &field.part {
                Part::Name(name) => name.clone(),
                Part::Index(index) => index.to_string(),
            })
            .collect();
        parts.reverse();
        Some(parts.join("."))
    }

    /// Whether a field has this path, compared from its end, where most paths differ.
    fn is_at(&self, field: &Found, path: &[Part]) -> bool {
        let Some((last, around)) = path.split_last() else { return false };
        field.part == *last
            && match field.around {
                Some(index) => self.is_at(&self.fields[index], around),
                None => around.is_empty(),
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str, path: &str) -> Option<usize> {
        Places::of(text).find(path).map(|place| place.line)
    }

    #[test]
    fn comments_strings_and_brackets_do_not_mislead() {
        let text = r####"#![enable(implicit_some)]
// mass_g: 1
( /* mass_g: 2 /* nested
 mass_g: 3 */ */
 title: "mass_g: 4, (\" mass_g: 5",
 notes: r##"mass_g: "#
 mass_g: 6"##,
 mass_g /* here */
 : 7,
 stops: Rigid(
   travel_limit_mm: 1, restitution: 0.5),
 damping: Ratio(
   0.1),
 excitation: Sum([
   Sine(frequency_hz: 1,
        amplitude_g: 2),
   Sum([Constant(
      accel_g: 1)]),
 ]),
 mechanism: Polynomial(coefficients_si: [0,
   1e-3,
   -2]),
 sweep: [(field: "é", from: 0,
    to: 1)],
)"####;
        assert_eq!(line(text, "mass_g"), Some(8));
        assert_eq!(line(text, "stops.restitution"), Some(11));
        assert_eq!(line(text, "damping.xi"), Some(13));
        assert_eq!(line(text, "excitation.0.amplitude_g"), Some(16));
        assert_eq!(line(text, "excitation.1.0.accel_g"), Some(18));
        assert_eq!(line(text, "mechanism.coefficients_si.2"), Some(22));
        assert_eq!(line(text, "sweep.0.to"), Some(24));
        assert_eq!(Places::of(text).find("sweep.0.from"), Some(Place { line: 23, column: 23 }));
    }

    #[test]
    fn a_field_left_out_is_found_at_what_surrounds_it() {
        let text = "(\nrun:\n(duration_s: 1))";
        assert_eq!(line(text, "run.settle_s"), Some(2));
        assert_eq!(line(text, "stops.left_mm"), None);
    }

    #[test]
    fn the_last_field_before_a_place() {
        let places = Places::of("(a: 1,\n b: (c: 2))");
        assert_eq!(places.last_before(Place { line: 2, column: 9 }), Some("b.c".to_owned()));
        assert_eq!(places.last_before(Place { line: 1, column: 1 }), None);
    }

    #[test]
    fn depth_and_length_are_harmless() {
        for open in ["(", "[", "{", "a(", "(a:", "\"", "/*", "r#", "'"] {
            Places::of(&open.repeat(300_000));
        }
    }
}
