//! Which values does a grid have, when its ends and step are decimal numbers?
//!
//! Steps are counted in whole units of the last decimal of the three numbers, in 128-bit integers, and
//! every value is the double nearest to its decimal: 0.58 is 0.58, where adding 0.02 to 0 would give
//! 0.5800000000000001.

/// An exact decimal number: digits times 10^exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Decimal {
    digits: i128,
    exponent: i32,
}

impl Decimal {
    /// Reads `-12.5e-3` and the like; `None` for anything else, NaN and the infinities included, and
    /// for more than 36 digits.
    pub(super) fn parse(text: &str) -> Option<Self> {
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
        let kept = digits.trim_start_matches('0');
        if kept.len() > 36 {
            return None;
        }
        let size: i128 = if kept.is_empty() { 0 } else { kept.parse().ok()? };
        let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        let digits = if negative { -size } else { size };
        Some(Self { digits, exponent: if digits == 0 { 0 } else { exponent } }.trimmed())
    }

    /// The shortest decimal that parses back to this double; `None` where it is not finite.
    pub(super) fn shortest(value: f64) -> Option<Self> {
        Self::parse(&format!("{value:e}"))
    }

    /// Without trailing zeros.
    fn trimmed(mut self) -> Self {
        while self.digits != 0 && self.digits % 10 == 0 {
            self.digits /= 10;
            self.exponent = self.exponent.saturating_add(1);
        }
        self
    }

    /// The digits when counted in units of 10^exponent, which is no larger than the own one.
    fn in_units(self, exponent: i32) -> Option<i128> {
        if self.digits == 0 {
            return Some(0);
        }
        let shift = u32::try_from(self.exponent.checked_sub(exponent)?).ok()?;
        self.digits.checked_mul(10_i128.checked_pow(shift)?)
    }

    /// The nearest double; infinite where it is too large for one.
    pub(super) fn value(self) -> f64 {
        // Clinger 1990: both factors are exact doubles, so one rounding is all there is.
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

/// An evenly spaced grid, not yet written out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Grid {
    from: i128,
    step: i128,
    exponent: i32,
    count: u128,
}

/// Why three numbers make no grid; a clause.
pub(super) type NoGrid = &'static str;

impl Grid {
    /// From `from` in steps of `step` up to `to`, which is included where a step reaches it.
    pub(super) fn new(from: Decimal, to: Decimal, step: Decimal) -> Result<Self, NoGrid> {
        let parts = [from, to, step];
        let exponents = parts.iter().filter(|part| part.digits != 0).map(|part| part.exponent);
        let exponent = exponents.min().unwrap_or(0);
        if step.digits == 0 {
            return Err("a step of 0 never arrives; give a step above 0");
        }
        if step.digits < 0 {
            return Err(
                "the step is negative; an axis goes upwards: give the smaller end first and a step above 0",
            );
        }
        let [Some(from), Some(to), Some(step)] = parts.map(|part| part.in_units(exponent)) else {
            return Err("the ends and the step differ by more than 36 digits");
        };
        let span = to.checked_sub(from).ok_or("the ends differ by more than 36 digits")?;
        if span < 0 {
            return Err("the end lies below the beginning; give the smaller end first");
        }
        Ok(Self { from, step, exponent, count: (span / step) as u128 + 1 })
    }

    /// How many values there are; nothing is written out for it.
    pub(super) fn count(&self) -> u128 {
        self.count
    }

    /// The i-th value as a decimal; `index` is below the count.
    pub(super) fn at(&self, index: u128) -> Decimal {
        let digits = self.from + self.step * index as i128;
        Decimal { digits, exponent: self.exponent }.trimmed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(from: &str, to: &str, step: &str) -> Result<Vec<f64>, NoGrid> {
        let [from, to, step] = [from, to, step].map(|text| Decimal::parse(text).unwrap());
        let grid = Grid::new(from, to, step)?;
        Ok((0..grid.count()).map(|i| grid.at(i).value()).collect())
    }

    #[test]
    fn every_value_is_the_double_nearest_to_its_decimal() {
        let values = grid("0", "2", "0.02").unwrap();
        assert_eq!(values.len(), 101);
        for (i, value) in values.iter().enumerate() {
            assert_eq!(*value, format!("{}.{:02}", i / 50, i % 50 * 2).parse::<f64>().unwrap());
        }
        assert_eq!(values[29], 0.58);
    }

    #[test]
    fn the_end_is_included_where_a_step_reaches_it() {
        assert_eq!(grid("0", "1", "0.25").unwrap(), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(grid("0", "1", "0.3").unwrap(), [0.0, 0.3, 0.6, 0.9]);
        assert_eq!(grid("-0.1", "0.1", "1e-1").unwrap(), [-0.1, 0.0, 0.1]);
        assert_eq!(grid("3", "3", "1").unwrap(), [3.0]);
        assert_eq!(grid("0.5", "8", "0.1875").unwrap().len(), 41);
        assert!(grid("0", "-1", "1").is_err());
        assert!(grid("0", "1", "0").is_err());
        assert!(grid("1", "0", "-1").is_err());
        assert!(grid("1e200", "1e201", "1e-3").is_err());
        assert_eq!(grid("1e200", "3e200", "1e200").unwrap(), [1e200, 2e200, 3e200]);
    }

    #[test]
    fn a_count_needs_no_room() {
        let [from, to, step] = ["0", "1e15", "1e-15"].map(|text| Decimal::parse(text).unwrap());
        assert_eq!(Grid::new(from, to, step).unwrap().count(), 10_u128.pow(30) + 1);
    }

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
}
