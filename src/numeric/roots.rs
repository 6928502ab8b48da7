//! Sign changes of a polynomial between 0 and 1, in order, with none missed.
//!
//! Contacts are roots of a polynomial on (0, 1]. Comparing signs at the ends of a step misses pairs of
//! roots inside it, so the search bounds the polynomial instead: first by nested bounds of its
//! value, then of its slope, and only where both leave room by its Bernstein coefficients, whose sign changes
//! bound the number of roots (Descartes' rule in the Bernstein basis, Lane and Riesenfeld 1981). An
//! interval with one sign change holds one root, one with none holds none, any other is halved.
//!
//! A double root touches and does not cross: a pair of roots closer than 2^-36 of the step, which is below
//! what the rounding of the coefficients can tell, counts as none.

use super::scalar::Scalar;
use super::single_root::expansion;

/// The largest degree that can be searched.
pub const MAX_DEGREE: usize = 39;

const COEFFICIENTS: usize = MAX_DEGREE + 1;
const MAX_DEPTH: u32 = 36;

/// BINOMIALS\[n\]\[k\] = n over k, exact: all are below 2^53.
static BINOMIALS: [[f64; COEFFICIENTS]; COEFFICIENTS] = {
    let mut rows = [[0.0; COEFFICIENTS]; COEFFICIENTS];
    let mut n = 0;
    while n < COEFFICIENTS {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

/// A polynomial on [0, 1], sum g\[k\] s^k, as something to find sign changes in.
///
/// A value of exactly 0 counts as negative throughout: a root at the very end of an interval belongs to
/// it, and is found once.
#[derive(Debug, Clone, Copy)]
pub struct PolynomialRoots<'a, T> {
    g: &'a [T],
}

impl<'a, T: Scalar> PolynomialRoots<'a, T> {
    /// Precondition: 1 to [`MAX_DEGREE`] + 1 coefficients.
    pub fn new(g: &'a [T]) -> Self {
        debug_assert!(!g.is_empty() && g.len() <= COEFFICIENTS);
        Self { g }
    }

    /// Value at `s`.
    #[inline]
    pub fn value(&self, s: T) -> T {
        let mut sum = T::zero();
        for c in self.g.iter().rev() {
            sum = sum * s + *c;
        }
        sum
    }

    /// Value, first and second derivative at `s`.
    pub fn value_and_slopes(&self, s: T) -> (T, T, T) {
        let (mut value, mut slope, mut half_curvature) = (T::zero(), T::zero(), T::zero());
        for c in self.g.iter().rev() {
            half_curvature = half_curvature * s + slope;
            slope = slope * s + value;
            value = value * s + *c;
        }
        (value, slope, half_curvature + half_curvature)
    }

    /// The first s in (0, 1] where the polynomial, positive at 0, ceases to be positive; none where it
    /// stays positive. Located to the rounding of its own evaluation, relative to s.
    pub fn first(&self) -> Option<T> {
        let mut found = None;
        self.each_sign_change(|s| {
            found = Some(s);
            false
        });
        found
    }

    /// Calls `visit` with every s in (0, 1] where the polynomial changes sign, in ascending order, until
    /// it returns false.
    pub fn each_sign_change(&self, mut visit: impl FnMut(T) -> bool) {
        self.each_bracket(|low, high| {
            let root = self.polish(low, high);
            visit(T::at_root(root, |s| {
                let (value, slope, _) = expansion(self.g, s);
                (value, slope)
            }))
        });
    }

    /// How often it changes sign in (0, 1]: what [`Self::each_sign_change`] visits, without locating it.
    pub fn count_sign_changes(&self) -> usize {
        let mut count = 0;
        self.each_bracket(|_, _| {
            count += 1;
            true
        });
        count
    }

    /// Calls `visit` with the ends of an interval around each sign change, in ascending order, until it
    /// returns false.
    #[inline]
    fn each_bracket(&self, mut visit: impl FnMut(T, T) -> bool) {
        let zero = T::zero();
        let g = self.g;
        if g.len() < 2 {
            return;
        }
        // Nested bounds: for s in [0, 1] the tail g[k] + s (g[k+1] + s ..) lies between g[k] plus the smaller
        // of 0 and the bound of the next tail, and g[k] plus the larger; likewise for the slope.
        let (mut least, mut most) = (zero, zero);
        let (mut least_slope, mut most_slope) = (zero, zero);
        for (k, c) in g.iter().enumerate().skip(1).rev() {
            least = *c + least.smaller(zero);
            most = *c + most.larger(zero);
            let slope = *c * T::whole(k);
            least_slope = slope + least_slope.smaller(zero);
            most_slope = slope + most_slope.larger(zero);
        }
        if if g[0] > zero { g[0] + least.smaller(zero) > zero } else { g[0] + most.larger(zero) < zero } {
            return;
        }
        if most_slope < zero || least_slope > zero {
            // Monotone: the end decides.
            if (self.value(T::of(1.0)) > zero) != (g[0] > zero) {
                visit(zero, T::of(1.0));
            }
            return;
        }
        let n = g.len() - 1;
        let mut b = [zero; COEFFICIENTS];
        for ((b, c), binomial) in b.iter_mut().zip(g).zip(&BINOMIALS[n]) {
            *b = *c / T::of(*binomial);
        }
        for i in 1..=n {
            for j in (i..=n).rev() {
                let below = b[j - 1];
                b[j] += below;
            }
        }
        self.isolate(&b, zero, T::of(1.0), 0, &mut visit);
    }

    /// Returns false once `visit` has.
    fn isolate(
        &self,
        b: &[T; COEFFICIENTS],
        low: T,
        width: T,
        depth: u32,
        visit: &mut impl FnMut(T, T) -> bool,
    ) -> bool {
        let zero = T::zero();
        let n = self.g.len() - 1;
        let changes = b[..=n].windows(2).filter(|w| (w[0] > zero) != (w[1] > zero)).count();
        if changes == 0 {
            return true;
        }
        if changes == 1 || depth == MAX_DEPTH {
            if changes % 2 == 1 {
                return visit(low, low + width);
            }
            return true; // a touch
        }
        let half = T::of(0.5);
        let mut left = [zero; COEFFICIENTS];
        let mut right = *b;
        left[0] = right[0];
        for (i, slot) in left[..=n].iter_mut().enumerate().skip(1) {
            for j in 0..=n - i {
                right[j] = (right[j] + right[j + 1]) * half;
            }
            *slot = right[0];
        }
        let w = width * half;
        self.isolate(&left, low, w, depth + 1, visit) && self.isolate(&right, low + w, w, depth + 1, visit)
    }

    /// The root between `low` and `high`, by Chebyshev's steps (third order) kept inside a shrinking bracket.
    fn polish(&self, mut low: T, mut high: T) -> T {
        let zero = T::zero();
        let below = if low == zero { self.g[0] > zero } else { self.value(low) > zero };
        let half = T::of(0.5);
        let mut s = self.guess(low, high).unwrap_or_else(|| (low + high) * half);
        let close = T::of(T::ROUGH);
        let mut last_move = high - low;
        for _ in 0..120 {
            let (value, slope, half_curvature) = expansion(self.g, s);
            if (value > zero) == below {
                low = s
            } else {
                high = s
            }
            let newton = value / slope;
            let bent = newton * half_curvature / slope;
            let step = newton + newton * bent;
            let next = s - step;
            // A step must stay inside and at least halve the last move; else halve the bracket.
            let inside = next >= low && next <= high && step.abs() * T::of(2.0) <= last_move;
            if inside && step.abs() <= s.abs() * close && bent.abs() <= close {
                return next; // what is left is the third power of that
            }
            if !inside && step.abs() <= s.abs() * T::of(T::EPSILON) {
                return s;
            }
            let next = if inside { next } else { (low + high) * half };
            last_move = (next - s).abs();
            if last_move <= s.abs() * T::of(T::EPSILON) {
                return next;
            }
            s = next;
        }
        s
    }

    /// Where the parabola that shares value and slope at 0 and the value at 1 changes sign, where the bracket
    /// is all of it.
    fn guess(&self, low: T, high: T) -> Option<T> {
        if low != T::zero() || high != T::of(1.0) || self.g.len() < 2 {
            return None;
        }
        let end = self.g.iter().map(|c| c.to_f64()).sum::<f64>();
        let (a, b) = (self.g[0].to_f64(), self.g[1].to_f64());
        let c = end - a - b;
        // (a slope of 0 has no sign of its own: the polynomial and its negative are to have the same guess)
        let root = (b * b - 4.0 * a * c).sqrt().copysign(if b == 0.0 { a } else { b });
        let near = -2.0 * a / (b + root);
        let far = -(b + root) / (2.0 * c);
        [near, far].into_iter().find(|s| *s > 0.0 && *s < 1.0).map(T::of)
    }
}

#[cfg(test)]
mod tests {
    use super::super::DoubleDouble;
    use super::*;

    fn from_roots(roots: &[f64], scale: f64) -> Vec<f64> {
        let mut g = vec![scale];
        for r in roots {
            let mut next = vec![0.0; g.len() + 1];
            for (k, c) in g.iter().enumerate() {
                next[k] -= c * r;
                next[k + 1] += c;
            }
            g = next;
        }
        g
    }

    fn all(g: &[f64]) -> Vec<f64> {
        let mut found = Vec::new();
        PolynomialRoots::new(g).each_sign_change(|s| {
            found.push(s);
            true
        });
        assert_eq!(PolynomialRoots::new(g).count_sign_changes(), found.len());
        found
    }

    #[test]
    fn a_polynomial_and_its_negative_have_the_same_roots_whatever_sign_a_zero_has() {
        // A mass that starts at rest: no slope, of either sign.
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..200 {
            let g = [0.2 + 0.5 * next(), 0.0, -0.9 - 0.3 * next(), 0.05 * next(), -0.01 * next()];
            let other = [g[0], -0.0, g[2], g[3], g[4]];
            let found = all(&g);
            assert!(!found.is_empty());
            assert_eq!(
                (all(&other), all(&g.map(|c| -c)), all(&other.map(|c| -c))),
                (found.clone(), found.clone(), found)
            );
        }
    }

    #[test]
    fn every_root_inside_is_found_once_and_in_order() {
        let g = from_roots(&[0.1, 0.35, 0.36, 0.9, 1.4, -0.2], -1.0);
        let found = all(&g);
        assert_eq!(found.len(), 4);
        for (f, r) in found.iter().zip([0.1, 0.35, 0.36, 0.9]) {
            assert!((f - r).abs() < 1e-13, "{f} {r}");
        }
        assert!((PolynomialRoots::new(&g).first().unwrap() - 0.1).abs() < 1e-15);
    }

    #[test]
    fn a_pair_that_the_ends_do_not_show() {
        let g = from_roots(&[0.5, 0.500_001], 1.0);
        let found = all(&g);
        assert_eq!(found.len(), 2);
        assert!((found[0] - 0.5).abs() < 1e-9 && (found[1] - 0.500_001).abs() < 1e-9);
    }

    #[test]
    fn a_double_root_is_a_touch() {
        assert!(all(&from_roots(&[0.3, 0.3], 1.0)).len().is_multiple_of(2));
        assert!(all(&from_roots(&[0.3, 0.3, 0.7], -1.0)).len() % 2 == 1);
        // a value of exactly 0 at a halving point is met as a pair, as close as rounding allows
        let pair = all(&from_roots(&[0.5, 0.5], 1.0));
        assert!(pair.len() == 2 && (pair[0] - 0.5).abs() < 1e-7 && (pair[1] - 0.5).abs() < 1e-7);
    }

    #[test]
    fn a_root_at_the_end_and_at_a_halving_point() {
        assert_eq!(all(&[1.0, -1.0]), vec![1.0]);
        let found = all(&from_roots(&[0.25, 0.5, 0.75], -1.0));
        assert_eq!(found.len(), 3);
    }

    #[test]
    fn small_roots_keep_their_relative_digits() {
        let g = [1e-9, -0.3, 0.2, 0.1];
        let s = PolynomialRoots::new(&g).first().unwrap();
        assert!((s - 1e-9 / 0.3 * (1.0 + 0.2 * 1e-9 / 0.09)).abs() < 1e-24);
    }

    #[test]
    fn the_expansion_is_value_and_slopes() {
        for count in 1..9 {
            let g: Vec<f64> = (0..count).map(|k| 1.0 / (1.5 + k as f64) - 0.3 * (k % 3) as f64).collect();
            let polynomial = PolynomialRoots::new(&g);
            for s in [-0.7, 0.0, 0.3, 1.0, 1.4] {
                let (value, slope, half_curvature) = expansion(&g, s);
                let (v, first, second) = polynomial.value_and_slopes(s);
                let near = |a: f64, b: f64| (a - b).abs() < 1e-13 * (1.0 + b.abs());
                assert!(
                    near(value, v) && near(slope, first) && near(2.0 * half_curvature, second),
                    "{count} {s}"
                );
            }
        }
    }

    #[test]
    fn the_same_code_in_double_double() {
        let g: Vec<DoubleDouble> = [2.0, 0.0, -4.0].iter().map(|c| crate::numeric::Number::of(*c)).collect();
        let s = PolynomialRoots::new(&g).first().unwrap();
        let half: DoubleDouble = crate::numeric::Number::of(0.5);
        assert!((s * s - half).to_f64().abs() < 1e-30);
    }
}
