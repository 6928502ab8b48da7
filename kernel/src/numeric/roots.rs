//! Sign changes of a polynomial between 0 and 1, found in ascending order without missing any.
//!
//! Contacts are roots of a polynomial on (0, 1]. Comparing signs at the ends of a step misses pairs of roots
//! inside it, so the search bounds the polynomial instead: first its value and its slope by nested bounds,
//! and if neither excludes a pair of roots, by its Bernstein coefficients, whose sign changes bound the
//! number of roots (Descartes' rule in the Bernstein basis, Lane and Riesenfeld 1981). An interval with one
//! sign change has one root, an interval without sign changes has none, and any other interval is halved.
//!
//! A double root touches 0 without crossing it. A pair of roots closer than 2^-36 of the step cannot be
//! resolved given the rounding of the coefficients and is not reported.

use super::scalar::Scalar;
use super::single_root::{completed, expansion, step};

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

/// Search for the sign changes of a polynomial on [0, 1], sum g\[k\] s^k.
///
/// The sign at 0 is the sign just after 0, so that a root at 0 is not a sign change. Elsewhere a value of
/// exactly 0 counts as the opposite of this first sign. Hence a root at an end of an interval is found once,
/// a root at 1 is found if the polynomial has its first sign just before 1, and a polynomial and its negative
/// have the same sign changes. A touch exactly at the end of a halved interval is found as a pair.
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

    /// The first s in (0, 1] at which the polynomial changes sign, to within the rounding of its evaluation,
    /// relative to s; `None` if it does not change sign.
    pub fn first(&self) -> Option<T> {
        let mut found = None;
        self.each_sign_change(&mut |s| {
            found = Some(s);
            false
        });
        found
    }

    /// Calls `visit` with every s in (0, 1] where the polynomial changes sign, in ascending order, until
    /// it returns false.
    pub fn each_sign_change(&self, visit: &mut dyn FnMut(T) -> bool) {
        let reduced = self.without_a_root_at_0();
        reduced.each_bracket(&mut |first_sign_at_low, bracket| {
            visit(completed(self.g, reduced.polish(first_sign_at_low, bracket)))
        });
    }

    /// The number of sign changes in (0, 1], without locating them.
    pub fn count_sign_changes(&self) -> usize {
        let mut count = 0;
        self.without_a_root_at_0().each_bracket(&mut |_, _| {
            count += 1;
            true
        });
        count
    }

    /// The polynomial reduced by the highest power of s that divides it, which has the same sign on (0, 1].
    #[inline]
    fn without_a_root_at_0(&self) -> Self {
        let first = self.g.iter().position(|c| *c != T::zero()).unwrap_or(0);
        Self { g: &self.g[first..] }
    }

    /// Whether a value has the polynomial's sign at 0.
    #[inline(always)]
    fn has_first_sign(&self, value: T) -> bool {
        if self.g[0] > T::zero() { value > T::zero() } else { value < T::zero() }
    }

    /// Calls `visit` for an interval around each sign change, in ascending order, until it returns false. Its
    /// arguments are whether the polynomial has its first sign at the lower end, and both ends. Precondition:
    /// the polynomial is not 0 at 0.
    fn each_bracket(&self, visit: &mut dyn FnMut(bool, (T, T)) -> bool) {
        let zero = T::zero();
        let g = self.g;
        if g.len() < 2 {
            return;
        }
        // Nested bounds: for s in [0, 1] the tail g[k] + s (g[k+1] + s ..) is at least g[k] plus the smaller
        // of 0 and the lower bound of the next tail, and likewise for the upper bound and for the slope.
        let (mut lower, mut upper) = (zero, zero);
        let (mut lower_slope, mut upper_slope) = (zero, zero);
        for (k, c) in g.iter().enumerate().skip(1).rev() {
            lower = *c + lower.smaller(zero);
            upper = *c + upper.larger(zero);
            let slope = *c * T::whole(k);
            lower_slope = slope + lower_slope.smaller(zero);
            upper_slope = slope + upper_slope.larger(zero);
        }
        let keeps_sign =
            if g[0] > zero { g[0] + lower.smaller(zero) > zero } else { g[0] + upper.larger(zero) < zero };
        if keeps_sign {
            return;
        }
        if upper_slope < zero || lower_slope > zero {
            // Monotone: there is one root if the sign at 1 differs from that at 0.
            if !self.has_first_sign(self.value(T::of(1.0))) {
                visit(true, (zero, T::of(1.0)));
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
        self.isolate(&b, zero, T::of(1.0), 0, visit);
    }

    /// Visits the sign changes from `low` to `low + width`, where the Bernstein coefficients are `b`. Returns
    /// false as soon as `visit` does.
    fn isolate(
        &self,
        b: &[T; COEFFICIENTS],
        low: T,
        width: T,
        depth: u32,
        visit: &mut dyn FnMut(bool, (T, T)) -> bool,
    ) -> bool {
        let zero = T::zero();
        let n = self.g.len() - 1;
        let first_sign = |c: T| self.has_first_sign(c);
        let changes = b[..=n].windows(2).filter(|w| first_sign(w[0]) != first_sign(w[1])).count();
        if changes == 0 {
            return true;
        }
        if changes == 1 || depth == MAX_DEPTH {
            if changes % 2 == 1 {
                return visit(first_sign(b[0]), (low, low + width));
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
    /// `first_sign_at_low` is the sign by which the bracket was found: if `low` is a root to within rounding,
    /// another way to evaluate the polynomial there may give the opposite sign.
    fn polish(&self, first_sign_at_low: bool, (mut low, mut high): (T, T)) -> T {
        let half = T::of(0.5);
        let mut s = self.guess(low, high).unwrap_or_else(|| (low + high) * half);
        let close = T::of(T::ROUGH);
        let mut last_move = high - low;
        for _ in 0..120 {
            let expansion = expansion(self.g, s);
            let (step, bent) = step(expansion);
            // The step leads to a sign change of the opposite direction at the end of the bracket, where the
            // sign is determined by rounding.
            let falls = (expansion.1 > T::zero()) != (self.g[0] > T::zero());
            let middle = (low + high) * half;
            if falls != first_sign_at_low && step.abs() <= close && s != middle {
                (s, last_move) = (middle, high - low);
                continue;
            }
            if self.has_first_sign(expansion.0) == first_sign_at_low {
                low = s
            } else {
                high = s
            }
            let next = s - step;
            // A step must stay inside the bracket and be at most half the last move; otherwise bisect.
            let inside = next >= low && next <= high && step.abs() * T::of(2.0) <= last_move;
            if inside && step.abs() <= s.abs() * close && bent.abs() <= close {
                return next; // the remaining error is the third power of the last one
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

    /// The sign change of the parabola with the polynomial's value and slope at 0 and its value at 1; `None`
    /// unless the bracket is all of [0, 1].
    fn guess(&self, low: T, high: T) -> Option<T> {
        if low != T::zero() || high != T::of(1.0) || self.g.len() < 2 {
            return None;
        }
        let end = self.g.iter().map(|c| c.to_f64()).sum::<f64>();
        let (a, b) = (self.g[0].to_f64(), self.g[1].to_f64());
        let c = end - a - b;
        // a slope of 0 takes the sign of the value, so that a polynomial and its negative have the same guess
        let root = (b * b - 4.0 * a * c).sqrt().copysign(if b == 0.0 { a } else { b });
        let near = -2.0 * a / (b + root);
        let far = -(b + root) / (2.0 * c);
        [near, far].into_iter().find(|s| *s > 0.0 && *s < 1.0).map(T::of)
    }
}

#[cfg(test)]
mod tests;
