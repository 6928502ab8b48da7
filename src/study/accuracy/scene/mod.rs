//! Accuracy of the run of one scene, and its cost.
//!
//! Three questions, each a function of a model: what the error of its run is and up to when its path can be
//! trusted ([`trust`]); what every digit costs ([`tolerances`]); and what a fixed step makes of it, as a game
//! or a small applet would take ([`step_size`]). Nothing here needs an exact answer: the error is the
//! difference from a far more accurate run.

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
pub use words::{duration, length_mm, moment, small_length, step_name};

/// A path is trusted until it is off by this share of the motion's travel: less than is seen in a plot.
pub const TRUSTED_SHARE: f64 = 0.01;
