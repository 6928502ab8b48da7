//! Motions with a closed form.
//!
//! They are computed in double-double arithmetic (some 31 digits) from the very doubles that a model holds,
//! so that an answer's own rounding is no part of any error measured against it. Only those for a corner are
//! in doubles.

mod ball;
mod corner;
mod coupled;
mod elementary;
mod oscillator;
mod pressed;
mod well;

pub use ball::{first_hit, impact_time, rest_time};
pub use corner::Corner;
pub use coupled::Coupled;
pub use elementary::{elliptic_k, exp, sin_cos, sine_turns};
pub use oscillator::{Forcing, Oscillator};
pub use pressed::Pressed;
pub use well::UnitWell;

use crate::numeric::DoubleDouble;

/// Shorthand for a double made a double-double.
pub(crate) fn dd(value: f64) -> DoubleDouble {
    crate::numeric::Number::of(value)
}
