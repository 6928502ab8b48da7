//! Round numbers: a leading digit times a power of ten.
//!
//! Arguments are above 0 and finite, which is not checked. A result is the double nearest to its decimal. A
//! value counts as round if it differs from a round number by at most 1e-9 of itself.

use super::elementary;

/// Leading digits of the steps of an axis.
pub const ONE_TWO_FIVE: [f64; 3] = [1.0, 2.0, 5.0];

/// Relative difference within which a number counts as round.
const ROUNDING: f64 = 1e-9;

/// Exponent of the largest power of ten that is not above `value`, which is above 0.
pub fn decade(value: f64) -> i32 {
    elementary::log10(value).floor() as i32
}

/// The smallest product of one of `digits` and a power of ten that is not below `value`. `digits` ascend from
/// 1 to below 10; `value` is above 0.
pub fn round_up(value: f64, digits: &[f64]) -> f64 {
    let power = decade(value);
    let found = digits.iter().map(|digit| nearest(*digit, power));
    found.into_iter().find(|round| *round >= value * (1.0 - ROUNDING)).unwrap_or(nearest(10.0, power))
}

/// The largest product of one of `digits` and a power of ten that is not above `value`; see [`round_up`].
pub fn round_down(value: f64, digits: &[f64]) -> f64 {
    let power = decade(value);
    let found = digits.iter().rev().map(|digit| nearest(*digit, power));
    found.into_iter().find(|round| *round <= value * (1.0 + ROUNDING)).unwrap_or(nearest(1.0, power))
}

/// The double nearest to a decimal.
fn nearest(digit: f64, power: i32) -> f64 {
    format!("{digit}e{power}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_numbers_lie_on_both_sides() {
        for (value, down, up) in
            [(0.96, 0.5, 1.0), (1.0, 1.0, 1.0), (0.003, 0.002, 0.005), (70.0, 50.0, 100.0)]
        {
            assert_eq!((round_down(value, &ONE_TWO_FIVE), round_up(value, &ONE_TWO_FIVE)), (down, up));
        }
    }
}
