//! Classification of a run: the regime, the side of the barrier, and how the run ended.

use serde::{Deserialize, Serialize};

/// Regime of the motion over the settled window.
///
/// The verdict is that of the settled window alone: a mass that crosses during the transient and then stays
/// in one well is intrawell. Under a drive that repeats, crossings repeat if the states once a forcing period
/// do, or their own instants to a hundredth of a period.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Regime {
    /// The mass never left the stop or the equilibrium.
    Rest,
    /// The mass moved without crossing the barrier.
    Intrawell,
    /// The mass crosses, and the crossings repeat after at most 12 forcing periods.
    Interwell,
    /// The mass crosses without such a period.
    Irregular,
    /// The mass crosses under a drive without a period or with a changing amplitude, or without a drive.
    Crossing,
    /// The curve has one well or none, so there is no barrier to cross.
    OneWell,
}

impl Regime {
    /// The word in the CSV; empty for one well.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Intrawell => "intrawell",
            Self::Interwell => "interwell",
            Self::Irregular => "irregular",
            Self::Crossing => "crossing",
            Self::OneWell => "",
        }
    }
}

/// How a run ended.
///
/// An end before the duration is a result and not an error, so that a sweep goes on. Budgets of steps and
/// impacts end a run that would take far longer than others of its length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// It reached its duration.
    Done,
    /// The mass left the range of the force curve at this time in s.
    LeftTable {
        /// Time in s.
        at: f64,
    },
    /// It used up its budget of impacts.
    ImpactBudget {
        /// Time in s.
        at: f64,
        /// Impacts made.
        count: u64,
    },
    /// It used up its budget of steps.
    StepBudget {
        /// Time in s.
        at: f64,
        /// Steps made.
        count: u64,
    },
    /// A number was no longer finite.
    NotFinite {
        /// Time in s.
        at: f64,
    },
    /// It reached its duration, but its energy does not balance: by more than a hundred tolerances, or by a
    /// tenth of the energy moved. Only for a run with a ledger.
    Inaccurate {
        /// The unaccounted energy over the sum of the magnitudes of the terms.
        residual: f64,
    },
    /// It was cancelled.
    Cancelled {
        /// Time in s.
        at: f64,
    },
}

impl Outcome {
    /// All values of [`name`](Self::name).
    pub const NAMES: &[&str] =
        &["done", "left_table", "impact_budget", "step_budget", "not_finite", "inaccurate", "cancelled"];

    /// The word in the CSV and the summary.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::LeftTable { .. } => "left_table",
            Self::ImpactBudget { .. } => "impact_budget",
            Self::StepBudget { .. } => "step_budget",
            Self::NotFinite { .. } => "not_finite",
            Self::Inaccurate { .. } => "inaccurate",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    /// Time in s at which the run ended early; `None` if it reached its duration.
    pub fn ended_at(self) -> Option<f64> {
        match self {
            Self::Done | Self::Inaccurate { .. } => None,
            Self::LeftTable { at }
            | Self::ImpactBudget { at, .. }
            | Self::StepBudget { at, .. }
            | Self::NotFinite { at }
            | Self::Cancelled { at } => Some(at),
        }
    }
}

/// The side of the barrier on which a motion is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Place {
    /// Never to the right of it.
    Left,
    /// Never to the left of it.
    Right,
    /// On both sides.
    Both,
}

impl Place {
    /// The word in the CSV.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Both => "both",
        }
    }
}
