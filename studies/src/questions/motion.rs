//! Questions about one scene: basins of attraction.

use std::sync::Arc;

use super::{Error, Progress, Simulation};
use crate::mechanics::Mechanism;
use crate::scene::{Axis, Document, Transducer};
use crate::study::{self, Answer, EvenRange, NoBasins, Starts, StartsError, Table};

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
