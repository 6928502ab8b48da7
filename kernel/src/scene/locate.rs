//! Places of the fields in a scene's text.
//!
//! serde keeps no positions. In a text that RON accepts, the [scanner](super::scanner) finds every field by
//! the same path as the traversal in `fields`. In other text it finds what it can, which is enough to tell
//! near which field a parser stopped.

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

/// The fields of a text with their places, in the order of the text.
///
/// Each field stores only the index of the field around it and the last part of its path. Whole paths could
/// exceed the memory for a hostile text of a few megabytes with long names around a million fields.
#[derive(Debug, Clone, Default)]
pub struct Places(Vec<Named>);

/// A field of a text.
#[derive(Debug, Clone)]
struct Named {
    /// Index of the field around it.
    around: Option<usize>,
    part: Part,
    place: Place,
    /// The bytes of its name and value.
    bytes: Range<usize>,
}

impl Places {
    /// Scans a text.
    pub fn of(text: &str) -> Self {
        let scanner = Scanner::over(text);
        let mut places = Vec::with_capacity(scanner.found.len());
        let (mut place, mut passed) = (Place { line: 1, column: 1 }, 0);
        for Found { around, part, at, end } in scanner.found {
            for byte in &text.as_bytes()[passed..at] {
                match byte {
                    b'\n' => place = Place { line: place.line + 1, column: 1 },
                    // continuation bytes of a character
                    0x80..=0xBF => {}
                    _ => place.column += 1,
                }
            }
            passed = at;
            places.push(Named { around, part, place, bytes: at..end });
        }
        Self(places)
    }

    /// The place of a field, or of the innermost field around it that the text has.
    pub fn find(&self, path: &str) -> Option<Place> {
        let parts: Vec<Part> = path.split('.').map(Part::of).collect();
        let place =
            |parts: &[Part]| self.0.iter().find(|named| self.is_at(named, parts)).map(|named| named.place);
        (1..=parts.len()).rev().find_map(|length| place(&parts[..length]))
    }

    /// The bytes of the field called `name` that begins at a place, including its value.
    pub(super) fn bytes_at(&self, place: Place, name: &str) -> Option<Range<usize>> {
        let is_name = |part: &Part| matches!(part, Part::Name(part) if part == name);
        let field = self.0.iter().find(|named| named.place == place && is_name(&named.part));
        field.map(|named| named.bytes.clone())
    }

    /// The path of the last field that begins at or before a place.
    pub fn last_before(&self, place: Place) -> Option<String> {
        let last = self.0.iter().rev().find(|named| named.place <= place)?;
        let outwards = std::iter::successors(Some(last), |named| named.around.map(|i| &self.0[i]));
        let mut parts: Vec<String> = outwards
            .map(|named| match &named.part {
                Part::Name(name) => name.clone(),
                Part::Index(index) => index.to_string(),
            })
            .collect();
        parts.reverse();
        Some(parts.join("."))
    }

    /// Whether a field has this path, compared from its end, where most paths differ.
    fn is_at(&self, named: &Named, path: &[Part]) -> bool {
        let Some((last, around)) = path.split_last() else { return false };
        named.part == *last
            && match named.around {
                Some(index) => self.is_at(&self.0[index], around),
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
