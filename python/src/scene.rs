//! Scenes and the questions about them.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use interwell_kernel::dynamics::Summary;
use interwell_kernel::mechanics::{FitReport, ForceCurve};
use interwell_kernel::numeric::Taper;
use interwell_kernel::scene::{Document, Excitation, FieldPath, Files, PRESETS, all_fields, write};
use interwell_studies::output::{
    Caption, Overlay, Provenance, Ranges, RunPanel, SpectrumQuantity, SweepPicture, View, basins_chart,
    branch_chart, comparison_chart, curve_chart, escape_chart, exponents_chart, identified, identified_chart,
    loci_chart, run_chart, section_chart, spectrum_chart, summary, sweep_chart, threshold_chart,
};
use interwell_studies::questions::{
    self, Basins, Best, Branch, BranchEvent, Carry, Compare, Curve, Error, Escape, ExponentOptions,
    Exponents, FieldRange, Grid, Identify, Locus, Onset, Orbit, ProbableThreshold, Progress, Sampling,
    Section, SectionAt, SectionOptions, Signal, Spectrum, Sweep, Table, Threshold, Uncertain, Until,
    WhatToIdentify,
};
use interwell_studies::study::{Identity, Keep, stop_positions};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::answer::{Answer, Asked};
use crate::errors::raised;
use crate::work::{Way, work, work_calling, work_here};

/// Fields and the values that each takes.
type Over = Vec<(String, Vec<f64>)>;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Steps of free flight in a time scale of the motion, about.
const STEPS_PER_SCALE: f64 = 10.0;

/// Work of a run that takes some milliseconds: such a run is done at once, without a thread that watches for
/// signals.
const SHORT: f64 = 3e6;

/// A scene that has been checked, with its model.
#[pyclass(frozen, module = "interwell._interwell")]
pub struct Simulation {
    inner: questions::Simulation,
}

/// What came of a question, or the exception.
fn checked<T>(py: Python<'_>, found: Result<T, Error>) -> PyResult<T> {
    found.map_err(|error| raised(py, &error))
}

/// The variant that is called `word`, or the exception that lists all.
fn named<T: Copy>(
    py: Python<'_>,
    argument: &str,
    word: &str,
    all: &[T],
    name: fn(T) -> &'static str,
) -> PyResult<T> {
    let found = all.iter().copied().find(|one| name(*one) == word);
    found.ok_or_else(|| {
        let known: Vec<&str> = all.iter().map(|one| name(*one)).collect();
        raised(py, &Error::argument(argument, word, format!("give one of {}", known.join(", "))))
    })
}

impl Simulation {
    fn caption(&self) -> Caption {
        Caption::new(self.inner.document(), VERSION)
    }

    fn new(inner: questions::Simulation) -> Self {
        Self { inner }
    }

    /// Thresholds of a field, with their picture if they are those of a grid.
    fn thresholds(
        &self,
        py: Python<'_>,
        table: Table,
        over: &Over,
        field: String,
        onset: Onset,
    ) -> PyResult<Answer> {
        let answer = Answer::new(py, table, self.caption());
        if over.is_empty() {
            return Ok(answer);
        }
        let (grid, shown) = (checked(py, self.inner.grid(over))?, self.inner.clone());
        Ok(answer.drawn(move |rows, asked| {
            let chart = threshold_chart(rows, &grid, shown.scene(), &field, onset, asked.ranges);
            chart.map_err(|problem| problem.to_string())
        }))
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
        let caption = self.caption();
        let shown = self.inner.clone();
        let drawn = move |_: &Table, asked: &Asked| {
            let panels = match &asked.quantity {
                None => RunPanel::USUAL.to_vec(),
                Some(names) => {
                    let panel = |name: &str| {
                        let known = || RunPanel::ALL.map(RunPanel::name).join(", ");
                        RunPanel::named(name.trim())
                            .ok_or_else(|| format!("no panel `{name}`; there are {}", known()))
                    };
                    names.split(',').map(panel).collect::<Result<Vec<_>, String>>()?
                }
            };
            let keep = Keep { times: Vec::new(), events: false, until_settled };
            let progress = Progress::none().stopped_by(asked.cancel);
            let found = shown.traced(&keep, asked.ranges.x, &progress);
            let (run, trace) = found.map_err(|error| error.to_string())?;
            let trace = RunPanel::complete(&panels, trace, shown.model(), asked.cancel);
            let (of, ranges) =
                ((&**shown.mechanism(), shown.model().mass()), Ranges { x: None, y: asked.ranges.y });
            Ok(run_chart(&trace, &run.summary, of, &panels, ranges))
        };
        Ok(Run {
            samples: Py::new(py, Answer::new(py, found.samples, caption.clone()).drawn(drawn))?,
            events: Py::new(py, Answer::new(py, found.events, caption))?,
            summary: found.summary,
            simulation: self.inner.clone(),
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

    #[pyo3(signature = (over, columns, until_settled=None, carry=None, uncertain=Vec::new(), draws=None,
                        seed=None, threads=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn sweep(
        &self,
        py: Python<'_>,
        over: Over,
        columns: Vec<String>,
        until_settled: Option<f64>,
        carry: Option<&str>,
        uncertain: Vec<String>,
        draws: Option<u64>,
        seed: Option<u64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let carry = carry.map(|word| named(py, "carry", word, &Carry::ALL, Carry::name)).transpose()?;
        let uncertain = Uncertain { fields: uncertain, draws, seed };
        let question = Sweep { over, columns, until_settled, carry, uncertain };
        let (shown, grid, about, table) = work(py, &Way { threads, progress }, |progress| {
            let shown = question.nominal(&self.inner, progress)?;
            let grid = shown.grid(&question.over)?;
            let cells = question.cells(shown.document(), grid.clone(), None, progress)?;
            let about = cells.sweep.options().draws.about();
            let table = question.run(&shown, progress)?;
            Ok((shown, grid, about, table))
        })?;
        Ok(Answer::new(py, table, self.caption()).drawn(move |rows, asked| {
            let (scene, mechanism) = (shown.scene(), shown.mechanism());
            let mechanism = (!grid.changes_mechanism()).then_some(&**mechanism);
            let overlay = match carry {
                Some(_) => Overlay::default(),
                None => Overlay::of(scene, mechanism, &grid, rows),
            };
            let quantity = asked.quantity.as_deref().unwrap_or("rms_velocity_m_per_s");
            let (grid, view, ranges) = (&grid, View::Top, asked.ranges);
            let picture = SweepPicture {
                rows,
                grid,
                scene,
                until_settled,
                quantity,
                overlay,
                view,
                ranges,
                draws: &about,
            };
            sweep_chart(&picture).map_err(|problem| problem.to_string())
        }))
    }

    #[pyo3(signature = (over, at, phase_deg=0.0, skip=None, keep=None, until_settled=None, carry=None,
                        threads=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn section(
        &self,
        py: Python<'_>,
        over: Over,
        at: &str,
        phase_deg: f64,
        skip: Option<u64>,
        keep: Option<u64>,
        until_settled: Option<f64>,
        carry: Option<&str>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let wrong =
            |name: &str, value: &str, problem: &str| Err(raised(py, &Error::argument(name, value, problem)));
        let together = "skip and keep belong together: give both, in forcing periods";
        match (skip, keep) {
            (Some(periods), None) => return wrong("skip", &periods.to_string(), together),
            (None, Some(periods)) => return wrong("keep", &periods.to_string(), together),
            _ => {}
        }
        let carry = carry.map(|word| named(py, "carry", word, &Carry::ALL, Carry::name)).transpose()?;
        let at = match at {
            "phase" => SectionAt::Phase(phase_deg),
            "impacts" => SectionAt::Impacts,
            other => return wrong("at", other, "give phase or impacts"),
        };
        let options = SectionOptions { at, periods: skip.zip(keep), until_settled, carry };
        let question = Section { over, options };
        let table = work(py, &Way { threads, progress }, |progress| question.run(&self.inner, progress))?;
        let over = match question.over.is_empty() {
            true => None,
            false => Some(checked(py, self.inner.grid(&question.over))?),
        };
        let stops = if over.is_none() { self.inner.model().stop_positions() } else { (None, None) };
        Ok(Answer::new(py, table, self.caption()).drawn(move |rows, asked| {
            let phase_deg = if let SectionAt::Phase(degrees) = at { Some(degrees) } else { None };
            Ok(section_chart(rows, over.as_ref(), phase_deg, stops, asked.ranges))
        }))
    }

    #[pyo3(signature = (over, periods=None, until_settled=None, threads=None, progress=None))]
    fn exponents(
        &self,
        py: Python<'_>,
        over: Over,
        periods: Option<u32>,
        until_settled: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let periods = periods.unwrap_or(ExponentOptions::PERIODS);
        let question =
            Exponents { over, options: ExponentOptions { periods, until_settled, circuits: false } };
        let table = work(py, &Way { threads, progress }, |progress| question.run(&self.inner, progress))?;
        let answer = Answer::new(py, table, self.caption());
        if question.over.is_empty() {
            return Ok(answer);
        }
        let (grid, shown) = (checked(py, self.inner.grid(&question.over))?, self.inner.clone());
        Ok(answer.drawn(move |rows, asked| {
            let chart = exponents_chart(rows, &grid, shown.scene(), asked.ranges);
            chart.map_err(|problem| problem.to_string())
        }))
    }

    #[pyo3(signature = (over, runs=None, within=None, until="well", threads=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn escape(
        &self,
        py: Python<'_>,
        over: Over,
        runs: Option<u64>,
        within: Option<f64>,
        until: &str,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let until = named(py, "until", until, &Until::ALL, Until::name)?;
        let question = Escape { over, runs: runs.unwrap_or(Escape::RUNS), within, until };
        let table = work(py, &Way { threads, progress }, |progress| question.run(&self.inner, progress))?;
        let answer = Answer::new(py, table, self.caption());
        if question.over.is_empty() {
            return Ok(answer);
        }
        let grid = checked(py, self.inner.grid(&question.over))?;
        let options = checked(py, question.options(self.inner.document(), &grid))?;
        Ok(answer.drawn(move |rows, asked| {
            let chart = escape_chart(rows, &grid, &options, asked.ranges);
            chart.map_err(|problem| problem.to_string())
        }))
    }

    #[pyo3(signature = (over, field, of, resolution=None, until_settled=None, melnikov=false, threads=None,
                        progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn threshold(
        &self,
        py: Python<'_>,
        over: Over,
        field: String,
        of: &str,
        resolution: Option<f64>,
        until_settled: Option<f64>,
        melnikov: bool,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let of = named(py, "of", of, &Onset::ALL, Onset::name)?;
        let question = Threshold { over, field, of, resolution, until_settled, melnikov };
        let table = work(py, &Way { threads, progress }, |progress| question.run(&self.inner, progress))?;
        let scan = checked(py, question.scan(self.inner.document(), &Grid::of_one()))?;
        self.thresholds(py, table, &question.over, scan.field, of)
    }

    #[pyo3(signature = (over, field, probability, runs=None, within=None, resolution=None, threads=None,
                        progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn probable_threshold(
        &self,
        py: Python<'_>,
        over: Over,
        field: String,
        probability: f64,
        runs: Option<u64>,
        within: Option<f64>,
        resolution: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let runs = runs.unwrap_or(Escape::RUNS);
        let question = ProbableThreshold { over, field, probability, runs, within, resolution };
        let table = work(py, &Way { threads, progress }, |progress| question.run(&self.inner, progress))?;
        let scan = checked(py, question.scan(self.inner.document(), &Grid::of_one()))?;
        self.thresholds(py, table, &question.over, scan.field, Onset::Crossing)
    }

    #[pyo3(signature = (period=None, phase_deg=0.0))]
    fn orbit(&self, py: Python<'_>, period: Option<u32>, phase_deg: f64) -> PyResult<Answer> {
        let question = Orbit { period, phase_deg };
        let found = work(py, &Way::default(), |progress| question.run(&self.inner, progress))?;
        Ok(Answer::new(py, found.table(), self.caption()))
    }

    #[pyo3(signature = (field, range, step, count, switch, period=None, phase_deg=0.0, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn branch(
        &self,
        py: Python<'_>,
        field: String,
        range: (f64, f64),
        step: f64,
        count: usize,
        switch: u32,
        period: Option<u32>,
        phase_deg: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let question = Branch { field, range, period, phase_deg, step, count };
        let way = Way { threads: None, progress };
        let found = work(py, &way, |progress| {
            let found = question.with_switches(switch, &self.inner, progress);
            found.map_err(|error| renamed(error, [["range", "end"]]))
        })?;
        let table = if switch > 0 { found.table() } else { found.branches[0].table() };
        let answer = Answer::new(py, table, self.caption()).told(found.remarks());
        Ok(answer.drawn(move |_, asked| Ok(branch_chart(&found.branches, phase_deg, asked.ranges))))
    }

    #[pyo3(signature = (
        event, field, range, second, second_range, step, count, period=None, phase_deg=0.0, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn locus(
        &self,
        py: Python<'_>,
        event: &str,
        field: String,
        range: (f64, f64),
        second: String,
        second_range: (f64, f64),
        step: f64,
        count: usize,
        period: Option<u32>,
        phase_deg: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let of = named(py, "event", event, &BranchEvent::ALL, BranchEvent::name)?;
        let branch = Branch { field, range, period, phase_deg, step, count };
        let question = Locus { branch, of, second: FieldRange { field: second, range: second_range } };
        let way = Way { threads: None, progress };
        let found = work(py, &way, |progress| question.run(&self.inner, progress))?;
        let answer = Answer::new(py, found.table(), self.caption()).told(found.remarks());
        Ok(answer.drawn(move |_, asked| Ok(loci_chart(&found.loci, phase_deg, asked.ranges))))
    }

    #[pyo3(signature = (of, taper, rate_hz=None, until_settled=None))]
    fn spectrum(
        &self,
        py: Python<'_>,
        of: &str,
        taper: &str,
        rate_hz: Option<f64>,
        until_settled: Option<f64>,
    ) -> PyResult<Answer> {
        let of = named(py, "of", of, &Signal::ALL, Signal::name)?;
        let taper = match taper {
            "auto" => None,
            "hann" => Some(Taper::Hann),
            "none" => Some(Taper::None),
            _ => return Err(raised(py, &Error::argument("taper", taper, "give auto, hann or none"))),
        };
        let question = Spectrum { of, taper, rate_hz, until_settled };
        let found = work(py, &Way::default(), |progress| question.run(&self.inner, progress))?;
        let answer = Answer::new(py, found.table().clone(), self.caption()).told(vec![found.describe()]);
        Ok(answer.drawn(move |_, asked| {
            let quantity = match asked.quantity.as_deref() {
                None | Some("amplitude") => SpectrumQuantity::Amplitude,
                Some("psd") => SpectrumQuantity::Density,
                Some(other) => return Err(format!("no column `{other}`; give amplitude or psd")),
            };
            Ok(spectrum_chart(&found, quantity, asked.ranges))
        }))
    }

    /// A row a start, and a row an attractor.
    #[pyo3(signature = (x_mm, v, random=None, threads=None, progress=None))]
    fn basins(
        &self,
        py: Python<'_>,
        x_mm: (f64, f64, u64),
        v: (f64, f64, u64),
        random: Option<(u64, u64)>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Answer, Answer)> {
        let question = Basins { random, ..Basins::of(x_mm, v) };
        let way = Way { threads, progress };
        let found = work(py, &way, |progress| {
            question.run(&self.inner, progress).map_err(|error| renamed(error, [["v", "v_m_per_s"]]))
        })?;
        let attractors = Answer::new(py, found.attractors(), self.caption());
        let starts = Answer::new(py, found.table(), self.caption()).told(found.answer.words());
        let starts = starts.drawn(move |_, _| Ok(basins_chart(&found.basins, &found.answer)));
        Ok((starts, attractors))
    }

    /// This scene, called `name`, beside others under its sine.
    #[pyo3(signature = (name, others, until_settled=None, threads=None, progress=None))]
    fn compare(
        &self,
        py: Python<'_>,
        name: String,
        others: Vec<(String, Py<Self>)>,
        until_settled: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let with = others.into_iter().map(|(name, other)| (name, other.get().inner.clone())).collect();
        let question = Compare { with, name, environment: None, until_settled };
        let way = Way { threads, progress };
        let found = work(py, &way, |progress| question.run(&self.inner, progress))?;
        Ok(Answer::new(py, found.table(), self.caption())
            .drawn(move |_, _| Ok(comparison_chart(&found.rated, found.frequency_hz))))
    }

    #[pyo3(signature = (over, maximise, subject_to, environment, vary, seed, until_settled=None, threads=None,
                        progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn best(
        &self,
        py: Python<'_>,
        over: Vec<String>,
        maximise: String,
        subject_to: Vec<String>,
        environment: Vec<String>,
        vary: Vec<String>,
        seed: u64,
        until_settled: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let question = Best { over, maximise, subject_to, environment, vary, seed, until_settled };
        let way = Way { threads, progress };
        let found = work(py, &way, |progress| question.run(&self.inner, progress))?;
        Ok(Answer::new(py, found.table(), self.caption()).told(found.words()))
    }
}

/// One run.
#[pyclass(frozen, module = "interwell._interwell")]
pub struct Run {
    #[pyo3(get)]
    samples: Py<Answer>,
    #[pyo3(get)]
    events: Py<Answer>,
    summary: Summary,
    simulation: questions::Simulation,
}

#[pymethods]
impl Run {
    /// The summary as JSON, as the command line writes it.
    fn summary(&self) -> String {
        let origin = Provenance {
            version: VERSION.to_owned(),
            arguments: Vec::new(),
            wall_s: f64::NAN,
            cpu_s: self.summary.cpu_s,
            jobs: 1,
        };
        summary(&self.summary, self.simulation.scene(), &origin)
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

/// Identifies a quantity from a record; the summary is JSON as the command line writes it.
#[pyfunction]
#[pyo3(signature = (path, of, time, column, position, base, between, impact_times, stops_mm, points=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn identify(
    py: Python<'_>,
    path: PathBuf,
    of: &str,
    time: [Option<String>; 2],
    column: [Option<String>; 2],
    position: [Option<String>; 2],
    base: [Option<String>; 2],
    between: [Option<f64>; 2],
    impact_times: bool,
    stops_mm: [Option<f64>; 2],
    points: Option<u32>,
) -> PyResult<(Answer, String)> {
    let of = named(py, "of", of, &WhatToIdentify::ALL, WhatToIdentify::name)?;
    let question = Identify { of, time, column, position, base, between, impact_times, stops_mm, points };
    let answer = work(py, &Way::default(), |progress| {
        question.run(&path, progress).map_err(|error| renamed(error, [["from", "start"], ["to", "end"]]))
    })?;
    let origin = Provenance {
        version: VERSION.to_owned(),
        arguments: Vec::new(),
        wall_s: f64::NAN,
        cpu_s: f64::NAN,
        jobs: 1,
    };
    let summary = identified(of.name(), &answer.found, answer.timing.as_ref(), &origin);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let caption = Caption::of_record(&name, of.name(), VERSION);
    let identities = answer.found.summary.iter().map(Identity::describe);
    let words = std::iter::once(answer.columns.clone()).chain(identities);
    let words = words.chain(answer.found.remarks.iter().cloned()).collect();
    let rows = Answer::new(py, answer.found.rows.clone(), caption).told(words);
    let drawn = move |_: &Table, asked: &Asked| {
        let record = (&answer.across[..], &answer.values.values[..]);
        Ok(identified_chart(of.name(), &answer.found, record, answer.values.quantity, asked.ranges))
    };
    Ok((rows.drawn(drawn), summary))
}

/// The error with the names that arguments have in Python, in place of those of the question.
fn renamed<const N: usize>(error: Error, names: [[&str; 2]; N]) -> Error {
    let named = |text: &str| {
        let option =
            |text: String, [from, to]: [&str; 2]| text.replace(&format!("--{from}"), &format!("--{to}"));
        names.into_iter().fold(text.to_owned(), option)
    };
    match error {
        Error::Argument { name, value, problem } => {
            let known = names.into_iter().find(|[from, _]| *from == name);
            let name = known.map_or(name, |[_, to]| to.to_owned());
            Error::Argument { name, value, problem: named(&problem) }
        }
        Error::Unfit { scene, problem } => Error::Unfit { scene, problem: named(&problem) },
        other => other,
    }
}

/// Names and titles of the built-in scenes.
#[pyfunction]
pub fn presets() -> Vec<(&'static str, String)> {
    let title = |name: &str| {
        interwell_kernel::scene::Document::preset(name)
            .map_or_else(|_| String::new(), |read| read.scene.title)
    };
    PRESETS.iter().map(|preset| (preset.name, title(preset.name))).collect()
}

/// A Python function of a number.
struct Function {
    function: Py<PyAny>,
    argument: &'static str,
    /// Its first exception, after which its values are NaN.
    failed: Mutex<Option<PyErr>>,
}

impl Function {
    fn new(function: &Bound<'_, PyAny>, argument: &'static str) -> Self {
        Self { function: function.clone().unbind(), argument, failed: Mutex::default() }
    }

    /// Its value.
    fn value(&self, at: f64) -> f64 {
        let mut failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
        if failed.is_some() {
            return f64::NAN;
        }
        Python::attach(|py| self.called(py, at)).unwrap_or_else(|error| {
            *failed = Some(error);
            f64::NAN
        })
    }

    fn called(&self, py: Python<'_>, at: f64) -> PyResult<f64> {
        // a function in C does not look for signals itself
        py.check_signals()?;
        let value = self.function.bind(py).call1((at,))?;
        value.extract::<f64>().map_err(|_| {
            let shown = value.repr().map_or_else(|_| String::new(), |text| text.to_string());
            let problem = format!("the function returned {shown} at {at}; it must return a number");
            raised(py, &Error::argument(self.argument, shown, problem))
        })
    }

    /// What was made of it, or its exception.
    fn unless_failed<T>(self, made: PyResult<T>) -> PyResult<T> {
        self.failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(made, Err)
    }
}
