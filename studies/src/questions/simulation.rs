//! A scene with its model.

use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

use super::grid::check_until;
use super::parts::thresholds;
use super::{Curve, Error, Progress};
use crate::dynamics::{Model, Outcome, Request, Run};
use crate::mechanics::{ForceCurve, Mechanism};
use crate::numeric::number_text;
use crate::scene::{Axis, Document, Excitation, Files, Quantity, Scene};
use crate::study::{
    Comparison, ForceComparison, Grid, Keep, MeasuredMotion, NoComparison, Recorded, Sampling, Table,
    Thresholds, Trace, can_cross, compare, contact, inspect, sample_times, simulate, simulate_with_trace,
};

/// A checked scene with its model, which every question takes.
///
/// It is made once from a built-in scene, a file or a text, which solves the mechanism (flexures take
/// longest), and it does not change: [`with`](Self::with) returns another one, which shares the mechanism if
/// none of its fields was changed. Fields and their units are those of scene files.
///
/// # Errors
///
/// Of all functions that return a simulation: [`Error::Scene`] for a scene that cannot be read, an unknown
/// field and values out of their range, with all faults at once, and [`Error::Failed`] for flexures without a
/// solution. [`run`](Self::run) never fails: if a run cannot continue, its outcome says so.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::dynamics::{EventKind, Request};
/// use interwell::questions::Simulation;
///
/// let simulation = Simulation::preset("paper")?;
/// let stronger = simulation.with("excitation.amplitude_g", 1.3)?;
/// let run = stronger.run(&Request { sample_times: &[1.0, 2.0], events: true, ..Request::default() });
/// assert!(run.summary.crossings > 0);
/// assert_eq!(run.samples.len(), 2); // displacement in m, velocity in m/s, ..
/// assert!(run.events.iter().any(|event| event.kind == EventKind::Crossing));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation {
    document: Document,
    model: Model,
    warnings: Vec<String>,
}

impl Simulation {
    /// The simulation of a built-in scene, such as `paper`; [`PRESETS`](crate::scene::PRESETS) lists them.
    pub fn preset(name: &str) -> Result<Self, Error> {
        Self::build(Document::preset(name)?, &Progress::none())
    }

    /// The simulation of a scene file.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::build(Document::from_file(path.as_ref())?, &Progress::none())
    }

    /// The simulation of a scene in RON, which `docs/scene.md` of the repository describes. Messages call it
    /// `name`. Files in it must have absolute paths or be built-in tables.
    pub fn from_text(name: &str, text: &str) -> Result<Self, Error> {
        Self::build(Document::from_text(name, text, Files::default())?, &Progress::none())
    }

    /// The simulation of a scene that has been read.
    pub fn new(document: &Document) -> Result<Self, Error> {
        Self::build(document.clone(), &Progress::none())
    }

    /// The simulation of a scene that has been read. [`Progress::stopped_by`] ends the solution of its
    /// mechanism, with [`Error::Cancelled`].
    pub fn build(document: Document, progress: &Progress) -> Result<Self, Error> {
        Self::of(document, None, progress)
    }

    /// The simulation of a document with its mechanism, if that is known.
    fn of(
        mut document: Document,
        known: Option<&Arc<Mechanism>>,
        progress: &Progress,
    ) -> Result<Self, Error> {
        let start_moved = document.settle_within();
        let warnings = start_moved.into_iter().chain(document.check()?).collect();
        let mechanism = match known {
            Some(known) => Arc::clone(known),
            None => {
                let scene = &document.scene;
                let built = Mechanism::build_cancellable(&scene.mechanism, &document.files, progress.stop());
                let built = built.ok_or(Error::Cancelled)?;
                Arc::new(built.map_err(|error| Error::unbuilt(&document, error))?)
            }
        };
        match Model::build(&document.scene, mechanism) {
            Ok(model) => Ok(Self { document, model, warnings }),
            Err(faults) => Err(Error::faults_of(&document, faults)),
        }
    }

    /// The simulation of a document whose model is known, such as one that continues a motion.
    #[doc(hidden)]
    pub fn of_model(document: Document, model: Model) -> Self {
        Self { document, model, warnings: Vec::new() }
    }

    /// The simulation with one field changed. The value is a number, arithmetic, or text as in a scene file,
    /// such as `Rigid(travel_limit_mm: 4, restitution: 0.36)` for the field `stops`.
    pub fn with(&self, field: &str, value: impl Display) -> Result<Self, Error> {
        self.with_all(&[(field.to_owned(), value.to_string())])
    }

    /// The simulation with several fields changed in this order. The scene is checked once, after all
    /// changes.
    pub fn with_all(&self, changes: &[(String, String)]) -> Result<Self, Error> {
        self.with_changes(changes, &Progress::none())
    }

    /// Like [`with_all`](Self::with_all). [`Progress::stopped_by`] ends the solution of a changed mechanism,
    /// with [`Error::Cancelled`].
    pub fn with_changes(&self, changes: &[(String, String)], progress: &Progress) -> Result<Self, Error> {
        let mut document = self.document.clone();
        for (field, value) in changes {
            document.set(&format!("{field}={value}"))?;
        }
        self.with_document(document, progress)
    }

    /// The simulation of a changed document, with the same mechanism if that is not changed.
    pub(crate) fn with_document(&self, document: Document, progress: &Progress) -> Result<Self, Error> {
        let same_mechanism = document.scene.mechanism == self.document.scene.mechanism;
        let known = same_mechanism && document.files == self.document.files;
        Self::of(document, known.then(|| self.mechanism()), progress)
    }

    /// The simulation with this force curve in place of its mechanism. The fields of the mechanism are then
    /// those of [`Pieces`](crate::scene::Mechanism::Pieces).
    ///
    /// # Errors
    ///
    /// [`Error::Scene`] if the scene does not fit the curve: its start lies beyond an end of it, or a damping
    /// ratio or a start at rest finds no well.
    pub fn with_force(&self, curve: &ForceCurve) -> Result<Self, Error> {
        let mut document = self.document.clone();
        document.scene.mechanism = curve.to_scene();
        document.scene.sweep.retain(|axis| !axis.field.starts_with("mechanism"));
        Self::build(document, &Progress::none())
    }

    /// The simulation with this drive in place of its excitation, such as that of the
    /// [`PeriodicDrive`](crate::scene::PeriodicDrive) which [`Excitation::from_fn`] or
    /// [`Excitation::from_samples`] makes.
    pub fn with_drive(&self, drive: &Excitation) -> Result<Self, Error> {
        let mut document = self.document.clone();
        document.scene.excitation = drive.clone();
        document.scene.sweep.retain(|axis| !axis.field.starts_with("excitation"));
        self.with_document(document, &Progress::none())
    }

    /// Runs the scene once and keeps what is requested.
    pub fn run(&self, request: &Request) -> Run {
        self.model.run(request)
    }

    /// Runs the scene once and keeps samples and events. With `until_settled` in s, the run continues window
    /// by window until the motion repeats, at most up to that time.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for sample times that are not finite, lie outside the run or are too many
    /// (at most 1e7), or for `until_settled`; [`Error::Cancelled`].
    ///
    /// # Example
    ///
    /// ```
    /// # use interwell_studies as interwell;
    /// use interwell::questions::{Progress, Sampling, Simulation};
    ///
    /// let simulation = Simulation::preset("nominal-cubic")?;
    /// let recorded = simulation.record(&Sampling::Every(0.01), None, &Progress::none())?;
    /// assert_eq!(recorded.samples.rows(), 1001);
    /// assert_eq!(recorded.events.words("kind")[0], "rest");
    /// # Ok::<(), interwell::questions::Error>(())
    /// ```
    pub fn record(
        &self,
        sampling: &Sampling,
        until_settled: Option<f64>,
        progress: &Progress,
    ) -> Result<Recorded, Error> {
        let keep = self.to_keep(sampling, until_settled)?;
        self.kept(&keep, progress)
    }

    /// What [`record`](Self::record) keeps; an error if an argument is wrong.
    #[doc(hidden)]
    pub fn to_keep(&self, sampling: &Sampling, until_settled: Option<f64>) -> Result<Keep, Error> {
        check_until(until_settled, &self.document, &self.model)?;
        let times = sample_times(&self.document.scene, &self.model, sampling, until_settled)
            .map_err(|problem| Error::number(problem.argument(), problem.value(), problem))?;
        Ok(Keep { times, events: true, until_settled })
    }

    /// A run of which this is kept.
    #[doc(hidden)]
    pub fn kept(&self, keep: &Keep, progress: &Progress) -> Result<Recorded, Error> {
        uncancelled(simulate(&self.model, keep, Some(progress.stop())))
    }

    /// The same with what a picture of it needs, over a window in s if one is given.
    #[doc(hidden)]
    pub fn traced(
        &self,
        keep: &Keep,
        window: Option<(f64, f64)>,
        progress: &Progress,
    ) -> Result<(Recorded, Trace), Error> {
        let (recorded, trace) = simulate_with_trace(&self.model, keep, window, Some(progress.stop()));
        Ok((uncancelled(recorded)?, trace))
    }

    /// Compares a measured motion with a run of the scene.
    /// [`RunPicture::chart_with_measured`](crate::output::RunPicture::chart_with_measured) draws both.
    ///
    /// # Method
    ///
    /// A shift that is not given is the one with the smallest mean square difference for which at least half
    /// of the shorter of record and run overlaps, found on an even grid and, for a displacement, refined by
    /// Gauss-Newton steps.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for times that are fewer than two, do not ascend, or are not as many as the
    /// values, and for numbers that are not finite; [`Error::Unfit`] if less than two samples lie within the
    /// run; [`Error::Cancelled`].
    ///
    /// # Example
    ///
    /// ```
    /// # use interwell_studies as interwell;
    /// use interwell::questions::{MeasuredMotion, Progress, Sampling, Simulation};
    /// use interwell::scene::{Channel, Quantity};
    ///
    /// // a record of the same motion that began 0.25 s later
    /// let simulation = Simulation::preset("nominal-cubic")?;
    /// let run = simulation.record(&Sampling::Every(0.01), None, &Progress::none())?;
    /// let values = run.samples.numbers("x_m").unwrap()[..500].to_vec();
    /// let times: Vec<f64> = run.samples.numbers("t_s").unwrap()[..500].iter().map(|t| t - 0.25).collect();
    /// let channel = Channel { quantity: Quantity::Displacement, column: "x_m".to_owned(), values };
    /// let motion = MeasuredMotion { shift: None, ..MeasuredMotion::of(&times, &channel) };
    /// let found = simulation.compared(&motion, &Progress::none())?;
    /// assert!((found.shift - 0.25).abs() < 1e-6 && found.rms.0 < 1e-6);
    /// # Ok::<(), interwell::questions::Error>(())
    /// ```
    pub fn compared(&self, motion: &MeasuredMotion, progress: &Progress) -> Result<Comparison, Error> {
        check_motion(motion)?;
        compare(&self.document.scene, &self.model, motion, progress.stop()).map_err(|problem| match problem {
            NoComparison::Cancelled => Error::Cancelled,
            NoComparison::Apart { .. } => Error::unfit(&self.document, problem),
        })
    }

    /// Forces in N that were measured at positions in m in a slow pull, beside those of the force curve that
    /// hold the mass there. Positions beyond the curve are left out, and a remark of the answer counts them.
    /// [`measured_force_chart`](crate::output::measured_force_chart) draws both.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for lists of different lengths and for numbers that are not finite;
    /// [`Error::Unfit`] if less than two positions lie on the curve.
    ///
    /// # Example
    ///
    /// ```
    /// # use interwell_studies as interwell;
    /// use interwell::questions::Simulation;
    ///
    /// // a record that reads 0.01 N too much
    /// let simulation = Simulation::preset("nominal-cubic")?;
    /// let positions = [-4e-3, -1e-3, 2e-3, 5e-3];
    /// let force = positions.map(|x| simulation.mechanism().curve.force(x) + 0.01);
    /// let found = simulation.compared_force(&positions, &force)?;
    /// assert!((found.rms.0 - 0.01).abs() < 1e-12 && (found.largest.1 + 0.01).abs() < 1e-12);
    /// # Ok::<(), interwell::questions::Error>(())
    /// ```
    pub fn compared_force(&self, positions: &[f64], force: &[f64]) -> Result<ForceComparison, Error> {
        if positions.len() != force.len() {
            let problem = format!("give as many as forces, which are {}", force.len());
            return Err(Error::argument("positions", positions.len(), problem));
        }
        for (name, values) in [("positions", positions), ("force", force)] {
            if let Some(value) = values.iter().find(|value| !value.is_finite()) {
                return Err(Error::number(name, *value, "give a finite number"));
            }
        }
        Curve::compared(&self.document, self.mechanism(), positions, force)
    }

    /// The amplitudes in g of a harmonic drive that release the mass from its stop and let it cross, in one
    /// call without a range; `None` for another drive, or without a barrier between the stops. They are those
    /// of the window's status line. [`Threshold`](super::Threshold) searches any field, with a resolution.
    ///
    /// # Method
    ///
    /// The release has a closed form. For the crossing, amplitudes are run from rest in steps of at most a
    /// 100th of the one whose inertial force equals the largest force of the mechanism, above twice that one
    /// in steps of 1 %, up to 30 times it, and the first change is bisected to a thousandth of the step. The
    /// range above the threshold is searched for gaps.
    ///
    /// # Errors
    ///
    /// [`Error::Cancelled`].
    ///
    /// # Example
    ///
    /// ```
    /// # use interwell_studies as interwell;
    /// use interwell::questions::{Progress, Simulation};
    ///
    /// let found = Simulation::preset("paper")?.thresholds(&Progress::none())?.unwrap();
    /// assert!((found.frees_at.unwrap() - 0.687_903_586_855).abs() < 1e-12);
    /// assert!((found.crossing.value.unwrap() - 0.7178).abs() < 1e-4);
    /// # Ok::<(), interwell::questions::Error>(())
    /// ```
    pub fn thresholds(&self, progress: &Progress) -> Result<Option<Thresholds>, Error> {
        let found = thresholds(&self.document.scene, self.mechanism(), progress);
        if progress.is_stopped() { Err(Error::Cancelled) } else { Ok(found) }
    }

    /// What the scene models and leaves out, how accurate its force curve is, and where it rests and leaves a
    /// stop, each a sentence.
    pub fn describe(&self) -> Vec<String> {
        inspect(&self.document.scene, &self.model)
    }

    /// Whether a barrier between two wells lies between the stops, so that a motion can cross it.
    pub fn can_cross(&self) -> bool {
        can_cross(&self.document.scene, self.mechanism())
    }

    /// One impact on the compliant stops over the impact speed, in closed form, beside a rigid stop of this
    /// restitution: `speed_m_per_s`, `restitution`, `rigid_restitution`, `contact_time_s`, `depth_m`,
    /// `peak_force_n`, `peak_pressure_pa`. Gives [`Error::Unfit`] if the stops are not compliant.
    pub fn impact(&self, rigid_restitution: f64) -> Result<Table, Error> {
        contact(&self.model, rigid_restitution).ok_or_else(|| {
            let problem = "its stops are not compliant; give it some, such as stops=Hertz(travel_limit_mm: \
                           1.5, radius_mm: 5, young_gpa: 69, loss_s_per_m: 10.4)";
            Error::unfit(&self.document, problem)
        })
    }

    /// The scene with its source text and the changes to it.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The fields of the scene.
    pub fn scene(&self) -> &Scene {
        &self.document.scene
    }

    /// The model in SI units.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The mechanism: its force curve, wells and barrier.
    pub fn mechanism(&self) -> &Arc<Mechanism> {
        self.model.mechanism()
    }

    /// Warnings about values that are valid but probably unintended, and about tables, each one sentence.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let name = &self.document.name;
        let of_tables = self.mechanism().warnings().map(move |warning| format!("{name}: {warning}"));
        self.warnings.iter().cloned().chain(of_tables)
    }

    /// The grid over these fields, each given by its dotted path with its values, the slowest first; if there
    /// are none, the grid of the scene's `sweep`. Questions make it themselves; a program needs it for a
    /// picture.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for a field that the scene does not have, values out of its range and too many
    /// cells (1e8); [`Error::Scene`] for cells that are no valid scene.
    pub fn grid(&self, over: &[(String, Vec<f64>)]) -> Result<Grid, Error> {
        if over.is_empty() {
            return Ok(Grid::new(self.document.axes::<&str>(&[])?)?);
        }
        let axis = |(field, values): &(String, Vec<f64>)| {
            let count = values.len();
            let value = if count == 1 { number_text(values[0]) } else { format!("{count} values") };
            let axis = Axis::listed(field, values.clone(), &self.document.scene);
            axis.map_err(|problem| Error::argument(field, value, problem))
        };
        let axes = over.iter().map(axis).collect::<Result<Vec<Axis>, Error>>()?;
        Ok(Grid::new(self.document.check_axes(axes, "over")?)?)
    }
}

/// Refuses a measured motion that is no motion over time.
fn check_motion(motion: &MeasuredMotion) -> Result<(), Error> {
    let MeasuredMotion { times, channel, offset, time_scale, shift } = motion;
    let (count, values) = (times.len(), &channel.values);
    if count < 2 || count != values.len() {
        let problem = format!("give at least 2, as many as values, which are {}", values.len());
        return Err(Error::argument("times", count, problem));
    }
    if let Some(pair) = times.windows(2).find(|pair| !(pair[0] < pair[1])) {
        return Err(Error::argument("times", format!("{}, {}", pair[0], pair[1]), "times must ascend"));
    }
    if !matches!(channel.quantity, Quantity::Displacement | Quantity::Velocity | Quantity::Acceleration) {
        let problem = "give a displacement, a velocity or an acceleration of the base";
        return Err(Error::argument("channel", channel.quantity.name(), problem));
    }
    let numbers = [("times", times[0]), ("times", times[count - 1]), ("offset", *offset)];
    let numbers = numbers.into_iter().chain(shift.map(|shift| ("shift", shift)));
    let numbers = numbers.chain(values.iter().map(|value| ("values", *value)));
    if let Some((name, number)) = numbers.into_iter().find(|(_, number)| !number.is_finite()) {
        return Err(Error::number(name, number, "give a finite number"));
    }
    match *time_scale > 0.0 && time_scale.is_finite() {
        true => Ok(()),
        false => Err(Error::number("time_scale", *time_scale, "give a number above 0")),
    }
}

/// The run, unless it was cancelled.
fn uncancelled(recorded: Recorded) -> Result<Recorded, Error> {
    match recorded.summary.outcome {
        Outcome::Cancelled { .. } => Err(Error::Cancelled),
        _ => Ok(recorded),
    }
}
