//! Lyapunov exponents of a settled motion: rates in 1/s at which small changes of it grow or die away.
//!
//! Where the motion repeats they are ln|multiplier| over its period, of the periodic motion itself, which
//! Newton's method finds. Elsewhere they are averages over forcing periods (Benettin et al. 1980): a change
//! is carried along by the derivatives of the stroboscopic map, which hold through impacts (Müller 1995),
//! and is made a unit long once a period. The map of a phase plane has two; the third one of the driven
//! motion, along its own path, is 0.
//!
//! Both together have an exact value, since damping and impacts alone shrink areas:
//! -c/m + 2 ln(restitution) times the rate of impacts, of each stop. The second exponent is this sum less the
//! first, so that it keeps its digits however far they lie apart. After a rest on a stop nothing is left of a
//! change: both are minus infinity.

mod average;
mod cells;
mod orbit;
mod result;
mod settle;
mod tangent;

pub use average::average_exponents;
pub use cells::{ExponentCells, drive_fault, exponents_row};
pub use result::{Estimate, ExponentOptions, Exponents, NoExponents};
pub use settle::exponents;
