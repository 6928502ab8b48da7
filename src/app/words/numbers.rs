//! Formats of numbers in fields and on axes, and round numbers for ranges and steps.

use crate::numeric::{self, round};

/// The least round number, of one or two significant digits, that is not below `value`.
pub fn round_up(value: f64) -> f64 {
    let digits = [1.0, 1.2, 1.5, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    round::round_up(value, &digits)
}

/// The greatest 1, 2 or 5 times a power of ten that is not above `value`.
pub fn below(value: f64) -> f64 {
    round::round_down(value, &round::ONE_TWO_FIVE)
}

/// The value rounded to seven significant digits, which removes the rounding errors of products.
pub fn decimal(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

/// Number of decimals that distinguishes multiples of a step.
pub fn decimals(step: f64) -> usize {
    let text = format!("{}", decimal(step));
    text.split_once('.').map_or(0, |(_, after)| after.len()).min(12)
}

/// Greatest number of significant digits that a field shows while it is not edited.
const DIGITS: usize = 7;

/// A number as a field shows it: with at least `least` decimals, and up to seven significant digits.
pub fn shown(value: f64, least: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    exact(rounded, least)
}

/// The same, with all digits of the number.
pub fn exact(value: f64, least: usize) -> String {
    if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{}", value + 0.0);
    let decimals = text.split_once('.').map_or(0, |(_, after)| after.len());
    if decimals >= least { text } else { format!("{:.least$}", value + 0.0) }
}

/// A number with at least three significant digits, and no more decimals than these take.
pub fn three(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{}", value + 0.0);
    }
    format!("{value:.0$}", numeric::decimals(size, 3))
}

/// The factor from W to the unit that suits powers up to `largest` in W, and the name of that unit.
pub fn power_unit(largest: f64) -> (f64, &'static str) {
    match largest {
        _ if largest >= 1.0 => (1.0, "W"),
        _ if largest >= 1e-3 || largest == 0.0 => (1e3, "mW"),
        _ if largest >= 1e-6 => (1e6, "µW"),
        _ => (1e9, "nW"),
    }
}

/// A power in W as text with a unit.
pub fn power(watt: f64) -> String {
    let (factor, unit) = power_unit(watt.abs());
    format!("{} {unit}", three(watt * factor))
}

/// Number of decimals with which numbers up to `largest` have three significant digits.
pub fn decimals_for(largest: f64) -> usize {
    if largest > 0.0 && largest.is_finite() { numeric::decimals(largest, 3) } else { 2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits() {
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
