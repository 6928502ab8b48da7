//! Questions about one scene: force curve, periodic motions, spectrum and basins of attraction.

use super::{Error, Progress, Simulation};
use crate::dynamics::Model;
use crate::numeric::{Taper, number_text};
use crate::scene::{Axis, Document, Transducer, is_whole};
use crate::study::{
    self, Answer, BranchEnd, CURVE_POINTS, EvenRange, Family, NoBasins, NoOrbit, NoSpectrum, Signal,
    SpectrumOptions, Starts, StartsError, Table, Task, branch, curve, default_positions, orbit, orbit_table,
    spectrum,
};

/// Force, potential and stiffness of the mechanism over displacement.
///
/// Columns: `x_m`, `force_n` (dV/dx, what must be applied to hold the mass there), `potential_j` (which is 0
/// at x = 0), `stiffness_n_per_m`. They are those of the piecewise polynomial with which every run computes;
/// how well it follows a table or a function is in `Simulation::mechanism().curve.fit()`.
///
/// Errors: [`Error::Argument`] for a position outside a curve that ends.
///
/// ```
/// use interwell_studies::questions::{Curve, Simulation};
///
/// // The wells of this double well lie at 7 mm, 0.49 mJ below the top of the barrier.
/// let simulation = Simulation::preset("nominal-cubic")?;
/// let table = Curve { positions: Some(vec![0.0, 7e-3]) }.run(&simulation)?;
/// assert!(table.numbers("force_n").unwrap()[1].abs() < 1e-12);
/// assert!((table.numbers("potential_j").unwrap()[1] + 0.49e-3).abs() < 1e-9);
/// # Ok::<(), interwell_studies::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// Positions in m; by default 401 over a range that includes equilibria and stops.
    pub positions: Option<Vec<f64>>,
}

impl Curve {
    /// The table `x_m,force_n,potential_j,stiffness_n_per_m`.
    pub fn run(&self, simulation: &Simulation) -> Result<Table, Error> {
        let default = || default_positions(simulation.scene(), simulation.mechanism(), CURVE_POINTS as usize);
        let positions = self.positions.clone().unwrap_or_else(default);
        curve(simulation.mechanism(), positions).map_err(|problem| Error::argument("positions", "", problem))
    }
}

/// The periodic orbit near the settled motion of a run, stable or not, with its Floquet multipliers.
///
/// The table of the answer has one row: `period` (forcing periods), `x_m`, `v_m_per_s` (at `phase_deg`),
/// `multiplier_1_re`, `multiplier_1_im`, `multiplier_2_re`, `multiplier_2_im`, `stable`, `impacts`, `rests`,
/// `gentlest_impact_m_per_s`, `nearest_miss_m`; beside a circuit also `current_a` or `voltage_v` and
/// `multiplier_3_re`, `multiplier_3_im`.
///
/// Method: a motion that repeats after n forcing periods is a fixed point of the stroboscopic map, found by
/// Newton's method. The derivative of the map is carried through impacts and releases by saltation matrices
/// (Müller 1995; Kong et al. 2024); its eigenvalues are the multipliers, which are 0 where the mass rests on
/// a stop, but for one of a circuit. It takes the run of the scene and some further periods.
///
/// Errors: [`Error::Argument`] for `period` or `phase_deg`; [`Error::Unfit`] if the drive does not repeat or
/// is 0; [`Error::Failed`] if the run comes to no motion that
/// repeats (name a period, start elsewhere, or lengthen the run), Newton's method does not converge, the
/// motion touches a stop without speed or ends early, or there is only an orbit of a shorter period.
///
/// ```
/// use interwell_studies::questions::{Orbit, Progress, Simulation};
///
/// // Without impacts the product of the multipliers is exp(-c T/m).
/// let simulation = Simulation::preset("nominal-cubic")?.with("stops", "None")?;
/// let weak = simulation.with("excitation.amplitude_g", 0.2)?;
/// let orbit = Orbit::default().run(&weak, &Progress::none())?;
/// let rate = 2.0 * 0.023 * (80.0_f64 / 15.2e-3).sqrt();
/// assert!(orbit.is_stable() && orbit.period == 1);
/// assert!((orbit.determinant() - (-rate / 3.0).exp()).abs() < 1e-9);
/// # Ok::<(), interwell_studies::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orbit {
    /// Its period in forcing periods, at least 1; by default that of the settled motion.
    pub period: Option<u32>,
    /// Phase of the drive in degrees at which the state is given.
    pub phase_deg: f64,
}

impl Orbit {
    /// Finds the orbit by Newton's method.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<study::Orbit, Error> {
        check_period(self.period)?;
        can_have_orbits(simulation.document(), simulation.model())?;
        let found = orbit(simulation.model(), phase(self.phase_deg)?, self.period, progress.stop());
        found.map_err(|error| no_orbit(simulation.document(), error, ""))
    }
}

impl study::Orbit {
    /// One row: period, state, multipliers and what happens on the motion.
    pub fn table(&self) -> Table {
        orbit_table(std::slice::from_ref(self))
    }
}

/// A branch of periodic orbits, continued in a field and followed around folds.
///
/// The table of the answer has one row per orbit, in order along the branch: the field in its unit, the
/// columns of [`Orbit`], and `event`: empty, `fold`, `flip`, `symmetry` or `grazing`. Its method `remarks`
/// says where the branch ended inside the range, and why.
///
/// Method: pseudo-arclength continuation (Keller 1977). Events are located to some 1e-9 of the range. At a
/// grazing the stroboscopic map changes like the square root of the distance (Nordmark 1991), so the motion
/// that grazes is solved for with the instant of the touch as an unknown. Two events of a kind within a
/// hundredth of the range can be missed. A branch of the prototype takes about a second.
///
/// Errors: those of [`Orbit`] for the first orbit, and [`Error::Argument`] for a field or a range that is
/// wrong; a field of whole numbers has no branch. A branch that ends early is not an error.
///
/// ```
/// use interwell_studies::questions::{Branch, Progress, Simulation};
///
/// // The stable motion in one well ends in a fold near 0.70 g; the branch goes back as an unstable one.
/// let simulation = Simulation::preset("nominal-cubic")?.with("stops", "None")?;
/// let question = Branch::over("excitation.amplitude_g", 0.6, 0.75);
/// let branch = question.run(&simulation, &Progress::none())?;
/// let table = branch.table();
/// let fold = table.words("event").iter().position(|event| *event == "fold").unwrap();
/// assert!((0.70..0.71).contains(&branch.values[fold]));
/// # Ok::<(), interwell_studies::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// The field.
    pub field: String,
    /// Its value at the first orbit, and the value towards which the branch is continued.
    pub range: (f64, f64),
    /// Period of the first orbit in forcing periods, at least 1; by default that of the settled motion.
    pub period: Option<u32>,
    /// Phase of the drive in degrees at which states are given.
    pub phase_deg: f64,
}

impl Branch {
    /// A branch over a field, from one value towards another.
    pub fn over(field: impl Into<String>, from: f64, to: f64) -> Self {
        Self { field: field.into(), range: (from, to), period: None, phase_deg: 0.0 }
    }

    /// Follows the branch. The value of the field in the scene is replaced by the first value of the range.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<study::Branch, Error> {
        let (from, to) = self.range;
        let shown = format!("{}={from}:{to}", self.field);
        let wrong = |problem: String| Error::argument("branch", &shown, problem);
        check_period(self.period)?;
        Axis::listed(&self.field, vec![from, to], simulation.scene()).map_err(wrong)?;
        if !(from.is_finite() && to.is_finite()) {
            return Err(wrong("A and B must be finite".to_owned()));
        }
        if is_whole(simulation.scene(), &self.field) {
            return Err(wrong(format!(
                "{} holds whole numbers, and a branch takes all values between A and B; follow the motion by \
                 a sweep with carry over it",
                self.field
            )));
        }
        if from == to {
            return Err(wrong(format!("A and B are both {from}; give a range, such as 0.5:2")));
        }
        let first = simulation.with(&self.field, from)?;
        let (document, mechanism) = (first.document(), first.mechanism());
        can_have_orbits(document, first.model())?;
        let phase = phase(self.phase_deg)?;
        let family = Family::new(&document.scene, &document.files, mechanism, &self.field);
        let found =
            progress.task(None, |task| branch(&family, &self.field, (from, to), phase, self.period, task));
        found.map_err(|error| no_orbit(document, error, &format!("at {} = {from}: ", self.field)))
    }
}

impl study::Branch {
    /// Remarks that have no column in the table: events that were not located and, unless the branch reached
    /// the end of its range, where and why it ended.
    pub fn remarks(&self, (from, to): (f64, f64)) -> Vec<String> {
        let field = &self.field;
        let unlocated = |(before, after): &(f64, f64)| {
            format!(
                "between {field} = {before} and {after} the motion changes how it touches the stops, or its \
                 stability; no event was located there, and the table has none"
            )
        };
        let mut lines: Vec<String> = self.unlocated.iter().map(unlocated).collect();
        let at = self.values.last().copied().unwrap_or(f64::NAN);
        let why = match self.end {
            BranchEnd::Range if (at - to).abs() < (at - from).abs() => return lines,
            BranchEnd::Range => "it came back to the value at which it began".to_owned(),
            other => other.to_string(),
        };
        lines.push(format!("the branch ends at {field} = {at}: {why}"));
        lines
    }
}

/// Largest period of an orbit in forcing periods.
const MAX_PERIOD: u32 = 1000;

fn check_period(period: Option<u32>) -> Result<(), Error> {
    match period.filter(|period| !(1..=MAX_PERIOD).contains(period)) {
        Some(period) => Err(Error::argument("period", period, format!("give 1 to {MAX_PERIOD}"))),
        None => Ok(()),
    }
}

/// The phase in forcing periods.
pub(super) fn phase(degrees: f64) -> Result<f64, Error> {
    match degrees.is_finite() {
        true => Ok(degrees / 360.0),
        false => Err(Error::number("phase_deg", degrees, "give a phase in degrees, such as 90")),
    }
}

/// Refuses a scene whose drive does not repeat.
pub fn can_have_orbits(document: &Document, model: &Model) -> Result<(), Error> {
    if !model.repeats() || !model.is_shaken() {
        let problem = "excitation: a periodic motion needs a drive that repeats and is not 0; take a Sine, \
                       or a Sum of sines whose frequencies have a common period";
        return Err(Error::unfit(document, problem));
    }
    Ok(())
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

/// The error for an orbit that was not found; `at` is a prefix that names the place, such as `at FIELD =
/// VALUE: `.
pub fn no_orbit(document: &Document, error: NoOrbit, at: &str) -> Error {
    match error {
        NoOrbit::Cancelled => Error::Cancelled,
        _ => Error::failed(document, format!("{at}{error}")),
    }
}

/// Amplitude and power spectral density of a settled motion.
///
/// The table of the answer has one row per line, from 0 to half the rate: `frequency_hz`, `amplitude` (half
/// of peak to peak; m, m/s or m/s^2 by the signal) and `psd` (one-sided, the square of that unit per Hz).
///
/// Method: the settled window is sampled evenly, over whole periods where the drive repeats. Where the motion
/// repeats too, its lines are exact and no window function is needed; otherwise that of von Hann is taken,
/// and amplitude and density are scaled as in Heinzel et al. (2002). What lies above half the rate folds
/// back: a higher `rate_hz` reduces this, which matters with impacts. Two runs are made, one for the verdict
/// and one for the samples.
///
/// Errors: [`Error::Argument`] for `rate_hz` (at most 1e7 samples) or `until_settled`; [`Error::Unfit`] if
/// the settled window has no length; [`Error::Failed`] if the run ends early.
///
/// ```
/// use interwell_studies::questions::{Progress, Signal, Simulation, Spectrum};
///
/// // The base moves with one sine of 1.5 g at 3 Hz.
/// let question = Spectrum { of: Signal::BaseAcceleration, ..Spectrum::default() };
/// let table = question.run(&Simulation::preset("nominal-cubic")?, &Progress::none())?.table;
/// let frequencies = table.numbers("frequency_hz").unwrap();
/// let line = frequencies.iter().position(|frequency| (frequency - 3.0).abs() < 1e-9).unwrap();
/// assert!((table.numbers("amplitude").unwrap()[line] - 1.5 * 9.806_65).abs() < 1e-9);
/// # Ok::<(), interwell_studies::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// The signal.
    pub of: Signal,
    /// Window function; by default none if the motion repeats, else that of von Hann.
    pub taper: Option<Taper>,
    /// Samples per second, raised until a forcing period has a whole number of them.
    pub rate_hz: Option<f64>,
    /// The run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
}

impl Default for Spectrum {
    fn default() -> Self {
        Self { of: Signal::Displacement, taper: None, rate_hz: None, until_settled: None }
    }
}

impl Spectrum {
    /// Runs the scene and transforms its settled window.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<study::Spectrum, Error> {
        simulation.check_until_settled(self.until_settled)?;
        let Self { of: signal, taper, rate_hz, until_settled } = *self;
        let options = SpectrumOptions { signal, taper, rate_hz, until_settled };
        let task = Task { tick: &|| (), cancel: progress.stop() };
        let document = simulation.document();
        spectrum(simulation.model(), &options, &task).map_err(|problem| match problem {
            NoSpectrum::Cancelled => Error::Cancelled,
            NoSpectrum::EndedEarly { .. } => Error::failed(document, problem),
            NoSpectrum::NoWindow(..) => Error::unfit(document, problem),
            NoSpectrum::Rate(_) => {
                let given = rate_hz.map_or_else(|| "(default)".to_owned(), number_text);
                Error::argument("rate_hz", given, format!("{}: {problem}", document.name))
            }
        })
    }
}

/// The attractor that each start goes to, and the share of the starts that go to each attractor.
///
/// [`BasinsAnswer::table`] has one row per start: `x_mm`, `v_m_per_s`, `attractor` (a number from 1),
/// `periods` (forcing periods until that was known), `sure`. [`BasinsAnswer::attractors`] has one row per
/// attractor: `attractor`, `regime`, `period`, `side`, `rms_velocity_m_per_s`, `x_m`, `v_m_per_s`, `starts`,
/// `share` and its 95 % interval `share_low`, `share_high` (Wilson 1927).
///
/// Method: starts that share a release share everything after it, which is computed once. Without rest a
/// start is followed until it enters an ellipse around a stable orbit (motions told by their return to known
/// ones: Datseris and Wagemakers 2022). The shares of `random` starts are the basin stability of Menck et al.
/// (2013). `sure` compares with ten times the tolerance, which costs somewhat less than half of the time.
/// Without rests of the mass the cost per start is many times as large; at most 1e7 starts are taken.
///
/// Errors: [`Error::Argument`] for wrong ranges or numbers of starts, or if all starts lie beyond a stop or
/// the end of the force curve; [`Error::Unfit`] if the drive changes and does not repeat, or nothing takes
/// energy. A start that reaches no attractor has no number.
///
/// ```
/// use interwell_studies::questions::{Basins, Progress, Simulation};
///
/// // Below the release amplitude the mass stays at rest on the left or on the right stop.
/// let weak = Simulation::preset("nominal-cubic")?.with("excitation.amplitude_g", 0.6)?;
/// let found = Basins::of((-4.0, 4.0, 5), (-0.2, 0.2, 3)).run(&weak, &Progress::none())?;
/// assert_eq!(found.table().rows(), 15);
/// assert_eq!(found.attractors().words("side"), ["left", "right"]);
/// # Ok::<(), interwell_studies::questions::Error>(())
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
#[derive(Debug)]
pub struct BasinsAnswer {
    /// The starts, and what is known of each.
    pub basins: study::Basins,
    /// The attractors, and the attractor of each start.
    pub answer: Answer,
}

impl Basins {
    /// A grid of starts: first and last displacement in mm and velocity in m/s, and how many.
    pub fn of(x_mm: (f64, f64, u64), v: (f64, f64, u64)) -> Self {
        let even = |(from, to, count): (f64, f64, u64)| EvenRange { from, to, count };
        Self { x_mm: even(x_mm), v: even(v), random: None }
    }

    fn starts(&self) -> Result<Starts, Error> {
        let EvenRange { from, to, count } = self.x_mm;
        let shown = |range: EvenRange| format!("{}:{}:{}", range.from, range.to, range.count);
        let wrong = |name: &str, value: String, problem: StartsError| Error::argument(name, value, problem);
        match self.random {
            None => {
                self.x_mm.check().map_err(|problem| wrong("x_mm", shown(self.x_mm), problem))?;
                self.v.check().map_err(|problem| wrong("v", shown(self.v), problem))?;
                Starts::grid(&self.x_mm, &self.v)
                    .map_err(|problem| wrong("x_mm", format!("{from}:{to}:{count}"), problem))
            }
            Some((count, seed)) => {
                let (x_mm, v) = ((from, to), (self.v.from, self.v.to));
                Starts::random(x_mm, (0.0, 0.0), 1, 0)
                    .map_err(|problem| wrong("x_mm", format!("{from}:{to}"), problem))?;
                Starts::random(v, (0.0, 0.0), 1, 0)
                    .map_err(|problem| wrong("v", format!("{}:{}", v.0, v.1), problem))?;
                Starts::random(x_mm, v, count, seed)
                    .map_err(|problem| wrong("random", count.to_string(), problem))
            }
        }
    }

    /// Follows the starts, then once more those whose answer may be uncertain. Progress counts the two phases
    /// separately.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<BasinsAnswer, Error> {
        let (document, starts) = (simulation.document(), self.starts()?);
        let count = starts.count() as u64;
        let basins = study::Basins::new(simulation.scene(), simulation.mechanism().clone(), starts);
        let mut basins = basins.map_err(|problem| no_basins(document, problem, self.x_mm))?;
        let answer = progress.pool(|pool| {
            let mut answer = progress.task(Some(count), |task| {
                while !basins.is_whole() && basins.run_level(pool, task) {}
                basins.answer(task).filter(|_| basins.is_whole())
            })?;
            let uncertain = basins.rows_to_check(&answer).len() as u64;
            let whole = progress.task(Some(uncertain), |task| basins.check(&mut answer, pool, task));
            whole.then_some(answer)
        })?;
        let answer = answer.ok_or(Error::Cancelled)?;
        Ok(BasinsAnswer { basins, answer })
    }
}

/// The error for a scene that has no basins.
fn no_basins(document: &Document, problem: NoBasins, x_mm: EvenRange) -> Error {
    match problem {
        NoBasins::Faults(faults) => Error::faults_of(document, faults),
        NoBasins::Beyond { .. } => {
            Error::argument("x_mm", format!("{}:{}:{}", x_mm.from, x_mm.to, x_mm.count), problem)
        }
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
