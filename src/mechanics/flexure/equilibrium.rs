//! Joint equilibrium of all flexures, and its stability.
//!
//! The shuttle does not rotate and is free axially: both groups share the lateral displacement x, their
//! shortenings add up to the preload and their axial forces are equal. Unknown are the rotations, the two
//! lateral forces and the compression P that the groups exchange. Newton's method with the exact derivatives;
//! what makes it converge where other solvers fail is the form of the bump's equations (see
//! [`beam`](super::beam)).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, LU};

use super::basis::Basis;
use super::beam::{Beam, Rotation, Shape, Terms};

/// A step smaller than this part of the unknowns ends the iteration: the next one would be its square.
const SMALL_STEP: f64 = 1e-9;

/// After a step as small as this the matrix before it is the matrix at the solution.
const SAME_MATRIX: f64 = 1e-12;

/// Where two groups are about to buckle at once the steps do not shrink below the rounding of an
/// ill-conditioned matrix; from the seventh on this is enough.
const STALLED_STEP: f64 = 1e-6;

/// More iterations than a convergent run needs; from a fair guess there are three to six.
const MOST_ITERATIONS: usize = 16;

/// The largest change of a coefficient of the rotation in one iteration; more leads astray.
const LARGEST_TURN: f64 = 0.6;

/// The flexures in scaled units, with the functions that their rotations are written in.
#[derive(Debug, Clone)]
pub(super) struct System {
    /// The parallel and the buckling flexures.
    pub beams: [Beam; 2],
    /// Sum of the two shortenings.
    pub preload: f64,
    pub basis: Basis,
}

/// An equilibrium of the whole mechanism at one x, in scaled units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub shapes: [Shape; 2],
    pub even: [Vec<f64>; 2],
    /// Coefficients of psi with a leading 1 (a bump), of the odd part (bowed), or nothing.
    pub odd: [Vec<f64>; 2],
    pub q: [f64; 2],
    /// Lateral force of one flexure of each group.
    pub lateral: [f64; 2],
    /// Compression that the groups exchange.
    pub compression: f64,
    /// dV/dx, its derivative, and the strain energy.
    pub force: f64,
    pub stiffness: f64,
    pub energy: f64,
}

/// What is prescribed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Prescribed {
    /// The displacement.
    Displacement(f64),
    /// The vanishing of this group's bump; the displacement is found.
    BumpVanishes(usize),
}

/// The iteration ended without an answer; the size of its last step, relative to the unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stalled {
    pub residual: f64,
}

impl Point {
    fn rotation(&self, group: usize, count: f64) -> Rotation<'_> {
        Rotation {
            shape: self.shapes[group],
            even: &self.even[group],
            odd: &self.odd[group],
            q: self.q[group],
            axial: -self.compression / count,
            lateral: self.lateral[group],
        }
    }

    /// The unknowns in a row: for each group the even coefficients and, where there are any, the odd ones (of
    /// a bump, q stands in place of the leading 1); then the lateral forces and the compression.
    fn unknowns(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for group in 0..2 {
            all.extend(&self.even[group]);
            all.extend(&self.odd[group]);
            if self.shapes[group] == Shape::Bump {
                let leading = all.len() - self.odd[group].len();
                all[leading] = self.q[group];
            }
        }
        all.extend(self.lateral);
        all.push(self.compression);
        all
    }

    /// Takes the unknowns back; the inverse of [`Self::unknowns`].
    fn take(&mut self, all: &[f64]) {
        let mut at = 0;
        for group in 0..2 {
            for part in [&mut self.even[group], &mut self.odd[group]] {
                let end = at + part.len();
                part.copy_from_slice(&all[at..end]);
                at = end;
            }
            if self.shapes[group] == Shape::Bump {
                self.q[group] = std::mem::replace(&mut self.odd[group][0], 1.0);
            }
        }
        self.lateral = [all[at], all[at + 1]];
        self.compression = all[at + 2];
    }

    /// The same state with other shapes: a bump that appears has vanishing size and the form of the first
    /// buckling mode, one that goes leaves nothing.
    pub fn reshaped(&self, shapes: [Shape; 2], basis: &Basis) -> Self {
        let mut own = Self { shapes, ..self.clone() };
        for (group, shape) in shapes.into_iter().enumerate() {
            match shape {
                Shape::Straight => {
                    own.odd[group] = Vec::new();
                    own.q[group] = 0.0;
                }
                Shape::Bump if self.shapes[group] != Shape::Bump => {
                    own.odd[group] = basis.first_buckling_mode();
                    let leading = own.odd[group][0];
                    own.odd[group].iter_mut().for_each(|c| *c /= leading);
                    own.q[group] = 0.0;
                }
                _ => {}
            }
        }
        own
    }

    /// The same state with more functions, whose coefficients are 0.
    pub fn padded(&self, modes: usize) -> Self {
        let mut own = self.clone();
        for group in 0..2 {
            own.even[group].resize(modes, 0.0);
            if own.shapes[group] != Shape::Straight {
                own.odd[group].resize(modes, 0.0);
            }
        }
        own
    }

    /// How large the last coefficients of the rotations are beside the largest: what further functions would
    /// add.
    pub fn tail(&self) -> f64 {
        let all = (0..2).flat_map(|g| {
            let size = self.q[g].abs().sqrt();
            let bowed = self.shapes[g] == Shape::Bowed;
            let odd: Vec<f64> = self.odd[g].iter().map(|a| if bowed { *a } else { a * size }).collect();
            [self.even[g].clone(), odd]
        });
        let parts: Vec<Vec<f64>> = all.collect();
        let largest = parts.iter().flatten().fold(0.0_f64, |most, a| most.max(a.abs()));
        let last = parts
            .iter()
            .flat_map(|part| part.iter().rev().take(2))
            .fold(0.0_f64, |most, a| most.max(a.abs()));
        if largest > 0.0 { last / largest } else { 0.0 }
    }

    /// A guess at `x` from solved points of the same shapes: Lagrange's interpolation of the unknowns. Points
    /// at x >= 0 stand for their mirror images too where `mirrored`: rotation and lateral force of the sway
    /// are odd in x, everything else is even.
    pub fn between(points: &[&Self], x: f64, mirrored: bool) -> Self {
        let modes = points.iter().map(|p| p.even[0].len()).max().unwrap_or(0);
        let points: Vec<Self> = points.iter().map(|p| p.padded(modes)).collect();
        let nodes: Vec<f64> = points
            .iter()
            .flat_map(|p| if mirrored && p.x > 0.0 { vec![p.x, -p.x] } else { vec![p.x] })
            .collect();
        let weight = |node: f64| -> f64 {
            nodes.iter().filter(|other| **other != node).map(|other| (x - other) / (node - other)).product()
        };
        let mut own = points[0].clone();
        let mut odd_in_x = Vec::new();
        for group in 0..2 {
            odd_in_x.extend(vec![true; own.even[group].len()]);
            odd_in_x.extend(vec![false; own.odd[group].len()]);
        }
        odd_in_x.extend([true, true, false]);
        let mut sum = vec![0.0; odd_in_x.len()];
        for point in &points {
            let right = weight(point.x);
            let left = if mirrored && point.x > 0.0 { weight(-point.x) } else { 0.0 };
            for ((s, value), odd) in sum.iter_mut().zip(point.unknowns()).zip(&odd_in_x) {
                *s += value * if *odd { right - left } else { right + left };
            }
        }
        own.take(&sum);
        own.x = x;
        own
    }
}

impl System {
    /// The state without any sway: the flexures compressed, straight or as bowed as they are made.
    pub fn straight(&self) -> Point {
        let compliance: f64 = self.beams.iter().map(|b| b.length * b.stretch / b.count).sum();
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
    /// Returns the point with force, stiffness and energy; fails where the iteration does not converge.
    pub fn solve(&self, guess: &Point, prescribed: Prescribed) -> Result<Point, Stalled> {
        let mut point = guess.clone();
        match prescribed {
            Prescribed::Displacement(x) => point.x = x,
            Prescribed::BumpVanishes(group) => point.q[group] = 0.0,
        }
        let mut residual = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
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
        Err(Stalled { residual })
    }

    /// Takes Newton's step, shortened where it turns too far; returns its full size relative to the unknowns.
    fn advance(&self, point: &mut Point, step: &DVector<f64>, prescribed: Prescribed) -> f64 {
        let mut unknowns = point.unknowns();
        let rotations = unknowns.len() - 3;
        let turn = step.iter().take(rotations).fold(0.0_f64, |most, s| most.max(s.abs()));
        let shorten = if turn > LARGEST_TURN { LARGEST_TURN / turn } else { 1.0 };
        let column = self.displacement_column(point, prescribed);
        let mut size: f64 = 0.0;
        for (i, (value, change)) in unknowns.iter_mut().zip(step.iter()).enumerate() {
            // Adding carries a NaN along where `max` would drop it.
            size = size.max(change.abs() / (1.0 + value.abs())) + 0.0 * change;
            if Some(i) == column {
                point.x += shorten * change;
            } else {
                *value += shorten * change;
            }
        }
        point.take(&unknowns);
        size
    }

    /// Where among the unknowns the displacement stands in place of q.
    fn displacement_column(&self, point: &Point, prescribed: Prescribed) -> Option<usize> {
        match prescribed {
            Prescribed::Displacement(_) => None,
            Prescribed::BumpVanishes(group) => Some(self.offsets(point)[group] + self.basis.modes),
        }
    }

    /// Where each group's unknowns begin, and where the three common ones do.
    fn offsets(&self, point: &Point) -> [usize; 3] {
        let size = |g: usize| point.even[g].len() + point.odd[g].len();
        [0, size(0), size(0) + size(1)]
    }

    pub fn terms(&self, point: &Point) -> [Terms; 2] {
        std::array::from_fn(|g| self.beams[g].terms(&self.basis, &point.rotation(g, self.beams[g].count)))
    }

    /// Newton's matrix and right-hand side. The rows stand in the order of the unknowns; the last three are
    /// the two deflections and the sum of the shortenings.
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
            // By a bump's leading unknown, q, where plain coefficients have their own.
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
    /// solutions, from the factors of the last iteration.
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
            // The matrix of the last iteration is as far off as its step was long, and beside a rounded kink
            // or a threshold the slope changes much faster than the state.
            Prescribed::Displacement(_) if residual < SAME_MATRIX => along(factors),
            _ => along(&self.assemble(&point, &terms, Prescribed::Displacement(point.x)).0.lu()),
        };
        point
    }

    /// Whether the equilibrium is stable with x held: the second variation of the strain energy is positive,
    /// for all flexures together and for each flexure of a group against its neighbours.
    ///
    /// Method: the forces eliminated from the second variation leave one symmetric matrix of the coefficients
    /// alone, which has a Cholesky factor where no eigenvalue is negative. At a bump that just vanishes it is
    /// singular and the answer is left to rounding.
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

/// The second variation of one flexure by its coefficients and by its two forces. Of a straight one the odd
/// coefficients stand apart, see [`stays_straight`].
struct Variation {
    stiffness: DMatrix<f64>,
    by_axial: DVector<f64>,
    by_lateral: DVector<f64>,
}

impl Variation {
    fn of(t: &Terms, q: f64) -> Self {
        // The odd rows were divided by this.
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

    /// With both ends of this flexure held.
    fn alone(&self, t: &Terms) -> DMatrix<f64> {
        let (a, b, c) = (-t.shortening_by_axial, -t.shortening_by_lateral, t.deflection_by_lateral);
        let determinant = a * c - b * b;
        let (u, v) = (&self.by_axial, &self.by_lateral);
        &self.stiffness
            + (c * u * u.transpose() - b * (u * v.transpose() + v * u.transpose()) + a * v * v.transpose())
                / determinant
    }

    /// With x held and the shuttle free axially.
    fn together(parts: &[Self; 2], terms: &[Terms; 2], counts: [f64; 2]) -> DMatrix<f64> {
        let sizes = parts.each_ref().map(|p| p.stiffness.nrows());
        let mut all = DMatrix::zeros(sizes[0] + sizes[1], sizes[0] + sizes[1]);
        // Columns: by the compression, by the two lateral forces.
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

/// Whether a straight flexure keeps its shape: no bump lowers its energy.
pub(super) fn stays_straight(t: &Terms) -> bool {
    is_positive(DMatrix::from_row_slice(t.modes, t.modes, &t.odd_odd))
}

fn is_positive(matrix: DMatrix<f64>) -> bool {
    Cholesky::new(matrix).is_some()
}
