//! Basis functions of a flexure's rotation.
//!
//! Integrated Legendre polynomials: each vanishes at both clamps, and their slopes are orthonormal, so that
//! the bending stiffness is a multiple of the identity. A flexure's rotation has an even part about its
//! middle (the sway between the shuttle and the frame) and an odd part (the bump). The two are not coupled in
//! the linear terms, and every integral is taken over one half.

use super::beam::dot;
use crate::numeric::{elementary, even_half};

/// The functions sampled at quadrature points; xi runs over \[-1, 1] along a flexure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Basis {
    /// Number of functions of each parity.
    pub modes: usize,
    /// Weights of the points at xi > 0; their sum is 1.
    pub weights: Vec<f64>,
    /// Values of the even functions, `modes` for each point.
    pub even: Vec<f64>,
    /// Values of the odd functions, `modes` for each point.
    pub odd: Vec<f64>,
}

impl Basis {
    /// `modes` functions of each parity, sampled at about 1.5 `modes` points of one half. This integrates the
    /// product of two functions exactly with a weight of half their degree; the coefficients of the weight
    /// fall as fast as those of the rotation.
    pub fn new(modes: usize) -> Self {
        let rule = even_half(modes + modes / 2 + 1);
        let (mut even, mut odd) = (Vec::new(), Vec::new());
        let mut row = vec![0.0; 2 * modes];
        for (xi, _) in &rule {
            functions(*xi, &mut row);
            even.extend(row.iter().step_by(2));
            odd.extend(row.iter().skip(1).step_by(2));
        }
        Self { modes, weights: rule.iter().map(|(_, w)| *w).collect(), even, odd }
    }

    /// Coefficients of the odd function sin(pi (1 + xi)), by orthogonality of the slopes: the
    /// rotation of the first buckling mode between clamps.
    pub fn first_buckling_mode(&self) -> Vec<f64> {
        use std::f64::consts::PI;
        // enough points for a cosine of one period with any number of modes
        let rule = even_half(2 * self.modes.max(16));
        let mut sum = vec![0.0; self.modes];
        let mut row = vec![0.0; 2 * self.modes];
        for (xi, weight) in rule {
            slopes(xi, &mut row);
            let slope = PI * elementary::cos(PI * (1.0 + xi));
            for (s, f) in sum.iter_mut().zip(row.iter().skip(1).step_by(2)) {
                *s += 2.0 * weight * slope * f;
            }
        }
        sum
    }

    /// The shortening of a flexure with this odd rotation, relative to its arc length.
    pub fn shortening(&self, odd: &[f64]) -> f64 {
        let rows = self.odd.chunks_exact(self.modes).zip(&self.weights);
        rows.map(|(row, weight)| {
            let sine = elementary::sin(0.5 * dot(row, odd));
            2.0 * weight * sine * sine
        })
        .sum()
    }
}

/// The values at `xi` of as many functions as `row` holds: even, odd, even, ...
pub(super) fn functions(xi: f64, row: &mut [f64]) {
    // the integral of P_k from -1 is (P_{k+1} - P_{k-1})/(2k + 1)
    for_each_legendre(xi, row, |twice, [before, _, next]| (next - before) / (2.0 * twice).sqrt());
}

/// The derivatives with respect to xi of the [`functions`]: orthonormal over \[-1, 1].
pub(super) fn slopes(xi: f64, row: &mut [f64]) {
    for_each_legendre(xi, row, |twice, [_, now, _]| (0.5 * twice).sqrt() * now);
}

/// Sets each element of `row` from 2k + 1 and the Legendre polynomials of degrees k - 1 to k + 1 at `xi`,
/// where k = 1, 2, ...
fn for_each_legendre(xi: f64, row: &mut [f64], value: impl Fn(f64, [f64; 3]) -> f64) {
    let (mut before, mut now) = (1.0, xi);
    for (i, element) in row.iter_mut().enumerate() {
        let k = (i + 1) as f64;
        let next = ((2.0 * k + 1.0) * xi * now - k * before) / (k + 1.0);
        *element = value(2.0 * k + 1.0, [before, now, next]);
        (before, now) = (now, next);
    }
}
