//! Order of the cells of a map, coarse to fine.
//!
//! Every eighth value of each axis first, then every fourth, every second, every one. The cells of a level
//! are among those of the next, so nothing is run twice, and the last level is the grid itself.

use super::grid::{Grid, places};

/// The strides of the levels, coarse first: powers of two, 1 at last.
pub const STRIDES: [usize; 4] = [8, 4, 2, 1];

/// The cells of a grid, coarse first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Levels {
    /// Every cell once, those of a coarser level before those that a finer one adds.
    pub order: Vec<u64>,
    /// How many cells of the order make up each level.
    pub ends: [usize; STRIDES.len()],
    lengths: Vec<usize>,
}

impl Levels {
    /// The levels of a grid.
    pub fn of(grid: &Grid) -> Self {
        Self::of_lengths(grid.axes().iter().map(|axis| axis.values.len()).collect())
    }

    /// The levels of a grid with axes of these lengths, slowest first.
    pub fn of_lengths(lengths: Vec<usize>) -> Self {
        let cells: u64 = lengths.iter().map(|length| *length as u64).product();
        let mut new: [Vec<u64>; STRIDES.len()] = Default::default();
        for index in 0..cells {
            // a power of two divides all places where it divides their bits together
            let bits = places(lengths.iter().copied(), index).fold(0, |bits, place| bits | place);
            new[STRIDES.partition_point(|stride| !bits.is_multiple_of(*stride))].push(index);
        }
        let mut end = 0;
        let ends = new.each_ref().map(|cells| {
            end += cells.len();
            end
        });
        let order = new.concat();
        Self { order, ends, lengths }
    }

    /// The finest level that is complete once `known` cells of the order are known.
    pub fn whole(&self, known: usize) -> Option<usize> {
        self.ends.iter().rposition(|end| known >= *end)
    }

    /// The cell that stands for cell `index` on a level: the nearest one that the level has.
    pub fn stand_in(&self, index: u64, level: usize) -> u64 {
        let stride = STRIDES[level];
        let nearest =
            places(self.lengths.iter().copied(), index).zip(&self.lengths).map(|(place, length)| {
                let last = (length - 1) / stride * stride;
                ((place + stride / 2) / stride * stride).min(last)
            });
        nearest.zip(&self.lengths).fold(0, |index, (place, length)| index * *length as u64 + place as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;

    #[test]
    fn every_cell_comes_once_and_coarse_ones_first() {
        let document = Document::load("nominal-cubic").unwrap();
        let over = ["stops.travel_limit_mm=1:3:0.1", "excitation.amplitude_g=0:1:0.1"];
        let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
        let levels = Levels::of(&grid);
        assert_eq!(levels.ends, [3 * 2, 6 * 3, 11 * 6, 21 * 11]);
        let mut sorted = levels.order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..grid.cells()));
        assert_eq!(
            [5, 6, 17, 18, 231].map(|known| levels.whole(known)),
            [None, Some(0), Some(0), Some(1), Some(3)]
        );
        for (level, end) in levels.ends.into_iter().enumerate() {
            for index in 0..grid.cells() {
                let other = levels.stand_in(index, level);
                assert!(levels.order[..end].contains(&other));
                assert_eq!(levels.stand_in(other, level), other);
            }
        }
        // the nearest one: of 21 values place 12 is half way between 8 and 16, place 20 has nothing above 16
        assert_eq!(
            [11 * 11, 12 * 11, 20 * 11 + 10].map(|i| levels.stand_in(i, 0)),
            [8 * 11, 16 * 11, 16 * 11 + 8]
        );
    }
}
