//! At which points is a smooth function sampled to integrate it over a step?

use super::scalar::Scalar;

/// The most points of a rule.
pub const MOST_POINTS: usize = 20;

/// Gauss-Legendre points and weights on \[0, 1].
///
/// Exact for polynomials up to degree 2 points - 1; for a series whose terms fall by a factor r the error falls like
/// (r/4)^(2 points).
#[derive(Debug, Clone)]
pub struct GaussLegendre<T> {
    points: usize,
    nodes: [T; MOST_POINTS],
    weights: [T; MOST_POINTS],
}

impl<T: Scalar> GaussLegendre<T> {
    /// The rule with 1 to [`MOST_POINTS`] points (clamped), to the rounding of `T`: Newton's method on the
    /// Legendre polynomials from the usual cosine guess.
    pub fn new(points: usize) -> Self {
        let points = points.clamp(1, MOST_POINTS);
        let mut rule = Self { points, nodes: [T::zero(); MOST_POINTS], weights: [T::zero(); MOST_POINTS] };
        for i in 0..points {
            (rule.nodes[i], rule.weights[i]) = point_and_weight(points, i);
        }
        rule
    }

    /// The points, ascending.
    pub fn nodes(&self) -> &[T] {
        &self.nodes[..self.points]
    }

    /// The weight of each point; their sum is 1.
    pub fn weights(&self) -> &[T] {
        &self.weights[..self.points]
    }
}

/// Point `i` of `points` on \[0, 1], ascending, and its weight.
fn point_and_weight<T: Scalar>(points: usize, i: usize) -> (T, T) {
    let (one, half) = (T::of(1.0), T::of(0.5));
    let angle = std::f64::consts::PI * (i as f64 + 0.75) / (points as f64 + 0.5);
    let mut x = T::of(angle.cos());
    let mut slope = one;
    for _ in 0..8 {
        let (mut value, mut before) = (one, T::zero());
        for n in 1..=points {
            let next =
                (T::of((2 * n - 1) as f64) * x * value - T::of((n - 1) as f64) * before) / T::of(n as f64);
            (before, value) = (value, next);
        }
        slope = T::of(points as f64) * (x * value - before) / (x * x - one);
        x -= value / slope;
    }
    (half - half * x, one / ((one - x * x) * slope * slope))
}

/// The half of a rule with 2 `half` points on \[-1, 1] that lies at x > 0: its points, descending, and weights,
/// whose sum is 1. It integrates an even function from 0 to 1, exactly up to degree 4 `half` - 1.
pub fn even_half(half: usize) -> Vec<(f64, f64)> {
    (0..half)
        .map(|i| {
            let (node, weight) = point_and_weight::<f64>(2 * half, i);
            (1.0 - 2.0 * node, 2.0 * weight)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::{DoubleDouble, Number};
    use super::*;

    #[test]
    fn powers_are_integrated_exactly() {
        for points in 1..=MOST_POINTS {
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
