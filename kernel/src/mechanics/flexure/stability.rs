//! Stability test of an equilibrium.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::beam::{Shape, Terms};
use super::equilibrium::System;
use super::point::Point;

impl System {
    /// Whether the equilibrium is stable at fixed x: the second variation of the strain energy is positive
    /// for all flexures together and for each flexure of a group relative to its neighbours.
    ///
    /// Method: eliminating the forces from the second variation leaves one symmetric matrix of the
    /// coefficients, which has a Cholesky factor if no eigenvalue is negative. For a bump that just vanishes
    /// the matrix is singular and the result depends on rounding.
    pub fn is_stable(&self, point: &Point) -> bool {
        let terms = self.terms(point);
        let parts: [Variation; 2] = std::array::from_fn(|g| Variation::of(&terms[g], point.q[g]));
        let counts = self.beams.each_ref().map(|b| b.count);
        let straight = |g: usize| point.shapes[g] == Shape::Straight;
        (0..2).all(|g| !straight(g) || stays_straight(&terms[g]))
            && (0..2).all(|g| counts[g] == 1.0 || is_positive(parts[g].alone(&terms[g])))
            && is_positive(Variation::together(&parts, &terms, counts))
    }
}

/// Second derivatives of the energy of one flexure with respect to its coefficients and its two forces. The
/// odd coefficients of a straight flexure are not included, see [`stays_straight`].
struct Variation {
    stiffness: DMatrix<f64>,
    by_axial: DVector<f64>,
    by_lateral: DVector<f64>,
}

impl Variation {
    fn of(t: &Terms, q: f64) -> Self {
        // the factor by which the odd rows were divided
        let size = q.max(0.0).sqrt();
        let n = t.modes;
        let all = n + t.odd.len();
        let stiffness = DMatrix::from_fn(all, all, |i, j| match (i < n, j < n) {
            (true, true) => t.even_even[i * n + j],
            (false, true) => size * t.odd_even[(i - n) * n + j],
            (true, false) => size * t.odd_even[(j - n) * n + i],
            (false, false) => t.odd_odd[(i - n) * n + j - n],
        });
        let by = |k: usize| {
            let odd = t.odd_by[k].iter().map(|b| size * b);
            DVector::from_iterator(all, t.even_by[k].iter().copied().chain(odd))
        };
        Self { stiffness, by_axial: by(0), by_lateral: by(1) }
    }

    /// The second variation with both ends of this flexure fixed.
    fn alone(&self, t: &Terms) -> DMatrix<f64> {
        let (a, b, c) = (-t.shortening_by_axial, -t.shortening_by_lateral, t.deflection_by_lateral);
        let determinant = a * c - b * b;
        let (u, v) = (&self.by_axial, &self.by_lateral);
        &self.stiffness
            + (c * u * u.transpose() - b * (u * v.transpose() + v * u.transpose()) + a * v * v.transpose())
                / determinant
    }

    /// The second variation of all flexures at fixed x with the shuttle free axially.
    fn together(parts: &[Self; 2], terms: &[Terms; 2], counts: [f64; 2]) -> DMatrix<f64> {
        let sizes = parts.each_ref().map(|p| p.stiffness.nrows());
        let mut all = DMatrix::zeros(sizes[0] + sizes[1], sizes[0] + sizes[1]);
        // columns: derivatives with respect to the compression and to the two lateral forces
        let mut by = DMatrix::zeros(sizes[0] + sizes[1], 3);
        let mut compliance = DMatrix::zeros(3, 3);
        for g in 0..2 {
            let (row, size) = (g * sizes[0], sizes[g]);
            all.view_mut((row, row), (size, size)).copy_from(&(&parts[g].stiffness * counts[g]));
            by.view_mut((row, 0), (size, 1)).copy_from(&-&parts[g].by_axial);
            by.view_mut((row, 1 + g), (size, 1)).copy_from(&(&parts[g].by_lateral * counts[g]));
            compliance[(0, 0)] -= terms[g].shortening_by_axial / counts[g];
            compliance[(0, 1 + g)] = terms[g].shortening_by_lateral;
            compliance[(1 + g, 0)] = terms[g].shortening_by_lateral;
            compliance[(1 + g, 1 + g)] = counts[g] * terms[g].deflection_by_lateral;
        }
        match compliance.try_inverse() {
            Some(stiffness) => all + &by * stiffness * by.transpose(),
            None => all,
        }
    }
}

/// Whether a straight flexure stays straight, because no bump lowers its energy.
pub(super) fn stays_straight(t: &Terms) -> bool {
    is_positive(DMatrix::from_row_slice(t.modes, t.modes, &t.odd_odd))
}

fn is_positive(matrix: DMatrix<f64>) -> bool {
    Cholesky::new(matrix).is_some()
}
