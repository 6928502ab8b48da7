//! Evenly spaced values between decimal ends.
//!
//! Steps are counted in whole units of the last decimal of the three numbers, in 128-bit integers, and
//! every value is the double nearest to its decimal: 0.58 is 0.58, whereas repeated addition of 0.02
//! would give 0.5800000000000001.

use crate::numeric::Decimal;

/// Evenly spaced values, computed on demand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct EvenSteps {
    from: i128,
    step: i128,
    exponent: i32,
    count: u128,
}

/// Reason why three numbers do not define even steps, as a clause.
pub(super) type StepsError = &'static str;

impl EvenSteps {
    /// Values from `from` in steps of `step` up to `to`, which is included if a step reaches it.
    pub(super) fn new(from: Decimal, to: Decimal, step: Decimal) -> Result<Self, StepsError> {
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

    /// Number of values.
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

    fn grid(from: &str, to: &str, step: &str) -> Result<Vec<f64>, StepsError> {
        let [from, to, step] = [from, to, step].map(|text| Decimal::parse(text).unwrap());
        let grid = EvenSteps::new(from, to, step)?;
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
        assert_eq!(EvenSteps::new(from, to, step).unwrap().count(), 10_u128.pow(30) + 1);
    }
}
