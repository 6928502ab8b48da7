//! Names of the axes, one for each quantity, on paper and on the screen.

use crate::study::with_unit;

/// Time.
#[doc(hidden)]
pub const TIME: &str = "time (s)";
/// Displacement of the mass, or the position of a measured force.
#[doc(hidden)]
pub const DISPLACEMENT: &str = "displacement (mm)";
/// Frequency.
#[doc(hidden)]
pub const FREQUENCY: &str = "frequency (Hz)";
/// Acceleration of the base, without its unit.
#[doc(hidden)]
pub const BASE_ACCELERATION: &str = "base acceleration";
/// Velocity of the mass, without its unit.
#[doc(hidden)]
pub const VELOCITY: &str = "velocity";
/// The force dV/dx that would hold the mass at a displacement, without its unit.
#[doc(hidden)]
pub const HOLDING_FORCE: &str = "holding force";

/// The name of an axis with its unit.
#[doc(hidden)]
pub fn axis_name(words: &str, unit: &str) -> String {
    with_unit(words.to_owned(), unit)
}
