//! Numbers as text: the shortest form that parses back, and few digits for sentences. Text for a terminal.

use std::borrow::Cow;
use std::fmt::Write;
use std::ops::Range;

use super::round::decade;

/// Appends `value` in its shortest form: plain (`0.58`) or with an exponent (`1e-9`), whichever has fewer
/// characters, and plain if they are equal. It parses back to the same double. Zero of either sign is `0`,
/// infinities are `inf` and `-inf`, and NaN appends nothing.
#[doc(hidden)]
pub fn push_number(text: &mut String, value: f64) {
    if value.is_nan() {
        return;
    }
    let value = value + 0.0; // makes -0 a plain 0
    let (begin, size) = (text.len(), value.abs());
    if size != 0.0 && size < 1e-3 {
        let _ = write!(text, "{value:e}");
        return;
    }
    let _ = write!(text, "{value}");
    // the exponent can be shorter in `1e-3` to `9e-3`, and from `1e3` on
    let length = text.len() - begin;
    if size >= 1e3 && size.is_finite() || size < 1e-2 && (5..=6).contains(&length) {
        let scientific = format!("{value:e}");
        if scientific.len() < length {
            text.truncate(begin);
            text.push_str(&scientific);
        }
    }
}

/// A number in plain digits from 1e-4 to 1e6, otherwise with an exponent. It parses back to the same double.
#[doc(hidden)]
pub fn number_text(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() || (1e-4..1e6).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// `value` rounded to so many significant digits.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// How a number in a sentence ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Without zeros at the end.
    Trimmed,
    /// With all its significant digits.
    Padded,
    /// The same, and with all digits before the point.
    Whole,
}

/// `value` with so many significant digits, and with an exponent where its size is not among the `plain`
/// ones.
pub fn significant(value: f64, digits: usize, ending: Ending, plain: Range<f64>) -> String {
    let rounded = rounded(value, digits);
    if rounded == 0.0 || !rounded.is_finite() {
        // adding 0 makes -0 a plain 0
        return format!("{}", rounded + 0.0);
    }
    let places = decimals(rounded, digits as i32);
    match (plain.contains(&rounded.abs()), ending) {
        (true, Ending::Trimmed) => format!("{rounded}"),
        (true, Ending::Padded) => format!("{rounded:.places$}"),
        (true, Ending::Whole) => format!("{value:.places$}"),
        (false, _) => format!("{rounded:e}"),
    }
}

/// `value` rounded to four significant digits, for sentences.
#[doc(hidden)]
pub fn short(value: f64) -> String {
    significant(value, 4, Ending::Trimmed, 1e-3..1e6)
}

/// The number of decimals that shows a number of this size with `digits` significant digits; at most 12, and
/// none for 0.
#[doc(hidden)]
pub fn decimals(value: f64, digits: i32) -> usize {
    let power = if value == 0.0 { digits } else { decade(value.abs()) };
    (digits - 1 - power).clamp(0, 12) as usize
}

/// Whether a character moves about a terminal, changes it, or turns the text around it: a control character,
/// or one of Unicode for the direction of text or for the end of a line.
#[doc(hidden)]
pub fn is_obeyed(c: char) -> bool {
    let turns = ['\u{61c}', '\u{200e}', '\u{200f}', '\u{2028}', '\u{2029}'];
    c.is_control() || turns.contains(&c) || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The text with an escape such as `\u{1b}` for each character that a terminal would obey, but for tabs and
/// line ends.
#[doc(hidden)]
pub fn visible(text: &str) -> Cow<'_, str> {
    let is_escaped = |c: char| is_obeyed(c) && c != '\n' && c != '\t';
    if !text.contains(is_escaped) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_escaped(c) { shown.extend(c.escape_default()) } else { shown.push(c) }
    }
    shown.into()
}

/// The same on one line: blanks in place of tabs and line ends.
#[doc(hidden)]
pub fn one_line(text: &str) -> String {
    visible(text).replace(['\n', '\t'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written = [7.18234e-3, -0.0, 1.0 / 3.0, 4123.4, 8.2e5, 1.2e-9, 8.2e7].map(short);
        assert_eq!(written, ["0.007182", "0", "0.3333", "4123", "820000", "1.2e-9", "8.2e7"]);
        assert_eq!([0.0, 7.18e-3, 41.2, 4123.4].map(|value| decimals(value, 3)), [0, 5, 1, 0]);
        // rounding reaches the next power of ten
        let of = |ending| [9.996, 41.0, 4123.4, 3e-7].map(|value| significant(value, 3, ending, 1e-6..1e9));
        assert_eq!(of(Ending::Trimmed), ["10", "41", "4120", "3e-7"]);
        assert_eq!(of(Ending::Padded), ["10.0", "41.0", "4120", "3e-7"]);
        assert_eq!(of(Ending::Whole), ["10.0", "41.0", "4123", "3e-7"]);
    }

    fn shortest(value: f64) -> String {
        let mut text = String::new();
        push_number(&mut text, value);
        text
    }

    #[test]
    fn the_shorter_of_two_forms_that_parse_back() {
        let mut values = vec![0.0, 1.0, -1.0, 0.58, 0.1 * 3.0, 100.0, 1e3, 12345.678, 1e-2, 1e-3, 1e21];
        values.extend([5e-324, f64::MAX, f64::MIN_POSITIVE, 1e22, 123456789012345680.0, -1.5e-9, 9.80665]);
        values.extend([1e-4, -1e-4, 1.5e-4, 9.99e-4, -1e-3, 9e-3, -9e-3, 9.1e-3, 0.01, 999.0, 1e5, -1e3]);
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for _ in 0..20_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            values.push(f64::from_bits(bits));
            values.push((bits >> 40) as f64 / 1024.0);
            values.push((bits >> 48) as f64 * 1e-3);
        }
        for value in values.into_iter().filter(|v| v.is_finite()) {
            let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
            let right = if scientific.len() < plain.len() { scientific } else { plain };
            let written = shortest(value);
            assert_eq!(written, right);
            assert_eq!(written.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }

    #[test]
    fn what_a_terminal_obeys_is_escaped() {
        assert_eq!(visible("a\tb\n\u{1b}[2J\r\u{9b}\u{7f}"), "a\tb\n\\u{1b}[2J\\r\\u{9b}\\u{7f}");
        assert_eq!(one_line("a\tb\n\u{202e}\u{2067}x"), "a b \\u{202e}\\u{2067}x");
        let plain = "Größe → \u{5d0} 𝄞 \\u{1b}";
        assert!(matches!(visible(plain), Cow::Borrowed(same) if same == plain));
    }

    #[test]
    fn zero_has_no_sign_and_a_missing_number_no_text() {
        assert_eq!([-0.0, 0.0, f64::NAN, f64::INFINITY].map(shortest), ["0", "0", "", "inf"]);
        assert_eq!(shortest(f64::NEG_INFINITY).parse(), Ok(f64::NEG_INFINITY));
    }
}
