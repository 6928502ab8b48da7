//! Motions with a closed form.
//!
//! They are computed in double-double arithmetic (some 31 digits) from the exact doubles that a model
//! holds, so that their rounding adds nothing to an error measured against them. Only those for a corner
//! are in doubles.

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

/// A double as a double-double.
pub(crate) fn dd(value: f64) -> DoubleDouble {
    crate::numeric::Number::of(value)
}
