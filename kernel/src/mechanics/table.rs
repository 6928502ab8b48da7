//! Points of a force curve, read from CSV.
//!
//! Nothing is repaired silently: an invalid row is rejected with its line and value. A table from right to
//! left is reversed and gives the same curve.

use crate::scene::{ColumnsError, read_columns};

/// Smallest number of points in a table: with fewer, a corner cannot be distinguished from a bend.
pub const MIN_POINTS: usize = 4;

/// Largest number of points in a table; fitting that many takes a few seconds.
pub const MAX_POINTS: usize = 100_000;

const X: &str = "x_m";
const FORCE: &str = "force_n";

/// The points of a measured or computed force; [`fit()`](super::fit()) makes a curve of them.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceTable {
    /// Positions in m, strictly increasing.
    pub x: Vec<f64>,
    /// Forces dV/dx in N, one for each position.
    pub force: Vec<f64>,
}

/// Error in the text of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The columns cannot be read.
    #[error(transparent)]
    Columns(#[from] ColumnsError),
    /// Fewer points than a curve needs.
    #[error("has {0} rows of numbers; a force curve needs at least {MIN_POINTS}")]
    TooFew(usize),
    /// A position that occurs twice.
    #[error("line {line}: {X} = {x:e} is there twice; each position needs one force")]
    Repeated {
        /// Line of the second of the two.
        line: usize,
        /// The position.
        x: f64,
    },
    /// Positions that are not monotone.
    #[error(
        "line {line}: {X} = {x:e} turns back after {before:e}; positions must run in one direction (sort the \
         rows; of a hysteresis loop keep one branch)"
    )]
    TurnsBack {
        /// Line of the first row that reverses the direction.
        line: usize,
        /// Position in that row.
        x: f64,
        /// Position in the row before it.
        before: f64,
    },
}

impl ForceTable {
    /// Parses a CSV table; rows from right to left are reversed.
    ///
    /// Guarantee: at least [`MIN_POINTS`] finite points with strictly increasing `x`.
    ///
    /// # Errors
    ///
    /// For a text without the columns `x_m,force_n`, a value that is no finite number, a position that occurs
    /// twice or turns back, and a number of points out of [`MIN_POINTS`] to [`MAX_POINTS`].
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let columns = read_columns(text, [X, FORCE], MAX_POINTS, true)?;
        let (mut x, mut force): (Vec<f64>, Vec<f64>) =
            columns.rows.iter().map(|row| (row[0], row[1])).unzip();
        if x.len() < MIN_POINTS {
            return Err(TableError::TooFew(x.len()));
        }
        let falling = x[1] < x[0];
        for (i, pair) in x.windows(2).enumerate() {
            let (before, x, line) = (pair[0], pair[1], columns.lines[i + 1]);
            if before == x {
                return Err(TableError::Repeated { line, x });
            }
            if (x < before) != falling {
                return Err(TableError::TurnsBack { line, x, before });
            }
        }
        if falling {
            x.reverse();
            force.reverse();
        }
        Ok(Self { x, force })
    }

    /// Warnings about values that are possible but unlikely, each a sentence.
    pub fn warnings(&self) -> Vec<String> {
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        let warning = format!(
            "{X} runs from {first} m to {last} m: if these are millimetres, divide the column by 1000"
        );
        if last - first > 1.0 { vec![warning] } else { Vec::new() }
    }
}
