//! Mechanisms and their fields.

use serde::{Deserialize, Serialize};

use super::data::is_default;

/// Source of the restoring force.
///
/// F(x) is what holds the mass at x, the derivative of the potential, so that the mechanism pushes the mass
/// with -F(x). [`mechanics::Mechanism::build`](crate::mechanics::Mechanism::build) makes its force curve; a
/// force that a program has as a function becomes `Pieces` by
/// [`ForceCurve::from_fn`](crate::mechanics::ForceCurve::from_fn) and
/// [`ForceCurve::to_scene`](crate::mechanics::ForceCurve::to_scene).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Mechanism {
    /// Flexures: thin strips, clamped at both ends, between the frame and a shuttle that carries the proof
    /// mass. The parallel flexures guide the shuttle. The buckling flexures are in line with them and are
    /// compressed by the preload until they buckle, which makes two wells.
    Flexures {
        /// Shortening in mm that parallel and buckling flexures share if the shuttle is at x = 0, 0 to
        /// 1e15 and at most half of the shorter flexure. 0 makes one well.
        preload_mm: f64,
        /// Thickness of every flexure in mm, 1e-15 to 1e15, at most a tenth of the shorter flexure.
        thickness_mm: f64,
        /// Young's modulus in GPa, 1e-60 to 1e60.
        young_gpa: f64,
        /// The flexures that guide the shuttle.
        parallel: FlexureGroup,
        /// The flexures that buckle.
        buckling: FlexureGroup,
        /// Poisson's ratio, 0 to 0.49.
        #[serde(default = "default_poisson")]
        poisson: f64,
        /// Whether E/(1 - poisson^2) replaces E in stretching and bending, as for strips much wider than
        /// thick; the shear modulus is unchanged.
        #[serde(default)]
        plane_strain: bool,
        /// Stress-free bow of the buckling flexures at their middle in mm, 0 to 1e15 and at most a twentieth
        /// of their length.
        #[serde(default)]
        initial_bow_mm: f64,
        /// Bending stress in GPa above which `curve --full` warns, 1e-60 to 1e60; it does not
        /// affect the force.
        #[serde(default = "default_yield")]
        yield_gpa: f64,
    },
    /// F = linear x + cubic x^3.
    Cubic {
        /// Linear stiffness in N/m, -1e200 to 1e200.
        linear_n_per_m: f64,
        /// Cubic stiffness in N/m^3, -1e200 to 1e200.
        cubic_n_per_m3: f64,
    },
    /// The quartic potential with two wells at +-equilibrium and a barrier between them.
    DoubleWell {
        /// Distance of the stable equilibria from the middle in mm, 1e-15 to 1e15.
        equilibrium_mm: f64,
        /// Height of the barrier in mJ, 1e-60 to 1e60.
        barrier_mj: f64,
    },
    /// F = c0 + c1 x + c2 x^2 + ...
    Polynomial {
        /// 1 to 16 coefficients from the constant up, in N/m^i, each -1e200 to 1e200. All zeros are a
        /// free mass.
        coefficients_si: Vec<f64>,
    },
    /// A piecewise polynomial, such as one that a program fitted to a function.
    Pieces {
        /// Ends of the pieces in m, ascending, one more than there are pieces. The first and the last are the
        /// ends of the curve; -inf and inf where it has none.
        ends_m: Vec<f64>,
        /// The pieces from left to right, at most 10000, continuous where they meet.
        pieces: Vec<ForcePiece>,
        /// Largest difference in N from the force that the curve stands for, 0 to 1e30. Bends of the curve
        /// that are smaller count as none.
        #[serde(default)]
        error_n: f64,
    },
    /// A measured or computed curve: CSV with columns `x_m,force_n`.
    Table {
        /// Path relative to the scene file, or the name of an embedded table.
        path: String,
        /// Allowed error of the fitted curve, relative to the force maximum between the wells, 1e-10
        /// to 0.1.
        #[serde(default = "default_table_tolerance")]
        tolerance: f64,
    },
    /// F = stiffness x: a spring, such as one that compensates part of a negative stiffness in parallel.
    Linear {
        /// Stiffness in N/m, -1e200 to 1e200.
        n_per_m: f64,
    },
    /// Two dipole magnets with a gap between them at x = 0, one of them on the mass.
    Magnet {
        /// mu_0 m_1 m_2/(4 pi) of the two moments in N mm^4, -1e60 to 1e60, above 0 for parallel ones. Those
        /// attract each other at x = 0 if they are facing and repel each other if they are transverse.
        strength_n_mm4: f64,
        /// Distance of the two dipoles at x = 0 in mm, 1e-15 to 1e15.
        gap_mm: f64,
        /// Direction of both moments; by default facing.
        #[serde(default, skip_serializing_if = "is_default")]
        moments: Moments,
    },
    /// Forces in parallel on the same mass: 1 to 16 parts, none of them a sum.
    Sum(Vec<Mechanism>),
}

impl Mechanism {
    /// The paths of its tables.
    pub(super) fn paths_mut(&mut self) -> Vec<&mut String> {
        match self {
            Self::Table { path, .. } => vec![path],
            Self::Sum(parts) => parts.iter_mut().flat_map(Self::paths_mut).collect(),
            _ => Vec::new(),
        }
    }
}

/// Direction of the moments of two magnets.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Moments {
    /// Along the line that joins the magnets at x = 0, so that poles face each other there.
    #[default]
    Facing,
    /// Perpendicular to that line and to the motion.
    Transverse,
}

/// One polynomial of a piecewise force: F = c0 + c1 (x - origin) + c2 (x - origin)^2 + ...
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForcePiece {
    /// Origin of the polynomial in m.
    #[serde(default)]
    pub origin_m: f64,
    /// 1 to 16 coefficients from the constant up, in N/m^i, each -1e200 to 1e200.
    pub coefficients_si: Vec<f64>,
}

/// Equal flexures in parallel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlexureGroup {
    /// Number of flexures; whole, 1 to 64.
    pub count: u64,
    /// Length of each between its clamps in mm, 1e-15 to 1e15.
    pub length_mm: f64,
    /// Width of each in mm, 1e-15 to 1e15.
    pub width_mm: f64,
}

fn default_poisson() -> f64 {
    0.34
}

fn default_yield() -> f64 {
    2.0
}

fn default_table_tolerance() -> f64 {
    1e-4
}
