//! Questions that can be asked for every cell of a grid.

use interwell_studies::output::{
    SweepPicture, escape_chart, exponents_chart, section_chart, sweep_chart, threshold_chart,
};
use interwell_studies::questions::{
    Carry, Error, Escape, ExponentOptions, Exponents, Grid, Onset, ProbableThreshold, Section, SectionAt,
    SectionOptions, Sweep, Threshold, Uncertain, Until,
};
use pyo3::prelude::*;

use crate::answer::{Answer, no_picture};
use crate::errors::{checked, named, raised};
use crate::scene::Simulation;
use crate::work::{Way, work};

/// Fields and the values that each takes.
type Over = Vec<(String, Vec<f64>)>;

#[pyfunction]
#[pyo3(signature = (
    scene, over, columns, until_settled=None, carry=None, uncertain=Vec::new(), draws=None, seed=None,
    threads=None, progress=None
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn sweep(
    scene: &Simulation,
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
        let shown = question.nominal(&scene.inner, progress)?;
        let grid = shown.grid(&question.over)?;
        let cells = question.cells(shown.document(), grid.clone(), &[], progress)?;
        let about = cells.sweep.options().draws.about();
        let table = question.run(&shown, progress)?;
        Ok((shown, grid, about, table))
    })?;
    Ok(Answer::new(py, table, scene.caption()).drawn(move |rows, asked| {
        let quantity = asked.quantity.as_deref().unwrap_or("rms_velocity_m_per_s");
        let picture = SweepPicture::of(&shown, &grid, rows, quantity);
        let (ranges, draws) = (asked.ranges, about.as_str());
        sweep_chart(&SweepPicture { until_settled, ranges, draws, ..picture }).map_err(no_picture)
    }))
}

#[pyfunction]
#[pyo3(signature = (
    scene, over, at, phase_deg=0.0, skip=None, keep=None, until_settled=None, carry=None, threads=None,
    progress=None
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn section(
    scene: &Simulation,
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
    let table = work(py, &Way { threads, progress }, |progress| question.run(&scene.inner, progress))?;
    let over = match question.over.is_empty() {
        true => None,
        false => Some(checked(py, scene.inner.grid(&question.over))?),
    };
    let stops = if over.is_none() { scene.inner.model().stop_positions() } else { (None, None) };
    Ok(Answer::new(py, table, scene.caption()).drawn(move |rows, asked| {
        let phase_deg = if let SectionAt::Phase(degrees) = at { Some(degrees) } else { None };
        Ok(section_chart(rows, over.as_ref(), phase_deg, stops, asked.ranges))
    }))
}

#[pyfunction]
#[pyo3(signature = (scene, over, periods=None, until_settled=None, threads=None, progress=None))]
pub fn exponents(
    scene: &Simulation,
    py: Python<'_>,
    over: Over,
    periods: Option<u32>,
    until_settled: Option<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let periods = periods.unwrap_or(ExponentOptions::PERIODS);
    let question = Exponents { over, options: ExponentOptions { periods, until_settled, circuits: false } };
    let way = Way { threads, progress };
    if question.over.is_empty() {
        let found = work(py, &way, |progress| question.of_one(&scene.inner, progress))?;
        let words = found.describe(scene.inner.model().repeats());
        return Ok(Answer::new(py, found.table(), scene.caption()).told(vec![words]));
    }
    let table = work(py, &way, |progress| question.run(&scene.inner, progress))?;
    let (grid, shown) = (checked(py, scene.inner.grid(&question.over))?, scene.inner.clone());
    Ok(Answer::new(py, table, scene.caption()).drawn(move |rows, asked| {
        exponents_chart(rows, &grid, shown.scene(), asked.ranges).map_err(no_picture)
    }))
}

#[pyfunction]
#[pyo3(signature = (scene, over, runs=None, within=None, until="well", threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn escape(
    scene: &Simulation,
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
    let table = work(py, &Way { threads, progress }, |progress| question.run(&scene.inner, progress))?;
    let words = vec![Escape::describe(&table)];
    let answer = Answer::new(py, table, scene.caption()).told(words);
    if question.over.is_empty() {
        return Ok(answer);
    }
    let (grid, shown) = (checked(py, scene.inner.grid(&question.over))?, scene.inner.clone());
    Ok(answer.drawn(move |rows, asked| {
        escape_chart(rows, &grid, shown.scene(), &question, asked.ranges).map_err(no_picture)
    }))
}

#[pyfunction]
#[pyo3(signature = (
    scene, over, field, of, resolution=None, until_settled=None, melnikov=false, threads=None, progress=None
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn threshold(
    scene: &Simulation,
    py: Python<'_>,
    over: Over,
    field: Option<String>,
    of: &str,
    resolution: Option<f64>,
    until_settled: Option<f64>,
    melnikov: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let of = named(py, "of", of, &Onset::ALL, Onset::name)?;
    let question = Threshold { over, field, of, resolution, until_settled, melnikov };
    let table = work(py, &Way { threads, progress }, |progress| question.run(&scene.inner, progress))?;
    let searched = checked(py, question.searched(scene.inner.document(), &Grid::of_one()))?;
    let remarks = question.remarks(&scene.inner, &table);
    let answer = Answer::new(py, table, scene.caption()).told(remarks);
    with_picture_of_thresholds(answer, scene, py, &question.over, searched.field().to_owned(), of)
}

#[pyfunction]
#[pyo3(signature = (
    scene, over, field, probability, runs=None, within=None, resolution=None, threads=None, progress=None
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn probable_threshold(
    scene: &Simulation,
    py: Python<'_>,
    over: Over,
    field: Option<String>,
    probability: f64,
    runs: Option<u64>,
    within: Option<f64>,
    resolution: Option<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let runs = runs.unwrap_or(Escape::RUNS);
    let question = ProbableThreshold { over, field, probability, runs, within, resolution };
    let table = work(py, &Way { threads, progress }, |progress| question.run(&scene.inner, progress))?;
    let scan = checked(py, question.scan(scene.inner.document(), &Grid::of_one()))?;
    let remarks = question.remarks(&scene.inner, &table);
    let answer = Answer::new(py, table, scene.caption()).told(remarks);
    with_picture_of_thresholds(answer, scene, py, &question.over, scan.field, Onset::Crossing)
}

/// The thresholds of a field, with their picture if they are those of a grid.
fn with_picture_of_thresholds(
    answer: Answer,
    scene: &Simulation,
    py: Python<'_>,
    over: &Over,
    field: String,
    onset: Onset,
) -> PyResult<Answer> {
    if over.is_empty() {
        return Ok(answer);
    }
    let (grid, shown) = (checked(py, scene.inner.grid(over))?, scene.inner.clone());
    Ok(answer.drawn(move |rows, asked| {
        threshold_chart(rows, &grid, shown.scene(), &field, onset, asked.ranges).map_err(no_picture)
    }))
}
