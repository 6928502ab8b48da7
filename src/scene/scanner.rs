//! Scanner of RON texts: fields, comments and numbers by their places.
//!
//! A second parser would be a second truth: this one only follows brackets, strings, comments and `name:`,
//! and never fails. One pass, linear in the text.

use std::ops::Range;

/// The last part of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Part {
    Name(String),
    Index(usize),
}

impl Part {
    pub fn of(text: &str) -> Self {
        text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Index)
    }
}

/// RON gives up at 128 levels; what lies deeper is skipped.
const DEEPEST: usize = 200;

/// Whether a scene's text has comments: `//` or `/*` outside of its strings, raw ones included.
pub fn has_comments(text: &str) -> bool {
    Scanner::over(text).comments
}

/// A field, with the bytes at which it begins and ends.
pub(super) struct Found {
    /// The field around it, by its number.
    pub around: Option<usize>,
    pub part: Part,
    pub at: usize,
    pub end: usize,
}

/// What follows a text.
pub(super) struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
    /// In the order of the text.
    pub found: Vec<Found>,
    /// Whether a comment was passed.
    comments: bool,
    /// The bytes of the first number in digits that is beyond the largest double.
    pub beyond: Option<Range<usize>>,
}

impl<'t> Scanner<'t> {
    /// Scans a text to its end.
    pub fn over(text: &'t str) -> Self {
        let mut own = Self { text: text.as_bytes(), at: 0, found: Vec::new(), comments: false, beyond: None };
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
                    let begin = self.at;
                    while self.peek().is_some_and(|byte| !b",()[]{}/\" \t\r\n".contains(&byte)) {
                        self.at += 1;
                    }
                    if self.beyond.is_none()
                        && is_beyond(&String::from_utf8_lossy(&self.text[begin..self.at]))
                    {
                        self.beyond = Some(begin..self.at);
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

/// Whether a text is a number in digits that is beyond the largest double; `inf` is what it says.
pub(super) fn is_beyond(text: &str) -> bool {
    text.contains(|c: char| c.is_ascii_digit())
        && text.trim().replace('_', "").parse().is_ok_and(f64::is_infinite)
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn numbers_beyond_the_largest_are_found() {
        let beyond = |text: &str| Scanner::over(text).beyond.map(|bytes| text[bytes].to_owned());
        for text in ["(a: 1, b: [2, -1e400])", "-1e400", "X(a: -1e400 /* 1e500 */)", "[(-1e400)]"] {
            assert_eq!(beyond(text).as_deref(), Some("-1e400"), "{text}");
        }
        assert_eq!(beyond("(a: 1_0e400)").as_deref(), Some("1_0e400"));
        for text in
            ["(a: inf, b: -inf, c: +inf)", "(a: \"1e400\", /* 1e400 */ b: 1e308)", "(a: 1e-400)", "1e"]
        {
            assert_eq!(beyond(text), None, "{text}");
        }
    }
}
