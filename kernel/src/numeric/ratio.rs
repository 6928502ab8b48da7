//! Exact ratio of two decimal numbers.

use super::decimal::Decimal;

/// A ratio of whole numbers in lowest terms, denominator above 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ratio {
    /// Numerator.
    pub numerator: u64,
    /// Denominator.
    pub denominator: u64,
}

impl Ratio {
    /// The ratio of two positive finite numbers, each taken as the shortest decimal text that parses back to
    /// it (3.1 is 31/10). Returns `None` if the numerator or denominator in lowest terms exceeds 2^53: such
    /// numbers are treated as incommensurable.
    pub fn of_decimals(a: f64, b: f64) -> Option<Self> {
        if a == b && a > 0.0 && a.is_finite() {
            return Some(Self { numerator: 1, denominator: 1 }); // the usual case: one sine is the clock
        }
        let positive = |value| Decimal::shortest(value).filter(|decimal| decimal.digits > 0);
        let (a, b) = (positive(a)?, positive(b)?);
        let shift = a.exponent - b.exponent;
        if shift.abs() > 17 {
            return None;
        }
        let scale = 10_u128.pow(shift.unsigned_abs());
        let (a, b) = (a.digits.unsigned_abs(), b.digits.unsigned_abs());
        let (n, d) = if shift >= 0 { (a * scale, b) } else { (a, b * scale) };
        let g = greatest_common_divisor(n, d);
        let fits = |v: u128| u64::try_from(v).ok().filter(|v| *v <= 1 << 53);
        Some(Self { numerator: fits(n / g)?, denominator: fits(d / g)? })
    }

    /// Fractional part of `count` times the ratio, rounded once.
    pub fn fraction_of_multiple(self, count: u64) -> f64 {
        if self.denominator == 1 {
            return 0.0;
        }
        let d = self.denominator;
        // below 2^53, so that only the quotient is rounded
        let rest = match count.checked_mul(self.numerator) {
            Some(product) => product % d,
            None => (u128::from(count) * u128::from(self.numerator) % u128::from(d)) as u64,
        };
        rest as f64 / d as f64
    }
}

/// Greatest common divisor (Euclid).
pub fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_of_decimal_texts() {
        let ratio = |a, b| Ratio::of_decimals(a, b).map(|r| (r.numerator, r.denominator));
        assert_eq!(ratio(3.1, 3.0), Some((31, 30)));
        assert_eq!(ratio(0.1, 0.3), Some((1, 3)));
        assert_eq!(ratio(6.0, 3.0), Some((2, 1)));
        assert_eq!([0.1, 3.0, 1.234_567_890_123_456_7].map(|a| ratio(a, a)), [Some((1, 1)); 3]);
        assert_eq!([0.0, -1.0, f64::INFINITY, f64::NAN].map(|a| ratio(a, a)), [None; 4]);
        assert_eq!(ratio(1e-3, 2e5), Some((1, 200_000_000)));
        assert_eq!(ratio(1e-9, 1e9), None);
        // Sixteen digits are few enough, seventeen are not.
        let digits = 3_141_592_653_589_793;
        assert_eq!(ratio(std::f64::consts::PI, 3.0), Some((digits, 3_000_000_000_000_000)));
        assert_eq!(ratio(1.234_567_890_123_456_7, 3.0), None);
        assert_eq!(ratio(3.0, 1.234_567_890_123_456_7), None);
        let r = Ratio { numerator: 31, denominator: 30 };
        assert_eq!(r.fraction_of_multiple(30), 0.0);
        assert_eq!(r.fraction_of_multiple(31), 1.0 / 30.0);
    }
}
