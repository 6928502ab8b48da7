//! Questions about the motions of one scene, and about its design.

use std::path::PathBuf;

use interwell_kernel::dynamics::MapState;
use interwell_studies::output::{branch_chart, comparison_chart, loci_chart};
use interwell_studies::questions::{Begin, Best, Branch, BranchEvent, Compare, FieldRange, Locus, Orbit};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::errors::named;
use crate::scene::Simulation;
use crate::work::{Way, work};

/// The motion that is meant: displacement in mm, velocity in m/s and A or V of a circuit at the phase, or the
/// number of its impacts.
#[derive(FromPyObject)]
pub enum Begins {
    State(f64, f64, f64),
    Impacts(u64),
}

impl Begins {
    fn named(begin: Option<Self>) -> Begin {
        match begin {
            None => Begin::Run,
            Some(Self::Impacts(impacts)) => Begin::Impacts(impacts),
            Some(Self::State(x_mm, v, electrical)) => {
                Begin::State(MapState { x: x_mm * 1e-3, v, electrical })
            }
        }
    }
}

#[pyfunction]
#[pyo3(signature = (scene, period=None, phase_deg=0.0, begin=None))]
pub fn orbit(
    scene: &Simulation,
    py: Python<'_>,
    period: Option<u32>,
    phase_deg: f64,
    begin: Option<Begins>,
) -> PyResult<Answer> {
    let question = Orbit { period, phase_deg, begin: Begins::named(begin) };
    let found = work(py, &Way::default(), |progress| question.run(&scene.inner, progress))?;
    Ok(Answer::new(py, found.table(), scene.caption()))
}

#[pyfunction]
#[pyo3(signature = (scene, field, range, step, count, switch, period=None, phase_deg=0.0, progress=None,
    begin=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn branch(
    scene: &Simulation,
    py: Python<'_>,
    field: String,
    range: (f64, f64),
    step: f64,
    count: usize,
    switch: u32,
    period: Option<u32>,
    phase_deg: f64,
    progress: Option<Py<PyAny>>,
    begin: Option<Begins>,
) -> PyResult<Answer> {
    let begin = Begins::named(begin);
    let question = Branch { field, range, period, phase_deg, begin, step, count };
    let way = Way { threads: None, progress };
    let found = work(py, &way, |progress| {
        let found = question.with_switches(switch, &scene.inner, progress);
        found.map_err(|error| error.renamed(&[["range", "end"]]))
    })?;
    let table = if switch > 0 { found.table() } else { found.branches[0].table() };
    let answer = Answer::new(py, table, scene.caption()).told(found.remarks());
    Ok(answer.drawn(move |_, asked| Ok(branch_chart(&found.branches, phase_deg, asked.ranges))))
}

#[pyfunction]
#[pyo3(signature = (
    scene, event, field, range, second, second_range, step, count, period=None, phase_deg=0.0, progress=None,
    begin=None
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn locus(
    scene: &Simulation,
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
    begin: Option<Begins>,
) -> PyResult<Answer> {
    let begin = Begins::named(begin);
    let of = named(py, "event", event, &BranchEvent::ALL, BranchEvent::name)?;
    let branch = Branch { field, range, period, phase_deg, begin, step, count };
    let question = Locus { branch, of, second: FieldRange { field: second, range: second_range } };
    let way = Way { threads: None, progress };
    let found = work(py, &way, |progress| question.run(&scene.inner, progress))?;
    let answer = Answer::new(py, found.table(), scene.caption()).told(found.remarks());
    Ok(answer.drawn(move |_, asked| Ok(loci_chart(&found.loci, phase_deg, asked.ranges))))
}

/// This scene, called `name`, beside others under its sine.
#[pyfunction]
#[pyo3(signature = (scene, name, others, until_settled=None, threads=None, progress=None))]
pub fn compare(
    scene: &Simulation,
    py: Python<'_>,
    name: String,
    others: Vec<(String, Py<Simulation>)>,
    until_settled: Option<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let with = others.into_iter().map(|(name, other)| (name, (*other.get().inner).clone())).collect();
    let question = Compare { with, name, environment: None, until_settled };
    let way = Way { threads, progress };
    let found = work(py, &way, |progress| question.run(&scene.inner, progress))?;
    let answer = Answer::new(py, found.table(), scene.caption()).told(found.remarks.clone());
    Ok(answer.drawn(move |_, _| Ok(comparison_chart(&found.rated, found.frequency_hz))))
}

#[pyfunction]
#[pyo3(signature = (
    scene, over, maximise, subject_to, environment, vary, seed, until_settled=None, runs_to=None, threads=None,
    progress=None
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn best(
    scene: &Simulation,
    py: Python<'_>,
    over: Vec<String>,
    maximise: String,
    subject_to: Vec<String>,
    environment: Vec<String>,
    vary: Vec<String>,
    seed: u64,
    until_settled: Option<f64>,
    runs_to: Option<PathBuf>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let question = Best { over, maximise, subject_to, environment, vary, seed, until_settled, runs_to };
    let way = Way { threads, progress };
    let found = work(py, &way, |progress| question.run(&scene.inner, progress))?;
    Ok(Answer::new(py, found.table(), scene.caption()).told(found.words()))
}
