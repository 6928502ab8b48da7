//! Hard cases: problems that break integrators of impacts, each with its answer and what its conditioning
//! allows.
//!
//! The texts of a case say what stands behind its code: the problem, where the answer comes from, and the
//! bound of its error. Throughout, d is the error that one step may make ([`STEP_ERROR`](super::STEP_ERROR)),
//! relative to the scene's length L and speed V, and n the number of steps. All run at the tolerance 1e-14;
//! at 1e-9 some sixty of their checks fail, so the bounds are no formality.

mod ball;
mod chatter;
mod curves;
mod drives;
mod long;
mod release;
mod scales;
mod touch;
mod well;

use super::Stopped;
use super::measure::{Bench, Variant};
use crate::study::Task;

/// A problem, its answer and its conditioning.
pub struct HardCase {
    /// The word that selects it.
    pub name: &'static str,
    /// What is run.
    pub problem: &'static str,
    /// What the right answer is and how it is known.
    pub answer: &'static str,
    /// Why so many digits are allowed.
    pub conditioning: &'static str,
    find: fn(&Bench) -> Result<Vec<Variant>, Stopped>,
}

impl HardCase {
    /// Runs the case. Progress is not told within a case; a cancelled one stops soon.
    pub fn find(&self, task: &Task) -> Result<Vec<Variant>, Stopped> {
        (self.find)(&Bench::new(task))
    }
}

impl std::fmt::Debug for HardCase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HardCase").field("name", &self.name).finish_non_exhaustive()
    }
}

/// All of them, in the order in which they are shown.
pub const HARD_CASES: &[HardCase] = &[
    well::SEPARATRIX,
    long::ELASTIC_BOX,
    ball::BOUNCING_BALL,
    ball::BUDGET,
    chatter::COMPLETE,
    chatter::INCOMPLETE,
    chatter::ENDS_WITH_THE_PRESS,
    release::THRESHOLD,
    release::ZERO_SLOPE,
    release::BIAS,
    release::PLASTIC,
    touch::GRAZING,
    touch::EXCURSION,
    touch::GAP,
    touch::COINCIDENT,
    drives::RIPPLE,
    drives::RAMP,
    drives::FAST,
    drives::SHOCK,
    drives::NOISE,
    drives::RECORD,
    curves::KINK,
    curves::STOP_ON_A_BREAK,
    curves::STOP_AT_THE_EQUILIBRIUM,
    curves::STOP_AT_THE_FORCE_MAXIMUM,
    curves::BOTH_STOPS_ON_ONE_SIDE,
    long::CHAOS,
    scales::UNITS,
];
