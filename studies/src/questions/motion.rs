//! Questions about one scene: force curve and basins of attraction.

use super::{Error, Progress, Simulation};
use std::sync::Arc;

use crate::mechanics::Mechanism;
use crate::mechanics::flexure::State;
use crate::scene::{Axis, Document, Transducer};
use crate::study::{
    self, Answer, CURVE_PICTURE_POINTS, CURVE_POINTS, EvenRange, ForceComparison, NoBasins, Starts,
    StartsError, StatesError, Table, compare_force, curve, default_positions, even_positions, full_curve,
    shapes, states, stress_warning,
};

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
        full_curve(&self.mechanism, &self.states)
    }

    /// The centre lines, point by point: `x_m`, `flexure` (`parallel` or `buckling`, each of which stands for
    /// its group), `s_m` (the length from its clamp in the frame), `px_m`, `py_m` (coordinates in the frame).
    pub fn shapes(&self) -> Table {
        shapes(&self.states)
    }

    /// A sentence if the bending stress exceeds the limit of the scene (`yield_gpa`) at some positions.
    pub fn warning(&self) -> Option<String> {
        stress_warning(self.mechanism.flexures.as_deref()?, &self.states)
    }
}

/// Whether the transducer has an electrical state, in the scene or in a cell over `axes`.
pub fn may_have_circuit(document: &Document, axes: &[Axis]) -> bool {
    let swept = |name: &str| axes.iter().any(|axis| axis.field == format!("transducer.{name}"));
    let cells_may_have = match document.scene.transducer {
        Transducer::None => false,
        Transducer::Electromagnetic { inductance_mh, .. } => {
            swept("inductance_mh") || inductance_mh > 0.0 && swept("load_ohm")
        }
        Transducer::Piezoelectric { .. } => swept("load_kohm"),
    };
    cells_may_have || document.scene.transducer.has_state()
}

/// The attractor that each start goes to, and the share of the starts that go to each attractor.
///
/// [`BasinsAnswer::table`] has one row per start: `x_mm`, `v_m_per_s`, `attractor` (a number from 1),
/// `periods` (forcing periods until that was known), `sure`. [`BasinsAnswer::attractors`] has one row per
/// attractor: `attractor`, `regime`, `period`, `side`, `rms_velocity_m_per_s`, `x_m`, `v_m_per_s`, `starts`,
/// `share` and its 95 % interval `share_low`, `share_high` (Wilson 1927).
///
/// # Method
///
/// Starts that share a release share everything after it, which is computed once. Without rest a
/// start is followed until it enters an ellipse around a stable orbit (motions told by their return to known
/// ones: Datseris and Wagemakers 2022). The shares of `random` starts are the basin stability of Menck et al.
/// (2013). A row is `sure` if a second run at a thousandth of the tolerance stays beside the first one up to
/// the attractor; it depends on no other start. Without rests of the mass the cost per start is many times as
/// large; at most 1e7 starts are taken.
///
/// # Errors
///
/// [`Error::Argument`] for wrong ranges or numbers of starts, or if all starts lie beyond a stop or
/// the end of the force curve; [`Error::Unfit`] if the drive changes and does not repeat, or nothing takes
/// energy. A start that reaches no attractor has no number.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Basins, Progress, Simulation};
///
/// // Below the release amplitude the mass stays at rest on the left or on the right stop.
/// let weak = Simulation::preset("nominal-cubic")?.with("excitation.amplitude_g", 0.6)?;
/// let found = Basins::of((-4.0, 4.0, 5), (-0.2, 0.2, 3)).run(&weak, &Progress::none())?;
/// assert_eq!(found.table().rows(), 15);
/// assert_eq!(found.attractors().words("side"), ["left", "right"]);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Basins {
    /// Smallest and largest displacement of the starts in mm, and how many.
    pub x_mm: EvenRange,
    /// Smallest and largest velocity in m/s, and how many.
    pub v: EvenRange,
    /// Number and seed of random starts in both ranges, in place of the grid.
    pub random: Option<(u64, u64)>,
}

/// The answer of [`Basins::run`].
///
/// It has two tables, [one row per start](Self::table) and [one row per attractor](Self::attractors), whose
/// columns are named at [`Basins`].
#[derive(Debug)]
pub struct BasinsAnswer {
    /// The starts, as [`basins_chart`](crate::output::basins_chart) takes them.
    pub basins: study::BasinMap,
    /// The attractors, and the attractor of each start.
    pub answer: Answer,
}

impl Basins {
    /// A grid of starts: first and last displacement in mm and velocity in m/s, and how many.
    pub fn of(x_mm: (f64, f64, u64), v: (f64, f64, u64)) -> Self {
        let even = |(from, to, count): (f64, f64, u64)| EvenRange { from, to, count };
        Self { x_mm: even(x_mm), v: even(v), random: None }
    }

    /// The starts; an error if an argument is wrong.
    #[doc(hidden)]
    pub fn starts(&self) -> Result<Starts, Error> {
        let wrong = |name: &'static str, value: String| {
            move |problem: StartsError| Error::argument(name, value, problem)
        };
        match self.random {
            None => {
                self.x_mm.check().map_err(wrong("x_mm", shown(self.x_mm)))?;
                self.v.check().map_err(wrong("v", shown(self.v)))?;
                Starts::grid(&self.x_mm, &self.v).map_err(wrong("x_mm", shown(self.x_mm)))
            }
            Some((count, seed)) => {
                let [x_mm, v] = [self.x_mm, self.v].map(|range| (range.from, range.to));
                for (name, (from, to)) in [("x_mm", x_mm), ("v", v)] {
                    let checked = Starts::random((from, to), (0.0, 0.0), 1, 0);
                    checked.map_err(wrong(name, format!("{from}:{to}")))?;
                }
                Starts::random(x_mm, v, count, seed).map_err(wrong("random", count.to_string()))
            }
        }
    }

    /// Follows the starts, each twice: the second run tells whether the answer is sure.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<BasinsAnswer, Error> {
        let begun = self.begin(self.starts()?, simulation.document(), simulation.mechanism())?;
        Self::followed(begun.checked(), progress, None)
    }

    /// The starts before any is followed, of a scene whose own start need not be possible.
    #[doc(hidden)]
    pub fn begin(
        &self,
        starts: Starts,
        document: &Document,
        mechanism: &Arc<Mechanism>,
    ) -> Result<study::BasinMap, Error> {
        let begun = study::BasinMap::new(&document.scene, Arc::clone(mechanism), starts);
        begun.map_err(|problem| no_basins(document, problem, self.x_mm))
    }

    /// Follows the starts that [`begin`](Self::begin), from coarse to fine. `coarse` gets what is known after
    /// each level but the last.
    #[doc(hidden)]
    pub fn followed(
        mut basins: study::BasinMap,
        progress: &Progress,
        coarse: Option<Coarse>,
    ) -> Result<BasinsAnswer, Error> {
        let answer = progress.shared(basins.starts().count() as u64, |pool, task| {
            while !basins.is_whole() && basins.run_level(pool, task) {
                if let Some(coarse) = coarse.filter(|_| !basins.is_whole()) {
                    coarse(&basins, basins.answer(task)?);
                }
            }
            basins.answer(task).filter(|_| basins.is_whole())
        })?;
        let answer = answer.ok_or(Error::Cancelled)?;
        Ok(BasinsAnswer { basins, answer })
    }
}

/// A callback for what is known of basins.
type Coarse<'a> = &'a (dyn Fn(&study::BasinMap, Answer) + Sync);

/// A range as an argument of the command line.
fn shown(EvenRange { from, to, count }: EvenRange) -> String {
    format!("{from}:{to}:{count}")
}

fn no_basins(document: &Document, problem: NoBasins, x_mm: EvenRange) -> Error {
    match problem {
        NoBasins::Faults(faults) => Error::faults_of(document, faults),
        NoBasins::Beyond { .. } => Error::argument("x_mm", shown(x_mm), problem),
        _ => Error::unfit(document, problem),
    }
}

impl BasinsAnswer {
    /// One row per start, the displacement the slower, or in the order in which they were drawn.
    pub fn table(&self) -> Table {
        self.answer.table(&self.basins, 0, self.answer.rows.len())
    }

    /// One row per attractor.
    pub fn attractors(&self) -> Table {
        self.answer.attractors_table()
    }
}
