//! Exact decimal numbers as written by a person, and the ratio of two of them.

/// An exact decimal number: digits times 10^exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decimal {
    /// The digits, as a whole number.
    pub digits: i128,
    /// The power of ten that multiplies the digits.
    pub exponent: i32,
}

impl Decimal {
    /// Parses a number such as `-12.5e-3`. Returns `None` for any other text, including NaN and infinities,
    /// and for more than 36 digits.
    pub fn parse(text: &str) -> Option<Self> {
        let (negative, rest) = match text.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let (mantissa, exponent) = match rest.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (rest, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = format!("{whole}{fraction}");
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let significant = digits.trim_start_matches('0');
        if significant.len() > 36 {
            return None;
        }
        let size: i128 = if significant.is_empty() { 0 } else { significant.parse().ok()? };
        let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        let digits = if negative { -size } else { size };
        Some(Self { digits, exponent: if digits == 0 { 0 } else { exponent } }.trimmed())
    }

    /// The shortest decimal that parses back to this double; `None` if it is not finite.
    pub fn shortest(value: f64) -> Option<Self> {
        Self::parse(&format!("{value:e}"))
    }

    /// The same number without trailing zeros.
    #[must_use]
    pub fn trimmed(mut self) -> Self {
        while self.digits != 0 && self.digits % 10 == 0 {
            self.digits /= 10;
            self.exponent = self.exponent.saturating_add(1);
        }
        self
    }

    /// The number in units of 10^`exponent`; `None` if `exponent` is above its own exponent, or on overflow.
    pub fn in_units(self, exponent: i32) -> Option<i128> {
        if self.digits == 0 {
            return Some(0);
        }
        let shift = u32::try_from(self.exponent.checked_sub(exponent)?).ok()?;
        self.digits.checked_mul(10_i128.checked_pow(shift)?)
    }

    /// The nearest double; infinite if the number is too large for one.
    pub fn value(self) -> f64 {
        // Clinger 1990: both factors are exact doubles, so the result is rounded only once.
        const EXACT: [f64; 23] = [
            1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17,
            1e18, 1e19, 1e20, 1e21, 1e22,
        ];
        let power = EXACT.get(self.exponent.unsigned_abs() as usize);
        match power {
            Some(power) if self.digits.unsigned_abs() < 1 << 53 => {
                let digits = self.digits as f64;
                if self.exponent < 0 { digits / power } else { digits * power }
            }
            _ => format!("{}e{}", self.digits, self.exponent).parse().unwrap_or(f64::NAN),
        }
    }
}

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
#[doc(hidden)]
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
    fn only_plain_decimals_are_read() {
        for text in
            ["", ".", "-", "e5", "1e", "NaN", "inf", "0x10", "1_000", "1,5", " 1", "1e99999999999", "--1"]
        {
            assert_eq!(Decimal::parse(text), None, "{text}");
        }
        for text in ["1.", ".5", "+2", "-0", "1E3", "5e-324", "1.7976931348623157e308"] {
            let value = text.parse::<f64>().unwrap();
            assert_eq!(Decimal::parse(text).unwrap().value(), value, "{text}");
            assert_eq!(Decimal::shortest(value).unwrap().value(), value, "{text}");
        }
    }

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
