//! Restoring force of a buckled flexure mechanism.
//!
//! `count` parallel flexures hold the shuttle on one side and one or more buckling flexures on the other. All
//! are clamped at both ends; the shuttle does not rotate and is free axially. A preload pushes the two groups
//! together: the buckling flexures bulge, and the sway of all flexures has two stable sides. The force has a
//! kink where the bulge vanishes and the flexures become taut.
//!
//! Method: geometrically exact beams (Reissner 1972) in a spectral discretisation (`basis`), the equilibrium
//! equations of all beams together (`equilibrium`), the stable branch with its kinks (`branch`), and a
//! piecewise polynomial through a few dozen states (`pieces`).

mod basis;
mod beam;
mod branch;
mod equilibrium;
mod pieces;
mod point;
mod shape;
mod solver;

use std::sync::atomic::AtomicBool;

use beam::{Beam, Shape};
use branch::Segment;
use equilibrium::Prescribed;
pub use pieces::Accuracy;
use pieces::{Scale, ScaledPiece, measure};
use point::Point;
use shape::Deflected;
use solver::{Failure, Solver};

use super::curve::{ForceCurve, Piece};

/// Shear coefficient of a rectangular section.
const SHEAR_FACTOR: f64 = 5.0 / 6.0;

/// Neglected coefficients of a rotation relative to the square root of the tolerance. They contribute a
/// hundredth of the tolerance to the error of the force.
const TAIL: f64 = 0.3;

/// The same for single states, which are solved more accurately than a curve.
const FINE_TAIL: f64 = 1e-6;

/// Equal flexures in parallel.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Number of flexures, 1 or more.
    pub count: usize,
    /// Length of each in m, along the flexure.
    pub length: f64,
    /// Width of each in m, across the plane of motion.
    pub width: f64,
}

/// The geometry and material of a mechanism, in SI.
///
/// [`Flexures::solve`] makes a force curve of it. A scene has it in mm and GPa, as
/// [`Flexures`](crate::scene::Mechanism::Flexures).
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Axial distance in m by which the two groups are pushed together from their stress-free lengths.
    pub preload: f64,
    /// Thickness of all flexures in m.
    pub thickness: f64,
    /// Young's modulus in Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Whether the flexures are so wide that they cannot contract sideways: E/(1 - poisson^2) replaces E.
    pub plane_strain: bool,
    /// Deflection in m of the middle of the stress-free buckling flexure, in the form of the
    /// first buckling mode.
    pub initial_bow: f64,
    /// Stress in Pa at which the flexures yield.
    pub yield_stress: f64,
    /// The flexures that guide the shuttle.
    pub parallel: Group,
    /// The flexures that bulge.
    pub buckling: Group,
}

/// Reason why no curve could be computed; x in m.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FlexureError {
    /// Newton's iteration did not converge.
    #[error(
        "the equilibrium of the flexures at x = {} mm was not found (residual {residual:.1e}): {}",
        crate::numeric::short(x * 1e3),
        remedy(*is_preloaded)
    )]
    NotConverged {
        /// Position in m.
        x: f64,
        /// Size of the last step, relative to the unknowns.
        residual: f64,
        /// Whether there is a preload.
        is_preloaded: bool,
    },
    /// The solver stopped after too much work, or was cancelled.
    #[error(
        "solving the flexures takes too much work at x = {} mm: {}",
        crate::numeric::short(x * 1e3),
        remedy(*is_preloaded)
    )]
    TooMuchWork {
        /// Position in m.
        x: f64,
        /// Whether there is a preload.
        is_preloaded: bool,
    },
    /// The stable branch ended.
    #[error(
        "the flexures have no stable shape of this kind at x = {} mm: {}",
        crate::numeric::short(x * 1e3),
        remedy(*is_preloaded)
    )]
    Unstable {
        /// Position in m.
        x: f64,
        /// Whether there is a preload.
        is_preloaded: bool,
    },
}

fn remedy(is_preloaded: bool) -> &'static str {
    if is_preloaded { "try a smaller preload or other proportions" } else { "try other proportions" }
}

/// The centre line of one flexure of a group; all flexures of a group are equal.
#[derive(Debug, Clone, PartialEq)]
pub struct CentreLine {
    /// `parallel` or `buckling`.
    pub flexure: &'static str,
    /// Arc length s from the clamp on the frame and the position px (axial), py (lateral), each in m. For a
    /// shuttle of zero width the parallel flexures are clamped to the frame at (0, 0) and the buckling
    /// flexures at px equal to the sum of the stress-free lengths less the preload.
    pub points: Vec<[f64; 3]>,
}

/// State of the mechanism held at one x.
///
/// It is solved anew at this position and not taken from the force curve.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Position in m.
    pub x: f64,
    /// Force dV/dx in N.
    pub force: f64,
    /// Potential in J, 0 at x = 0.
    pub potential: f64,
    /// Stiffness in N/m; at a kink that of its inner side.
    pub stiffness: f64,
    /// Axial force in N, equal for both groups and positive in compression.
    pub axial: f64,
    /// Deflection in m of the middle of a bulging flexure in excess of its sway.
    pub bump: f64,
    /// Largest bending stress in Pa.
    pub max_stress: f64,
    /// Shapes of the two groups.
    pub lines: Vec<CentreLine>,
}

/// A solved mechanism: the states that its force curve was computed from.
///
/// [`Mechanism::flexures`](super::Mechanism::flexures) has it for a scene with flexures;
/// [`state`](Self::state) solves the shape and the stress at one displacement.
#[derive(Debug, Clone)]
pub struct Flexures {
    geometry: Geometry,
    tolerance: f64,
    accuracy: Accuracy,
    solver: Solver<'static>,
    segments: Vec<Segment>,
    units: Units,
}

/// Geometry and tolerance determine everything else.
impl PartialEq for Flexures {
    fn eq(&self, other: &Self) -> bool {
        self.geometry == other.geometry && self.tolerance == other.tolerance
    }
}

/// Units of length and force of the scaled equations, from one buckling flexure.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Units {
    length: f64,
    force: f64,
}

impl Flexures {
    /// Solves the mechanism.
    ///
    /// Returns the force curve, odd bit for bit, and the solved flexures. The domain ends at 1.15 times the
    /// last kink, 1.1 times the wells or a tenth of the shortest flexure, whichever is farthest; breaks are
    /// the kinks and the joints of pieces that meet smoothly.
    ///
    /// Preconditions: sizes above 0, a preload from 0 to half of the shorter flexure, a thickness of at most
    /// a tenth of it.
    ///
    /// Guarantee: at the checked points, force and potential are within `tolerance` (1e-6 to 1e-9) and
    /// the stiffness within 100 times `tolerance`, relative to the references in [`Accuracy`]. A preload
    /// up to a quarter of the shorter flexure can be solved; beyond that the stable branch may end, which
    /// is an error.
    ///
    /// A smaller `tolerance` takes longer; 1e-8 takes milliseconds.
    pub fn solve(geometry: &Geometry, tolerance: f64) -> Result<(ForceCurve, Self), FlexureError> {
        Self::solve_cancellable(geometry, tolerance, None)
    }

    /// Like [`solve`](Self::solve), but fails, with any error, soon after `cancel` is set.
    pub fn solve_cancellable(
        geometry: &Geometry,
        tolerance: f64,
        cancel: Option<&AtomicBool>,
    ) -> Result<(ForceCurve, Self), FlexureError> {
        let (mut solver, units) = scaled(geometry, TAIL * tolerance.sqrt(), cancel);
        let is_preloaded = geometry.preload > 0.0;
        let in_metres = |failure: Failure| match failure {
            Failure::NotConverged { x, residual } => {
                FlexureError::NotConverged { x: x * units.length, residual, is_preloaded }
            }
            Failure::Unstable { x } => FlexureError::Unstable { x: x * units.length, is_preloaded },
            Failure::TooMuchWork { x } => FlexureError::TooMuchWork { x: x * units.length, is_preloaded },
        };
        let mut segments = branch::trace(&mut solver).map_err(in_metres)?;
        // Potentials are differences from this state, and wells may be shallow compared with the energy of
        // the preload, so solve it more accurately.
        let coarse = std::mem::replace(&mut solver.tail, FINE_TAIL);
        let rest = solver.solve(&segments[0].points[0], Prescribed::Displacement(0.0)).map_err(in_metres)?;
        segments[0].points[0] = rest;
        solver.tail = coarse;
        let scale = Scale::of(&segments);
        let scaled_pieces = pieces::fit(&mut solver, &mut segments, scale, tolerance).map_err(in_metres)?;
        let curve = curve(&scaled_pieces, units);
        let accuracy = measure(&curve, &scaled_pieces, &segments, scale, units, &solver);
        let solver = solver.without_cache();
        Ok((curve, Self { geometry: geometry.clone(), tolerance, accuracy, solver, segments, units }))
    }

    /// The geometry that was solved.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Errors of the curve, measured at states that were not used to build it.
    pub fn accuracy(&self) -> &Accuracy {
        &self.accuracy
    }

    /// Solves the mechanism held at `x` in m, within the domain of the curve.
    ///
    /// # Errors
    ///
    /// [`FlexureError`] if there is no stable state of the branch at `x`, or it is not found.
    pub fn state(&self, x: f64) -> Result<State, FlexureError> {
        let mut solver = self.solver.clone();
        solver.tail = FINE_TAIL;
        let distance = x.abs() / self.units.length;
        let last = self.segments.len() - 1;
        // Compare in metres, like the breaks of the curve: x/length may round to the other side of a kink.
        let beyond = |segment: &Segment| segment.to * self.units.length < x.abs();
        let segment = &self.segments[self.segments.partition_point(beyond).min(last)];
        let is_preloaded = self.geometry.preload > 0.0;
        let mut point = segment.solve_at(&mut solver, distance).map_err(|_| FlexureError::NotConverged {
            x,
            residual: f64::NAN,
            is_preloaded,
        })?;
        if x < 0.0 {
            point.x = -point.x;
            point.force = -point.force;
            point.lateral = point.lateral.map(|q| -q);
            point.even.iter_mut().flatten().for_each(|a| *a = -*a);
        }
        Ok(self.described(&mut solver, &point, x))
    }

    fn described(&self, solver: &mut Solver, point: &Point, x: f64) -> State {
        let Units { length, force } = self.units;
        let system = solver.system(point.even[0].len()).clone();
        let deflected: [Deflected; 2] = std::array::from_fn(|g| Deflected::of(&system.beams[g], point, g));
        let curvature = deflected[0].curvature().max(deflected[1].curvature()) / length;
        let lines = deflected.each_ref().map(Deflected::line);
        let bumps = (0..2).filter(|g| point.shapes[*g] != Shape::Straight).map(|g| shape::bump(&lines[g]));
        let bump = bumps.fold(0.0, f64::max);
        let clamp = (0..2).map(|g| system.beams[g].length - system.beams[g].natural_shortening).sum::<f64>()
            - system.preload;
        let line = |g: usize, flexure: &'static str| CentreLine {
            flexure,
            points: lines[g]
                .iter()
                .map(|[s, along, across]| {
                    let along = if g == 0 { *along } else { clamp - along };
                    [s * length, along * length, across * length]
                })
                .collect(),
        };
        State {
            x,
            force: point.force * force,
            potential: (point.energy - self.segments[0].points[0].energy) * force * length,
            stiffness: point.stiffness * force / length,
            axial: point.compression * force,
            bump: bump * length,
            max_stress: bending_modulus(&self.geometry) * 0.5 * self.geometry.thickness * curvature,
            lines: vec![line(0, "parallel"), line(1, "buckling")],
        }
    }
}

fn bending_modulus(geometry: &Geometry) -> f64 {
    let Geometry { young, poisson, plane_strain, .. } = geometry;
    if *plane_strain { young / (1.0 - poisson * poisson) } else { *young }
}

/// The equations in units of one buckling flexure: its length, and its EI over the square of that length.
fn scaled<'a>(geometry: &Geometry, tail: f64, cancel: Option<&'a AtomicBool>) -> (Solver<'a>, Units) {
    let Geometry { thickness, young, poisson, .. } = *geometry;
    let modulus = bending_modulus(geometry);
    let shear_modulus = young / (2.0 * (1.0 + poisson));
    let bending = |group: &Group| modulus * group.width * thickness.powi(3) / 12.0;
    let length = geometry.buckling.length;
    let force = bending(&geometry.buckling) / (length * length);
    let beam = |group: &Group| Beam {
        count: group.count as f64,
        length: group.length / length,
        bending: bending(group) / (force * length * length),
        stretch: force / (modulus * group.width * thickness),
        shear: force / (SHEAR_FACTOR * shear_modulus * group.width * thickness),
        natural: Vec::new(),
        natural_shortening: 0.0,
    };
    let bow = std::f64::consts::PI * geometry.initial_bow / length;
    let beams = [beam(&geometry.parallel), beam(&geometry.buckling)];
    (Solver::new(beams, geometry.preload / length, [0.0, bow], tail, cancel), Units { length, force })
}

/// The whole curve in SI units from the scaled pieces of its right half.
fn curve(scaled_pieces: &[ScaledPiece], units: Units) -> ForceCurve {
    let in_metres = |ScaledPiece { piece, .. }: &ScaledPiece| {
        let mut power = 1.0;
        let coefficients = piece.coefficients.iter().map(|c| {
            let scaled = c * units.force / power;
            power *= units.length;
            scaled
        });
        Piece::new(piece.origin * units.length, coefficients.collect())
    };
    let right: Vec<Piece> = scaled_pieces.iter().map(in_metres).collect();
    let ends: Vec<f64> = scaled_pieces.iter().map(|s| s.to * units.length).collect();
    ForceCurve::odd(right, &ends[..ends.len() - 1], ends[ends.len() - 1])
}
