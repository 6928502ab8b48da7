//! Starts of a map of basins: a grid over displacement and velocity, or random ones.

use std::fmt;
use std::str::FromStr;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::Deserialize;

use crate::numeric::Decimal;
use crate::scene::read_number;
use crate::study::{Levels, even_positions};

/// Largest number of starts of one map: minutes on one core if the mass comes to rest on stops, else hours.
pub const MAX_STARTS: u64 = 10_000_000;

/// Largest displacement in mm and velocity in m/s, as in a scene.
const LARGEST: f64 = 1e15;

/// What is wrong with a range or a number of starts.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StartsError {
    /// An invalid range.
    #[error("{0}")]
    Range(&'static str),
    /// Too many starts.
    #[error("makes {0} starts; at most {MAX_STARTS} fit in one map: take fewer values")]
    TooMany(String),
}

/// The values of one axis of a grid: `count` even values from `from` to `to` inclusive.
///
/// Both ends are values themselves: -5 to 5 with a count of 101 has steps of 0.1.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(from = "Ends")]
pub struct EvenRange {
    /// First value, in mm or m/s.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values; 0 where it is not said.
    pub count: u64,
}

/// A range as a program writes it, with or without the number of its values.
#[derive(Deserialize)]
#[serde(untagged)]
enum Ends {
    Even(f64, f64, u64),
    Range(f64, f64),
}

impl From<Ends> for EvenRange {
    fn from(ends: Ends) -> Self {
        match ends {
            Ends::Even(from, to, count) => Self { from, to, count },
            Ends::Range(from, to) => Self { from, to, count: 0 },
        }
    }
}

impl From<(f64, f64, u64)> for EvenRange {
    fn from((from, to, count): (f64, f64, u64)) -> Self {
        Self { from, to, count }
    }
}

impl fmt::Display for EvenRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { from, to, count } = self;
        if *count == 0 { write!(f, "{from}:{to}") } else { write!(f, "{from}:{to}:{count}") }
    }
}

impl Default for EvenRange {
    /// A range that was not given.
    fn default() -> Self {
        Self { from: f64::NAN, to: f64::NAN, count: 0 }
    }
}

impl FromStr for EvenRange {
    type Err = String;

    /// Reads A:B:N, or A:B without the number of values.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(':').collect();
        let (from, to, count) = match parts[..] {
            [from, to] => (from, to, 0),
            [from, to, count] => match count.trim().parse() {
                Ok(0) => return Err(NO_VALUES.to_owned()),
                Ok(count) => (from, to, count),
                Err(_) => return Err(format!("N is not a whole number; {AS_EVEN}")),
            },
            _ => return Err(AS_EVEN.to_owned()),
        };
        Ok(Self { from: read_number(from)?, to: read_number(to)?, count })
    }
}

/// The form of a range.
pub(super) const AS_EVEN: &str = "write A:B:N, the first value, the last and how many, such as -5:5:101";
const NO_VALUES: &str = "no values: N counts them, both ends included, such as -5:5:101";

impl EvenRange {
    /// Whether it was given.
    pub(super) fn is_given(&self) -> bool {
        self.count > 0 || !self.from.is_nan()
    }

    /// Its first and its last value.
    pub(super) fn ends(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    /// Checks the ends and the number of values.
    pub fn check(&self) -> Result<(), StartsError> {
        check_ends((self.from, self.to))?;
        let wrong = |what| Err(StartsError::Range(what));
        match self.count {
            0 => wrong(AS_EVEN),
            1 if self.from < self.to => wrong("one value cannot be both ends: write A:A:1, or a larger N"),
            2.. if self.from == self.to => wrong("both ends are equal: write A:A:1 for one value"),
            _ if self.count > MAX_STARTS => Err(StartsError::TooMany(self.count.to_string())),
            _ => Ok(()),
        }
    }

    /// The values, each the double nearest to its exact decimal.
    fn values(&self) -> Vec<f64> {
        let plain = || even_positions((self.from, self.to), self.count as usize);
        self.exact().unwrap_or_else(plain)
    }

    fn exact(&self) -> Option<Vec<f64>> {
        let (from, to) = (Decimal::shortest(self.from)?, Decimal::shortest(self.to)?);
        let exponent = from.exponent.min(to.exponent).min(0);
        let last = i128::from(self.count.saturating_sub(1).max(1));
        let below = last.checked_mul(10_i128.checked_pow(exponent.unsigned_abs())?)?;
        let (from, to) = (from.in_units(exponent)?, to.in_units(exponent)?);
        // a quotient of integers that are exact as doubles is rounded only once
        let whole = |number: i128| (number.unsigned_abs() <= 1 << 53).then_some(number as f64);
        let below = whole(below)?;
        let value = |place: i128| {
            let above = from.checked_mul(last - place)?.checked_add(to.checked_mul(place)?)?;
            Some(whole(above)? / below)
        };
        (0..i128::from(self.count)).map(value).collect()
    }
}

fn check_ends((from, to): (f64, f64)) -> Result<(), StartsError> {
    let wrong = |what| Err(StartsError::Range(what));
    match (from, to) {
        _ if !(from.abs() <= LARGEST && to.abs() <= LARGEST) => wrong("give finite numbers, at most 1e15"),
        _ if from > to => wrong("the range is reversed: write A:B with A not above B"),
        _ => Ok(()),
    }
}

/// The starts of a map in the order of their rows, with displacement in mm and velocity in m/s.
#[derive(Debug, Clone, PartialEq)]
pub struct Starts {
    x_mm: Vec<f64>,
    v: Vec<f64>,
    /// Whether the starts are all pairs of the values, the displacement changing slower; otherwise start i
    /// has the i-th values.
    product: bool,
}

impl Starts {
    /// A grid. Precondition: both ranges passed [`EvenRange::check`].
    pub fn grid(x_mm: &EvenRange, v: &EvenRange) -> Result<Self, StartsError> {
        match x_mm.count.checked_mul(v.count) {
            Some(count) if count <= MAX_STARTS => {
                Ok(Self { x_mm: x_mm.values(), v: v.values(), product: true })
            }
            _ => Err(StartsError::TooMany(format!("{} x {}", x_mm.count, v.count))),
        }
    }

    /// `count` starts drawn uniformly from two ranges by ChaCha8 seeded with `seed`: for each start first the
    /// displacement, then the velocity, each from the upper 53 bits of 64.
    pub fn random(x_mm: (f64, f64), v: (f64, f64), count: u64, seed: u64) -> Result<Self, StartsError> {
        check_ends(x_mm).and(check_ends(v))?;
        match count {
            0 => return Err(StartsError::Range("no starts: give how many to draw, such as 1000")),
            1..=MAX_STARTS => {}
            _ => return Err(StartsError::TooMany(count.to_string())),
        }
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut draw = |(from, to): (f64, f64)| {
            let share = (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
            from + (to - from) * share
        };
        let (x_mm, v) = (0..count).map(|_| (draw(x_mm), draw(v))).unzip();
        Ok(Self { x_mm, v, product: false })
    }

    /// Number of starts.
    pub fn count(&self) -> usize {
        if self.product { self.x_mm.len() * self.v.len() } else { self.x_mm.len() }
    }

    /// Displacement in mm and velocity in m/s of start `row`.
    pub fn at(&self, row: usize) -> (f64, f64) {
        match self.product {
            true => (self.x_mm[row / self.v.len()], self.v[row % self.v.len()]),
            false => (self.x_mm[row], self.v[row]),
        }
    }

    /// Whether the starts are a grid.
    pub fn is_grid(&self) -> bool {
        self.product
    }

    /// The values on the axes of a grid.
    pub fn axes(&self) -> Option<(&[f64], &[f64])> {
        self.product.then_some((&self.x_mm, &self.v))
    }

    /// The order of the runs, from coarse to fine; random starts are run as they were drawn.
    pub(super) fn levels(&self) -> Levels {
        match self.product {
            true => Levels::of_lengths(vec![self.x_mm.len(), self.v.len()]),
            false => Levels::of_lengths(vec![self.x_mm.len()]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from: f64, to: f64, count: u64) -> EvenRange {
        EvenRange { from, to, count }
    }

    #[test]
    fn values_are_exact_decimals_and_mirror_each_other() {
        assert_eq!(range(0.1, 0.7, 7).values(), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
        assert_eq!(range(-1.5, 1.5, 5).values(), [-1.5, -0.75, 0.0, 0.75, 1.5]);
        let thirds = range(-1.1, 1.1, 100).values();
        assert!((0..100).all(|i| thirds[i] == -thirds[99 - i]));
        assert_eq!(range(3.0, 3.0, 1).values(), [3.0]);
        assert_eq!(range(-1e15, 1e-300, 2).values(), [-1e15, 1e-300]);
    }

    #[test]
    fn random_starts_fill_both_ranges_and_depend_on_the_seed() {
        let starts = Starts::random((-1.0, 3.0), (0.0, 2.0), 10_000, 7).unwrap();
        let mean =
            |of: fn((f64, f64)) -> f64| (0..10_000).map(|row| of(starts.at(row))).sum::<f64>() / 10_000.0;
        // 4 standard errors of a uniform mean
        assert!((mean(|start| start.0) - 1.0).abs() < 4.0 * 4.0 / 12.0_f64.sqrt() / 100.0);
        assert!((mean(|start| start.1) - 1.0).abs() < 4.0 * 2.0 / 12.0_f64.sqrt() / 100.0);
        assert_eq!(starts, Starts::random((-1.0, 3.0), (0.0, 2.0), 10_000, 7).unwrap());
        assert_ne!(starts, Starts::random((-1.0, 3.0), (0.0, 2.0), 10_000, 8).unwrap());
    }
}
