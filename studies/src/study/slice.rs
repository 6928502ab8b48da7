//! Shards of a sweep: which of its rows each of several processes computes.
//!
//! The rows are divided into blocks of whole units, about [`ROUNDS`] for each shard, and dealt in rounds:
//! each shard gets one block of every round, so that its cells are spread over the grid and costs are
//! balanced. The order of the shards changes from round to round by a fixed pseudorandom generator; with a
//! constant order, a shard could get the same columns of a map in every round.

use std::fmt;

/// One of several shards of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    count: u64,
}

/// Number of rounds, unless blocks have their [largest length](MAX_BLOCK).
const ROUNDS: u64 = 64;

/// Largest number of rows of a block, unless a unit is longer.
const MAX_BLOCK: u64 = 4096;

const MAX_SHARDS: u64 = 1_000_000;

impl Shard {
    /// All rows.
    pub const WHOLE: Self = Self { number: 1, count: 1 };

    /// Shard `number`, from 1, of `count`; the error is a clause.
    pub fn new(number: u64, count: u64) -> Result<Self, String> {
        if !(1..=MAX_SHARDS).contains(&count) {
            return Err(format!("{count} shards cannot be; give 1 to {MAX_SHARDS}"));
        }
        if !(1..=count).contains(&number) {
            return Err(format!(
                "there is no shard {number} of {count}; they are numbered from 1 to {count}"
            ));
        }
        Ok(Self { number, count })
    }

    /// Reads `I/N`; the error is a clause.
    pub fn parse(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').map(|(number, count)| (number.trim().parse(), count.trim().parse()));
        let Some((Ok(number), Ok(count))) = parts else {
            return Err("write I/N with whole numbers, such as 2/5, or auto".to_owned());
        };
        Self::new(number, count)
    }

    /// Its number, from 1.
    pub fn number(self) -> u64 {
        self.number
    }

    /// The number of shards.
    pub fn count(self) -> u64 {
        self.count
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

/// The rows of a sweep that belong to a shard, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Slice {
    shard: Shard,
    /// Rows of a unit.
    unit: u64,
    /// Units of a block.
    block: u64,
    /// Units of the whole sweep.
    units: u64,
    /// Units of the shard.
    shard_units: u64,
}

/// Rotation of the order of the shards in a round (splitmix64; Steele, Lea and Flood 2014).
fn turn(round: u64, count: u64) -> u64 {
    let mut z = round.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) % count
}

impl Slice {
    /// The rows of `shard` of a sweep of `rows` rows, cut only between units. Precondition: `rows` is a
    /// multiple of `unit`, which is at least 1.
    pub fn new(rows: u64, unit: u64, shard: Shard) -> Self {
        let units = rows / unit;
        let block = units.div_ceil(ROUNDS * shard.count).clamp(1, (MAX_BLOCK / unit).max(1));
        let mut slice = Self { shard, unit, block, units, shard_units: 0 };
        // only the last round and the very last block may be incomplete
        let (full, left) = (slice.blocks() / shard.count, slice.blocks() % shard.count);
        let place = slice.place(full);
        slice.shard_units = full * block + if place < left { block } else { 0 };
        let last = slice.blocks().checked_sub(1).map(|last| (last / shard.count, last % shard.count));
        if last.is_some_and(|(round, place)| slice.place(round) == place) {
            slice.shard_units -= slice.blocks() * block - units;
        }
        slice
    }

    fn blocks(&self) -> u64 {
        self.units.div_ceil(self.block)
    }

    /// Position of the block of the shard in a round.
    fn place(&self, round: u64) -> u64 {
        let count = self.shard.count;
        (self.shard.number - 1 + turn(round, count)) % count
    }

    /// Which shard it is.
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// The number of its rows.
    pub fn rows(&self) -> u64 {
        self.shard_units * self.unit
    }

    /// Rows that are computed one after the other.
    pub fn unit(&self) -> u64 {
        self.unit
    }

    /// Its row number `place` as a row of the whole sweep.
    pub fn row(&self, place: u64) -> u64 {
        let (unit, within) = (place / self.unit, place % self.unit);
        let round = unit / self.block;
        let block = round * self.shard.count + self.place(round);
        (block * self.block + unit % self.block) * self.unit + within
    }

    /// The rows of the whole sweep in order, as pairs of a shard number, from 1, and a number of rows.
    pub fn dealt(&self) -> impl Iterator<Item = (u64, u64)> + '_ {
        let count = self.shard.count;
        (0..self.blocks()).map(move |block| {
            let number = (block % count + count - turn(block / count, count)) % count + 1;
            (number, self.block.min(self.units - block * self.block) * self.unit)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_belongs_to_one_shard_and_the_stretches_say_to_which() {
        for (rows, unit) in [(0, 1), (1, 1), (7, 1), (1000, 1), (300_007, 1), (60, 5), (91 * 101, 101)] {
            for count in [1, 2, 3, 5, 64, 1000] {
                let slices: Vec<Slice> =
                    (1..=count).map(|i| Slice::new(rows, unit, Shard::new(i, count).unwrap())).collect();
                let mut owner = vec![0; rows as usize];
                for slice in &slices {
                    let numbers: Vec<u64> = (0..slice.rows()).map(|place| slice.row(place)).collect();
                    assert!(numbers.is_sorted_by(|a, b| a < b), "{rows} {unit} {}", slice.shard());
                    for row in numbers {
                        assert_eq!(std::mem::replace(&mut owner[row as usize], slice.shard().number()), 0);
                    }
                }
                let dealt: Vec<u64> = slices[0]
                    .dealt()
                    .flat_map(|(shard, rows)| std::iter::repeat_n(shard, rows as usize))
                    .collect();
                assert_eq!(owner, dealt, "{rows} {unit} {count}");
                let even = rows / count;
                let block = slices[0].block * unit;
                assert!(slices.iter().all(|slice| slice.rows() <= even + 2 * block), "{rows} {unit} {count}");
            }
        }
    }

    #[test]
    fn costs_that_repeat_along_the_rows_even_out() {
        // one column of a map of 128 columns costs all
        for count in [2, 4, 8, 16] {
            let expensive = |slice: &Slice| (0..slice.rows()).filter(|p| slice.row(*p) % 128 < 8).count();
            let costs: Vec<usize> = (1..=count)
                .map(|i| expensive(&Slice::new(128 * 256, 1, Shard::new(i, count).unwrap())))
                .collect();
            let mean = 2048.0 / count as f64;
            assert!(costs.iter().all(|cost| *cost as f64 <= 2.0 * mean), "{count}: {costs:?}");
        }
    }
}
