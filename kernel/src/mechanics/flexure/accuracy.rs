//! Accuracy of a force curve, measured at independently solved states.

use super::Units;
use super::branch::Segment;
use super::pieces::{Scale, ScaledPiece};
use super::solver::Solver;
use crate::mechanics::ForceCurve;

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
