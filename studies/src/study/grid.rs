//! Cells of a sweep: the product of its axes, the first the slowest; their order from coarse to fine.

use super::Table;
use crate::scene::{Axis, Scene, column_names};

/// Largest number of cells of one sweep: a day on one core at 1 ms per cell.
pub const MAX_CELLS: u64 = 100_000_000;

/// Why a sweep has no cells to run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// No axis at all.
    #[error("there is nothing to sweep: the scene has no `sweep`; name a field, as FIELD=FROM:TO:STEP")]
    NoAxes,
    /// More cells than [`MAX_CELLS`].
    #[error("the sweep has {0} cells; at most {MAX_CELLS} fit in one: take longer steps or shorter ranges")]
    TooMany(String),
}

/// The axes of a sweep; a cell has an index, from which its place on each axis follows.
///
/// The last axis changes fastest. A question makes it from its fields;
/// [`Simulation::grid`](crate::questions::Simulation::grid) makes it for a picture. A grid has at most 1e8
/// cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    axes: Vec<Axis>,
    columns: Vec<String>,
    cells: u64,
}

pub(crate) fn is_of_mechanism(field: &str) -> bool {
    field.split('.').next() == Some("mechanism")
}

/// The name of a field, the last part of its path.
pub(crate) fn name_of(field: &str) -> &str {
    field.rsplit('.').next().unwrap_or(field)
}

impl Grid {
    /// The grid on these axes, each of which has values; an error where it has no or too many cells.
    pub fn new(axes: Vec<Axis>) -> Result<Self, GridError> {
        let cells = count(axes.iter().map(|axis| axis.values.len() as u64))?;
        let fields: Vec<&str> = axes.iter().map(|axis| axis.field.as_str()).collect();
        Ok(Self { columns: column_names(&fields), axes, cells })
    }

    /// The grid without axes, whose one cell is the scene as it is.
    pub fn of_one() -> Self {
        Self { axes: Vec::new(), columns: Vec::new(), cells: 1 }
    }

    /// The axes, slowest first.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The names of the swept columns, slowest first.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The number of cells.
    pub fn cells(&self) -> u64 {
        self.cells
    }

    /// The place of cell `index` on each axis.
    fn places(&self, index: u64) -> impl Iterator<Item = usize> + Clone {
        places(self.axes.iter().map(|axis| axis.values.len()), index)
    }

    /// The values of cell `index`, in the order of the axes.
    pub fn values(&self, index: u64) -> impl Iterator<Item = f64> + Clone {
        self.axes.iter().zip(self.places(index)).map(|(axis, place)| axis.values[place])
    }

    /// The columns of the swept fields, a row for each of these cells.
    pub(super) fn table<I: Iterator<Item = u64>>(&self, cells: impl Fn() -> I) -> Table {
        let value = |place: usize| move |index: u64| self.values(index).nth(place);
        let columns = self.columns.iter().enumerate();
        columns
            .fold(Table::new(), |table, (place, name)| table.with(name, cells().map(value(place)).collect()))
    }

    /// Sets the fields of a scene to the values of cell `index`, without allocation.
    pub fn apply(&self, index: u64, scene: &mut Scene) {
        self.axes.iter().zip(self.places(index)).for_each(|(axis, place)| axis.apply(scene, place));
    }

    /// Whether the cells have different mechanisms.
    #[doc(hidden)]
    pub fn changes_mechanism(&self) -> bool {
        self.axes.iter().any(|axis| is_of_mechanism(&axis.field))
    }

    /// The number of different mechanisms among the cells.
    #[doc(hidden)]
    pub fn mechanisms(&self) -> u64 {
        let axes = self.axes.iter().filter(|axis| is_of_mechanism(&axis.field));
        axes.map(|axis| axis.values.len() as u64).product()
    }

    /// Which of the [`mechanisms`](Self::mechanisms) cell `index` has.
    #[doc(hidden)]
    pub fn mechanism(&self, index: u64) -> u64 {
        let places =
            self.axes.iter().zip(self.places(index)).filter(|(axis, _)| is_of_mechanism(&axis.field));
        places.fold(0, |number, (axis, place)| number * axis.values.len() as u64 + place as u64)
    }

    /// Description of cell `index`: `travel_limit_mm = 0.5, amplitude_g = 0.02`.
    pub fn describe(&self, index: u64) -> String {
        let parts = self.columns.iter().zip(self.values(index));
        let parts: Vec<String> = parts.map(|(column, value)| format!("{column} = {value}")).collect();
        parts.join(", ")
    }
}

/// The place of cell `index` on each axis of a grid with axes of these lengths, the slowest first.
pub(crate) fn places<L>(lengths: L, index: u64) -> impl Iterator<Item = usize> + Clone
where
    L: Iterator<Item = usize> + Clone,
{
    let mut below: u64 = lengths.clone().map(|length| length as u64).product();
    lengths.map(move |length| {
        below /= length as u64;
        (index / below % length as u64) as usize
    })
}

fn count(lengths: impl Iterator<Item = u64> + Clone) -> Result<u64, GridError> {
    let exact = lengths.clone().try_fold(1_u64, u64::checked_mul);
    match exact {
        _ if lengths.clone().next().is_none() => Err(GridError::NoAxes),
        Some(cells) if cells <= MAX_CELLS => Ok(cells),
        Some(cells) => Err(GridError::TooMany(cells.to_string())),
        None => {
            let about: f64 = lengths.map(|n| n as f64).product();
            Err(GridError::TooMany(format!("about {about:.3e}")))
        }
    }
}

/// The strides of the levels, from coarse to fine: powers of two, the last one 1.
pub const STRIDES: [usize; 4] = [8, 4, 2, 1];

/// The cells of a grid, coarse first: every eighth value of each axis, then every fourth, every second, every
/// one. The cells of a level are among those of the next, so nothing is run twice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Levels {
    /// Every cell once, those of a coarser level before those that a finer one adds.
    pub order: Vec<u64>,
    /// Number of cells of the order that make up each level.
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
            // a power of two divides all places if it divides their bitwise or
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

    fn grid(over: &[&str]) -> Grid {
        let document = Document::load("nominal-cubic").unwrap();
        Grid::new(document.axes(over).unwrap()).unwrap()
    }

    #[test]
    fn every_cell_comes_once_and_coarse_ones_first() {
        let grid = grid(&["stops.travel_limit_mm=1:3:0.1", "excitation.amplitude_g=0:1:0.1"]);
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
