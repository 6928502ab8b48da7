//! Formatting of numbers with few digits for use in sentences.

use super::round::decade;

/// `value` rounded to four significant digits, for sentences.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        // Adding 0 makes -0 a plain 0.
        format!("{}", rounded + 0.0)
    } else {
        format!("{rounded:e}")
    }
}

/// The number of decimals that shows a number of this size with `digits` significant digits; at most 12.
pub fn decimals(value: f64, digits: i32) -> usize {
    (digits - 1 - decade(value.abs())).clamp(0, 12) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written = [7.18234e-3, -0.0, 1.0 / 3.0, 4123.4, 8.2e5, 1.2e-9, 8.2e7].map(short);
        assert_eq!(written, ["0.007182", "0", "0.3333", "4123", "820000", "1.2e-9", "8.2e7"]);
    }
}
