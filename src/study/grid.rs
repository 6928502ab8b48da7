//! Which cells does a sweep have? The product of its axes, the first one slowest.

use crate::scene::{FieldPath, Scene};

/// The largest number of cells of one sweep: at a thousandth of a second each, a day of one core.
pub const MAX_CELLS: u64 = 100_000_000;

/// Why a sweep has no cells to run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// No axis at all.
    #[error("there is nothing to sweep: the scene has no `sweep`; name fields with --over FIELD=FROM:TO:STEP")]
    NoAxes,
    /// An axis without values.
    #[error("the axis {0} has no values")]
    Empty(String),
    /// More cells than [`MAX_CELLS`].
    #[error("the sweep has {0} cells; at most {MAX_CELLS} fit in one: take longer steps or shorter ranges")]
    TooMany(String),
    /// Two axes over one field.
    #[error("the field {0} is swept twice; name it once")]
    Twice(String),
}

/// One swept field and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Dotted path of the field.
    pub path: String,
    /// Name of its column.
    pub column: String,
    /// Values in the field's own unit, in the order of the rows.
    pub values: Vec<f64>,
    field: FieldPath,
}

impl Axis {
    /// An axis over the field at `path`, named `column` in the table.
    pub fn new(path: &str, column: &str, values: Vec<f64>) -> Self {
        Self { path: path.into(), column: column.into(), values, field: FieldPath::new(path) }
    }

    /// Whether another value means another mechanism.
    fn changes_mechanism(&self) -> bool {
        self.path.starts_with("mechanism.")
    }
}

/// The axes and how a cell's index divides among them.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    axes: Vec<Axis>,
    cells: u64,
}

impl Grid {
    /// The number of cells on axes of these lengths, where one sweep takes as many. Ask this before
    /// the values are made: a range may name more of them than there is memory.
    pub fn count(lengths: &[u64]) -> Result<u64, GridError> {
        let exact = lengths.iter().try_fold(1_u64, |product, n| product.checked_mul(*n));
        match exact {
            _ if lengths.is_empty() => Err(GridError::NoAxes),
            Some(cells) if cells <= MAX_CELLS => Ok(cells),
            Some(cells) => Err(GridError::TooMany(cells.to_string())),
            None => {
                let about: f64 = lengths.iter().map(|n| *n as f64).product();
                Err(GridError::TooMany(format!("about {about:.3e}")))
            }
        }
    }

    /// The grid on these axes.
    pub fn new(axes: Vec<Axis>) -> Result<Self, GridError> {
        let lengths: Vec<u64> = axes.iter().map(|axis| axis.values.len() as u64).collect();
        let cells = Self::count(&lengths)?;
        if let Some(axis) = axes.iter().find(|axis| axis.values.is_empty()) {
            return Err(GridError::Empty(axis.path.clone()));
        }
        let twice = (1..axes.len()).find(|i| axes[..*i].iter().any(|axis| axis.path == axes[*i].path));
        match twice {
            Some(i) => Err(GridError::Twice(axes[i].path.clone())),
            None => Ok(Self { axes, cells }),
        }
    }

    /// The axes, slowest first.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The number of cells.
    pub fn cells(&self) -> u64 {
        self.cells
    }

    /// The values of cell `index`, in the order of the axes.
    pub fn values(&self, index: u64) -> impl Iterator<Item = f64> {
        let mut below = self.cells;
        self.axes.iter().map(move |axis| {
            below /= axis.values.len() as u64;
            axis.values[(index / below % axis.values.len() as u64) as usize]
        })
    }

    /// Puts the values of cell `index` into `scene`; false where it lacks one of the fields.
    #[must_use]
    pub fn apply(&self, index: u64, scene: &mut Scene) -> bool {
        let mut all = true;
        for (axis, value) in self.axes.iter().zip(self.values(index)) {
            all &= axis.field.set(scene, value);
        }
        all
    }

    /// The number of different mechanisms among the cells.
    pub fn mechanisms(&self) -> u64 {
        self.axes.iter().filter(|axis| axis.changes_mechanism()).map(|axis| axis.values.len() as u64).product()
    }

    /// Which of the [`mechanisms`](Self::mechanisms) cell `index` has.
    pub fn mechanism(&self, index: u64) -> u64 {
        let mut below = self.cells;
        self.axes.iter().fold(0, |number, axis| {
            let length = axis.values.len() as u64;
            below /= length;
            if axis.changes_mechanism() { number * length + index / below % length } else { number }
        })
    }

    /// Cell `index` in words: `travel_limit_mm = 0.5, amplitude_g = 0.02`.
    pub fn describe(&self, index: u64) -> String {
        let parts = self.axes.iter().zip(self.values(index));
        let parts: Vec<String> = parts.map(|(axis, value)| format!("{} = {value}", axis.column)).collect();
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        let axes = [("stops.a", 3), ("mechanism.b", 2), ("mechanism.c", 4)];
        let axes = axes.map(|(path, n)| Axis::new(path, path, (0..n).map(f64::from).collect()));
        Grid::new(axes.into()).unwrap()
    }

    #[test]
    fn the_first_axis_is_the_slowest() {
        let grid = grid();
        assert_eq!(grid.cells(), 24);
        let mut expected = Vec::new();
        for a in 0..3 {
            for b in 0..2 {
                for c in 0..4 {
                    expected.push((vec![f64::from(a), f64::from(b), f64::from(c)], b as u64 * 4 + c as u64));
                }
            }
        }
        let cell = |i| (grid.values(i).collect::<Vec<_>>(), grid.mechanism(i));
        assert_eq!((0..24).map(cell).collect::<Vec<_>>(), expected);
        assert_eq!(grid.mechanisms(), 8);
    }

    #[test]
    fn too_many_cells_are_counted() {
        assert_eq!(Grid::count(&[101, 41]), Ok(4141));
        let error = Grid::count(&[1_000_000, 1_000_000]).unwrap_err();
        assert!(error.to_string().contains("1000000000000 cells"), "{error}");
        assert!(matches!(Grid::count(&[u64::MAX, 3]), Err(GridError::TooMany(_))));
        assert_eq!(Grid::count(&[]), Err(GridError::NoAxes));
    }
}
