//! Joint equilibrium of all flexures, and its stability.
//!
//! The shuttle does not rotate and is free axially: both groups share the lateral displacement x, their
//! shortenings add up to the preload, and their axial forces are equal. The unknowns are the rotations, the
//! two lateral forces and the axial compression P. They are solved by Newton's method with exact derivatives;
//! it converges reliably because of the form of the bump's equations (see [`beam`](super::beam)).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, LU};

use super::basis::Basis;
use super::beam::{Beam, Shape, Terms};
use super::point::Point;

/// Step, relative to the unknowns, below which the iteration has converged: the next step would
/// be its square.
const SMALL_STEP: f64 = 1e-9;

/// Step below which the last matrix is used as the matrix at the solution.
const SAME_MATRIX: f64 = 1e-12;

/// Step that is accepted from the seventh iteration on. If two groups are about to buckle together, rounding
/// in the ill-conditioned matrix keeps the steps from shrinking further.
const STALLED_STEP: f64 = 1e-6;

/// Largest number of iterations; from a good guess three to six are needed.
const MAX_ITERATIONS: usize = 16;

/// Largest change of a coefficient of the rotation in one iteration; larger steps tend to diverge.
const MAX_ROTATION: f64 = 0.6;

/// The flexures in scaled units with the basis functions of their rotations.
#[derive(Debug, Clone)]
pub(super) struct System {
    /// The parallel and the buckling flexures.
    pub beams: [Beam; 2],
    /// Sum of the two shortenings.
    pub preload: f64,
    pub basis: Basis,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Prescribed {
    /// The displacement is given.
    Displacement(f64),
    /// The bump of this group vanishes; the displacement is an unknown.
    BumpVanishes(usize),
}

impl System {
    /// The state without sway: compressed flexures that are straight or have their stress-free bow.
    pub fn straight(&self) -> Point {
        let compliance: f64 = self.beams.iter().map(Beam::compliance).sum();
        let shapes = std::array::from_fn(|g| match self.beams[g].natural.is_empty() {
            true => Shape::Straight,
            false => Shape::Bowed,
        });
        Point {
            x: 0.0,
            shapes,
            even: std::array::from_fn(|_| vec![0.0; self.basis.modes]),
            odd: std::array::from_fn(|g| self.beams[g].natural.clone()),
            q: shapes.map(|shape| if shape == Shape::Bowed { 1.0 } else { 0.0 }),
            lateral: [0.0; 2],
            compression: self.preload / compliance,
            force: 0.0,
            stiffness: 0.0,
            energy: 0.0,
        }
    }

    /// Solves for the equilibrium near `guess`.
    ///
    /// Returns the point with force, stiffness and energy. The error, if the iteration does not converge, is
    /// the size of its last step relative to the unknowns.
    pub fn solve(&self, guess: &Point, prescribed: Prescribed) -> Result<Point, f64> {
        let mut point = guess.clone();
        match prescribed {
            Prescribed::Displacement(x) => point.x = x,
            Prescribed::BumpVanishes(group) => point.q[group] = 0.0,
        }
        let mut residual = f64::INFINITY;
        for iteration in 0..MAX_ITERATIONS {
            let terms = self.terms(&point);
            let (matrix, right) = self.assemble(&point, &terms, prescribed);
            let factors = matrix.lu();
            let Some(step) = factors.solve(&right) else { break };
            residual = self.advance(&mut point, &step, prescribed);
            if !residual.is_finite() {
                break;
            }
            if residual < SMALL_STEP || (iteration > 6 && residual < STALLED_STEP) {
                return Ok(self.finish(point, &factors, residual, prescribed));
            }
        }
        Err(residual)
    }

    /// Takes Newton's step, shortened to [`MAX_ROTATION`]; returns its full size relative to the unknowns.
    fn advance(&self, point: &mut Point, step: &DVector<f64>, prescribed: Prescribed) -> f64 {
        let mut unknowns = point.unknowns();
        let rotations = unknowns.len() - 3;
        let turn = step.iter().take(rotations).fold(0.0_f64, |largest, s| largest.max(s.abs()));
        let shorten = if turn > MAX_ROTATION { MAX_ROTATION / turn } else { 1.0 };
        let column = self.displacement_column(point, prescribed);
        let mut size: f64 = 0.0;
        for (i, (value, change)) in unknowns.iter_mut().zip(step.iter()).enumerate() {
            // the sum propagates a NaN, which `max` would drop
            size = size.max(change.abs() / (1.0 + value.abs())) + 0.0 * change;
            if Some(i) == column {
                point.x += shorten * change;
            } else {
                *value += shorten * change;
            }
        }
        point.set_unknowns(&unknowns);
        size
    }

    /// Index of the unknown q that the displacement replaces, if any.
    fn displacement_column(&self, point: &Point, prescribed: Prescribed) -> Option<usize> {
        match prescribed {
            Prescribed::Displacement(_) => None,
            Prescribed::BumpVanishes(group) => Some(self.offsets(point)[group] + self.basis.modes),
        }
    }

    /// Indices of the first unknown of each group and of the first of the three common unknowns.
    fn offsets(&self, point: &Point) -> [usize; 3] {
        let size = |g: usize| point.even[g].len() + point.odd[g].len();
        [0, size(0), size(0) + size(1)]
    }

    pub fn terms(&self, point: &Point) -> [Terms; 2] {
        std::array::from_fn(|g| self.beams[g].terms(&self.basis, &point.rotation(g, self.beams[g].count)))
    }

    /// Newton's matrix and right-hand side. The rows are in the order of the unknowns; the last three are the
    /// two deflections and the sum of the shortenings.
    fn assemble(
        &self,
        point: &Point,
        terms: &[Terms; 2],
        prescribed: Prescribed,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let offsets = self.offsets(point);
        let common = offsets[2];
        let size = common + 3;
        let n = self.basis.modes;
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        let (shortening_row, compression) = (common + 2, common + 2);
        right[shortening_row] = self.preload;
        for (g, t) in terms.iter().enumerate() {
            let by_compression = -1.0 / self.beams[g].count;
            let (even, odd) = (offsets[g], offsets[g] + n);
            let (lateral, deflection_row) = (common + g, common + g);
            let bump = point.shapes[g] == Shape::Bump;
            // The factor that the division of the odd rows by sqrt(q) leaves in the transposed entries.
            let q = point.q[g];
            for i in 0..n {
                right[even + i] = -t.even[i];
                for j in 0..n {
                    matrix[(even + i, even + j)] = t.even_even[i * n + j];
                }
                matrix[(even + i, compression)] = t.even_by[0][i] * by_compression;
                matrix[(even + i, lateral)] = t.even_by[1][i];
                matrix[(deflection_row, even + i)] = -t.even_by[1][i];
                matrix[(shortening_row, even + i)] = t.even_by[0][i];
            }
            for i in 0..t.odd.len() {
                right[odd + i] = -t.odd[i];
                for j in 0..n {
                    matrix[(odd + i, even + j)] = t.odd_even[i * n + j];
                    matrix[(odd + i, odd + j)] = t.odd_odd[i * n + j];
                    matrix[(even + j, odd + i)] = q * t.odd_even[i * n + j];
                }
                matrix[(odd + i, compression)] = t.odd_by[0][i] * by_compression;
                matrix[(odd + i, lateral)] = t.odd_by[1][i];
                matrix[(deflection_row, odd + i)] = -q * t.odd_by[1][i];
                matrix[(shortening_row, odd + i)] = q * t.odd_by[0][i];
            }
            if bump {
                let half = |by: &[f64]| 0.5 * by.iter().zip(&point.odd[g]).map(|(b, a)| b * a).sum::<f64>();
                for i in 0..n {
                    matrix[(even + i, odd)] = t.even_by[2][i];
                    matrix[(odd + i, odd)] = t.odd_by[2][i];
                }
                matrix[(deflection_row, odd)] = -half(&t.odd_by[1]);
                matrix[(shortening_row, odd)] = half(&t.odd_by[0]);
            }
            right[deflection_row] = point.x - t.deflection;
            right[shortening_row] -= t.shortening;
            matrix[(deflection_row, lateral)] = t.deflection_by_lateral;
            matrix[(deflection_row, compression)] = -t.shortening_by_lateral * by_compression;
            matrix[(shortening_row, lateral)] = t.shortening_by_lateral;
            matrix[(shortening_row, compression)] += t.shortening_by_axial * by_compression;
        }
        if let Some(column) = self.displacement_column(point, prescribed) {
            matrix.column_mut(column).fill(0.0);
            matrix[(common, column)] = -1.0;
            matrix[(common + 1, column)] = -1.0;
        }
        (matrix, right)
    }

    /// Adds force, stiffness and energy. The stiffness is the derivative of the lateral forces along the
    /// branch, from the factors of the last iteration.
    fn finish(
        &self,
        mut point: Point,
        factors: &LU<f64, Dyn, Dyn>,
        residual: f64,
        prescribed: Prescribed,
    ) -> Point {
        let counts = self.beams.each_ref().map(|b| b.count);
        point.force = counts[0] * point.lateral[0] + counts[1] * point.lateral[1];
        let terms = self.terms(&point);
        point.energy = counts[0] * terms[0].energy + counts[1] * terms[1].energy;
        let common = self.offsets(&point)[2];
        let along = |factors: &LU<f64, Dyn, Dyn>| {
            let mut right = DVector::zeros(common + 3);
            right[common] = 1.0;
            right[common + 1] = 1.0;
            let change = factors.solve(&right);
            change.map_or(f64::NAN, |c| counts[0] * c[common] + counts[1] * c[common + 1])
        };
        point.stiffness = match prescribed {
            // The error of the last iteration's matrix is proportional to its step, and near a rounded kink
            // or a buckling threshold the slope changes much faster than the state.
            Prescribed::Displacement(_) if residual < SAME_MATRIX => along(factors),
            _ => along(&self.assemble(&point, &terms, Prescribed::Displacement(point.x)).0.lu()),
        };
        point
    }

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
