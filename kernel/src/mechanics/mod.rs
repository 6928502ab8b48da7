//! Static mechanics: restoring forces and their potential landscapes.
//!
//! [`Mechanism::build`] makes of the mechanism of a scene a [`ForceCurve`], one piecewise polynomial with its
//! potential and stiffness, and the [`Landscape`] of that curve: equilibria, barrier, extrema and kinks. All
//! motion is computed with this curve, whatever it came from. Units: displacement in m, force in N, potential
//! in J, stiffness in N/m. The force is the derivative of the potential, that is, what holds the mass at x.
//!
//! Where a curve comes from, by source: flexures as geometrically exact beams ([`flexure`]; Reissner 1972),
//! which are solved to [`FLEXURE_TOLERANCE`] and take much longer than anything else; magnets as point
//! dipoles ([`magnet_force`]; Griffiths 1999); a measured [`ForceTable`] by a fit to a tolerance; a function
//! of the program by [`ForceCurve::from_fn`]; polynomials as they stand. A tighter tolerance of a table or a
//! function needs higher degrees or more pieces; the error that was found is in [`ForceCurve::fit`].
//! Compliant stops have their law in [`Hertz`] (Johnson 1985).
//!
//! # Errors
//!
//! [`BuildError::Wrong`] names the field or file that is wrong, [`BuildError::Unsolved`] says that
//! valid flexures have no solution; a table gives a [`TableError`], a function a [`FunctionError`].
//!
//! # Example
//!
//! ```
//! # use interwell_kernel as interwell;
//! use interwell::mechanics::{ForceCurve, Landscape};
//!
//! // The force x^3 - x has wells at -1 and 1 m and a barrier of 1/4 J between them.
//! let curve = ForceCurve::polynomial(&[0.0, -1.0, 0.0, 1.0]);
//! let landscape = Landscape::of(&curve);
//! let barrier = landscape.barrier.unwrap();
//! assert!((barrier.right_well - 1.0).abs() < 1e-12);
//! assert!((barrier.from_right_j - 0.25).abs() < 1e-12);
//! assert_eq!(curve.stiffness(1.0), 2.0);
//! ```

mod curve;
mod fit;
pub mod flexure;
mod function;
mod hertz;
mod homoclinic;
mod landscape;
mod local;
mod magnet;
mod table;

pub use curve::{FitReport, ForceCurve, Piece};
pub use fit::{fit, force_scale};
pub use flexure::{FlexureError, Flexures};
pub use function::FunctionError;
pub use hertz::{ContactMaterial, Hertz};
pub use homoclinic::Homoclinic;
pub use landscape::{Barrier, Equilibrium, ForceExtremum, Kink, KinkAtWell, Landscape, Well};
pub use magnet::{magnet_force, transverse_magnet_force};
pub use table::{ForceTable, MAX_POINTS, MIN_POINTS, TableError};

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use self::fit::fit_cancellable;
use self::flexure::{Geometry, Group};
use crate::scene::{self, Fault, Files, FlexureGroup, Moments};

/// A mechanism in SI units: its force curve and what follows from it.
///
/// Building it is the slow part of a scene with flexures or a table, so that it is shared by all models with
/// the same mechanism. Errors are those of its fields, or flexures without a solution.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::mechanics::Mechanism;
/// use interwell::scene::Document;
///
/// let document = Document::preset("paper")?;
/// let mechanism = Mechanism::build(&document.scene.mechanism, &document.files)?;
/// let barrier = mechanism.landscape.barrier.unwrap();
/// // the mass rests where the force is 0, here within rounding of the scale of 1 N
/// assert!(mechanism.curve.force(barrier.right_well).abs() < 1e-9);
/// assert!(barrier.from_left_j > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mechanism {
    /// The force curve.
    pub curve: ForceCurve,
    /// Its equilibria, barrier, extrema and kinks.
    pub landscape: Landscape,
    /// The flexures that the curve was computed from, if any; for a sum, those of its only
    /// part with flexures.
    pub flexures: Option<Arc<Flexures>>,
    /// The spring or the magnets that the curve describes, if it is one of these; `None` for a sum.
    pub element: Option<Element>,
    /// The parts of a sum; empty for any other mechanism.
    pub parts: Vec<Self>,
}

/// Parameters of a mechanism that is a spring or a pair of magnets, in SI units.
///
/// [`Mechanism::element`] has them, for pictures and descriptions; the motion is computed with the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Element {
    /// A spring without force at x = 0.
    Spring {
        /// In N/m.
        stiffness: f64,
    },
    /// Two dipole magnets beside each other at x = 0.
    Magnets {
        /// In N m^4; above 0 for parallel moments, which attract each other at x = 0 if they are facing and
        /// repel each other if they are transverse.
        strength: f64,
        /// In m.
        gap: f64,
        /// Direction of both moments.
        moments: Moments,
    },
}

/// Reason why a mechanism has no force curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// The scene or a file that it names is wrong.
    #[error("{} = {}: {}", .0.field, .0.value, .0.problem)]
    Wrong(Fault),
    /// The scene is valid, but the solver failed on its flexures.
    #[error(transparent)]
    Unsolved(#[from] FlexureError),
}

impl From<Fault> for BuildError {
    fn from(fault: Fault) -> Self {
        Self::Wrong(fault)
    }
}

/// Error of the force of flexures, relative to its maximum between the wells: the same for every study, and
/// far below the difference between a beam model and a real flexure.
pub const FLEXURE_TOLERANCE: f64 = 1e-8;

impl Mechanism {
    /// Builds the curve of the mechanism in a scene that has passed its range check. A polynomial becomes one
    /// exact piece; a table is read from `files` and fitted; flexures are solved, which takes much longer
    /// than anything else.
    ///
    /// # Errors
    ///
    /// [`BuildError::Wrong`] for a table that cannot be read or fitted, a polynomial with too many terms, a
    /// magnet whose forces leave the range of double precision and parts of a sum that have no range in
    /// common; the fault names the field. [`BuildError::Unsolved`] for flexures without a solution.
    pub fn build(described: &scene::Mechanism, files: &Files) -> Result<Self, BuildError> {
        Self::build_with(described, files, FLEXURE_TOLERANCE, None)
    }

    /// Like [`build`](Self::build), but returns `None` soon after `cancel` is set. The flag is checked at
    /// each state of flexures and each piece of a table, which take a few milliseconds at most.
    pub fn build_cancellable(
        described: &scene::Mechanism,
        files: &Files,
        cancel: &AtomicBool,
    ) -> Option<Result<Self, BuildError>> {
        let built = Self::build_with(described, files, FLEXURE_TOLERANCE, Some(cancel));
        (!cancel.load(Ordering::Relaxed)).then_some(built)
    }

    /// Like [`build`](Self::build), with flexures solved to `flexure_tolerance` (1e-6 to 1e-9; see
    /// [`Flexures::solve`]): a larger one is faster, for a geometry that is being dragged. Fails, with any
    /// error, soon after `cancel` is set.
    pub fn build_with(
        described: &scene::Mechanism,
        files: &Files,
        flexure_tolerance: f64,
        cancel: Option<&AtomicBool>,
    ) -> Result<Self, BuildError> {
        match described {
            scene::Mechanism::Flexures {
                preload_mm,
                thickness_mm,
                young_gpa,
                parallel,
                buckling,
                poisson,
                plane_strain,
                initial_bow_mm,
                yield_gpa,
            } => {
                let geometry = Geometry {
                    preload: preload_mm / 1e3,
                    thickness: thickness_mm / 1e3,
                    young: young_gpa * 1e9,
                    poisson: *poisson,
                    plane_strain: *plane_strain,
                    initial_bow: initial_bow_mm / 1e3,
                    yield_stress: yield_gpa * 1e9,
                    parallel: group(parallel),
                    buckling: group(buckling),
                };
                let (curve, flexures) = Flexures::solve_cancellable(&geometry, flexure_tolerance, cancel)?;
                Ok(Self { flexures: Some(Arc::new(flexures)), ..Self::new(curve) })
            }
            scene::Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 } => {
                Ok(Self::new(ForceCurve::polynomial(&[0.0, *linear_n_per_m, 0.0, *cubic_n_per_m3])))
            }
            scene::Mechanism::DoubleWell { equilibrium_mm, barrier_mj } => {
                Ok(Self::new(double_well(equilibrium_mm / 1e3, barrier_mj / 1e3)))
            }
            scene::Mechanism::Polynomial { coefficients_si } => {
                let terms = coefficients_si.iter().rposition(|c| *c != 0.0).map_or(0, |i| i + 1);
                if terms > ForceCurve::MAX_COEFFICIENTS {
                    let problem = format!("at most {} are possible", ForceCurve::MAX_COEFFICIENTS);
                    let value = format!("{terms} coefficients");
                    return Err(Fault::new("mechanism.coefficients_si", value, problem).into());
                }
                Ok(Self::new(ForceCurve::polynomial(coefficients_si)))
            }
            scene::Mechanism::Pieces { ends_m, pieces, error_n } => {
                Ok(Self::new(ForceCurve::as_written(ends_m, pieces, *error_n)))
            }
            scene::Mechanism::Table { path, tolerance } => {
                let fault = |problem: String| Fault::new("mechanism.path", path, problem);
                let text = files.read(path).map_err(|e| fault(e.to_string()))?;
                let table = ForceTable::parse(&text).map_err(|e| fault(e.to_string()))?;
                Ok(Self::new(fit_cancellable(&table, *tolerance, cancel).map_err(fault)?))
            }
            scene::Mechanism::Linear { n_per_m } => {
                let element = Some(Element::Spring { stiffness: *n_per_m });
                Ok(Self { element, ..Self::new(ForceCurve::polynomial(&[0.0, *n_per_m])) })
            }
            scene::Mechanism::Magnet { strength_n_mm4, gap_mm, moments } => {
                let (strength, gap) = (strength_n_mm4 * 1e-12, gap_mm / 1e3);
                let value = strength_n_mm4.to_string();
                let fault = |problem: String| Fault::new("mechanism.strength_n_mm4", value, problem);
                let curve = magnet::magnet(*moments, strength, gap).map_err(fault)?;
                let element = Some(Element::Magnets { strength, gap, moments: *moments });
                Ok(Self { element, ..Self::new(curve) })
            }
            scene::Mechanism::Sum(parts) => {
                let part = |(index, part): (usize, &scene::Mechanism)| {
                    let mut built = Self::build_with(part, files, flexure_tolerance, cancel);
                    if let Err(BuildError::Wrong(fault)) = &mut built {
                        fault.field = fault.field.replacen("mechanism.", &format!("mechanism.{index}."), 1);
                    }
                    built
                };
                Self::sum(parts.iter().enumerate().map(part).collect::<Result<_, _>>()?)
            }
        }
    }

    /// Reads and fits the text of a table: CSV with the columns `x_m,force_n`. See [`ForceTable::parse`] and
    /// [`fit()`].
    ///
    /// The error is a sentence that continues "the table ...".
    pub fn from_table(text: &str, tolerance: f64) -> Result<Self, String> {
        let table = ForceTable::parse(text).map_err(|e| e.to_string())?;
        fit(&table, tolerance).map(Self::new)
    }

    /// A mechanism with this curve.
    pub fn new(curve: ForceCurve) -> Self {
        let landscape = Landscape::of(&curve);
        Self { curve, landscape, flexures: None, element: None, parts: Vec::new() }
    }

    /// The sum of at least one mechanism in parallel. Fails if the domains of their curves do not overlap.
    fn sum(parts: Vec<Self>) -> Result<Self, BuildError> {
        let curves: Vec<&ForceCurve> = parts.iter().map(|part| &part.curve).collect();
        let curve = curve::sum(&curves)
            .filter(|sum| sum.pieces().iter().all(|piece| piece.coefficients.iter().all(|c| c.is_finite())));
        let problem = "the parts have no displacement at which all of their forces are known and finite; \
                       take tables that overlap";
        let curve = curve.ok_or_else(|| Fault::new("mechanism", "Sum([..])", problem))?;
        let mut flexures = parts.iter().filter_map(|part| part.flexures.clone());
        let only = flexures.next().filter(|_| flexures.next().is_none());
        let error = parts.iter().filter_map(|part| part.curve.fit()).map(|fit| fit.worst_n).sum();
        let landscape = Landscape::with_error(&curve, error);
        Ok(Self { curve, landscape, flexures: only, element: None, parts })
    }

    /// The parts of a sum; for any other mechanism, the mechanism itself.
    pub fn parts_or_self(&self) -> &[Self] {
        if self.parts.is_empty() { std::slice::from_ref(self) } else { &self.parts }
    }

    /// Warnings about the tables that the curve was fitted to, each a sentence.
    pub fn warnings(&self) -> impl Iterator<Item = &str> {
        let all = std::iter::once(self).chain(&self.parts);
        all.filter_map(|mechanism| mechanism.curve.fit()).flat_map(|fit| &fit.warnings).map(String::as_str)
    }

    /// The stiffness in N/m that a damping ratio refers to; see [`Landscape::damping_stiffness`].
    pub fn damping_stiffness(&self) -> Option<f64> {
        self.landscape.damping_stiffness()
    }
}

fn group(described: &FlexureGroup) -> Group {
    let FlexureGroup { count, length_mm, width_mm } = *described;
    // the range of the count is far below the limit of `usize`
    Group { count: count as usize, length: length_mm / 1e3, width: width_mm / 1e3 }
}

/// The quartic potential barrier ((x/x_e)^2 - 1)^2 up to a constant, from SI values.
fn double_well(equilibrium: f64, barrier: f64) -> ForceCurve {
    let linear = 4.0 * barrier / (equilibrium * equilibrium);
    ForceCurve::polynomial(&[0.0, -linear, 0.0, linear / (equilibrium * equilibrium)])
}
