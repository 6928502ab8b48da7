//! Least-squares polynomials of several degrees through samples, with the errors of their values and slopes.
//!
//! [`Orthogonal::fit`] takes as many places, in ascending order, as values, in any units; it does not fail.
//! Of n samples only the polynomials with 1 to n coefficients exist, at most [`MAX_TERMS`]. A variance is
//! to be multiplied by that of the samples.

/// Largest number of coefficients.
pub const MAX_TERMS: usize = 7;

/// Least-squares polynomials with up to [`MAX_TERMS`] coefficients.
///
/// Method: a sum of polynomials orthonormal over the samples (Forsythe 1957), whose coefficients are
/// independent. If the errors of the samples have variance 1, so has each coefficient; dropping the last
/// coefficients gives the fit of a lower degree.
#[derive(Debug, Clone)]
pub struct Orthogonal {
    centre: f64,
    scale: f64,
    /// Coefficients of the recurrence b p_next = (u - a) p - b_before p_before, which begins with `first`.
    a: [f64; MAX_TERMS],
    b: [f64; MAX_TERMS],
    first: f64,
    coefficients: [f64; MAX_TERMS],
    squared_residuals: [f64; MAX_TERMS],
    terms: usize,
    samples: usize,
}

/// Value and derivatives of a polynomial at one position. The variances hold for samples whose errors have
/// variance 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tangent {
    /// The value.
    pub value: f64,
    /// The first derivative.
    pub slope: f64,
    /// The second derivative.
    pub bend: f64,
    /// Variance of the value.
    pub value_variance: f64,
    /// Variance of the slope.
    pub slope_variance: f64,
    /// Covariance of value and slope.
    pub covariance: f64,
}

impl Orthogonal {
    /// Fits `values` at ascending `places`.
    pub fn fit(places: &[f64], values: &[f64]) -> Self {
        let samples = places.len();
        let (from, to) = (places.first().map_or(0.0, |x| *x), places.last().map_or(0.0, |x| *x));
        let (centre, scale) = (0.5 * (from + to), (0.5 * (to - from)).max(f64::MIN_POSITIVE));
        let first = 1.0 / (samples as f64).sqrt();
        let zero = [0.0; MAX_TERMS];
        let (mut a, mut b, mut coefficients, mut squared_residuals) = (zero, zero, zero, zero);
        let places: Vec<f64> = places.iter().map(|x| (x - centre) / scale).collect();
        let mut rest = values.to_vec();
        let (mut now, mut before) = (vec![first; samples], vec![0.0; samples]);
        let terms = MAX_TERMS.min(samples);
        for k in 0..terms {
            coefficients[k] = now.iter().zip(&rest).map(|(p, r)| p * r).sum();
            rest.iter_mut().zip(&now).for_each(|(r, p)| *r -= coefficients[k] * p);
            squared_residuals[k] = rest.iter().map(|r| r * r).sum();
            a[k] = places.iter().zip(&now).map(|(u, p)| u * p * p).sum();
            let before_b = if k == 0 { 0.0 } else { b[k - 1] };
            for ((u, p), q) in places.iter().zip(&mut now).zip(&mut before) {
                (*p, *q) = ((u - a[k]) * *p - before_b * *q, *p);
            }
            b[k] = now.iter().map(|p| p * p).sum::<f64>().sqrt();
            now.iter_mut().for_each(|p| *p /= b[k]);
        }
        Self { centre, scale, a, b, first, coefficients, squared_residuals, terms, samples }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The sum of the squared residuals of the polynomial with `terms` coefficients; `None` if there
    /// are fewer samples.
    pub fn squared_residuals(&self, terms: usize) -> Option<f64> {
        (1..=self.terms).contains(&terms).then(|| self.squared_residuals[terms - 1])
    }

    /// The polynomial with `terms` coefficients, at most the number of samples, at `place`.
    pub fn at(&self, place: f64, terms: usize) -> Tangent {
        let u = (place - self.centre) / self.scale;
        let mut tangent = Tangent::default();
        // value and two derivatives of the current polynomial and of the previous one
        let (mut p, mut before) = ([self.first, 0.0, 0.0], [0.0; 3]);
        for k in 0..terms.min(self.terms) {
            let c = self.coefficients[k];
            tangent.value += c * p[0];
            tangent.slope += c * p[1] / self.scale;
            tangent.bend += c * p[2] / self.scale.powi(2);
            tangent.value_variance += p[0] * p[0];
            tangent.slope_variance += (p[1] / self.scale).powi(2);
            tangent.covariance += p[0] * p[1] / self.scale;
            let (shift, below) = (u - self.a[k], if k == 0 { 0.0 } else { self.b[k - 1] });
            let next = [
                shift * p[0] - below * before[0],
                shift * p[1] + p[0] - below * before[1],
                shift * p[2] + 2.0 * p[1] - below * before[2],
            ];
            (p, before) = (next.map(|value| value / self.b[k]), p);
        }
        tangent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::regression::{least_squares, powers};

    #[test]
    fn value_slope_and_errors_are_those_of_the_normal_equations() {
        let places: Vec<f64> = (0..23).map(|i| 3.0 + 0.01 * f64::from(i) + 1e-3 * f64::from(i % 3)).collect();
        let values: Vec<f64> = places.iter().map(|x| (7.0 * x).sin() + 0.01 * (900.0 * x).cos()).collect();
        let fit = Orthogonal::fit(&places, &values);
        let (at, scale) = (2.97, 0.1);
        let rows: Vec<([f64; 4], f64)> =
            places.iter().zip(&values).map(|(x, y)| (powers((x - at) / scale), *y)).collect();
        let exact = least_squares(&rows).unwrap();
        let variance = fit.squared_residuals(4).unwrap() / exact.freedom as f64;
        let found = fit.at(at, 4);
        let pairs = [
            (found.value, exact.coefficients[0]),
            (found.slope * scale, exact.coefficients[1]),
            (found.bend * scale * scale, 2.0 * exact.coefficients[2]),
            (found.value_variance * variance, exact.covariance[(0, 0)]),
            (found.covariance * scale * variance, exact.covariance[(0, 1)]),
            (found.slope_variance * scale * scale * variance, exact.covariance[(1, 1)]),
        ];
        for (found, exact) in pairs {
            assert!((found - exact).abs() < 1e-10 * exact.abs(), "{found} for {exact}");
        }
    }

    #[test]
    fn as_many_terms_as_samples_leave_no_residual() {
        let fit = Orthogonal::fit(&[0.0, 1.0, 2.0, 4.0], &[1.0, -1.0, 3.0, 2.0]);
        assert!(fit.squared_residuals(4).unwrap() < 1e-28 && fit.squared_residuals(5).is_none());
        assert!((fit.at(2.0, 4).value - 3.0).abs() < 1e-13);
        assert!((fit.at(2.0, 4).value_variance - 1.0).abs() < 1e-13);
    }
}
