//! Points of a force curve, read from CSV.
//!
//! Nothing is repaired silently: what cannot be meant is refused with its line and value; a table from right
//! to left is read as the same curve from left to right.

use crate::scene::{ColumnsError, read_columns};

/// The fewest points a table may have: below, a corner and a bend look the same.
pub const FEWEST_POINTS: usize = 4;

/// The most points a table may have; fitting takes some seconds there.
pub const MOST_POINTS: usize = 100_000;

const X: &str = "x_m";
const FORCE: &str = "force_n";

/// The points of a force curve.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceTable {
    /// Positions in m, strictly increasing.
    pub x: Vec<f64>,
    /// Forces dV/dx in N, one for each position.
    pub force: Vec<f64>,
}

/// What is wrong with the text of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The columns cannot be read.
    #[error(transparent)]
    Columns(#[from] ColumnsError),
    /// Fewer points than a curve needs.
    #[error("has {0} rows of numbers; a force curve needs at least {FEWEST_POINTS}")]
    TooFew(usize),
    /// A position that is there twice.
    #[error("line {line}: {X} = {x:e} is there twice; each position needs one force")]
    Repeated {
        /// Line of the second of the two.
        line: usize,
        /// The position.
        x: f64,
    },
    /// Positions that go up and down.
    #[error(
        "line {line}: {X} = {x:e} turns back after {before:e}; positions must run in one direction (sort the \
         rows; of a hysteresis loop keep one branch)"
    )]
    TurnsBack {
        /// Line of the first row against the direction.
        line: usize,
        /// Its position.
        x: f64,
        /// The position before it.
        before: f64,
    },
}

impl ForceTable {
    /// Reads the text of a CSV table; rows from right to left are reversed.
    ///
    /// Guarantee: at least [`FEWEST_POINTS`] finite points with strictly increasing `x`.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let columns = read_columns(text, [X, FORCE], MOST_POINTS, true)?;
        let (mut x, mut force): (Vec<f64>, Vec<f64>) =
            columns.rows.iter().map(|row| (row[0], row[1])).unzip();
        if x.len() < FEWEST_POINTS {
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

    /// Remarks about values that are possible but unlikely, each a sentence.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        if last - first > 1.0 {
            warnings.push(format!(
                "{X} runs from {first} m to {last} m: if these are millimetres, divide the column by 1000"
            ));
        }
        warnings
    }
}
