//! Formats of numbers in fields and on axes, and round numbers for their ends and steps.

use crate::numeric::{self, round};

/// The least number of one or two digits that is not below `value`.
pub fn round_up(value: f64) -> f64 {
    let digits = [1.0, 1.2, 1.5, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    round::round_up(value, &digits)
}

/// 1, 2 or 5 times a power of ten, not above `value`.
pub fn below(value: f64) -> f64 {
    round::round_down(value, &round::ONE_TWO_FIVE)
}

/// The number of six digits: what products of round numbers are meant to be.
pub fn decimal(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

/// Decimals that tell multiples of a step apart.
pub fn decimals(step: f64) -> usize {
    let text = format!("{}", decimal(step));
    text.split_once('.').map_or(0, |(_, after)| after.len()).min(12)
}

/// The most significant digits that a field shows while nobody types in it.
const DIGITS: usize = 7;

/// A number as a field shows it: at least so many decimals, and all digits that it has up to seven.
pub fn shown(value: f64, least: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    exact(rounded, least)
}

/// The same with every digit that the number has.
pub fn exact(value: f64, least: usize) -> String {
    if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{}", value + 0.0);
    let own = text.split_once('.').map_or(0, |(_, after)| after.len());
    if own >= least { text } else { format!("{:.least$}", value + 0.0) }
}

/// A number with at least three significant digits, and no more decimals than these take.
pub fn three(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{}", value + 0.0);
    }
    format!("{value:.0$}", numeric::decimals(size, 3))
}

/// The unit in which powers up to `most` in W are short, and how many of it a watt is.
pub fn power_unit(most: f64) -> (f64, &'static str) {
    match most {
        _ if most >= 1.0 => (1.0, "W"),
        _ if most >= 1e-3 || most == 0.0 => (1e3, "mW"),
        _ if most >= 1e-6 => (1e6, "µW"),
        _ => (1e9, "nW"),
    }
}

/// A power in W in words.
pub fn power(watt: f64) -> String {
    let (factor, unit) = power_unit(watt.abs());
    format!("{} {unit}", three(watt * factor))
}

/// Decimals with which numbers up to `most` have three significant digits.
pub fn decimals_for(most: f64) -> usize {
    if most > 0.0 && most.is_finite() { numeric::decimals(most, 3) } else { 2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_they_have() {
        let all = [
            (0.9, 2),
            (1.137, 2),
            (0.037_729_499_880_183_35, 2),
            (1_047.197_551, 0),
            (15.0, 1),
            (-0.0, 2),
            (1e-9, 2),
        ];
        let texts = all.map(|(value, least)| shown(value, least));
        assert_eq!(texts, ["0.90", "1.137", "0.0377295", "1047.198", "15.0", "0.00", "1e-9"]);
        assert_eq!(exact(0.037_729_499_880_183_35, 2), "0.03772949988018335");
        assert_eq!([0.05, 0.01, 15.0, 2e-4].map(decimals), [2, 2, 0, 4]);
        let powers = [0.0, 1.234, 0.012_34, 5e-6, -2e-9].map(power);
        assert_eq!(powers, ["0 mW", "1.23 W", "12.3 mW", "5.00 µW", "-2.00 nW"]);
        assert_eq!([0.0384, 1.25, 1000.0].map(three), ["0.0384", "1.25", "1000"]);
    }
}
