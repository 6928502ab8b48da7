//! Accuracy of a force curve, measured at fresh states.

use super::Units;
use super::branch::Segment;
use super::pieces::{Scale, Stretch};
use super::solver::Solver;
use crate::mechanics::ForceCurve;

/// How far the force curve is from fresh solutions at points that it was not made of.
///
/// *Inside* is between the outermost kinks, or between the outermost equilibria where there is no kink; with
/// one well and no kink there is no inside, and what is said of it is NaN.
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
    /// Equilibria solved for.
    pub solves: usize,
    /// Functions of each parity that the most demanding of them needed.
    pub modes: usize,
}

/// Compares the curve with the fresh states of its pieces.
pub(super) fn measured(
    curve: &ForceCurve,
    stretches: &[Stretch],
    segments: &[Segment],
    scale: Scale,
    units: Units,
    solver: &Solver,
) -> Accuracy {
    let Units { length, force } = units;
    let start = segments[0].points[0].energy;
    let inside = segments.iter().flat_map(|s| &s.points).filter(|p| p.x > 0.0 && p.x <= scale.inside);
    let two_wells = inside.clone().any(|p| p.force < 0.0);
    let deepest = inside.fold(0.0_f64, |most, p| most.max(start - p.energy));
    let none = if scale.inside > 0.0 { 0.0 } else { f64::NAN };
    let mut own = Accuracy {
        force: none,
        potential: if two_wells { 0.0 } else { f64::NAN },
        stiffness: none,
        outer_force: 0.0,
        solves: solver.solves,
        modes: solver.most_modes,
    };
    for point in stretches.iter().flat_map(|s| &s.checks) {
        let x = point.x * length;
        let missed = (curve.force(x) / force - point.force).abs() / scale.force.max(point.force.abs());
        if point.x > scale.inside {
            own.outer_force = own.outer_force.max(missed);
            continue;
        }
        let potential = curve.potential(x) / (force * length) - (point.energy - start);
        let stiffness = curve.stiffness(x) * length / force - point.stiffness;
        own.force = own.force.max(missed);
        if two_wells {
            own.potential = own.potential.max(potential.abs() / deepest);
        }
        own.stiffness = own.stiffness.max(stiffness.abs() / scale.stiffness);
    }
    own
}
