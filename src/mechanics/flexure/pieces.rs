//! Piecewise polynomial through the states of a branch.
//!
//! Every solved state gives force and slope, so each piece is Hermite's interpolant at Chebyshev-Lobatto
//! points: neighbouring pieces share value and slope, and nothing is smoothed across a kink. Inside the kink
//! one odd polynomial is enough; the pieces of the taut branch are as long as the tolerance allows. Each
//! piece is compared with fresh states between its points, and these comparisons are the accuracy that is
//! reported.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::branch::Segment;
use super::point::Point;
use super::solver::{Lost, Solver};

/// Points of a piece; its degree is twice this less one.
const POINTS: usize = 7;

/// Points of the odd piece about x = 0 at x > 0; with the slope at 0 its degree is 4 times this and one.
const ODD_POINTS: usize = 3;

/// Where, from -1 to 1 along a piece, it is compared with fresh states. At cos(phi) the error of the force
/// goes with sin(6 phi)^2 and that of the slope with sin(12 phi), which vanishes where the first is largest;
/// at 160, 110 and 50 degrees they have three quarters and nine tenths of their largest values.
const CHECKS: [f64; 3] = [-0.94, -0.342, 0.643];

/// The same for the odd piece, from 0 to 1; the innermost is for wells much shallower than the forces at the
/// kink.
const ODD_CHECKS: [f64; 4] = [0.174, 0.342, 0.643, 0.94];

/// The slope may be off by this many times the force's tolerance, relative to the slope at 0.
const SLOPE: f64 = 100.0;

/// The share of the tolerance that a piece may use up; the rest is for places that were not looked at.
const SHARE: f64 = 0.5;

/// The share of the outermost segment that its first piece takes, where it meets the tolerance there.
const FIRST: f64 = 0.3;

/// The share that giving up the highest degrees may use.
const SHARE_OF_DEGREES: f64 = 0.2;

/// The states that a piece is compared with leave out this much less of the rotation than those it is made
/// of.
const CHECK_TAIL: f64 = 0.1;

/// A piece shorter than this part of its position means that the curve is not smooth there.
const SHORTEST: f64 = 1e-9;

/// A segment shorter than this part of its position, between the kinks of two groups that are almost alike,
/// is a straight line: over so little the force bends by less than its rounding, and rounding over so little
/// is a slope.
const STRAIGHT: f64 = 3e-8;

/// A polynomial in x - origin on an interval of x >= 0, in scaled units.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    pub to: f64,
    pub origin: f64,
    pub coefficients: Vec<f64>,
    /// The fresh states that it was compared with.
    pub checks: Vec<Point>,
}

impl Stretch {
    fn force(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * (x - self.origin) + c)
    }

    fn stiffness(&self, x: f64) -> f64 {
        let terms = self.coefficients.iter().enumerate().skip(1).rev();
        terms.fold(0.0, |sum, (i, c)| sum * (x - self.origin) + i as f64 * c)
    }
}

/// What an error is relative to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// The largest force between the wells; 0 where there is one well.
    pub force: f64,
    /// The slope at x = 0, without its sign.
    pub stiffness: f64,
    /// How far the inside reaches: to the last kink, where there is none to the outermost equilibrium, 0 for
    /// one well.
    pub inside: f64,
}

impl Scale {
    pub fn of(segments: &[Segment]) -> Self {
        let points = segments.iter().flat_map(|s| &s.points);
        let force = points.clone().fold(0.0_f64, |most, p| most.max(-p.force));
        let stiffness = segments[0].points[0].stiffness.abs();
        let kink = segments[segments.len() - 1].from;
        let pulled = points.filter(|p| p.force < 0.0).fold(0.0_f64, |last, p| last.max(p.x));
        Self { force, stiffness, inside: if kink > 0.0 { kink } else { pulled } }
    }

    /// How far a stretch is off at a state, as a part of what `tolerance` allows.
    fn miss(&self, stretch: &Stretch, point: &Point, tolerance: f64) -> f64 {
        let force = (stretch.force(point.x) - point.force).abs() / self.force.max(point.force.abs());
        let slope = (stretch.stiffness(point.x) - point.stiffness).abs() / self.stiffness;
        let miss = if point.x <= self.inside { force.max(slope / SLOPE) } else { force };
        miss / tolerance
    }
}

/// The polynomials of all segments, from x = 0 outwards; the first is odd.
pub(super) fn fit(
    solver: &mut Solver,
    segments: &mut [Segment],
    scale: Scale,
    tolerance: f64,
) -> Result<Vec<Stretch>, Lost> {
    let mut stretches = Vec::new();
    let last = segments.len() - 1;
    for (i, segment) in segments.iter_mut().enumerate() {
        let kink_at_end = i < last;
        let length = segment.to - segment.from;
        if length <= STRAIGHT * segment.to {
            stretches.push(line(segment));
            continue;
        }
        let mut from = segment.from;
        let mut size = if kink_at_end { length } else { FIRST * length };
        while from < segment.to {
            let to = if from + 1.2 * size >= segment.to { segment.to } else { from + size };
            let odd = from == 0.0;
            let mut stretch =
                if odd { odd_piece(solver, segment, to)? } else { piece(solver, segment, from, to)? };
            if odd && kink_at_end && to == segment.to {
                lower_degree(&mut stretch, scale, tolerance);
            }
            let at = |t: f64| if odd { t * to } else { 0.5 * (from + to) + 0.5 * (to - from) * t };
            let mut miss = 0.0_f64;
            for t in if odd { &ODD_CHECKS[..] } else { &CHECKS[..] } {
                let tail = solver.tail;
                solver.tail = CHECK_TAIL * tail;
                let point = segment.at(solver, at(*t));
                solver.tail = tail;
                let point = point?;
                miss = miss.max(scale.miss(&stretch, &point, tolerance));
                stretch.checks.push(point);
                // Hopeless: the rest would tell no more.
                if miss > 1e3 {
                    break;
                }
            }
            // The error falls like the size to the power of the number of conditions.
            let change = (0.3 * SHARE / miss.max(1e-30)).powf(0.5 / POINTS as f64);
            if miss <= SHARE {
                from = to;
                size = (to - from).max(size) * change.clamp(0.5, 2.5);
                stretches.push(stretch);
            } else {
                size = (to - from) * change.clamp(0.1, 0.8);
                if !(size > SHORTEST * segment.to) {
                    return Err(Lost::NotConverged { x: from, residual: miss * tolerance });
                }
            }
        }
    }
    Ok(stretches)
}

/// The straight line between the ends of a segment.
fn line(segment: &Segment) -> Stretch {
    let (first, last) = (&segment.points[0], &segment.points[segment.points.len() - 1]);
    let slope = (last.force - first.force) / (last.x - first.x);
    Stretch { to: last.x, origin: first.x, coefficients: vec![first.force, slope], checks: Vec::new() }
}

/// The odd polynomial from 0 to `to`.
fn odd_piece(solver: &mut Solver, segment: &mut Segment, to: f64) -> Result<Stretch, Lost> {
    let terms = 2 * ODD_POINTS + 1;
    let mut matrix = DMatrix::zeros(terms, terms);
    let mut right = DVector::zeros(terms);
    let degrees: Vec<usize> = (0..terms).map(|i| 2 * i + 1).collect();
    for j in 0..=ODD_POINTS {
        let t = (0.5 * PI * j as f64 / ODD_POINTS as f64).cos();
        let (t, x) = if j == ODD_POINTS { (0.0, 0.0) } else { (t, t * to) };
        let point = segment.at(solver, x)?;
        let slope_row = if j == ODD_POINTS { 2 * ODD_POINTS } else { 2 * j + 1 };
        for (column, degree) in degrees.iter().enumerate() {
            let (value, slope) = chebyshev(*degree, t);
            matrix[(slope_row, column)] = slope;
            if j < ODD_POINTS {
                matrix[(2 * j, column)] = value;
            }
        }
        right[slope_row] = point.stiffness * to;
        if j < ODD_POINTS {
            right[2 * j] = point.force;
        }
    }
    let all = solved(matrix, &right);
    let mut coefficients = vec![0.0; 2 * terms];
    for (degree, c) in degrees.iter().zip(all.iter()) {
        coefficients[*degree] = *c;
    }
    Ok(Stretch { to, origin: 0.0, coefficients: monomials(&coefficients, to), checks: Vec::new() })
}

/// The polynomial from `from` to `to`.
fn piece(solver: &mut Solver, segment: &mut Segment, from: f64, to: f64) -> Result<Stretch, Lost> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let terms = 2 * POINTS;
    let mut matrix = DMatrix::zeros(terms, terms);
    let mut right = DVector::zeros(terms);
    for j in 0..POINTS {
        let t = -(PI * j as f64 / (POINTS - 1) as f64).cos();
        let x = match j {
            0 => from,
            _ if j == POINTS - 1 => to,
            _ => middle + half * t,
        };
        let point = segment.at(solver, x)?;
        for degree in 0..terms {
            let (value, slope) = chebyshev(degree, t);
            matrix[(2 * j, degree)] = value;
            matrix[(2 * j + 1, degree)] = slope;
        }
        right[2 * j] = point.force;
        right[2 * j + 1] = point.stiffness * half;
    }
    let coefficients = solved(matrix, &right);
    Ok(Stretch { to, origin: middle, coefficients: monomials(&coefficients, half), checks: Vec::new() })
}

/// The points of an interpolation are distinct, so that the matrix is regular.
fn solved(matrix: DMatrix<f64>, right: &DVector<f64>) -> Vec<f64> {
    matrix.lu().solve(right).map_or_else(|| vec![f64::NAN; right.len()], |c| c.as_slice().to_vec())
}

/// Chebyshev's polynomial of this degree and its derivative at `t`.
fn chebyshev(degree: usize, t: f64) -> (f64, f64) {
    let (mut value, mut next) = (1.0, t);
    let (mut slope, mut next_slope) = (0.0, 1.0);
    for _ in 0..degree {
        (value, next, slope, next_slope) =
            (next, 2.0 * t * next - value, next_slope, 2.0 * next + 2.0 * t * next_slope - slope);
    }
    (value, slope)
}

/// Coefficients of powers of y from those of Chebyshev polynomials of y/`half`.
fn monomials(chebyshev: &[f64], half: f64) -> Vec<f64> {
    let mut sum = vec![0.0; chebyshev.len()];
    let (mut before, mut now) = (vec![0.0; chebyshev.len()], vec![0.0; chebyshev.len()]);
    now[0] = 1.0;
    for (degree, c) in chebyshev.iter().enumerate() {
        for (s, m) in sum.iter_mut().zip(&now) {
            *s += c * m;
        }
        let factor = if degree == 0 { 1.0 } else { 2.0 };
        let next: Vec<f64> =
            (0..now.len()).map(|i| factor * if i > 0 { now[i - 1] } else { 0.0 } - before[i]).collect();
        before = std::mem::replace(&mut now, next);
        if degree == 0 {
            before = vec![0.0; chebyshev.len()];
            before[0] = 1.0;
        }
    }
    let mut power = 1.0;
    for s in &mut sum {
        *s /= power;
        power *= half;
    }
    sum
}

/// Gives up the highest degrees of the odd piece that the tolerance does not need; the value at its end
/// stays.
///
/// A run pays for each degree at every step. T_n - T_(n-2) is at most 2 and vanishes at the end.
fn lower_degree(stretch: &mut Stretch, scale: Scale, tolerance: f64) {
    let to = stretch.to;
    let (mut force, mut slope) = (0.0, 0.0);
    while stretch.coefficients.len() > 4 {
        let highest = stretch.coefficients.len() - 1;
        if stretch.coefficients[highest] == 0.0 {
            stretch.coefficients.pop();
            continue;
        }
        // The leading coefficient of T_n is 2^(n-1).
        let size = stretch.coefficients[highest] * to.powi(highest as i32) / 2.0_f64.powi(highest as i32 - 1);
        force += 2.0 * size.abs();
        slope += 4.0 * (highest - 1) as f64 * size.abs() / to;
        if force > SHARE_OF_DEGREES * tolerance * scale.force
            || slope > SHARE_OF_DEGREES * SLOPE * tolerance * scale.stiffness
        {
            return;
        }
        let mut lost = vec![0.0; highest + 1];
        lost[highest] = size;
        lost[highest - 2] = -size;
        for (c, m) in stretch.coefficients.iter_mut().zip(monomials(&lost, to)) {
            *c -= m;
        }
        stretch.coefficients.truncate(highest);
    }
}
