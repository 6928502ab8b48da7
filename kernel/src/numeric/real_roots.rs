//! All real roots of a polynomial, in an interval or on the whole line.
//!
//! This allocates, so it is meant for setup and not for the loop of a run. The roots of the derivative, found
//! first, divide the interval into pieces on which the polynomial is monotone; a sign change on such a piece
//! is bracketed and refined to rounding. This is slower than an eigenvalue or Bernstein method, but it cannot
//! miss a root or report one twice, and a double root is simply a root of the derivative at which the
//! polynomial vanishes to rounding.

use super::elementary;

/// Value of the polynomial with `coefficients` from the constant up (Horner), and the sum of the magnitudes
/// of its terms, to which its rounding error is proportional.
pub fn value_and_magnitude(coefficients: &[f64], x: f64) -> (f64, f64) {
    let size = x.abs();
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(value, magnitude), c| (value * x + c, magnitude * size + c.abs()))
}

/// The sign -1, 0 or 1 of the polynomial at `x`; 0 where it vanishes to rounding.
///
/// Rounding is taken as 2 n units of the last place of the sum of the magnitudes of the n terms, the bound
/// for Horner's scheme (Higham, "Accuracy and Stability of Numerical Algorithms", eq. 5.3).
pub fn sign(coefficients: &[f64], x: f64) -> f64 {
    let (value, magnitude) = value_and_magnitude(coefficients, x);
    let rounding = 2.0 * coefficients.len() as f64 * (0.5 * f64::EPSILON);
    if value.abs() <= rounding * magnitude { 0.0 } else { value.signum() }
}

/// The derivative's coefficients.
pub fn derivative(coefficients: &[f64]) -> Vec<f64> {
    coefficients.iter().enumerate().skip(1).map(|(i, c)| i as f64 * c).collect()
}

/// All distinct real roots within `[left, right]`, ascending; the ends may be infinite.
///
/// Method: recursion over the derivatives, a safeguarded Newton iteration on each monotone piece. A
/// polynomial in x^2 (times a power of x) is solved in x^2, so that its roots are symmetric bit for bit
/// and 0 is exact. The variable is scaled by a power of two, so that nothing overflows.
///
/// Preconditions: finite coefficients, `left <= right`.
///
/// Guarantee: every root that double precision resolves is found, to a few units in the last place times its
/// condition number. A multiple root, or a cluster that rounding does not resolve, is returned once. The
/// result is empty for the zero polynomial, which vanishes everywhere.
pub fn real_roots(coefficients: &[f64], left: f64, right: f64) -> Vec<f64> {
    let Some(last) = coefficients.iter().rposition(|c| *c != 0.0) else { return Vec::new() };
    let first = coefficients.iter().position(|c| *c != 0.0).unwrap_or(0);
    let core = &coefficients[first..=last];
    let bound = root_bound(core);
    let (low, high) = (left.max(-bound), right.min(bound));
    let mut roots = Vec::new();
    if core.len() > 1 && low <= high {
        if core.iter().skip(1).step_by(2).all(|c| *c == 0.0) {
            let squares: Vec<f64> = core.iter().copied().step_by(2).collect();
            let reach = low.abs().max(high.abs());
            // slightly larger, so that rounding of the square does not exclude a root at an end
            let limit = (reach * reach * (1.0 + 4.0 * f64::EPSILON)).min(f64::MAX);
            for square in scaled_roots(&squares, 0.0, limit) {
                let root = square.sqrt();
                roots.extend([-root, root].into_iter().filter(|r| (low..=high).contains(r)));
            }
        } else {
            roots = scaled_roots(core, low, high);
        }
    }
    if first > 0 && left <= 0.0 && right >= 0.0 {
        roots.push(0.0);
    }
    roots.sort_by(f64::total_cmp);
    roots.dedup();
    roots
}

/// A bound on the magnitude of every root: twice the largest |a_(n-i)/a_n|^(1/i) (Fujiwara 1916). Logarithms
/// avoid overflow; the factor includes a margin for their rounding.
fn root_bound(core: &[f64]) -> f64 {
    let degree = core.len() - 1;
    let lead = elementary::log2(core[degree].abs());
    let largest = core[..degree]
        .iter()
        .enumerate()
        .filter(|(_, c)| **c != 0.0)
        .map(|(i, c)| (elementary::log2(c.abs()) - lead) / (degree - i) as f64)
        .fold(f64::NEG_INFINITY, f64::max);
    elementary::exp2(largest + 1.001).min(f64::MAX)
}

/// Roots in a finite interval, after scaling variable and values by powers of two (exact).
fn scaled_roots(core: &[f64], low: f64, high: f64) -> Vec<f64> {
    let reach = low.abs().max(high.abs());
    if reach == 0.0 {
        return if core[0] == 0.0 { vec![0.0] } else { Vec::new() };
    }
    let power = elementary::log2(reach).ceil().clamp(-1000.0, 1000.0) as i32;
    let unit = elementary::powi(2.0, power);
    let top = core
        .iter()
        .enumerate()
        .filter(|(_, c)| **c != 0.0)
        .map(|(i, c)| elementary::log2(c.abs()).floor() as i32 + i as i32 * power)
        .max()
        .unwrap_or(0);
    let scaled: Vec<f64> =
        core.iter().enumerate().map(|(i, c)| times_power_of_two(*c, i as i32 * power - top)).collect();
    monotone_roots(&scaled, low / unit, high / unit).into_iter().map(|r| r * unit).collect()
}

/// c 2^power without intermediate overflow; a result too small for a double becomes 0.
fn times_power_of_two(mut c: f64, mut power: i32) -> f64 {
    while power != 0 && c != 0.0 && c.is_finite() {
        let part = power.clamp(-900, 900);
        c *= elementary::powi(2.0, part);
        power -= part;
    }
    c
}

/// Distinct roots within [low, high], by recursion over the derivatives.
fn monotone_roots(coefficients: &[f64], low: f64, high: f64) -> Vec<f64> {
    let Some(last) = coefficients.iter().rposition(|c| *c != 0.0) else { return Vec::new() };
    let coefficients = &coefficients[..=last];
    if last == 0 {
        return Vec::new();
    }
    if last == 1 {
        let root = -coefficients[0] / coefficients[1];
        return if (low..=high).contains(&root) { vec![root] } else { Vec::new() };
    }
    let slope = derivative(coefficients);
    let mut cuts = vec![low];
    cuts.extend(monotone_roots(&slope, low, high).into_iter().filter(|c| *c > low && *c < high));
    cuts.push(high);
    let mut roots: Vec<f64> = Vec::new();
    let mut sign_before = sign(coefficients, low);
    if sign_before == 0.0 {
        roots.push(low);
    }
    for pair in cuts.windows(2) {
        let sign_here = sign(coefficients, pair[1]);
        if sign_before * sign_here < 0.0 {
            roots.push(bracketed(coefficients, &slope, pair[0], pair[1], sign_before));
        }
        if sign_here == 0.0 {
            // Neighbouring cuts with values of 0 to rounding, also between them, are one cluster of roots.
            let same_cluster = sign_before == 0.0 && sign(coefficients, 0.5 * (pair[0] + pair[1])) == 0.0;
            if !same_cluster {
                roots.push(pair[1]);
            }
        }
        sign_before = sign_here;
    }
    roots
}

/// The root between `low` and `high`, where the sign changes from `sign_low`. It takes Newton's step if that
/// stays inside the bracket and the bracket keeps shrinking, and otherwise bisects.
fn bracketed(coefficients: &[f64], slope: &[f64], mut low: f64, mut high: f64, sign_low: f64) -> f64 {
    let mut x = 0.5 * (low + high);
    let mut width = high - low;
    let mut newton_steps = 0;
    loop {
        let (value, _) = value_and_magnitude(coefficients, x);
        if value == 0.0 {
            return x;
        }
        if value.signum() == sign_low {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / value_and_magnitude(slope, x).0;
        // Newton's steps finally approach the root from one side, so that the other end of the bracket stays
        // far away: a step below rounding ends the iteration.
        if (newton - x).abs() <= 0.5 * f64::EPSILON * x.abs() && newton >= low && newton <= high {
            return newton;
        }
        newton_steps += 1;
        let halved = high - low <= 0.5 * width;
        if halved {
            width = high - low;
            newton_steps = 0;
        }
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            // The end with the smaller value; of equals the one nearer to 0, so that a mirrored polynomial
            // has mirrored roots.
            let miss = |x: f64| (value_and_magnitude(coefficients, x).0.abs(), x.abs());
            return if miss(low) <= miss(high) { low } else { high };
        }
        // After five Newton steps that do not halve the bracket, bisect once.
        x = if newton > low && newton < high && newton_steps < 5 {
            newton
        } else {
            newton_steps = 0;
            middle
        };
    }
}

#[cfg(test)]
mod tests {
    use super::real_roots;
    use crate::numeric::times_roots;

    const LINE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

    fn product(roots: &[f64]) -> Vec<f64> {
        times_roots(&[1.0], roots)
    }

    #[test]
    fn simple_roots_on_the_line() {
        let expected = [-3.0, -1.5, 0.25, 2.0, 7.0];
        let found = real_roots(&product(&expected), LINE.0, LINE.1);
        assert_eq!(found.len(), 5);
        for (f, e) in found.iter().zip(&expected) {
            assert!((f - e).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn an_interval_includes_its_ends() {
        let p = product(&[-1.0, 2.0, 3.0]);
        assert_eq!(real_roots(&p, -1.0, 2.5).len(), 2);
        assert_eq!(real_roots(&p, 0.0, 1.0), Vec::<f64>::new());
        assert_eq!(real_roots(&[-1.0, 0.0, 1.0], -1.0, 1.0), vec![-1.0, 1.0]);
    }

    #[test]
    fn a_mirrored_polynomial_has_mirrored_roots() {
        // the polynomial is as small on one side of the root as on the other
        let mut polynomial = [1.1902863311193113, 0.9015141295019665, -0.6060376420249709, 0.0, 0.0, 1.0];
        let roots = real_roots(&polynomial, LINE.0, LINE.1);
        polynomial.iter_mut().step_by(2).for_each(|c| *c = -*c);
        let mirrored: Vec<f64> = roots.iter().map(|root| -root).collect();
        assert_eq!(real_roots(&polynomial, LINE.0, LINE.1), mirrored);
    }

    #[test]
    fn multiple_roots_are_returned_once() {
        assert_eq!(real_roots(&product(&[1.0, 1.0]), LINE.0, LINE.1), vec![1.0]);
        assert_eq!(real_roots(&[0.0, 0.0, 0.0, 1.0], LINE.0, LINE.1), vec![0.0]);
        let found = real_roots(&product(&[1.0, 1.0, 1.0, -2.0]), LINE.0, LINE.1);
        assert_eq!(found.len(), 2, "{found:?}");
        let found = real_roots(&product(&[0.5, 0.5, -0.5, -0.5]), LINE.0, LINE.1);
        assert_eq!(found, vec![-0.5, 0.5]);
    }

    #[test]
    fn polynomials_without_roots_have_none() {
        for p in [&[][..], &[0.0, 0.0], &[3.0], &[1.0, 0.0, 1.0], &[1.0, 1.0, 1.0]] {
            assert_eq!(real_roots(p, LINE.0, LINE.1), Vec::<f64>::new());
        }
    }

    #[test]
    fn odd_polynomials_have_symmetric_roots() {
        let found = real_roots(&[0.0, 0.7, 0.0, -1.3, 0.0, 0.1], LINE.0, LINE.1);
        assert_eq!(found.len(), 5);
        assert_eq!(found[2], 0.0);
        assert_eq!(found[0], -found[4]);
        assert_eq!(found[1], -found[3]);
    }

    #[test]
    fn scale_does_not_matter() {
        for scale in [1e-100, 1e-9, 1e9, 1e20] {
            let p = product(&[-2.0 * scale, scale, 5.0 * scale]);
            let found = real_roots(&p, LINE.0, LINE.1);
            assert_eq!(found.len(), 3, "{scale}: {found:?}");
            for (f, e) in found.iter().zip([-2.0, 1.0, 5.0]) {
                assert!((f / scale - e).abs() < 1e-13);
            }
        }
        let far_apart = product(&[1e-9, 1.0, 1e9]);
        let found = real_roots(&far_apart, LINE.0, LINE.1);
        assert_eq!(found.len(), 3);
        assert!((found[0] / 1e-9 - 1.0).abs() < 1e-12, "{found:?}");
    }
}
