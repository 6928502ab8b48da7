//! Mathematics without mechanics: number types, roots, fits, sums, decimals.
//!
//! This module has what must be exact to rounding or have the same bits on every processor:
//! [`PolynomialRoots`] (the sign changes in a step, without allocation; Lane and Riesenfeld 1981) and
//! [`real_roots`] (all roots, for setup), [`DoubleDouble`] (about 31 digits; Dekker 1971), [`Dual`]
//! (derivatives; Clifford 1873), [`Lanes`] (several numbers by the same instructions), [`GaussLegendre`],
//! [`CompensatedSum`] (Neumaier 1974), [`Decimal`] (numbers as a person writes them), and for measured data
//! [`Periodogram`], [`Envelope`], [`orthogonal`] and [`regression`]. Sines, exponentials, powers and
//! logarithms are those of [`elementary`] everywhere in the kernel and the studies.
//!
//! Numbers have no unit here, or the unit of the caller. Functions state their preconditions instead of
//! returning errors; where there may be no answer they return an `Option`.
//!
//! ```
//! # use interwell_kernel as interwell;
//! use interwell::numeric::PolynomialRoots;
//!
//! // (s - 1/4)(s - 1/2) changes sign twice in (0, 1].
//! let coefficients = [0.125_f64, -0.75, 1.0];
//! let roots = PolynomialRoots::new(&coefficients);
//! assert_eq!(roots.count_sign_changes(), 2);
//! assert!((roots.first().unwrap() - 0.25).abs() < 1e-12);
//! ```

mod bisect;
mod collocation;
mod correlation;
mod decimal;
mod double_double;
mod dual;
pub mod elementary;
mod envelope;
mod exponential;
pub mod fit;
mod fourier;
mod lanes;
mod normal;
pub mod orthogonal;
mod periodogram;
#[doc(hidden)]
pub mod pieces;
mod quadrature;
pub mod real_roots;
pub mod regression;
mod roots;
#[doc(hidden)]
pub mod round;
mod scalar;
mod shift;
pub(crate) mod single_root;
mod sum;
mod survival;
mod text;
mod turns;

pub use bisect::{bisect, golden_section};
pub(crate) use collocation::{Collocation, GROUP, MAX_GROUPS, Values};
pub use correlation::{Alignment, alignment};
pub use decimal::{Decimal, Ratio, greatest_common_divisor};
pub use double_double::DoubleDouble;
pub use dual::Dual;
pub use envelope::{Envelope, MIN_TURNS, TurningPoint};
pub(crate) use exponential::{decay, fast_exp2, fast_log2};
pub use fourier::TrigonometricPolynomial;
pub use lanes::Lanes;
pub(crate) use lanes::widest;
pub use normal::{normal_probability, normal_quantile};
pub use periodogram::{Periodogram, Taper, periodogram};
pub use quadrature::{GaussLegendre, MAX_POINTS, even_half};
pub use roots::{MAX_DEGREE, PolynomialRoots};
pub use scalar::{Number, Scalar};
pub(crate) use shift::shift;
pub use sum::CompensatedSum;
pub use survival::{QuantileRanks, Rate, Waiting, median};
pub use text::{
    Ending, decimals, is_obeyed, number_text, one_line, push_number, rounded, short, significant, visible,
};
pub use turns::{Turn, extent, turns};

/// The coefficients of the polynomial `factor` times (x - root) for each root.
#[cfg(test)]
fn times_roots(factor: &[f64], roots: &[f64]) -> Vec<f64> {
    roots.iter().fold(factor.to_vec(), |g, root| {
        let mut next = vec![0.0; g.len() + 1];
        for (k, c) in g.iter().enumerate() {
            next[k] -= root * c;
            next[k + 1] += c;
        }
        next
    })
}

/// Numbers from 0 to 1, the same in every test.
#[cfg(test)]
pub(crate) fn random() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}
