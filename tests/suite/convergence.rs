//! The error against the tolerance, and changes that leave an answer as it is.

mod hard;
mod tolerance;
mod units;
mod untouched;
