//! Least squares with the uncertainty of what is fitted.

use nalgebra::{SMatrix, SVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Coefficients that fit values in the sense of least squares.
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
    /// Degrees of freedom of that variance: values less coefficients.
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
/// Method: normal equations by Cholesky; with columns of one size their condition is that of the rows
/// squared, so polynomials want a variable within \[-1, 1]. The covariance takes the errors of the values as
/// independent and of one size, which is estimated from the residuals.
///
/// `None` where there are no more values than coefficients, or where they do not determine them.
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
    // one step of refinement, after which the residuals are those of the rounded coefficients
    let mut rest = SVector::<f64, N>::zeros();
    rows.iter().for_each(|row| rest += SVector::<f64, N>::from(row.0) * residual(&coefficients, row));
    coefficients += factors.solve(&rest);
    let square: f64 = rows.iter().map(|row| residual(&coefficients, row).powi(2)).sum();
    let (inverse, variance) = (factors.inverse(), square / freedom as f64);
    let covariance = inverse * variance;
    let finite = coefficients.iter().chain(covariance.iter()).all(|number| number.is_finite());
    finite.then_some(Fit { coefficients, covariance, inverse, variance, freedom })
}

/// The powers 1, u, u^2, .. of a row of a polynomial.
pub fn powers<const N: usize>(u: f64) -> [f64; N] {
    std::array::from_fn(|k| u.powi(k as i32))
}

/// The factor on a standard error with which an interval holds the true value in 95 of 100 cases, where the
/// error was estimated with so many degrees of freedom: the quantile 0.975 of Student's distribution.
pub fn student(freedom: usize) -> f64 {
    StudentsT::new(0.0, 1.0, freedom.max(1) as f64).map_or(f64::NAN, |law| law.inverse_cdf(0.975))
}

/// The most steps of Gauss and Newton.
const MOST_STEPS: usize = 60;

/// The coefficients c, a, q for which c + a q^k follows `values` (k = 0, 1, ..) best.
///
/// Method: Gauss-Newton from q as the ratio of successive differences, with steps halved until the residual
/// shrinks; the covariance is that of the linearised problem. `None` for fewer than four values, or where no
/// such law fits better than a constant does.
pub fn geometric(values: &[f64]) -> Option<Fit<3>> {
    let differences: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let product: f64 = differences.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let square: f64 = differences.iter().rev().skip(1).map(|own| own * own).sum();
    if values.len() < 4 || !(square > 0.0) {
        return None;
    }
    let first = product / square;
    // c and a follow from q by linear least squares
    let line: Vec<([f64; 2], f64)> =
        values.iter().enumerate().map(|(k, value)| ([1.0, first.powi(k as i32)], *value)).collect();
    let start = least_squares(&line)?.coefficients;
    let mut now = SVector::<f64, 3>::new(start[0], start[1], first);
    let law = |c: &SVector<f64, 3>, k: usize| c[0] + c[1] * c[2].powi(k as i32);
    let misfit = |c: &SVector<f64, 3>| -> f64 {
        values.iter().enumerate().map(|(k, value)| (value - law(c, k)).powi(2)).sum()
    };
    let mut fit = None;
    for _ in 0..MOST_STEPS {
        let rows: Vec<([f64; 3], f64)> = values
            .iter()
            .enumerate()
            .map(|(k, value)| {
                let slope = if k == 0 { 0.0 } else { now[1] * k as f64 * now[2].powi(k as i32 - 1) };
                ([1.0, now[2].powi(k as i32), slope], value - law(&now, k))
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
    fit.filter(|own| own.coefficients.iter().all(|own| own.is_finite()))
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
        for (own, exact) in fit.coefficients.iter().zip(cubic) {
            assert!((own - exact).abs() < 1e-14, "{fit:?}");
        }
        assert!(fit.covariance[(3, 3)] < 1e-26 && fit.freedom == 36);
        for q in [0.36, -0.93] {
            let values: Vec<f64> = (0..12).map(|k| 0.2 + 3.0 * f64::powi(q, k)).collect();
            let fit = geometric(&values).unwrap();
            let exact = [0.2, 3.0, q];
            for (own, exact) in fit.coefficients.iter().zip(exact) {
                assert!((own - exact).abs() < 1e-12, "{fit:?}");
            }
        }
        assert!(geometric(&[1.0; 9]).is_none() && geometric(&[1.0, 2.0, 3.0]).is_none());
        assert!(least_squares(&[([1.0, 1.0], 1.0), ([1.0, 1.0], 2.0), ([2.0, 2.0], 1.0)]).is_none());
    }
}
