//! Force, potential and stiffness of a mechanism over displacement, and shapes, axial force and stress of its
//! flexures. The force curve is a piecewise polynomial; the states of flexures are solved at each position.

mod chart;
mod positions;
mod shapes;

use std::sync::Arc;

use crate::mechanics::Mechanism;
use crate::mechanics::flexure::State;
use crate::questions::{Error, Progress, Simulation};
use crate::scene::Document;
use crate::study::{ForceComparison, Table, compare_force};
pub use chart::{contact_chart, curve_chart, force_panel, zero_of_energy};
pub(crate) use chart::{subtitle, telling, wall};
pub(crate) use positions::small_amplitude_frequency;
pub use positions::{
    CURVE_PICTURE_POINTS, CURVE_POINTS, OutsideCurve, StatesError, curve, default_positions, even_positions,
    metres, states, stop_positions,
};
use positions::{rows, stress_warning};
pub(crate) use shapes::drawn_shapes;
pub use shapes::shapes_chart;

/// Force, potential and stiffness of the mechanism over displacement.
///
/// # Columns
///
/// `x_m`, `force_n` (dV/dx, what must be applied to hold the mass there), `potential_j` (which is 0
/// at x = 0), `stiffness_n_per_m`. They are those of the piecewise polynomial with which every run computes;
/// [`ForceCurve::fit`](crate::mechanics::ForceCurve::fit) says how well it follows a table or a function.
///
/// # Errors
///
/// [`Error::Argument`] for a position outside a curve that ends.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Curve, Simulation};
///
/// // The wells of this double well lie at 7 mm, 0.49 mJ below the top of the barrier.
/// let simulation = Simulation::preset("nominal-cubic")?;
/// let table = Curve { positions: Some(vec![0.0, 7e-3]) }.run(&simulation)?;
/// assert!(table.numbers("force_n").unwrap()[1].abs() < 1e-12);
/// assert!((table.numbers("potential_j").unwrap()[1] + 0.49e-3).abs() < 1e-9);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// Positions in m; by default 401 over a range that includes equilibria and stops.
    pub positions: Option<Vec<f64>>,
}

impl Curve {
    /// The table `x_m,force_n,potential_j,stiffness_n_per_m`.
    pub fn run(&self, simulation: &Simulation) -> Result<Table, Error> {
        self.of_mechanism(simulation.document(), simulation.mechanism())
    }

    /// The same of a scene that may have no model, such as one without a well.
    #[doc(hidden)]
    pub fn of_mechanism(&self, document: &Document, mechanism: &Mechanism) -> Result<Table, Error> {
        let default = || default_positions(&document.scene, mechanism, CURVE_POINTS as usize);
        let found = curve(mechanism, self.positions.clone().unwrap_or_else(default));
        found.map_err(|problem| Error::number("positions", problem.x, problem))
    }

    /// The curve of a picture: over a range in m, or over the default range.
    #[doc(hidden)]
    pub fn drawn(
        range: Option<(f64, f64)>,
        document: &Document,
        mechanism: &Mechanism,
    ) -> Result<Table, Error> {
        let usual = || default_positions(&document.scene, mechanism, CURVE_PICTURE_POINTS);
        let positions = range.map_or_else(usual, |range| even_positions(range, CURVE_PICTURE_POINTS));
        Self { positions: Some(positions) }.of_mechanism(document, mechanism)
    }

    /// Forces in N that were measured at positions in m beside those of the curve.
    #[doc(hidden)]
    pub fn compared(
        document: &Document,
        mechanism: &Mechanism,
        positions: &[f64],
        force: &[f64],
    ) -> Result<ForceComparison, Error> {
        compare_force(mechanism, positions, force).map_err(|problem| Error::unfit(document, problem))
    }

    /// The flexures of the mechanism at the positions, each solved anew.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for a position outside the curve; [`Error::Unfit`] if the mechanism is not
    /// made of flexures; [`Error::Failed`] if there is no solution at a position; [`Error::Cancelled`].
    ///
    /// # Example
    ///
    /// ```
    /// # use interwell_studies as interwell;
    /// use interwell::questions::{Curve, Progress, Simulation};
    ///
    /// // At the middle the buckling flexures are straight: their bump has vanished, and they push hardest.
    /// let question = Curve { positions: Some(vec![0.0, 1e-3]) };
    /// let flexures = question.flexures(&Simulation::preset("paper")?, &Progress::none())?;
    /// let axial = flexures.table();
    /// let axial = axial.numbers("axial_n").unwrap();
    /// assert!(axial[0].abs() > axial[1].abs());
    /// # Ok::<(), interwell::questions::Error>(())
    /// ```
    pub fn flexures(&self, simulation: &Simulation, progress: &Progress) -> Result<FlexuresAnswer, Error> {
        self.flexures_of(simulation.document(), simulation.mechanism(), progress)
    }

    /// The same of a scene that may have no model.
    #[doc(hidden)]
    pub fn flexures_of(
        &self,
        document: &Document,
        mechanism: &Arc<Mechanism>,
        progress: &Progress,
    ) -> Result<FlexuresAnswer, Error> {
        let default = || default_positions(&document.scene, mechanism, CURVE_POINTS as usize);
        let positions = self.positions.clone().unwrap_or_else(default);
        match states(mechanism, &positions, &progress.silent()) {
            Ok(states) => Ok(FlexuresAnswer { states, mechanism: Arc::clone(mechanism) }),
            Err(StatesError::Cancelled) => Err(Error::Cancelled),
            Err(StatesError::Outside(problem)) => Err(Error::number("positions", problem.x, problem)),
            Err(problem @ StatesError::NoFlexures) => Err(Error::unfit(document, problem)),
            Err(problem @ StatesError::Unsolved(_)) => Err(Error::failed(document, problem)),
        }
    }
}

/// The answer of [`Curve::flexures`]: the flexures at some positions of the mass.
///
/// [`shapes_chart`](crate::output::shapes_chart) draws their shapes.
#[derive(Debug, Clone)]
pub struct FlexuresAnswer {
    /// The state of the flexures at each position, in SI units.
    pub states: Vec<State>,
    mechanism: Arc<Mechanism>,
}

impl FlexuresAnswer {
    /// One row per position: the columns of [`Curve`], then `axial_n` (the axial force of all buckling
    /// flexures), `bump_m` (the height of their buckled shape) and `max_stress_pa` (the largest bending
    /// stress of any flexure).
    pub fn table(&self) -> Table {
        let states = &self.states;
        let positions: Vec<f64> = states.iter().map(|state| state.x).collect();
        rows(&self.mechanism, &positions)
            .each("axial_n", states, |state| state.axial)
            .each("bump_m", states, |state| state.bump)
            .each("max_stress_pa", states, |state| state.max_stress)
    }

    /// The centre lines, point by point: `x_m`, `flexure` (`parallel` or `buckling`, each of which stands for
    /// its group), `s_m` (the length from its clamp in the frame), `px_m`, `py_m` (coordinates in the frame).
    ///
    /// The coordinates are those for a shuttle without width: the parallel flexures are clamped at (0, 0) and
    /// reach the shuttle at (L_p - u, x), u being their shortening; the buckling ones are clamped at (L_p +
    /// L_b - preload, 0) and reach the same point of the shuttle.
    pub fn shapes(&self) -> Table {
        let mut rows = Vec::new();
        for state in &self.states {
            for line in &state.lines {
                // adding 0 turns -0 into 0
                let row =
                    |[s, px, py]: &[f64; 3]| (line.flexure, [state.x, *s, *px, *py].map(|value| value + 0.0));
                rows.extend(line.points.iter().map(row));
            }
        }
        Table::new()
            .each("x_m", &rows, |row| row.1[0])
            .each("flexure", &rows, |row| row.0)
            .each("s_m", &rows, |row| row.1[1])
            .each("px_m", &rows, |row| row.1[2])
            .each("py_m", &rows, |row| row.1[3])
    }

    /// A sentence if the bending stress exceeds the limit of the scene (`yield_gpa`) at some positions.
    pub fn warning(&self) -> Option<String> {
        stress_warning(self.mechanism.flexures.as_deref()?, &self.states)
    }
}
