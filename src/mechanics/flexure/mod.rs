//! Which force do clamped flexures exert on their shuttle? The interface of the solver, with a stand-in for it.

use super::curve::{ForceCurve, Piece};

/// Equal flexures side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Group {
    /// How many there are.
    pub count: usize,
    /// Length of each between its clamps in m.
    pub length: f64,
    /// Width of each in m.
    pub width: f64,
}

/// Flexures in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Shortening in m that parallel and buckling flexures share at x = 0.
    pub preload: f64,
    /// Thickness of every flexure in m.
    pub thickness: f64,
    /// Young's modulus in Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Whether E/(1 - poisson^2) takes the place of E in stretching and bending.
    pub plane_strain: bool,
    /// Stress-free bow of the buckling flexures at their middle in m.
    pub initial_bow: f64,
    /// Bending stress in Pa that is allowed.
    pub yield_stress: f64,
    /// The flexures that guide the shuttle.
    pub parallel: Group,
    /// The flexures that buckle.
    pub buckling: Group,
}

/// A solved mechanism.
#[derive(Debug, Clone, PartialEq)]
pub struct Flexures {
    geometry: Geometry,
    accuracy: Accuracy,
    curve: ForceCurve,
}

/// Errors of the force curve against fresh solutions at points that it was not made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Of the force inside the kink, relative to the inner force maximum.
    pub force: f64,
    /// Of the potential, relative to the barrier.
    pub potential: f64,
    /// Of the stiffness at x = 0, relative to it.
    pub stiffness: f64,
    /// Of the force beyond the kink, relative to the larger of the inner maximum and the force there.
    pub outer_force: f64,
    /// Solutions that the curve was made from.
    pub solves: usize,
    /// Modes of each flexure.
    pub modes: usize,
}

/// One solution.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Displacement of the shuttle in m.
    pub x: f64,
    /// Force dV/dx in N.
    pub force: f64,
    /// Potential in J.
    pub potential: f64,
    /// Stiffness in N/m.
    pub stiffness: f64,
    /// Compression of all buckling flexures together in N.
    pub axial: f64,
    /// Height of the bump of the buckling flexures in m.
    pub bump: f64,
    /// Largest bending stress in Pa.
    pub max_stress: f64,
    /// Centre line of one flexure of each group.
    pub lines: Vec<CentreLine>,
}

/// The centre line of a flexure.
#[derive(Debug, Clone, PartialEq)]
pub struct CentreLine {
    /// `parallel` or `buckling`.
    pub flexure: &'static str,
    /// s, px and py in m.
    pub points: Vec<[f64; 3]>,
}

/// Why flexures have no solution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FlexureError {
    /// The iteration did not converge.
    #[error("the flexures could not be solved at x = {} mm: the residual stays at {residual:e}", x * 1e3)]
    NotConverged {
        /// Where, in m.
        x: f64,
        /// Relative residual.
        residual: f64,
    },
    /// No stable solution was found.
    #[error("no stable shape of the flexures was found at x = {} mm", x * 1e3)]
    Unstable {
        /// Where, in m.
        x: f64,
    },
}

impl Flexures {
    /// The force curve to a relative `tolerance`, and the solution behind it.
    pub fn solve(geometry: &Geometry, _tolerance: f64) -> Result<(ForceCurve, Self), FlexureError> {
        let shorter = geometry.parallel.length.min(geometry.buckling.length);
        if geometry.preload > 0.25 * shorter {
            return Err(FlexureError::NotConverged { x: 0.0, residual: 1.0 });
        }
        let kink = (shorter * geometry.preload).sqrt().max(0.1 * shorter);
        let strength = geometry.young * geometry.thickness.powi(3) * geometry.parallel.width;
        let linear = -strength / shorter.powi(3);
        let inner = vec![0.0, linear, 0.0, -0.9999 * linear / (kink * kink)];
        let at = kink * (linear - 0.9999 * linear);
        let outer = vec![at, -50.0 * linear, -1e5 * linear];
        let middle = Piece { origin: 0.0, coefficients: inner, potential_at_origin: 0.0 };
        let right = Piece { origin: kink, coefficients: outer, potential_at_origin: 0.0 };
        let pieces = vec![right.mirrored(), middle, right];
        let curve =
            ForceCurve::from_pieces(pieces, vec![-kink, kink], (-1.15 * kink, 1.15 * kink), true, None);
        let accuracy =
            Accuracy { force: 0.0, potential: 0.0, stiffness: 0.0, outer_force: 0.0, solves: 1, modes: 1 };
        let own = Self { geometry: geometry.clone(), accuracy, curve: curve.clone() };
        Ok((curve, own))
    }

    /// What was solved.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// How good the force curve is.
    pub fn accuracy(&self) -> &Accuracy {
        &self.accuracy
    }

    /// A fresh solution at `x` in m.
    pub fn state(&self, x: f64) -> Result<State, FlexureError> {
        let Geometry { parallel, buckling, preload, .. } = &self.geometry;
        let line = |flexure, from: f64, to: f64| CentreLine {
            flexure,
            points: (0..=4).map(|i| f64::from(i) / 4.0).map(|s| [s, from + s * (to - from), s * x]).collect(),
        };
        let end = parallel.length + buckling.length - preload;
        Ok(State {
            x,
            force: self.curve.force(x),
            potential: self.curve.potential(x),
            stiffness: self.curve.stiffness(x),
            axial: 1.0,
            bump: 0.0,
            max_stress: self.geometry.young * self.geometry.thickness * x.abs() / parallel.length.powi(2),
            lines: vec![line("parallel", 0.0, parallel.length), line("buckling", end, parallel.length)],
        })
    }
}
