//! Least-squares fits with the uncertainty of their coefficients.
//!
//! A fit of N coefficients needs at least N + 1 values; otherwise, and where the values do not determine
//! it, there is `None`. Coefficients have the units of value over row. For an interval of 95 % a standard
//! error, the root of an entry on the diagonal of the covariance, is multiplied by [`student`] of
//! [`Fit::freedom`].

use nalgebra::{SMatrix, SVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::elementary;

/// Coefficients of a least-squares fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit<const N: usize> {
    /// The coefficients.
    pub coefficients: SVector<f64, N>,
    /// Their covariance: the inverse of the normal matrix times the variance of the residuals.
    pub covariance: SMatrix<f64, N, N>,
    /// The inverse of the normal matrix: the covariance of values with errors of variance 1.
    pub inverse: SMatrix<f64, N, N>,
    /// The variance of the residuals.
    pub variance: f64,
    /// Degrees of freedom of that variance: number of values less number of coefficients.
    pub freedom: usize,
}

impl<const N: usize> Fit<N> {
    /// The value of a linear form in the coefficients, and its standard error.
    pub fn form(&self, form: &SVector<f64, N>) -> (f64, f64) {
        (form.dot(&self.coefficients), (form.transpose() * self.covariance * form)[0].max(0.0).sqrt())
    }
}

/// The coefficients c that minimise sum (row . c - value)^2 over `rows`, each with its value.
///
/// Method: normal equations by Cholesky, whose condition number is the square of that of the rows, so that
/// the variable of a polynomial should lie within \[-1, 1]. The covariance assumes that the errors of the
/// values are independent and have the same variance, which is estimated from the residuals.
///
/// Returns `None` if there are no more values than coefficients, or if they do not determine the fit.
pub fn least_squares<const N: usize>(rows: &[([f64; N], f64)]) -> Option<Fit<N>> {
    let freedom = rows.len().checked_sub(N).filter(|freedom| *freedom > 0)?;
    let mut normal = SMatrix::<f64, N, N>::zeros();
    let mut right = SVector::<f64, N>::zeros();
    for (row, value) in rows {
        let row = SVector::<f64, N>::from(*row);
        normal += row * row.transpose();
        right += row * *value;
    }
    let factors = normal.cholesky()?;
    let mut coefficients = factors.solve(&right);
    let residual =
        |c: &SVector<f64, N>, (row, value): &([f64; N], f64)| value - SVector::<f64, N>::from(*row).dot(c);
    // one step of iterative refinement
    let mut rest = SVector::<f64, N>::zeros();
    rows.iter().for_each(|row| rest += SVector::<f64, N>::from(row.0) * residual(&coefficients, row));
    coefficients += factors.solve(&rest);
    let square: f64 = rows.iter().map(|row| residual(&coefficients, row).powi(2)).sum();
    let (inverse, variance) = (factors.inverse(), square / freedom as f64);
    let covariance = inverse * variance;
    let finite = coefficients.iter().chain(covariance.iter()).all(|number| number.is_finite());
    finite.then_some(Fit { coefficients, covariance, inverse, variance, freedom })
}

/// The powers 1, u, u^2, .. as a row for the fit of a polynomial.
pub fn powers<const N: usize>(u: f64) -> [f64; N] {
    std::array::from_fn(|k| elementary::powi(u, k as i32))
}

/// The half-width of a 95 % confidence interval in standard errors, if the error was estimated with `freedom`
/// degrees of freedom: the 0.975 quantile of Student's distribution.
pub fn student(freedom: usize) -> f64 {
    StudentsT::new(0.0, 1.0, freedom.max(1) as f64).map_or(f64::NAN, |law| law.inverse_cdf(0.975))
}

/// Largest number of Gauss-Newton steps.
const MAX_STEPS: usize = 60;

/// The least-squares fit of c + a q^k to `values` (k = 0, 1, ..), with coefficients in the order c, a, q.
///
/// Method: Gauss-Newton, starting with q as the ratio of successive differences and halving each step until
/// the residual falls; the covariance is that of the linearised problem. Returns `None` for fewer than four
/// values, or if the values do not determine the coefficients, as when they are constant.
pub fn geometric(values: &[f64]) -> Option<Fit<3>> {
    let differences: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let product: f64 = differences.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let square: f64 = differences.iter().rev().skip(1).map(|difference| difference * difference).sum();
    if values.len() < 4 || !(square > 0.0) {
        return None;
    }
    let first = product / square;
    // c and a follow from q by linear least squares
    let line: Vec<([f64; 2], f64)> = values
        .iter()
        .enumerate()
        .map(|(k, value)| ([1.0, elementary::powi(first, k as i32)], *value))
        .collect();
    let start = least_squares(&line)?.coefficients;
    let mut now = SVector::<f64, 3>::new(start[0], start[1], first);
    let law = |c: &SVector<f64, 3>, k: usize| c[0] + c[1] * elementary::powi(c[2], k as i32);
    let misfit = |c: &SVector<f64, 3>| -> f64 {
        values.iter().enumerate().map(|(k, value)| (value - law(c, k)).powi(2)).sum()
    };
    let mut fit = None;
    for _ in 0..MAX_STEPS {
        let rows: Vec<([f64; 3], f64)> = values
            .iter()
            .enumerate()
            .map(|(k, value)| {
                let slope =
                    if k == 0 { 0.0 } else { now[1] * k as f64 * elementary::powi(now[2], k as i32 - 1) };
                ([1.0, elementary::powi(now[2], k as i32), slope], value - law(&now, k))
            })
            .collect();
        let step = least_squares(&rows)?;
        let (before, mut share) = (misfit(&now), 1.0);
        while share > 1e-6 && !(misfit(&(now + step.coefficients * share)) <= before) {
            share *= 0.5;
        }
        if share > 1e-6 {
            now += step.coefficients * share;
        }
        fit = Some(Fit { coefficients: now, ..step });
        if share <= 1e-6 || (step.coefficients[2] * share).abs() <= 1e-14 * now[2].abs() {
            break;
        }
    }
    fit.filter(|fit| fit.coefficients.iter().all(|coefficient| coefficient.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, quantile) in [(1, 12.7062), (2, 4.3027), (5, 2.5706), (10, 2.2281), (1000, 1.9623)] {
            assert!((student(freedom) - quantile).abs() < 1e-4, "{freedom}: {}", student(freedom));
        }
    }

    #[test]
    fn a_cubic_and_a_geometric_law_are_recovered() {
        let cubic = [0.3, -1.0, 0.5, 2.0];
        let rows: Vec<([f64; 4], f64)> = (0..40)
            .map(|i| f64::from(i) / 19.5 - 1.0)
            .map(|u| (powers(u), powers::<4>(u).iter().zip(cubic).map(|(p, c)| p * c).sum()))
            .collect();
        let fit = least_squares(&rows).unwrap();
        for (fitted, exact) in fit.coefficients.iter().zip(cubic) {
            assert!((fitted - exact).abs() < 1e-14, "{fit:?}");
        }
        assert!(fit.covariance[(3, 3)] < 1e-26 && fit.freedom == 36);
        for q in [0.36, -0.93] {
            let values: Vec<f64> = (0..12).map(|k| 0.2 + 3.0 * f64::powi(q, k)).collect();
            let fit = geometric(&values).unwrap();
            let exact = [0.2, 3.0, q];
            for (fitted, exact) in fit.coefficients.iter().zip(exact) {
                assert!((fitted - exact).abs() < 1e-12, "{fit:?}");
            }
        }
        assert!(geometric(&[1.0; 9]).is_none() && geometric(&[1.0, 2.0, 3.0]).is_none());
        assert!(least_squares(&[([1.0, 1.0], 1.0), ([1.0, 1.0], 2.0), ([2.0, 2.0], 1.0)]).is_none());
    }
}
