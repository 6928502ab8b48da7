//! Places of the fields in a scene's text.
//!
//! serde keeps no positions, and a second parser would be a second truth: this scanner only follows
//! brackets, strings, comments and `name:`, and never fails. On text that RON accepts it names every
//! field by the same path as the walk in `fields`; on other text it names what it can, which is enough
//! to say near which field a parser stopped. One pass, linear in the text.

use std::ops::Range;

/// A place in a text, both counted from 1, the column in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// The fields of a text with their places, in the order of the text.
///
/// Each knows the one around it and its own part of the path alone: whole paths would make of a hostile text
/// of a few megabytes, long names around a million fields, more than fits into memory.
#[derive(Debug, Clone, Default)]
pub struct Places(Vec<Named>);

/// A field, as a text names it.
#[derive(Debug, Clone)]
struct Named {
    /// The field around it, by its number.
    around: Option<usize>,
    part: Part,
    place: Place,
    /// Its bytes, name and value.
    bytes: Range<usize>,
}

/// The last part of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Name(String),
    Index(usize),
}

impl Part {
    fn of(text: &str) -> Self {
        text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Index)
    }
}

/// RON gives up at 128 levels; what lies deeper is skipped.
const DEEPEST: usize = 200;

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
                    // The further bytes of a character.
                    0x80..=0xBF => {}
                    _ => place.column += 1,
                }
            }
            passed = at;
            places.push(Named { around, part, place, bytes: at..end });
        }
        Self(places)
    }

    /// The place of a field, or of the nearest one around it that the text names.
    pub fn find(&self, path: &str) -> Option<Place> {
        let parts: Vec<Part> = path.split('.').map(Part::of).collect();
        let place =
            |parts: &[Part]| self.0.iter().find(|named| self.is_at(named, parts)).map(|own| own.place);
        (1..=parts.len()).rev().find_map(|length| place(&parts[..length]))
    }

    /// The bytes of the field called `name` that begins at a place, its value among them.
    pub(super) fn bytes_at(&self, place: Place, name: &str) -> Option<Range<usize>> {
        let named = |own: &&Named| own.place == place && matches!(&own.part, Part::Name(own) if own == name);
        self.0.iter().find(named).map(|own| own.bytes.clone())
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

    /// Whether a field has this path; compared from its end, where most differ.
    fn is_at(&self, named: &Named, path: &[Part]) -> bool {
        let Some((last, around)) = path.split_last() else { return false };
        named.part == *last
            && match named.around {
                Some(index) => self.is_at(&self.0[index], around),
                None => around.is_empty(),
            }
    }
}

/// Whether a scene's text has comments: `//` or `/*` outside of its strings, raw ones included.
pub fn has_comments(text: &str) -> bool {
    Scanner::over(text).comments
}

/// A field of the scanner, with the byte at which it begins.
struct Found {
    around: Option<usize>,
    part: Part,
    at: usize,
    end: usize,
}

struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
    /// In the order of the text.
    found: Vec<Found>,
    /// Whether a comment was passed.
    comments: bool,
}

impl<'t> Scanner<'t> {
    /// Scans a text to its end.
    fn over(text: &'t str) -> Self {
        let mut own = Self { text: text.as_bytes(), at: 0, found: Vec::new(), comments: false };
        own.header();
        own.value(None, 0);
        own.blank();
        own
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn starts(&self, with: &[u8]) -> bool {
        self.text[self.at..].starts_with(with)
    }

    fn skip_to(&mut self, end: &[u8]) {
        while self.at < self.text.len() && !self.starts(end) {
            self.at += 1;
        }
        self.at = (self.at + end.len()).min(self.text.len());
    }

    /// `#![enable(..)]`, the one attribute that RON knows.
    fn header(&mut self) {
        loop {
            self.blank();
            if !self.starts(b"#!") {
                return;
            }
            self.skip_to(b"]");
        }
    }

    fn blank(&mut self) {
        while let Some(byte) = self.peek() {
            if byte.is_ascii_whitespace() {
                self.at += 1;
            } else if self.starts(b"//") {
                self.comments = true;
                self.skip_to(b"\n");
            } else if self.starts(b"/*") {
                self.comments = true;
                self.at += 2;
                let mut open = 1;
                while open > 0 && self.at < self.text.len() {
                    match (self.starts(b"/*"), self.starts(b"*/")) {
                        (true, _) => (open, self.at) = (open + 1, self.at + 2),
                        (_, true) => (open, self.at) = (open - 1, self.at + 2),
                        _ => self.at += 1,
                    }
                }
            } else {
                return;
            }
        }
    }

    fn string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b'"' => return,
                b'\\' => self.at = (self.at + 1).min(self.text.len()),
                _ => {}
            }
        }
    }

    /// `r"..."`, `r#"..."#` and so on; false where none begins here.
    fn raw_string(&mut self) -> bool {
        let hashes = self.text[self.at + 1..].iter().take_while(|byte| **byte == b'#').count();
        if self.text.get(self.at + 1 + hashes) != Some(&b'"') {
            return false;
        }
        self.at += hashes + 2;
        let end: Vec<u8> = std::iter::once(b'"').chain(std::iter::repeat_n(b'#', hashes)).collect();
        self.skip_to(&end);
        true
    }

    fn identifier(&mut self) -> Option<String> {
        if self.starts(b"r#") {
            self.at += 2;
        }
        let begin = self.at;
        if self.peek().is_some_and(|byte| byte.is_ascii_digit()) {
            return None;
        }
        while self.peek().is_some_and(|byte| byte.is_ascii_alphanumeric() || byte == b'_' || byte >= 0x80) {
            self.at += 1;
        }
        let name = String::from_utf8_lossy(&self.text[begin..self.at]).into_owned();
        (!name.is_empty()).then_some(name)
    }

    fn value(&mut self, around: Option<usize>, depth: usize) {
        self.blank();
        match self.peek() {
            None => {}
            Some(b'"') => self.string(),
            Some(b'r') if self.raw_string() => {}
            Some(b'(') => self.inside(b')', "", around, depth),
            Some(b'[') => self.inside(b']', "", around, depth),
            Some(b'{') => self.inside(b'}', "", around, depth),
            Some(_) => {
                if let Some(variant) = self.identifier() {
                    self.blank();
                    if self.peek() == Some(b'(') {
                        self.inside(b')', &variant, around, depth);
                    }
                } else {
                    while self.peek().is_some_and(|byte| !b",()[]{}/\" \t\r\n".contains(&byte)) {
                        self.at += 1;
                    }
                }
            }
        }
    }

    fn inside(&mut self, close: u8, variant: &str, around: Option<usize>, depth: usize) {
        self.at += 1;
        let mut index = 0;
        loop {
            self.blank();
            let begin = self.at;
            match self.peek() {
                None => return,
                Some(byte) if byte == close => {
                    self.at += 1;
                    return;
                }
                Some(b',') => {
                    self.at += 1;
                    continue;
                }
                Some(_) => {}
            }
            if depth >= DEEPEST {
                self.at += 1;
                continue;
            }
            let part = if close == b']' {
                Some(Part::Index(index))
            } else if let Some(name) = self.key() {
                Some(Part::Name(name))
            } else {
                // The only positional number; in `Sum([..])` and `Some(..)` the bracket adds nothing.
                (variant == "Ratio").then(|| Part::Name("xi".to_owned()))
            };
            let mut own = around;
            if let Some(part) = part {
                own = Some(self.found.len());
                self.found.push(Found { around, part, at: begin, end: begin });
            }
            self.value(own, depth + 1);
            if own != around
                && let Some(own) = own
            {
                self.found[own].end = self.at;
            }
            index += 1;
            if self.at == begin {
                self.at += 1;
            }
        }
    }

    /// A `name:`, or nothing consumed.
    fn key(&mut self) -> Option<String> {
        let begin = self.at;
        if let Some(name) = self.identifier() {
            self.blank();
            if self.peek() == Some(b':') {
                self.at += 1;
                return Some(name);
            }
        }
        self.at = begin;
        None
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

    #[test]
    fn comments_are_told_from_text() {
        assert!(has_comments("( // what\n)") && has_comments("(/* what */)"));
        assert!(!has_comments("(notes: \"http://a \\\" // b\", mass_g: 1)"));
        assert!(has_comments("(notes: \"a\\\\\") // b"));
        assert!(!has_comments(r#"(notes: r"C:\" , title: "http://a")"#));
        assert!(!has_comments("(notes: r#\"she said \"no\" // not a comment\"#, mass_g: 1)"));
        assert!(has_comments(r#"(notes: r"C:\" /* here */)"#));
        assert!(has_comments("(notes: r##\"a \"# b\"## // here\n)"));
        // a name that ends in r is no raw string
        assert!(has_comments("(r: \"a\\\"b\", // here\n)"));
    }
}
