//! Best design for an environment: the place in some fields at which a result is largest.
//!
//! Results of a mass with stops over a design have cliffs (one step further out the mass rests) and windows
//! (values that do between values that do not), so nothing is followed by its slope. The whole range is
//! scanned first, coarsely and then finely; around each of the best places the scan is repeated in an ever
//! smaller box. What lies between two places of the scan and is narrower than its step may be missed.

mod design;
mod evaluate;
mod search;
mod varied;

use super::Task;
use crate::system::threads::Pool;

pub use design::{
    BestDesign, BestQuestion, Constraint, DesignRange, Environment, INTERVALS, MOST_FIELDS, NoBest, Optimum,
    Spread, Variation,
};
use evaluate::Evaluator;
pub use varied::SAMPLES;

/// Searches for the best design. `preview` gets the best place of the coarse scan, and the best place when it
/// is found, before margins and samples. The result is the same for any number of threads.
pub fn best(
    question: &BestQuestion,
    pool: &Pool,
    task: &Task,
    preview: &mut dyn FnMut(&Optimum),
) -> Result<BestDesign, NoBest> {
    let evaluator = Evaluator::new(question, pool, task)?;
    let found = search::search(&evaluator, preview)?;
    let margins = search::margins(&evaluator, &found)?;
    let (spread, stepped_back) = varied::robust(&evaluator, &found, &margins)?;
    let border = |(range, at): (&DesignRange, &f64)| *at <= range.low || *at >= range.high;
    Ok(BestDesign {
        at_border: evaluator.over.iter().zip(&found.optimum.at).map(border).collect(),
        resolution: evaluator.over.iter().map(search::resolution).collect(),
        optimum: found.optimum,
        flat: found.flat,
        margins,
        spread,
        stepped_back,
    })
}

/// Number of runs of the scan of the whole range.
pub fn scan_runs(question: &BestQuestion) -> u64 {
    let places: u64 = question.over.iter().map(|range| range.intervals as u64 + 1).product();
    places * question.environments.len() as u64
}
