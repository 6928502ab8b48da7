//! How accurate is the run of one scene, and what does its accuracy cost?
//!
//! Three questions, each a function of a model: what the error of its run is and up to when its path can be trusted
//! ([`trust`]); what every digit costs ([`tolerances`]); and what a fixed step makes of it, as a game or a small applet
//! would take ([`step_size`]). Nothing here needs an exact answer: the error is the change against a run that is more
//! accurate by far.

mod arrivals;
mod beside;
mod step_size;
mod tables;
mod tolerances;
mod trust;
mod words;

pub use arrivals::Lateness;
pub use step_size::{StepSize, TRUE_TOLERANCE, Unfit, step_size};
pub use tables::scene_table;
pub use tolerances::{AtTolerance, TOLERANCES, Tolerances, tolerances};
pub use trust::{Course, Trust, trust};
pub use words::{duration, length_mm, small_length};

use crate::dynamics::Model;

/// A path is trusted until it is off by this share of the motion's travel: less than is seen in a plot.
pub const TRUSTED_SHARE: f64 = 0.01;

/// The most periods of the drive (or, without one, of the motion's own pace) that are compared with a run that is a hundred
/// times as slow: chaos has eaten all digits by then, and a motion with a rhythm has been seen often enough.
const MOST_PERIODS: f64 = 60.0;

/// The model run at another tolerance.
fn at_tolerance(model: &Model, tolerance: f64) -> Model {
    let mut model = model.clone();
    model.tolerance = tolerance;
    model
}

/// The model with its run cut to the periods that are compared, and the settled window cut to its second half where it
/// would begin later. A shorter run is left as it is.
fn shortened(model: &Model) -> Model {
    let mut model = model.clone();
    let most = MOST_PERIODS * model.pace();
    if model.duration > most {
        model.duration = most;
        model.settle = model.settle.min(0.5 * most);
    }
    model
}
