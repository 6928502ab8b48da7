//! Gauss-Legendre quadrature rules.

use std::sync::OnceLock;

use super::elementary;
use super::scalar::Number;

/// Largest number of points of a rule.
pub const MAX_POINTS: usize = 20;

/// Gauss-Legendre points and weights on \[0, 1].
///
/// Exact for polynomials up to degree 2 points - 1. For a series whose terms fall by a factor r, the error
/// falls like (r/4)^(2 points).
#[derive(Debug, Clone)]
pub struct GaussLegendre<T> {
    points: usize,
    nodes: [T; MAX_POINTS],
    weights: [T; MAX_POINTS],
}

impl<T: Number> GaussLegendre<T> {
    /// The points, ascending.
    #[inline(always)]
    pub fn nodes(&self) -> &[T] {
        &self.nodes[..self.points]
    }

    /// The weight of each point; their sum is 1.
    #[inline(always)]
    pub fn weights(&self) -> &[T] {
        &self.weights[..self.points]
    }

    /// The same rule in another number type.
    pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> GaussLegendre<U> {
        GaussLegendre { points: self.points, nodes: self.nodes.map(&f), weights: self.weights.map(&f) }
    }

    /// The rule with 1 to [`MAX_POINTS`] points (clamped), to the rounding of `T`: Newton's method on the
    /// Legendre polynomials from the usual cosine guess.
    pub fn new(points: usize) -> Self {
        let points = points.clamp(1, MAX_POINTS);
        let mut rule = Self { points, nodes: [T::zero(); MAX_POINTS], weights: [T::zero(); MAX_POINTS] };
        let (x, slope) = roots::<T>(points, 0, points);
        let (one, half) = (T::of(1.0), T::of(0.5));
        for i in 0..points {
            rule.nodes[i] = half - half * x[i];
            rule.weights[i] = one / ((one - x[i] * x[i]) * slope[i] * slope[i]);
        }
        rule
    }
}

/// The rules for every number of points, each computed when first used.
pub struct Rules<T>([OnceLock<GaussLegendre<T>>; MAX_POINTS]);

impl<T: Number> Rules<T> {
    /// Starts with no rule computed.
    pub const fn new() -> Self {
        Self([const { OnceLock::new() }; MAX_POINTS])
    }

    /// The rule with 1 to [`MAX_POINTS`] points (clamped).
    #[inline]
    pub fn of(&self, points: usize) -> &GaussLegendre<T> {
        let points = points.clamp(1, MAX_POINTS);
        self.0[points - 1].get_or_init(|| GaussLegendre::new(points))
    }
}

/// Roots of the Legendre polynomial of degree `points`, and its slope at each: `count` of them, from index
/// `first` in the order from 1 down to -1. At most [`MAX_POINTS`] at a time.
fn roots<T: Number>(points: usize, first: usize, count: usize) -> ([T; MAX_POINTS], [T; MAX_POINTS]) {
    let one = T::of(1.0);
    let mut x = [one; MAX_POINTS];
    for (i, x) in x[..count].iter_mut().enumerate() {
        let place = (first + i) as f64 + 0.75;
        *x = T::of(elementary::cos(std::f64::consts::PI * place / (points as f64 + 0.5)));
    }
    // All roots are refined together: with one root alone each division would wait for the previous one.
    let mut slope = [one; MAX_POINTS];
    for _ in 0..8 {
        let (mut value, mut before) = ([one; MAX_POINTS], [T::zero(); MAX_POINTS]);
        for n in 1..=points {
            let (twice, less, whole) = (T::of((2 * n - 1) as f64), T::of((n - 1) as f64), T::of(n as f64));
            for ((value, before), x) in value[..count].iter_mut().zip(&mut before).zip(&x) {
                let next = (twice * *x * *value - less * *before) / whole;
                (*before, *value) = (*value, next);
            }
        }
        for i in 0..count {
            slope[i] = T::of(points as f64) * (x[i] * value[i] - before[i]) / (x[i] * x[i] - one);
            x[i] -= value[i] / slope[i];
        }
    }
    (x, slope)
}

/// The half at x > 0 of the rule with 2 `half` points on \[-1, 1]: descending points and their weights, whose
/// sum is 1. It integrates an even polynomial from 0 to 1 exactly up to degree 4 `half` - 1.
#[doc(hidden)]
pub fn even_half(half: usize) -> Vec<(f64, f64)> {
    let mut rule = Vec::with_capacity(half);
    for first in (0..half).step_by(MAX_POINTS) {
        let count = MAX_POINTS.min(half - first);
        let (x, slope) = roots::<f64>(2 * half, first, count);
        rule.extend((0..count).map(|i| (x[i], 2.0 / ((1.0 - x[i] * x[i]) * slope[i] * slope[i]))));
    }
    rule
}

#[cfg(test)]
mod tests {
    use super::super::{DoubleDouble, Scalar};
    use super::*;

    #[test]
    fn powers_are_integrated_exactly() {
        for points in 1..=MAX_POINTS {
            let rule = GaussLegendre::<f64>::new(points);
            for power in 0..2 * points as i32 {
                let sum: f64 = rule.nodes().iter().zip(rule.weights()).map(|(x, w)| w * x.powi(power)).sum();
                assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-13, "{points} {power} {sum}");
            }
        }
        let rule = GaussLegendre::<DoubleDouble>::new(9);
        let mut sum = DoubleDouble::of(0.0);
        for (x, w) in rule.nodes().iter().zip(rule.weights()) {
            sum += *w * *x * *x;
        }
        assert!((sum * DoubleDouble::of(3.0) - DoubleDouble::of(1.0)).to_f64().abs() < 1e-29);
    }

    #[test]
    fn the_half_rule_integrates_even_powers() {
        for half in [1, 5, 40] {
            for power in (0..4 * half as i32).step_by(2) {
                let sum: f64 = even_half(half).iter().map(|(x, w)| w * x.powi(power)).sum();
                assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-12, "{half} {power} {sum}");
            }
        }
    }
}
