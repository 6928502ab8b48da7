//! Mathematics without mechanics: number types, roots, fits, sums, decimals.

mod bisect;
mod correlation;
mod decimal;
mod double_double;
mod dual;
pub mod fit;
mod lanes;
mod number;
mod periodogram;
mod quadrature;
mod quick;
mod ratio;
pub mod real_roots;
pub mod regression;
mod roots;
pub mod round;
mod scalar;
mod short;
mod sum;

pub use bisect::bisect;
pub use correlation::{Alignment, alignment};
pub use decimal::Decimal;
pub use double_double::DoubleDouble;
pub use dual::Dual;
pub use lanes::Lanes;
pub use number::Number;
pub use periodogram::{Periodogram, Taper, periodogram};
pub use quadrature::{GaussLegendre, MOST_POINTS, even_half};
pub(crate) use quick::{fast_exp2, fast_log2};
pub use ratio::Ratio;
pub(crate) use ratio::greatest_common_divisor;
pub use roots::{MAX_DEGREE, PolynomialRoots};
pub use scalar::Scalar;
pub use short::{decimals, short};
pub use sum::CompensatedSum;
