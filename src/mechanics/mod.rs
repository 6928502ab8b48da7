//! Statics: where the restoring force comes from, and its landscape.

mod curve;
mod fit;
mod landscape;
mod table;

pub use curve::{FitReport, ForceCurve, Piece};
pub use fit::{fit, force_scale};
pub use landscape::{Barrier, Equilibrium, ForceExtremum, Kink, Landscape};
pub use table::{FEWEST_POINTS, MOST_POINTS, Table, TableError};

use crate::scene::{self, Fault, Files};

/// A mechanism as run: its force curve and what follows from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Mechanism {
    /// The force curve.
    pub curve: ForceCurve,
    /// Its equilibria, barrier, extrema and kinks.
    pub landscape: Landscape,
}

impl Mechanism {
    /// Builds the curve that a scene describes; the scene has passed its range check.
    pub fn build(described: &scene::Mechanism, files: &Files) -> Result<Self, Fault> {
        let _ = (described, files);
        todo!("mechanics")
    }
}
