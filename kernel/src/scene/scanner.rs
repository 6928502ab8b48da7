//! Scanner for RON texts that finds fields and their places, comments and numbers.
//!
//! serde keeps no positions. This is not a second parser, which could disagree with RON: it only follows
//! brackets, strings, comments and `name:`, and never fails. It makes one pass and takes linear time. In a
//! text that RON accepts, it finds every field by the same path as the traversal in `fields`. In any other
//! text it finds some of the fields, enough to name the field near which a parser stopped.

use std::ops::Range;

use super::arithmetic;

/// One part of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Part {
    Name(String),
    Index(usize),
}

impl Part {
    /// Splits a path at its dots. A number with leading zeros or a sign, such as `01`, is a name.
    pub fn all_of(path: &str) -> Vec<Self> {
        let part = |text: &str| match text.parse::<usize>() {
            Ok(index) if index.to_string() == text => Self::Index(index),
            _ => Self::Name(text.to_owned()),
        };
        path.split('.').map(part).collect()
    }
}

/// Depth from which fields are skipped; RON fails at 128 levels.
const MAX_DEPTH: usize = 200;

/// Whether a scene's text has comments: `//` or `/*` outside of strings and raw strings.
#[doc(hidden)]
pub fn has_comments(text: &str) -> bool {
    Scanner::over(text).comments
}

/// A field with the bytes at which it begins and ends.
#[derive(Debug, Clone)]
struct Found {
    /// Index of the field around it.
    around: Option<usize>,
    part: Part,
    at: usize,
    end: usize,
}

/// A number in a text.
#[derive(Debug, Clone)]
pub(super) struct Number {
    /// Index of the field that it belongs to.
    field: Option<usize>,
    pub bytes: Range<usize>,
    /// Whether it is written as arithmetic.
    pub is_arithmetic: bool,
}

pub(super) struct Scanner<'t> {
    whole: &'t str,
    text: &'t [u8],
    at: usize,
    /// The fields in the order of the text.
    found: Vec<Found>,
    comments: bool,
    /// The numbers in the order of the text, but not the words `inf` and `NaN`.
    pub numbers: Vec<Number>,
}

/// The first byte from `at` on that is neither blank nor in a comment, and whether there was a comment.
pub(super) fn skip_blank(text: &[u8], mut at: usize) -> (usize, bool) {
    let starts = |at: usize, with: &[u8]| text[at..].starts_with(with);
    let mut comments = false;
    while let Some(byte) = text.get(at) {
        if byte.is_ascii_whitespace() {
            at += 1;
        } else if starts(at, b"//") {
            comments = true;
            at += text[at..].iter().position(|byte| *byte == b'\n').map_or(text.len() - at, |end| end + 1);
        } else if starts(at, b"/*") {
            comments = true;
            at += 2;
            let mut open = 1;
            while open > 0 && at < text.len() {
                match (starts(at, b"/*"), starts(at, b"*/")) {
                    (true, _) => (open, at) = (open + 1, at + 2),
                    (_, true) => (open, at) = (open - 1, at + 2),
                    _ => at += 1,
                }
            }
        } else {
            break;
        }
    }
    (at, comments)
}

impl<'t> Scanner<'t> {
    /// Scans a text to its end.
    pub fn over(text: &'t str) -> Self {
        let (found, numbers) = (Vec::new(), Vec::new());
        let mut scanner = Self { whole: text, text: text.as_bytes(), at: 0, found, comments: false, numbers };
        scanner.header();
        scanner.value(None, 0);
        scanner.blank();
        scanner
    }

    /// The bytes of the first decimal number that exceeds the largest double.
    pub fn overflow(&self) -> Option<Range<usize>> {
        let is_over = |number: &&Number| {
            !number.is_arithmetic && overflows(&String::from_utf8_lossy(&self.text[number.bytes.clone()]))
        };
        self.numbers.iter().find(is_over).map(|number| number.bytes.clone())
    }

    /// The path of the field that a number belongs to; empty for the value of the whole text.
    pub fn path(&self, number: &Number) -> String {
        number.field.map_or(String::new(), |field| path(&self.found, field))
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

    /// Skips `#![enable(..)]`, the only attribute of RON.
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
        let (at, comments) = skip_blank(self.text, self.at);
        (self.at, self.comments) = (at, self.comments || comments);
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

    /// Skips `r"..."`, `r#"..."#` and so on; returns false if there is no raw string here.
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
        let begin = self.at;
        if self.peek().is_some_and(|byte| byte.is_ascii_digit() || b"-.(pgs".contains(&byte))
            && let Some(end) = arithmetic::end(self.whole, begin)
        {
            self.at = end;
            self.numbers.push(Number { field: around, bytes: begin..end, is_arithmetic: true });
            return;
        }
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
                    if begin < self.at {
                        let bytes = begin..self.at;
                        self.numbers.push(Number { field: around, bytes, is_arithmetic: false });
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
            if depth >= MAX_DEPTH {
                self.at += 1;
                continue;
            }
            let part = if close == b']' {
                Some(Part::Index(index))
            } else if let Some(name) = self.key() {
                Some(Part::Name(name))
            } else {
                // `Ratio` has the only number without a name; `Sum([..])` and `Some(..)` add no part.
                (variant == "Ratio").then(|| Part::Name("xi".to_owned()))
            };
            let mut field = around;
            if let Some(part) = part {
                field = Some(self.found.len());
                self.found.push(Found { around, part, at: begin, end: begin });
            }
            self.value(field, depth + 1);
            if field != around
                && let Some(field) = field
            {
                self.found[field].end = self.at;
            }
            index += 1;
            if self.at == begin {
                self.at += 1;
            }
        }
    }

    /// Consumes `name:` and returns the name; consumes nothing if there is none.
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

/// The dotted path of a field.
fn path(fields: &[Found], field: usize) -> String {
    let outwards = std::iter::successors(Some(field), |field| fields[*field].around);
    let mut parts: Vec<String> = outwards
        .map(|field| match &fields[field].part {
            Part::Name(name) => name.clone(),
            Part::Index(index) => index.to_string(),
        })
        .collect();
    parts.reverse();
    parts.join(".")
}

/// Whether a text is a decimal number that exceeds the largest double; `inf` is not.
pub(super) fn overflows(text: &str) -> bool {
    text.contains(|c: char| c.is_ascii_digit())
        && text.trim().replace('_', "").parse().is_ok_and(f64::is_infinite)
}

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
#[doc(hidden)]
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
        let last = self.fields.iter().rposition(|field| field.at <= at)?;
        Some(path(&self.fields, last))
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

    #[test]
    fn comments_are_distinguished_from_text() {
        assert!(has_comments("( // what\n)") && has_comments("(/* what */)"));
        assert!(!has_comments("(notes: \"http://a \\\" // b\", mass_g: 1)"));
        assert!(has_comments("(notes: \"a\\\\\") // b"));
        assert!(!has_comments(r#"(notes: r"C:\" , title: "http://a")"#));
        assert!(!has_comments("(notes: r#\"she said \"no\" // not a comment\"#, mass_g: 1)"));
        assert!(has_comments(r#"(notes: r"C:\" /* here */)"#));
        assert!(has_comments("(notes: r##\"a \"# b\"## // here\n)"));
        // a name that ends in r does not begin a raw string
        assert!(has_comments("(r: \"a\\\"b\", // here\n)"));
    }

    #[test]
    fn numbers_beyond_the_largest_are_found() {
        let overflow = |text: &str| Scanner::over(text).overflow().map(|bytes| text[bytes].to_owned());
        for text in ["(a: 1, b: [2, -1e400])", "-1e400", "X(a: -1e400 /* 1e500 */)", "[-1e400]"] {
            assert_eq!(overflow(text).as_deref(), Some("-1e400"), "{text}");
        }
        assert_eq!(overflow("(a: 1_0e400)").as_deref(), Some("1_0e400"));
        // in parentheses it is arithmetic, whose errors differ
        assert_eq!(overflow("[(-1e400)]"), None);
        for text in
            ["(a: inf, b: -inf, c: +inf)", "(a: \"1e400\", /* 1e400 */ b: 1e308)", "(a: 1e-400)", "1e"]
        {
            assert_eq!(overflow(text), None, "{text}");
        }
    }

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
    fn a_missing_field_is_found_at_the_field_around_it() {
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
