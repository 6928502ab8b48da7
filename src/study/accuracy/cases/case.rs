//! A hard case: a problem, its answer and its conditioning.

use crate::study::Task;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::measure::{Bench, Variant};

/// A problem, its answer and its conditioning.
pub struct HardCase {
    /// The word that selects it.
    pub name: &'static str,
    /// What is run.
    pub problem: &'static str,
    /// What the right answer is and how it is known.
    pub answer: &'static str,
    /// The conditioning, from which the allowed errors follow.
    pub conditioning: &'static str,
    pub(super) find: fn(&Bench) -> Result<Vec<Variant>, Stopped>,
}

impl HardCase {
    /// Runs the case. Reports no progress within the case; stops soon after cancellation.
    pub fn find(&self, task: &Task) -> Result<Vec<Variant>, Stopped> {
        (self.find)(&Bench::new(task))
    }
}

impl std::fmt::Debug for HardCase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HardCase").field("name", &self.name).finish_non_exhaustive()
    }
}
