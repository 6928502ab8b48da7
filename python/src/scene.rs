//! Scenes, their force curves and their runs.

use std::sync::Arc;

use interwell_kernel::dynamics::Summary;
use interwell_kernel::mechanics::{FitReport, ForceCurve};
use interwell_kernel::scene::{Document, Excitation, FieldPath, Files, PRESETS, all_fields, write};
use interwell_studies::output::{Caption, Provenance, RunPanel, RunPicture, curve_chart, summary};
use interwell_studies::questions::{self, Curve, Error, Progress, Sampling, Table};
use interwell_studies::study::stop_positions;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::answer::{Answer, Asked};
use crate::errors::raised;
use crate::function::Function;
use crate::work::{Way, work, work_calling, work_here};

pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Steps of free flight in a time scale of the motion, about.
const STEPS_PER_SCALE: f64 = 10.0;

/// Work of a run that takes some milliseconds: such a run is done at once, without a thread that watches for
/// signals.
const SHORT: f64 = 3e6;

/// A scene that has been checked, with its model.
#[pyclass(frozen, module = "interwell._interwell")]
pub struct Simulation {
    pub inner: Arc<questions::Simulation>,
}

impl Simulation {
    /// Makes the caption of a picture.
    pub fn caption(&self) -> impl Fn() -> Caption + use<> {
        let simulation = Arc::clone(&self.inner);
        move || Caption::new(simulation.document(), VERSION)
    }

    fn new(inner: questions::Simulation) -> Self {
        Self { inner: Arc::new(inner) }
    }

    /// Whether a run takes some milliseconds at most.
    fn is_short(&self, until_settled: Option<f64>) -> bool {
        let model = self.inner.model();
        let steps = STEPS_PER_SCALE * model.duration() / model.scales().time;
        let (cost, _) = model.cost_of_a_step(model.tolerance());
        until_settled.is_none() && model.compliant().is_none() && steps * (cost as f64) < SHORT
    }
}

#[pymethods]
impl Simulation {
    /// A scene file or a built-in scene of that name.
    #[staticmethod]
    fn load(py: Python<'_>, spec: &str) -> PyResult<Self> {
        let build = |progress: &Progress| questions::Simulation::build(Document::load(spec)?, progress);
        work(py, &Way::default(), build).map(Self::new)
    }

    #[staticmethod]
    fn preset(py: Python<'_>, name: &str) -> PyResult<Self> {
        let build = |progress: &Progress| questions::Simulation::build(Document::preset(name)?, progress);
        work(py, &Way::default(), build).map(Self::new)
    }

    #[staticmethod]
    fn from_text(py: Python<'_>, name: &str, text: &str) -> PyResult<Self> {
        let build = |progress: &Progress| {
            questions::Simulation::build(Document::from_text(name, text, Files::default())?, progress)
        };
        work(py, &Way::default(), build).map(Self::new)
    }

    fn with_all(&self, py: Python<'_>, changes: Vec<(String, String)>) -> PyResult<Self> {
        let of_mechanism = changes.iter().any(|(field, _)| field.starts_with("mechanism"));
        match of_mechanism {
            true => work(py, &Way::default(), |progress| self.inner.with_changes(&changes, progress)),
            false => work_here(py, |_| self.inner.with_all(&changes)),
        }
        .map(Self::new)
    }

    /// The scene with the force of a function, and the largest error in N that was found.
    fn with_force(
        &self,
        py: Python<'_>,
        force: &Bound<'_, PyAny>,
        range: (f64, f64),
        tolerance: f64,
        breaks: Vec<f64>,
    ) -> PyResult<(Self, f64)> {
        let function = Function::new(force, "force");
        let made = work_calling(py, &Way::default(), &|x| function.value(x), |progress, force| {
            let curve = ForceCurve::from_fn_cancellable(force, range, tolerance, &breaks, progress.stop())?;
            let error = curve.fit().map_or(0.0, |FitReport { worst_n, .. }| *worst_n);
            Ok((self.inner.with_force(&curve)?, error))
        });
        let (inner, error) = function.unless_failed(made)?;
        Ok((Self::new(inner), error))
    }

    /// The scene with the force curve through samples.
    fn with_force_samples(
        &self,
        py: Python<'_>,
        x_m: Vec<f64>,
        force_n: Vec<f64>,
        tolerance: f64,
    ) -> PyResult<Self> {
        let with_samples = |progress: &Progress| {
            let curve = ForceCurve::from_samples_cancellable(&x_m, &force_n, tolerance, progress.stop())?;
            self.inner.with_force(&curve)
        };
        work(py, &Way::default(), with_samples).map(Self::new)
    }

    /// The scene with the drive of a function of the time, or of samples of one period.
    fn with_drive(
        &self,
        py: Python<'_>,
        acceleration: &Bound<'_, PyAny>,
        frequency_hz: f64,
        tolerance: f64,
    ) -> PyResult<Self> {
        if !acceleration.is_callable() {
            let samples = acceleration.extract::<Vec<f64>>()?;
            let with_samples = |_: &Progress| {
                self.inner.with_drive(&Excitation::from_samples(&samples, frequency_hz)?.excitation)
            };
            return work(py, &Way::default(), with_samples).map(Self::new);
        }
        let function = Function::new(acceleration, "acceleration");
        let made = work_calling(py, &Way::default(), &|t| function.value(t), |_, acceleration| {
            let drive = Excitation::from_fn(acceleration, frequency_hz, tolerance)?;
            self.inner.with_drive(&drive.excitation)
        });
        function.unless_failed(made).map(Self::new)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.inner.document().name
    }

    #[getter]
    fn title(&self) -> &str {
        &self.inner.scene().title
    }

    #[getter]
    fn notes(&self) -> &str {
        &self.inner.scene().notes
    }

    /// The scene as RON text.
    #[getter]
    fn text(&self) -> PyResult<String> {
        write(self.inner.scene()).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.inner.warnings().collect()
    }

    /// Dotted paths of all fields.
    #[getter]
    fn fields(&self) -> Vec<String> {
        all_fields(self.inner.scene())
    }

    /// The number at a path, and otherwise its value as one word.
    fn get(&self, field: &str) -> (Option<f64>, Option<String>) {
        let path = FieldPath::new(field);
        (path.get(self.inner.scene()), path.word(self.inner.scene()))
    }

    /// Equilibria: position in m, and whether they are stable.
    #[getter]
    fn equilibria(&self) -> Vec<(f64, bool)> {
        let landscape = &self.inner.mechanism().landscape;
        landscape.equilibria.iter().map(|found| (found.x, found.stable)).collect()
    }

    /// Height of the barrier in J, seen from the left and from the right well.
    #[getter]
    fn barrier_j(&self) -> Option<(f64, f64)> {
        let barrier = self.inner.mechanism().landscape.barrier;
        barrier.map(|barrier| (barrier.from_left_j, barrier.from_right_j))
    }

    #[pyo3(signature = (dt=None, at=None, until_settled=None))]
    fn run(
        &self,
        py: Python<'_>,
        dt: Option<f64>,
        at: Option<Vec<f64>>,
        until_settled: Option<f64>,
    ) -> PyResult<Run> {
        let sampling = match (dt, at) {
            (Some(step), Some(_)) => {
                let error = Error::number("dt", step, "give a step dt or the times at, not both");
                return Err(raised(py, &error));
            }
            (None, Some(times)) => Sampling::At(times),
            (Some(step), None) => Sampling::Every(step),
            (None, None) => Sampling::Default,
        };
        let question = |progress: &Progress| self.inner.record(&sampling, until_settled, progress);
        let found = match self.is_short(until_settled) {
            true => work_here(py, question),
            false => work(py, &Way::default(), question),
        }?;
        let shown = Arc::clone(&self.inner);
        let drawn = move |_: &Table, asked: &Asked| {
            let panels = match &asked.quantity {
                None => RunPanel::USUAL.to_vec(),
                Some(names) => names.split(',').map(panel).collect::<Result<_, _>>()?,
            };
            let picture = RunPicture { panels, ranges: asked.ranges, until_settled };
            let progress = Progress::none().stopped_by(asked.cancel);
            picture.chart(&shown, &progress)
        };
        Ok(Run {
            samples: Py::new(py, Answer::new(py, found.samples, self.caption()).drawn(drawn))?,
            events: Py::new(py, Answer::new(py, found.events, self.caption()))?,
            summary: found.summary,
            simulation: Arc::clone(&self.inner),
        })
    }

    #[pyo3(signature = (positions=None))]
    fn curve(&self, py: Python<'_>, positions: Option<Vec<f64>>) -> PyResult<Answer> {
        let question = Curve { positions };
        let table = work(py, &Way::default(), |_| question.run(&self.inner))?;
        let shown = self.inner.clone();
        Ok(Answer::new(py, table, self.caption()).drawn(move |rows, asked| {
            Ok(curve_chart(rows, shown.mechanism(), stop_positions(shown.scene()), asked.ranges))
        }))
    }
}

/// The panel of a run with this name.
fn panel(name: &str) -> Result<RunPanel, Error> {
    RunPanel::named(name.trim()).ok_or_else(|| {
        let known = RunPanel::ALL.map(RunPanel::name).join(", ");
        Error::argument("panels", name.trim(), format!("there is no such panel; there are {known}"))
    })
}

/// One run.
#[pyclass(frozen, module = "interwell._interwell")]
pub struct Run {
    #[pyo3(get)]
    samples: Py<Answer>,
    #[pyo3(get)]
    events: Py<Answer>,
    summary: Summary,
    simulation: Arc<questions::Simulation>,
}

#[pymethods]
impl Run {
    /// The summary as JSON, as the command line writes it.
    fn summary(&self) -> String {
        summary(&self.summary, self.simulation.scene(), &origin(self.summary.cpu_s))
    }

    /// Mass in g.
    #[getter]
    fn mass_g(&self) -> f64 {
        self.simulation.scene().mass_g
    }

    /// Potential of the mechanism in J at each sample.
    fn potential<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let positions = self.samples.get().numbers(py, "x_m")?;
        let curve = &self.simulation.mechanism().curve;
        let potential = py.detach(|| positions.into_iter().map(|x| curve.potential(x)).collect());
        Ok(PyArray1::from_vec(py, potential))
    }

    /// Why the run ended before its duration, or is inaccurate; None if it is done.
    fn outcome(&self) -> &'static str {
        self.summary.outcome.name()
    }
}

/// The origin of an answer that took this CPU time in s.
pub fn origin(cpu_s: f64) -> Provenance {
    Provenance { version: VERSION.to_owned(), arguments: Vec::new(), wall_s: f64::NAN, cpu_s, jobs: 1 }
}

/// Names and titles of the built-in scenes.
#[pyfunction]
pub fn presets() -> Vec<(&'static str, String)> {
    let title = |name| Document::preset(name).map_or_else(|_| String::new(), |read| read.scene.title);
    PRESETS.iter().map(|preset| (preset.name, title(preset.name))).collect()
}
