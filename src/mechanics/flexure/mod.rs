//! Force of a buckled flexure mechanism.
//!
//! `count` parallel flexures hold the shuttle on one side, one or more buckling flexures on the other; all
//! are clamped at both ends, the shuttle does not rotate and is free axially. A preload pushes the two groups
//! together: the buckling flexures bulge, and the sway of all of them has two stable sides. The curve ends in
//! a kink where the bulge is used up and the flexures are taut.
//!
//! Method: geometrically exact beams (Reissner 1972) in a spectral discretisation (`basis`), the equilibrium
//! equations of all of them at once (`equilibrium`), the stable branch with its kinks (`branch`), and
//! from a few dozen states the piecewise polynomial (`pieces`).

mod accuracy;
mod basis;
mod beam;
mod branch;
mod equilibrium;
mod pieces;
mod point;
mod shape;
mod solver;
mod stability;

use std::sync::atomic::AtomicBool;

pub use accuracy::Accuracy;
use accuracy::measured;
use beam::{Beam, Shape};
use branch::Segment;
use equilibrium::Prescribed;
use pieces::{Scale, Stretch};
use point::Point;
use shape::Bent;
use solver::{Lost, Solver};

use super::curve::{ForceCurve, Piece};

/// Shear coefficient of a rectangular section.
const SHEAR_FACTOR: f64 = 5.0 / 6.0;

/// The coefficients that a rotation may leave out, as this many times the root of the tolerance: the force
/// then has a hundredth of the tolerance from there.
const TAIL: f64 = 0.3;

/// The same for a state that a person asks for, and for those that a curve is compared with.
const FINE_TAIL: f64 = 1e-6;

/// Flexures that are alike and share both ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// How many, 1 or more.
    pub count: usize,
    /// Length of each in m, along the flexure.
    pub length: f64,
    /// Width of each in m, across the plane of motion.
    pub width: f64,
}

/// The geometry and material of a mechanism, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// By how much the two groups are pushed together axially, from their stress-free lengths, in m.
    pub preload: f64,
    /// Thickness of all flexures in m.
    pub thickness: f64,
    /// Young's modulus in Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Whether the strips are so wide that they cannot contract sideways: E/(1 - poisson^2) in place of E.
    pub plane_strain: bool,
    /// Deflection in m of the middle of the stress-free buckling flexure: a bow of the first buckling mode.
    pub initial_bow: f64,
    /// Stress in Pa at which the flexures yield.
    pub yield_stress: f64,
    /// The flexures that guide the shuttle.
    pub parallel: Group,
    /// The flexures that bulge.
    pub buckling: Group,
}

impl Accuracy {
    /// Whether a state needed more functions than there are: its flexures are so thin that it is not resolved
    /// where they bend.
    pub fn is_at_limit(&self) -> bool {
        self.modes >= solver::MOST_MODES
    }
}

/// Why no curve could be computed; x in m.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FlexureError {
    /// Newton's iteration came to no end.
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
    /// It takes too long.
    #[error(
        "the flexures take more work than can be meant, at x = {} mm: {}",
        crate::numeric::short(x * 1e3),
        remedy(*is_preloaded)
    )]
    Endless {
        /// Position in m.
        x: f64,
        /// Whether there is a preload.
        is_preloaded: bool,
    },
    /// No stable equilibrium could be followed.
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

/// What may be solved in place of a geometry.
fn remedy(is_preloaded: bool) -> &'static str {
    if is_preloaded { "try a smaller preload or other proportions" } else { "try other proportions" }
}

/// The centre line of one flexure of a group; all of a group are alike.
#[derive(Debug, Clone, PartialEq)]
pub struct CentreLine {
    /// `parallel` or `buckling`.
    pub flexure: &'static str,
    /// Arc length s from the clamp on the frame and the position px (axial), py (lateral), each in m. With a
    /// shuttle of no width the parallel flexures are clamped at (0, 0), the buckling ones at their common
    /// stress-free length less the preload.
    pub points: Vec<[f64; 3]>,
}

/// The mechanism held at one x.
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
    /// Axial force in N that the groups exchange, positive in compression.
    pub axial: f64,
    /// Deflection in m of the middle of a bulging flexure beyond its sway.
    pub bump: f64,
    /// Largest bending stress in Pa.
    pub max_stress: f64,
    /// Shapes of the two groups.
    pub lines: Vec<CentreLine>,
}

/// A solved mechanism: what its force curve was made from.
#[derive(Debug, Clone)]
pub struct Flexures {
    geometry: Geometry,
    tolerance: f64,
    accuracy: Accuracy,
    solver: Solver<'static>,
    segments: Vec<Segment>,
    units: Units,
}

/// Everything else follows from these two.
impl PartialEq for Flexures {
    fn eq(&self, other: &Self) -> bool {
        self.geometry == other.geometry && self.tolerance == other.tolerance
    }
}

/// Length and force of the scaled equations: those of one buckling flexure.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Units {
    length: f64,
    force: f64,
}

impl Flexures {
    /// Solves the mechanism.
    ///
    /// Returns its force curve, odd bit for bit, with the flexures behind it. The domain reaches 1.15 times
    /// the last kink, 1.1 times the wells and a tenth of the shortest flexure at least; breaks are the kinks,
    /// and joints of pieces that meet smoothly.
    ///
    /// Preconditions: sizes above 0, a preload from 0 to half of the shorter flexure, a thickness of at most
    /// a tenth of it.
    ///
    /// Guarantee: force and potential within `tolerance` (1e-6 to 1e-9) and stiffness within 100 times it at
    /// the points that were looked at, relative to what [`Accuracy`] says. A preload up to a quarter of the
    /// shorter flexure solves; beyond, the stable branch may end, which is an error.
    ///
    /// `tolerance` trades time for closeness; at 1e-8 it takes milliseconds.
    pub fn solve(geometry: &Geometry, tolerance: f64) -> Result<(ForceCurve, Self), FlexureError> {
        Self::solve_unless(geometry, tolerance, None)
    }

    /// As [`solve`](Self::solve); once `cancel` is set, it soon fails with any error.
    pub fn solve_unless(
        geometry: &Geometry,
        tolerance: f64,
        cancel: Option<&AtomicBool>,
    ) -> Result<(ForceCurve, Self), FlexureError> {
        let (mut solver, units) = scaled(geometry, TAIL * tolerance.sqrt(), cancel);
        let is_preloaded = geometry.preload > 0.0;
        let lost = |lost: Lost| match lost {
            Lost::NotConverged { x, residual } => {
                FlexureError::NotConverged { x: x * units.length, residual, is_preloaded }
            }
            Lost::Unstable { x } => FlexureError::Unstable { x: x * units.length, is_preloaded },
            Lost::Endless { x } => FlexureError::Endless { x: x * units.length, is_preloaded },
        };
        let mut segments = branch::trace(&mut solver).map_err(lost)?;
        // Potentials are differences from this state, and wells may be shallow beside the energy of the
        // preload.
        let coarse = std::mem::replace(&mut solver.tail, FINE_TAIL);
        let rest = solver.solve(&segments[0].points[0], Prescribed::Displacement(0.0)).map_err(lost)?;
        segments[0].points[0] = rest;
        solver.tail = coarse;
        let scale = Scale::of(&segments);
        let stretches = pieces::fit(&mut solver, &mut segments, scale, tolerance).map_err(lost)?;
        let curve = curve(&stretches, units);
        let accuracy = measured(&curve, &stretches, &segments, scale, units, &solver);
        let solver = solver.forget();
        Ok((curve, Self { geometry: geometry.clone(), tolerance, accuracy, solver, segments, units }))
    }

    /// The geometry that was solved.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// How good the curve is, measured at fresh solutions that it was not made of.
    pub fn accuracy(&self) -> &Accuracy {
        &self.accuracy
    }

    /// The mechanism held at `x` in m, solved for afresh; within the domain of the curve.
    pub fn state(&self, x: f64) -> Result<State, FlexureError> {
        let mut solver = self.solver.clone();
        solver.tail = FINE_TAIL;
        let distance = x.abs() / self.units.length;
        let last = self.segments.len() - 1;
        // In metres, as the curve has its breaks: x/length may round to the other side of a kink.
        let beyond = |segment: &Segment| segment.to * self.units.length < x.abs();
        let segment = &self.segments[self.segments.partition_point(beyond).min(last)];
        let is_preloaded = self.geometry.preload > 0.0;
        let mut point = segment.afresh(&mut solver, distance).map_err(|_| FlexureError::NotConverged {
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
        let bent: [Bent; 2] = std::array::from_fn(|g| Bent::of(&system.beams[g], point, g));
        let curvature = bent[0].curvature().max(bent[1].curvature()) / length;
        let lines = bent.each_ref().map(Bent::line);
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

/// The equations in units of one buckling flexure: its length, and its EI over that length squared.
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

/// The whole curve from its right half.
fn curve(stretches: &[Stretch], units: Units) -> ForceCurve {
    let piece = |stretch: &Stretch| {
        let mut power = 1.0;
        let coefficients = stretch.coefficients.iter().map(|c| {
            let scaled = c * units.force / power;
            power *= units.length;
            scaled
        });
        Piece {
            origin: stretch.origin * units.length,
            coefficients: coefficients.collect(),
            potential_at_origin: 0.0,
        }
    };
    let right: Vec<Piece> = stretches.iter().map(piece).collect();
    let ends: Vec<f64> = stretches.iter().map(|s| s.to * units.length).collect();
    let (breaks, end) = (&ends[..ends.len() - 1], ends[ends.len() - 1]);
    let left = right.iter().skip(1).rev().map(Piece::mirrored);
    let pieces: Vec<Piece> = left.chain(right.iter().cloned()).collect();
    let all: Vec<f64> = breaks.iter().rev().map(|b| -b).chain(breaks.iter().copied()).collect();
    ForceCurve::from_pieces(pieces, all, (-end, end), true, None)
}
