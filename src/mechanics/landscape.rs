//! Where does the mechanism rest, and what stands between its resting places?

/// A place where the restoring force vanishes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Position in m.
    pub x: f64,
    /// Whether the force drives back on both sides.
    pub stable: bool,
    /// Stiffness just left of it in N/m.
    pub stiffness_left: f64,
    /// Stiffness just right of it in N/m.
    pub stiffness_right: f64,
}

/// The top between two wells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Barrier {
    /// Position in m.
    pub x: f64,
    /// The stable equilibrium left of it in m.
    pub left_well: f64,
    /// The stable equilibrium right of it in m.
    pub right_well: f64,
    /// Height above the left well in J.
    pub from_left_j: f64,
    /// Height above the right well in J.
    pub from_right_j: f64,
}

/// A local extremum of the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceExtremum {
    /// Position in m.
    pub x: f64,
    /// Force dV/dx there in N.
    pub force: f64,
}

/// A corner of the force curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kink {
    /// Position in m.
    pub x: f64,
    /// Stiffness just left of it in N/m.
    pub stiffness_left: f64,
    /// Stiffness just right of it in N/m.
    pub stiffness_right: f64,
}

/// Equilibria, barrier, force extrema and kinks of one force curve, each from left to right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Landscape {
    /// Every place where the force vanishes; empty where it does so on a whole interval.
    pub equilibria: Vec<Equilibrium>,
    /// The barrier between the wells: with more than two wells the one nearest to x = 0.
    pub barrier: Option<Barrier>,
    /// Local extrema of the force.
    pub extrema: Vec<ForceExtremum>,
    /// Corners of the force.
    pub kinks: Vec<Kink>,
}
