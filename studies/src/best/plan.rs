//! Number of runs that a search for the best design has left to do.

use super::evaluate::Evaluator;
use super::{scan_places, search, varied};

/// The parts of a search, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Scan,
    Refinement,
    Margins,
    Samples,
}

/// The designs that each part has left to run: what is certain of the scan and the samples, the most that
/// there can be of the refinement and the margins.
pub(super) struct Plan<'a> {
    left: [u64; 4],
    environments: u64,
    report: &'a (dyn Fn(u64) + Sync),
}

impl<'a> Plan<'a> {
    pub fn new(evaluator: &Evaluator, report: &'a (dyn Fn(u64) + Sync)) -> Self {
        let question = evaluator.question;
        let samples = if question.vary.is_empty() { 0 } else { varied::LEAST_SAMPLES };
        let all = evaluator.over.iter().map(|range| search::outward(range, range.low, 1.0).len() as u64);
        let left = [
            scan_places(question),
            search::most_refined(&evaluator.over, search::REFINED),
            all.sum(),
            samples,
        ];
        let plan = Self { left, environments: question.environments.len() as u64, report };
        plan.say();
        plan
    }

    /// `part` has begun, and so many designs are left of it.
    pub fn is_at(&mut self, part: Part, designs: u64) {
        self.left[..part as usize].fill(0);
        self.left[part as usize] = designs;
        self.say();
    }

    fn say(&self) {
        (self.report)(self.left.iter().sum::<u64>() * self.environments);
    }
}
