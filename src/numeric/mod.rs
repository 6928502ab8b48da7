//! Mathematics that knows no mechanics: number types, root isolation, sums, decimals.

mod decimal;
mod double_double;
mod roots;
mod scalar;
mod sum;

pub use decimal::Ratio;
pub(crate) use decimal::greatest_common_divisor;
pub use double_double::DoubleDouble;
pub use roots::{PolynomialRoots, MAX_DEGREE};
pub use scalar::{Number, Scalar};
pub use sum::CompensatedSum;
