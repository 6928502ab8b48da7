//! Questions about the motions of one scene, and about its design.

use std::path::PathBuf;

use interwell_studies::output::comparison_chart;
use interwell_studies::questions::{Best, Compare};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::scene::Simulation;
use crate::work::{Way, work};

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
