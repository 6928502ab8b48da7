//! Statics: where the restoring force comes from, and its landscape.

mod curve;
mod fit;
pub mod flexure;
mod landscape;
mod local;
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
    ///
    /// Polynomials enter exactly, as one piece; a table is read from `files` and fitted. The fault of a table
    /// names `mechanism.path`; that of a polynomial with too many terms `mechanism.coefficients_si`.
    pub fn build(described: &scene::Mechanism, files: &Files) -> Result<Self, Fault> {
        match described {
            scene::Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 } => {
                Ok(Self::new(ForceCurve::polynomial(&[0.0, *linear_n_per_m, 0.0, *cubic_n_per_m3])))
            }
            scene::Mechanism::DoubleWell { equilibrium_mm, barrier_mj } => {
                Ok(Self::new(double_well(equilibrium_mm / 1e3, barrier_mj / 1e3)))
            }
            scene::Mechanism::Polynomial { coefficients_si } => {
                let terms = coefficients_si.iter().rposition(|c| *c != 0.0).map_or(0, |i| i + 1);
                if terms > ForceCurve::MAX_COEFFICIENTS {
                    return Err(Fault {
                        field: "mechanism.coefficients_si".into(),
                        value: format!("{terms} coefficients"),
                        problem: format!("at most {} are possible", ForceCurve::MAX_COEFFICIENTS),
                    });
                }
                Ok(Self::new(ForceCurve::polynomial(coefficients_si)))
            }
            scene::Mechanism::Table { path, tolerance } => {
                let fault =
                    |problem: String| Fault { field: "mechanism.path".into(), value: path.clone(), problem };
                let text = files.read(path).map_err(|e| fault(e.to_string()))?;
                Self::from_table(&text, *tolerance).map_err(fault)
            }
        }
    }

    /// Reads and fits the text of a table: CSV with the columns `x_m,force_n`. See [`Table::parse`] and [`fit()`].
    ///
    /// Fails with a sentence that continues "the table ...".
    pub fn from_table(text: &str, tolerance: f64) -> Result<Self, String> {
        let table = Table::parse(text).map_err(|e| e.to_string())?;
        fit(&table, tolerance).map(Self::new)
    }

    /// A mechanism with this curve.
    pub fn new(curve: ForceCurve) -> Self {
        let landscape = Landscape::of(&curve);
        Self { curve, landscape }
    }

    /// The stiffness in N/m that a damping ratio refers to; see [`Landscape::damping_stiffness`].
    pub fn damping_stiffness(&self) -> Option<f64> {
        self.landscape.damping_stiffness()
    }
}

/// The quartic potential barrier ((x/x_e)^2 - 1)^2 up to a constant, both in SI.
fn double_well(equilibrium: f64, barrier: f64) -> ForceCurve {
    let linear = 4.0 * barrier / (equilibrium * equilibrium);
    ForceCurve::polynomial(&[0.0, -linear, 0.0, linear / (equilibrium * equilibrium)])
}
