//! The standard normal distribution: mean 0, standard deviation 1.

use std::f64::consts::{SQRT_2, TAU};

use statrs::function::erf::erfc_inv;

use super::elementary;

/// Distance from 0 beyond which the probability differs from 0 or 1 by less than a rounding of 1.
const FAR: f64 = 8.5;

/// The probability that a standard normal number is at most `x`, with an error below 1e-15.
///
/// Method: the Taylor series of the distribution over its density, whose terms have one sign (Marsaglia 2004,
/// "Evaluating the normal distribution"). `erfc` of statrs is accurate only to 1e-9.
pub fn normal_probability(x: f64) -> f64 {
    if x.abs() > FAR {
        return if x > 0.0 { 1.0 } else { 0.0 };
    }
    let (mut term, mut sum, mut odd) = (x, x, 1.0);
    while term.abs() > f64::EPSILON * sum.abs() {
        odd += 2.0;
        term *= x * x / odd;
        sum += term;
    }
    0.5 + sum * elementary::exp(-0.5 * x * x) / TAU.sqrt()
}

/// The number that a standard normal number is at most with this probability: the inverse of
/// [`normal_probability`]. Precondition: `probability` lies strictly between 0 and 1.
pub fn normal_quantile(probability: f64) -> f64 {
    -SQRT_2 * erfc_inv(2.0 * probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_those_of_the_tables() {
        for (x, probability) in [
            (-2.0, 0.022_750_131_948_179_2),
            (0.0, 0.5),
            (0.5, 0.691_462_461_274_013),
            (1.0, 0.841_344_746_068_543),
            (1.959_963_984_540_054, 0.975),
            (3.0, 0.998_650_101_968_37),
            (40.0, 1.0),
            (f64::NEG_INFINITY, 0.0),
        ] {
            assert!((normal_probability(x) - probability).abs() < 1e-15, "{x}: {}", normal_probability(x));
        }
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
        assert_eq!(normal_quantile(0.5), 0.0);
    }

    #[test]
    fn the_quantile_is_the_inverse_of_the_probability() {
        for i in -500..=500 {
            let x = f64::from(i) / 100.0;
            // an error of the probability is divided by the density
            let density = (-0.5 * x * x).exp() / TAU.sqrt();
            let error = (normal_quantile(normal_probability(x)) - x).abs();
            assert!(error < 1e-15 * (2.0 + x.abs()) + 1e-15 / density, "{x}: {error:e}");
        }
    }
}
