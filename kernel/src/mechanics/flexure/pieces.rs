//! Piecewise polynomial through the states of a branch.
//!
//! Every solved state gives force and slope, so each piece is a Hermite interpolant at Chebyshev-Lobatto
//! points: neighbouring pieces share value and slope, and nothing is smoothed across a kink. Inside the first
//! kink one odd polynomial is enough; the pieces of the taut branch are as long as the tolerance allows. Each
//! piece is compared with independently solved states between its points, which give the reported accuracy.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::Units;
use super::branch::Segment;
use super::point::Point;
use super::solver::{Failure, MAX_MODES, Solver};
use crate::mechanics::{ForceCurve, Piece};
use crate::numeric::elementary;

/// Points of a piece; its degree is twice this less one.
const POINTS: usize = 7;

/// Points at x > 0 of the odd piece about x = 0; with the slope at 0 its degree is 4 times this plus one.
const ODD_POINTS: usize = 3;

/// Positions, from -1 to 1 along a piece, at which it is compared with solved states. At cos(phi) the
/// error of the force is proportional to sin(6 phi)^2 and that of the slope to sin(12 phi), which is 0
/// where the first is largest; at 160, 110 and 50 degrees they have three quarters and nine tenths of
/// their largest values.
const CHECKS: [f64; 3] = [-0.94, -0.342, 0.643];

/// Positions, from 0 to 1, at which the odd piece is compared with solved states; the innermost is for wells
/// much shallower than the forces at the kink.
const ODD_CHECKS: [f64; 4] = [0.174, 0.342, 0.643, 0.94];

/// Allowed error of the slope relative to the slope at 0, in units of the tolerance of the force.
const SLOPE_FACTOR: f64 = 100.0;

/// Share of the tolerance that a piece may use at the checks; the rest is a margin for other positions.
const CHECK_SHARE: f64 = 0.5;

/// Share of the outermost segment that its first piece covers, if it meets the tolerance.
const FIRST_SHARE: f64 = 0.3;

/// Share of the tolerance that dropping the highest degrees may use.
const DEGREE_SHARE: f64 = 0.2;

/// Neglected tail of the rotation at check states, relative to that of the states a piece is built from.
const CHECK_TAIL: f64 = 0.1;

/// Smallest length of a piece relative to its position; a shorter one means that the curve is
/// not smooth there.
const MIN_LENGTH: f64 = 1e-9;

/// Length of a segment, relative to its position, below which it is a straight line. Such segments lie
/// between the kinks of two nearly equal groups; the force there is straight to rounding, and a slope
/// computed from it would be dominated by rounding.
const STRAIGHT_LENGTH: f64 = 3e-8;

/// A polynomial on an interval of x >= 0, in scaled units.
#[derive(Debug, Clone)]
pub(super) struct ScaledPiece {
    pub to: f64,
    pub piece: Piece,
    /// The solved states that it was compared with.
    pub checks: Vec<Point>,
}

impl ScaledPiece {
    fn new(to: f64, origin: f64, coefficients: Vec<f64>) -> Self {
        Self { to, piece: Piece::new(origin, coefficients), checks: Vec::new() }
    }
}

/// Reference values of the relative errors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// The largest force between the wells; 0 with a single well.
    pub force: f64,
    /// The magnitude of the slope at x = 0.
    pub stiffness: f64,
    /// Position up to which a state is inside: the last kink, or the outermost equilibrium without kinks; 0
    /// for a single well.
    pub inside: f64,
}

impl Scale {
    pub fn of(segments: &[Segment]) -> Self {
        let points = segments.iter().flat_map(|s| &s.points);
        let force = points.clone().fold(0.0_f64, |largest, p| largest.max(-p.force));
        let stiffness = segments[0].points[0].stiffness.abs();
        let kink = segments[segments.len() - 1].from;
        let pulled = points.filter(|p| p.force < 0.0).fold(0.0_f64, |last, p| last.max(p.x));
        Self { force, stiffness, inside: if kink > 0.0 { kink } else { pulled } }
    }

    /// Error of a piece at a solved state, relative to what `tolerance` allows.
    fn error(&self, piece: &Piece, point: &Point, tolerance: f64) -> f64 {
        let force = (piece.force(point.x) - point.force).abs() / self.force.max(point.force.abs());
        let slope = (piece.stiffness(point.x) - point.stiffness).abs() / self.stiffness;
        let error = if point.x <= self.inside { force.max(slope / SLOPE_FACTOR) } else { force };
        error / tolerance
    }
}

/// The polynomials of all segments, from x = 0 outwards; the first is odd.
pub(super) fn fit(
    solver: &mut Solver,
    segments: &mut [Segment],
    scale: Scale,
    tolerance: f64,
) -> Result<Vec<ScaledPiece>, Failure> {
    let mut scaled_pieces = Vec::new();
    let last = segments.len() - 1;
    for (i, segment) in segments.iter_mut().enumerate() {
        let kink_at_end = i < last;
        let length = segment.to - segment.from;
        if length <= STRAIGHT_LENGTH * segment.to {
            scaled_pieces.push(line(segment));
            continue;
        }
        let mut from = segment.from;
        let mut size = if kink_at_end { length } else { FIRST_SHARE * length };
        while from < segment.to {
            let to = if from + 1.2 * size >= segment.to { segment.to } else { from + size };
            let odd = from == 0.0;
            let mut scaled_piece =
                if odd { odd_piece(solver, segment, to)? } else { piece(solver, segment, from, to)? };
            if odd && kink_at_end && to == segment.to {
                lower_degree(&mut scaled_piece, scale, tolerance);
            }
            let at = |t: f64| if odd { t * to } else { 0.5 * (from + to) + 0.5 * (to - from) * t };
            let mut error = 0.0_f64;
            for t in if odd { &ODD_CHECKS[..] } else { &CHECKS[..] } {
                let tail = solver.tail;
                solver.tail = CHECK_TAIL * tail;
                let point = segment.at(solver, at(*t));
                solver.tail = tail;
                let point = point?;
                error = error.max(scale.error(&scaled_piece.piece, &point, tolerance));
                scaled_piece.checks.push(point);
                // the piece is rejected whatever the other checks give
                if error > 1e3 {
                    break;
                }
            }
            // the error grows like the size to the power of the number of conditions
            let change = elementary::powf(0.3 * CHECK_SHARE / error.max(1e-30), 0.5 / POINTS as f64);
            if error <= CHECK_SHARE {
                from = to;
                size *= change.clamp(0.5, 2.5);
                scaled_pieces.push(scaled_piece);
            } else {
                size = (to - from) * change.clamp(0.1, 0.8);
                if !(size > MIN_LENGTH * segment.to) {
                    return Err(Failure::NotConverged { x: from, residual: error * tolerance });
                }
            }
        }
    }
    Ok(scaled_pieces)
}

/// The straight line between the ends of a segment.
fn line(segment: &Segment) -> ScaledPiece {
    let (first, last) = (&segment.points[0], segment.last());
    let slope = (last.force - first.force) / (last.x - first.x);
    ScaledPiece::new(last.x, first.x, vec![first.force, slope])
}

/// The odd polynomial from 0 to `to`.
fn odd_piece(solver: &mut Solver, segment: &mut Segment, to: f64) -> Result<ScaledPiece, Failure> {
    let degrees: Vec<usize> = (0..=2 * ODD_POINTS).map(|i| 2 * i + 1).collect();
    let node = |j: usize| match elementary::cos(0.5 * PI * j as f64 / ODD_POINTS as f64) {
        _ if j == ODD_POINTS => (0.0, 0.0),
        t => (t, t * to),
    };
    let found = interpolation(solver, segment, &degrees, (0..=ODD_POINTS).map(node), to)?;
    let mut coefficients = vec![0.0; 2 * degrees.len()];
    for (degree, c) in degrees.iter().zip(found) {
        coefficients[*degree] = c;
    }
    Ok(ScaledPiece::new(to, 0.0, monomials(&coefficients, to)))
}

/// The polynomial from `from` to `to`.
fn piece(solver: &mut Solver, segment: &mut Segment, from: f64, to: f64) -> Result<ScaledPiece, Failure> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let degrees: Vec<usize> = (0..2 * POINTS).collect();
    let node = |j: usize| {
        let t = -elementary::cos(PI * j as f64 / (POINTS - 1) as f64);
        (
            t,
            if j == 0 {
                from
            } else if j == POINTS - 1 {
                to
            } else {
                middle + half * t
            },
        )
    };
    let coefficients = interpolation(solver, segment, &degrees, (0..POINTS).map(node), half)?;
    Ok(ScaledPiece::new(to, middle, monomials(&coefficients, half)))
}

/// The coefficients of the Chebyshev polynomials of these degrees in t whose sum has the force and the slope
/// of the states at the nodes, each t with its x; `half` is dx/dt. A node at x = 0 gives the slope alone, as
/// the force there is 0 by symmetry.
fn interpolation(
    solver: &mut Solver,
    segment: &mut Segment,
    degrees: &[usize],
    nodes: impl Iterator<Item = (f64, f64)>,
    half: f64,
) -> Result<Vec<f64>, Failure> {
    let terms = degrees.len();
    let (mut matrix, mut right) = (DMatrix::zeros(terms, terms), DVector::zeros(terms));
    let mut row = 0;
    for (t, x) in nodes {
        let point = segment.at(solver, x)?;
        let slope_row = if x == 0.0 { row } else { row + 1 };
        for (column, degree) in degrees.iter().enumerate() {
            let (value, slope) = chebyshev(*degree, t);
            matrix[(row, column)] = value;
            matrix[(slope_row, column)] = slope;
        }
        right[row] = point.force;
        right[slope_row] = point.stiffness * half;
        row = slope_row + 1;
    }
    // the nodes are distinct, so that the matrix is regular
    Ok(matrix.lu().solve(&right).map_or_else(|| vec![f64::NAN; terms], |c| c.as_slice().to_vec()))
}

/// Chebyshev polynomial of a given degree and its derivative at `t`.
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
    }
    let mut power = 1.0;
    for s in &mut sum {
        *s /= power;
        power *= half;
    }
    sum
}

/// Drops the highest degrees of the odd piece that the tolerance does not need, without changing the value at
/// its end.
///
/// Each degree makes every step of a run slower. T_n - T_(n-2) is at most 2 and vanishes at the end.
fn lower_degree(ScaledPiece { to, piece, .. }: &mut ScaledPiece, scale: Scale, tolerance: f64) {
    let to = *to;
    let (mut force, mut slope) = (0.0, 0.0);
    while piece.coefficients.len() > 4 {
        let highest = piece.coefficients.len() - 1;
        if piece.coefficients[highest] == 0.0 {
            piece.coefficients.pop();
            continue;
        }
        // the leading coefficient of T_n is 2^(n-1)
        let size = piece.coefficients[highest] * elementary::powi(to, highest as i32)
            / elementary::powi(2.0, highest as i32 - 1);
        force += 2.0 * size.abs();
        slope += 4.0 * (highest - 1) as f64 * size.abs() / to;
        if force > DEGREE_SHARE * tolerance * scale.force
            || slope > DEGREE_SHARE * SLOPE_FACTOR * tolerance * scale.stiffness
        {
            return;
        }
        let mut dropped = vec![0.0; highest + 1];
        dropped[highest] = size;
        dropped[highest - 2] = -size;
        for (c, m) in piece.coefficients.iter_mut().zip(monomials(&dropped, to)) {
            *c -= m;
        }
        piece.coefficients.truncate(highest);
    }
}

/// Errors of the force curve at states that were not used to build it.
///
/// *Inside* is the range between the outermost kinks, or between the outermost equilibria without kinks. With
/// one well and no kink there is no such range, and errors inside are NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Accuracy {
    /// Error of the force inside, relative to its largest magnitude between the wells.
    pub force: f64,
    /// Error of the potential inside, relative to the barrier; NaN with one well.
    pub potential: f64,
    /// Error of the stiffness inside, relative to its magnitude at x = 0.
    pub stiffness: f64,
    /// Error of the force outside, relative to the larger of that largest magnitude and the force itself.
    pub outer_force: f64,
    /// Number of equilibria solved.
    pub solves: usize,
    /// Largest number of functions of each parity that an equilibrium needed.
    pub modes: usize,
}

impl Accuracy {
    /// Whether a state needed the largest number of functions: its flexures are so thin that their bending is
    /// not resolved.
    pub fn is_at_limit(&self) -> bool {
        self.modes >= MAX_MODES
    }
}

/// Compares the curve with the check states of its pieces.
pub(super) fn measure(
    curve: &ForceCurve,
    scaled_pieces: &[ScaledPiece],
    segments: &[Segment],
    scale: Scale,
    units: Units,
    solver: &Solver,
) -> Accuracy {
    let Units { length, force } = units;
    let start = segments[0].points[0].energy;
    let inside = segments.iter().flat_map(|s| &s.points).filter(|p| p.x > 0.0 && p.x <= scale.inside);
    let two_wells = inside.clone().any(|p| p.force < 0.0);
    let deepest = inside.fold(0.0_f64, |largest, p| largest.max(start - p.energy));
    let start_value = if scale.inside > 0.0 { 0.0 } else { f64::NAN };
    let mut accuracy = Accuracy {
        force: start_value,
        potential: if two_wells { 0.0 } else { f64::NAN },
        stiffness: start_value,
        outer_force: 0.0,
        solves: solver.solves,
        modes: solver.max_modes,
    };
    for point in scaled_pieces.iter().flat_map(|s| &s.checks) {
        let x = point.x * length;
        let error = (curve.force(x) / force - point.force).abs() / scale.force.max(point.force.abs());
        if point.x > scale.inside {
            accuracy.outer_force = accuracy.outer_force.max(error);
            continue;
        }
        let potential = curve.potential(x) / (force * length) - (point.energy - start);
        let stiffness = curve.stiffness(x) * length / force - point.stiffness;
        accuracy.force = accuracy.force.max(error);
        if two_wells {
            accuracy.potential = accuracy.potential.max(potential.abs() / deepest);
        }
        accuracy.stiffness = accuracy.stiffness.max(stiffness.abs() / scale.stiffness);
    }
    accuracy
}
