//! Arithmetic in place of a number, such as `0.8/9.80665`, `1.6/(2*pi)` or `sqrt(2)/3`.
//!
//! ```text
//! sum     = product (("+" | "-") product)*
//! product = signed (("*" | "/") signed)*
//! signed  = "-" signed | power
//! power   = operand ("^" signed)?
//! operand = number | "pi" | "g" | "sqrt" "(" sum ")" | "(" sum ")"
//! ```
//!
//! Every operation is that of doubles, from left to right, and its result must be finite. Blanks and the
//! comments of RON may stand between the parts. A plain number is not arithmetic: it keeps the bits that its
//! parser gives it.

use std::f64::consts::PI;

use super::error::clip;
use super::scanner::skip_blank;
use super::text::TOO_LARGE;
use super::unit::STANDARD_GRAVITY;
use crate::numeric::elementary;

/// Largest length of an expression in bytes.
const MAX_LENGTH: usize = 1000;

/// Largest depth of parentheses, signs and powers within each other.
const MAX_DEPTH: usize = 64;

/// An error in an expression.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Problem {
    /// The byte at which it is.
    pub at: usize,
    /// The problem and its remedy.
    pub what: String,
}

/// Reads a number: a plain one, which [`str::parse`] reads, or arithmetic. The error is a sentence.
///
/// ```
/// # use interwell_kernel as interwell;
/// assert_eq!(interwell::scene::read_number("2 * 0.25"), Ok(0.5));
/// ```
pub fn read_number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse() {
        Ok(plain) => Ok(plain),
        Err(_) if is_arithmetic(text) => {
            evaluate(text).map_err(|problem| format!("`{}`: {}", clip(text), problem.what))
        }
        Err(_) => Err(format!("`{}` is not a number", clip(text))),
    }
}

/// Whether a text begins with arithmetic rather than with a plain number or anything else.
pub(super) fn is_arithmetic(text: &str) -> bool {
    end(text, skip_blank(text.as_bytes(), 0).0).is_some()
}

/// The value of an expression that fills a text.
pub(super) fn evaluate(text: &str) -> Result<f64, Problem> {
    if text.len() > MAX_LENGTH {
        let what = format!("it is longer than {MAX_LENGTH} bytes; write its result");
        return Err(Problem { at: 0, what });
    }
    let mut parser = Parser { tokens: Tokens { text, at: 0 }, token: Token::End, at: 0, depth: 0 };
    parser.advance();
    let value = parser.sum()?;
    match parser.token {
        Token::End => Ok(value),
        Token::Sign(b')') => Err(parser.wrong("this `)` has no `(`; remove it")),
        _ => {
            let what = format!("an operator is missing before {}; write * for a product", parser.found());
            Err(parser.wrong(&what))
        }
    }
}

/// The end of the arithmetic that begins at byte `at` of a RON text; `None` if a plain number or no number
/// begins there. It has a number or a known name first, and need not be complete.
pub(super) fn end(text: &str, at: usize) -> Option<usize> {
    let mut tokens = Tokens { text, at };
    let (mut depth, mut end, mut operand_due) = (0_usize, at, true);
    // the begin of the first operand, if that is a number, and whether it has only a sign
    let (mut first, mut is_single) = (None, true);
    let is_bracket = text.as_bytes().get(at) == Some(&b'(');
    loop {
        let (begin, token) = tokens.next();
        match (token, operand_due) {
            (Token::Sign(b'-'), true) => {}
            (Token::Sign(b'('), true) => (depth, is_single) = (depth + 1, false),
            (Token::Number(_), true) => (first, operand_due) = (first.or(Some(begin)), false),
            (Token::Name(name), true) if first.is_some() || is_known(name) => {
                (first, is_single, operand_due) = (first.or(Some(begin)), false, name == "sqrt");
            }
            (Token::Sign(b')'), false) if depth > 0 => depth -= 1,
            (Token::Sign(b'+' | b'-' | b'*' | b'/' | b'^'), false) => {
                (operand_due, is_single) = (true, false)
            }
            _ => break,
        }
        end = tokens.at;
        // brackets around anything else are followed no further, since those within them are tried again
        if (is_bracket || first.is_none()) && (depth > MAX_DEPTH || end - at > MAX_LENGTH) {
            return None;
        }
    }
    let is_plain = is_single && first.is_some_and(|first| first <= at + 1);
    (first.is_some() && !is_plain && !(is_bracket && depth > 0)).then_some(end)
}

fn is_known(name: &str) -> bool {
    ["pi", "g", "sqrt"].contains(&name)
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Token<'t> {
    Number(&'t str),
    Name(&'t str),
    /// An operator or a parenthesis.
    Sign(u8),
    /// Any other character.
    Other(char),
    End,
}

/// The parts of an expression; `at` is the end of the last one.
struct Tokens<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Tokens<'t> {
    /// The next part with the byte at which it begins.
    fn next(&mut self) -> (usize, Token<'t>) {
        let begin = skip_blank(self.text.as_bytes(), self.at).0;
        let rest = &self.text[begin..];
        let Some(first) = rest.chars().next() else { return (begin, Token::End) };
        let is_named = |c: char| c.is_alphanumeric() || c == '_';
        let (length, token) = match first {
            '+' | '-' | '*' | '/' | '^' | '(' | ')' => (1, Token::Sign(first as u8)),
            _ if number_length(rest) > 0 => {
                let length = number_length(rest);
                (length, Token::Number(&rest[..length]))
            }
            _ if is_named(first) => {
                let length = rest.find(|c| !is_named(c)).unwrap_or(rest.len());
                (length, Token::Name(&rest[..length]))
            }
            other => (other.len_utf8(), Token::Other(other)),
        };
        self.at = begin + length;
        (begin, token)
    }
}

/// The length in bytes of the number without a sign at the begin of a text; 0 if there is none.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let digits = |from: usize| {
        let is_part = |byte: &&u8| byte.is_ascii_digit() || **byte == b'_';
        if is_digit(from) { from + bytes[from..].iter().take_while(is_part).count() } else { from }
    };
    let whole = digits(0);
    let has_point = bytes.get(whole) == Some(&b'.') && (whole > 0 || is_digit(1));
    let mantissa = if has_point { digits(whole + 1) } else { whole };
    let exponent = mantissa + 1 + usize::from(matches!(bytes.get(mantissa + 1), Some(b'+' | b'-')));
    let has_exponent = mantissa > 0 && matches!(bytes.get(mantissa), Some(b'e' | b'E')) && is_digit(exponent);
    if has_exponent { digits(exponent) } else { mantissa }
}

struct Parser<'t> {
    tokens: Tokens<'t>,
    /// The part that comes next, and the byte at which it begins.
    token: Token<'t>,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    /// Goes past a part and returns the byte at which it begins.
    fn advance(&mut self) -> usize {
        let at = self.at;
        (self.at, self.token) = self.tokens.next();
        at
    }

    fn sum(&mut self) -> Result<f64, Problem> {
        let mut value = self.product()?;
        while let Token::Sign(sign @ (b'+' | b'-')) = self.token {
            let at = self.advance();
            let right = self.product()?;
            value = finite(at, if sign == b'+' { value + right } else { value - right })?;
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<f64, Problem> {
        let mut value = self.signed()?;
        while let Token::Sign(sign @ (b'*' | b'/')) = self.token {
            let at = self.advance();
            let right = self.signed()?;
            if sign == b'/' && right == 0.0 {
                return Err(Problem { at, what: "a division by 0; give another divisor".to_owned() });
            }
            value = finite(at, if sign == b'*' { value * right } else { value / right })?;
        }
        Ok(value)
    }

    fn signed(&mut self) -> Result<f64, Problem> {
        // every part within another one comes through here; the outermost is in none
        if self.depth > MAX_DEPTH {
            return Err(self.wrong(&format!("it is nested deeper than {MAX_DEPTH} levels; write its result")));
        }
        self.depth += 1;
        let value = if self.token == Token::Sign(b'-') {
            self.advance();
            -self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(value)
    }

    fn power(&mut self) -> Result<f64, Problem> {
        let value = self.operand()?;
        if self.token != Token::Sign(b'^') {
            return Ok(value);
        }
        let at = self.advance();
        finite(at, elementary::powf(value, self.signed()?))
    }

    fn operand(&mut self) -> Result<f64, Problem> {
        match self.token {
            Token::Number(digits) => {
                let value = digits.replace('_', "").parse().ok().filter(|value: &f64| value.is_finite());
                let wrong = || self.wrong(&format!("`{}` {TOO_LARGE}; write a smaller one", clip(digits)));
                self.known(value.ok_or_else(wrong)?)
            }
            Token::Name("pi") => self.known(PI),
            Token::Name("g") => self.known(STANDARD_GRAVITY),
            Token::Name("sqrt") => {
                let at = self.advance();
                if self.token != Token::Sign(b'(') {
                    return Err(self.wrong("`(` is missing after `sqrt`; write sqrt(..)"));
                }
                finite(at, self.parentheses()?.sqrt())
            }
            Token::Name(name) => {
                let what =
                    format!("`{}` is unknown; arithmetic has pi, g (9.80665) and sqrt(..)", clip(name));
                Err(self.wrong(&what))
            }
            Token::Sign(b'(') => self.parentheses(),
            Token::End => Err(self.wrong("it ends where a number is expected; complete it")),
            Token::Sign(_) | Token::Other(_) => {
                Err(self.wrong(&format!("a number is expected in place of {}", self.found())))
            }
        }
    }

    /// Goes past a part that has this value.
    fn known(&mut self, value: f64) -> Result<f64, Problem> {
        self.advance();
        Ok(value)
    }

    fn parentheses(&mut self) -> Result<f64, Problem> {
        let at = self.advance();
        let value = self.sum()?;
        if self.token != Token::Sign(b')') {
            return Err(match self.token {
                Token::End => Problem { at, what: "this `(` has no `)`; add it".to_owned() },
                _ => self.wrong(&format!("an operator or `)` is expected in place of {}", self.found())),
            });
        }
        self.advance();
        Ok(value)
    }

    /// The part that comes next, as messages show it.
    fn found(&self) -> String {
        match self.token {
            Token::Number(text) | Token::Name(text) => format!("`{}`", clip(text)),
            Token::Sign(sign) => format!("`{}`", char::from(sign)),
            Token::Other(other) => format!("`{}`", clip(&other.to_string())),
            Token::End => "the end".to_owned(),
        }
    }

    fn wrong(&self, what: &str) -> Problem {
        Problem { at: self.at, what: what.to_owned() }
    }
}

/// A result, if it is finite; `at` is the byte of its operator or operand.
fn finite(at: usize, value: f64) -> Result<f64, Problem> {
    if value.is_finite() {
        return Ok(value);
    }
    let what = match value.is_nan() {
        true => {
            "a root or a broken power of a negative number, which is not real; change its sign".to_owned()
        }
        false => format!("the result {TOO_LARGE}; write a smaller one"),
    };
    Err(Problem { at, what })
}
