//! Polynomial of the lowest degree that follows given points closely enough.
//!
//! Least squares with polynomials orthogonal over the points themselves (Forsythe 1957, "Generation and use
//! of orthogonal polynomials for data-fitting with a digital computer"): each further degree costs one pass
//! over the points and keeps the lower coefficients, so that trying all degrees costs as much as fitting the
//! highest. A QR factorisation per degree would cost `degree` times as much.

use super::elementary;

/// The polynomial q of lowest degree that `accept` accepts.
///
/// Returns the monomial coefficients of q in the variable of `points`, from the constant up, where q
/// minimises sum (`weights` q(`points`) - `values`)^2 among the polynomials of its degree. `accept` gets the
/// coefficients of each degree in turn, from the zero polynomial (an empty slice) to `terms` coefficients;
/// the first polynomial that it accepts is returned.
///
/// Method: Forsythe 1957, three-term recurrence. Each term is subtracted from the values before the next one
/// is fitted (as in modified Gram-Schmidt), so that the residual stays accurate as orthogonality degrades.
///
/// Preconditions: the three slices are equally long; `points` lie in about [-1, 1] (monomial coefficients
/// grow like 2.4^degree there, so that degree 15 loses some five digits).
///
/// The largest error has no bound; `accept` judges it. Returns `None` if `accept` never accepts, or if fewer
/// points have a weight than there are terms.
///
/// More `terms` fit closer, but cost more and oscillate more: keep them well below the number of points.
pub fn lowest_degree(
    points: &[f64],
    weights: &[f64],
    values: &[f64],
    terms: usize,
    mut accept: impl FnMut(&[f64]) -> bool,
) -> Option<Vec<f64>> {
    let mut sum: Vec<f64> = Vec::with_capacity(terms);
    if accept(&sum) {
        return Some(sum);
    }
    let mut rest = values.to_vec();
    // The last two orthogonal polynomials, as weighted values at the points and as coefficients.
    let mut now = weights.to_vec();
    let mut before = vec![0.0; points.len()];
    let mut now_monomials = vec![1.0];
    let mut before_monomials: Vec<f64> = Vec::new();
    let mut norm_before = 0.0;
    let mut first_norm = 0.0;
    for term in 0..terms {
        let norm: f64 = now.iter().map(|p| p * p).sum();
        if term == 0 {
            first_norm = norm;
        }
        // The squared norm of monic orthogonal polynomials on [-1, 1] falls like 4^-degree. One that is
        // smaller by another twelve digits vanishes at every point and consists of rounding errors.
        if norm <= first_norm * 1e-12 * elementary::powi(0.25, term as i32) || !norm.is_finite() {
            return None;
        }
        let share = now.iter().zip(&rest).map(|(p, r)| p * r).sum::<f64>() / norm;
        for (r, p) in rest.iter_mut().zip(&now) {
            *r -= share * p;
        }
        sum.resize(now_monomials.len(), 0.0);
        for (s, c) in sum.iter_mut().zip(&now_monomials) {
            *s += share * c;
        }
        if accept(&sum) {
            return Some(sum);
        }
        let alpha = points.iter().zip(&now).map(|(t, p)| t * p * p).sum::<f64>() / norm;
        let beta = if term == 0 { 0.0 } else { norm / norm_before };
        for ((p, b), t) in now.iter_mut().zip(before.iter_mut()).zip(points) {
            let next = (t - alpha) * *p - beta * *b;
            *b = *p;
            *p = next;
        }
        let mut next = vec![0.0; now_monomials.len() + 1];
        for (i, c) in now_monomials.iter().enumerate() {
            next[i + 1] += c;
            next[i] -= alpha * c;
        }
        for (n, c) in next.iter_mut().zip(&before_monomials) {
            *n -= beta * c;
        }
        before_monomials = std::mem::replace(&mut now_monomials, next);
        norm_before = norm;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::lowest_degree;
    use crate::numeric::real_roots::value_and_magnitude;

    #[test]
    fn a_polynomial_is_recovered_at_its_own_degree() {
        let points: Vec<f64> = (0..40).map(|i| i as f64 / 19.5 - 1.0).collect();
        let truth = [0.3, -1.0, 0.0, 2.0, 0.25];
        let value = |c: &[f64], t: f64| value_and_magnitude(c, t).0;
        let values: Vec<f64> = points.iter().map(|t| value(&truth, *t)).collect();
        let weights = vec![1.0; 40];
        let fit = lowest_degree(&points, &weights, &values, 12, |c| {
            points.iter().zip(&values).all(|(t, v)| (value(c, *t) - v).abs() < 1e-13)
        })
        .unwrap();
        assert_eq!(fit.len(), 5);
        for (a, b) in fit.iter().zip(&truth) {
            assert!((a - b).abs() < 1e-13, "{fit:?}");
        }
    }

    #[test]
    fn more_terms_than_points_is_no_fit() {
        let points = [-1.0, 0.0, 1.0];
        assert_eq!(lowest_degree(&points, &[1.0; 3], &[1.0, 5.0, -1.0], 9, |_| false), None);
        assert_eq!(lowest_degree(&[], &[], &[], 9, |_| false), None);
    }
}
