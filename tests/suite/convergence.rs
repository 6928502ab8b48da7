//! How the error follows the tolerance, and what must not change an answer at all.

mod hard;
mod tolerance;
mod units;
mod untouched;
