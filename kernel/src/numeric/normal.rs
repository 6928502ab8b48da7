//! The standard normal distribution: mean 0, standard deviation 1.

use std::f64::consts::SQRT_2;

use statrs::function::erf::{erfc, erfc_inv};

/// The probability that a standard normal number is at most `x`.
pub fn normal_probability(x: f64) -> f64 {
    0.5 * erfc(-x / SQRT_2)
}

/// The number that a standard normal number is at most with this probability: the inverse of
/// [`normal_probability`]. Precondition: `probability` lies strictly between 0 and 1.
pub fn normal_quantile(probability: f64) -> f64 {
    -SQRT_2 * erfc_inv(2.0 * probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The probability by the Taylor series of its density about 0, whose terms are all positive (Marsaglia
    /// 2004, "Evaluating the normal distribution").
    fn series(x: f64) -> f64 {
        let (mut term, mut sum) = (x, x);
        for odd in (3..400).step_by(2) {
            term *= x * x / f64::from(odd);
            sum += term;
        }
        0.5 + sum * (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt()
    }

    #[test]
    fn probability_and_quantile_are_those_of_the_series() {
        for i in -600..=600 {
            let x = f64::from(i) / 100.0;
            let exact = series(x);
            assert!((normal_probability(x) - exact).abs() < 1e-15, "{x}");
            if (1e-6..=1.0 - 1e-6).contains(&exact) {
                // an error of the probability is divided by the density, at least 4e-6 here
                assert!((normal_quantile(exact) - x).abs() < 1e-9, "{x}: {}", normal_quantile(exact));
            }
        }
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
        assert_eq!(normal_quantile(0.5), 0.0);
    }
}
