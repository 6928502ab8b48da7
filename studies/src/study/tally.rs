//! Result of a cell of a grid, its faults, and the tally of the cells.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::dynamics::{Outcome, Summary};
use crate::scene::Fault;

/// The column of the direction of a walk.
pub const DIRECTION: &str = "direction";

/// Result of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "nearly all cells are run")]
pub enum Cell {
    /// It has not been run.
    NotRun,
    /// Its mechanism is valid but was not solved.
    Unsolved,
    /// It was run.
    Run(Summary),
}

impl Cell {
    /// The summary of its run.
    pub fn summary(&self) -> Option<&Summary> {
        if let Self::Run(summary) = self { Some(summary) } else { None }
    }

    /// The word in the CSV; empty where the cell was not run.
    pub fn outcome(&self) -> &'static str {
        match self {
            Self::NotRun => "",
            Self::Unsolved => "not_converged",
            Self::Run(summary) => summary.outcome.name(),
        }
    }

    /// Whether its run reached its end.
    pub fn is_done(&self) -> bool {
        self.summary().is_some_and(|summary| summary.outcome == Outcome::Done)
    }

    /// The summary of a run that reached its settled window; in others, counts of 0 would be misleading.
    pub fn settled(&self) -> Option<&Summary> {
        self.summary().filter(|summary| summary.rms_velocity.is_some())
    }
}

/// The faults of one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellFaults {
    /// Description of the cell.
    pub cell: String,
    /// Its faults.
    pub faults: Vec<Fault>,
}

/// Why a sweep ended before its last cell; `E` is the error of the writer.
#[derive(Debug)]
pub enum SweepEnd<E> {
    /// It was cancelled.
    Cancelled,
    /// The rows could not be written.
    Write(E),
}

/// Counts of the results of the cells of a grid.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Cells that were run, including those without a solved mechanism.
    pub cells: u64,
    /// Cells whose run ended early, as their outcome says.
    pub ended_early: u64,
    /// Cells whose mechanism was not solved.
    pub not_converged: u64,
    /// Cells whose motion rests on a stop, so that all exponents are minus infinity.
    #[serde(skip)]
    pub resting: u64,
    /// Cells without exponents: ended early, touched a stop without speed, or with flexures not solved.
    #[serde(skip)]
    pub without_exponents: u64,
    /// Cells in which the contact pressure on a compliant stop exceeded the yield limit of its material.
    pub yielding: u64,
    /// Mechanisms built: one for each combination of the swept fields of the mechanism.
    #[serde(skip)]
    pub mechanisms: u64,
    /// Cells by outcome.
    pub outcomes: BTreeMap<Box<str>, u64>,
    /// Cells by regime; those that ended before their settled window, and those of one well, have none.
    pub regimes: BTreeMap<Box<str>, u64>,
}

fn add(counts: &mut BTreeMap<Box<str>, u64>, word: &str, n: u64) {
    match counts.get_mut(word) {
        Some(count) => *count += n,
        None => drop(counts.insert(word.into(), n)),
    }
}

impl Tally {
    pub(crate) fn count(&mut self, cell: &Cell) {
        self.cells += 1;
        self.ended_early += u64::from(cell.summary().is_some_and(|row| row.outcome.ended_at().is_some()));
        self.not_converged += u64::from(*cell == Cell::Unsolved);
        self.yielding += u64::from(cell.summary().is_some_and(|row| row.contact_yields));
        add(&mut self.outcomes, cell.outcome(), 1);
        if let Some(row) = cell.settled().filter(|row| !row.regime.name().is_empty()) {
            add(&mut self.regimes, row.regime.name(), 1);
        }
    }

    /// Adds the counts of `other`, except its mechanisms, which may be the same ones.
    pub fn add(&mut self, other: &Self) {
        self.cells += other.cells;
        self.ended_early += other.ended_early;
        self.not_converged += other.not_converged;
        self.resting += other.resting;
        self.without_exponents += other.without_exponents;
        self.yielding += other.yielding;
        other.outcomes.iter().for_each(|(word, n)| add(&mut self.outcomes, word, *n));
        other.regimes.iter().for_each(|(word, n)| add(&mut self.regimes, word, *n));
    }
}
