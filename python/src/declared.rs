//! Studies that declare their arguments, table, remarks and picture.

use interwell_studies::questions::{Basins, Error, Escape, Exponents, Orbits, Section, Spectrum, Threshold};
use interwell_studies::study::{Framing, Study, answer};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::depythonize;

use crate::answer::{Answer, no_picture};
use crate::errors::raised;
use crate::scene::Simulation;
use crate::work::{Way, work};

/// Asks the study of this name about a scene; `arguments` are its fields. Returns its table and further ones.
#[pyfunction]
#[pyo3(signature = (study, scene, arguments, threads=None, progress=None))]
pub fn ask(
    py: Python<'_>,
    study: &str,
    scene: &Simulation,
    arguments: &Bound<'_, PyDict>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Answer, Vec<Answer>)> {
    let way = Way { threads, progress };
    match study {
        Basins::NAME => asked::<Basins>(py, scene, arguments, &way),
        Escape::NAME => asked::<Escape>(py, scene, arguments, &way),
        Exponents::NAME => asked::<Exponents>(py, scene, arguments, &way),
        Orbits::NAME => asked::<Orbits>(py, scene, arguments, &way),
        Section::NAME => asked::<Section>(py, scene, arguments, &way),
        Spectrum::NAME => asked::<Spectrum>(py, scene, arguments, &way),
        Threshold::NAME => asked::<Threshold>(py, scene, arguments, &way),
        other => Err(raised(py, &Error::argument("study", other, "there is no such study"))),
    }
}

fn asked<S: Study>(
    py: Python<'_>,
    scene: &Simulation,
    arguments: &Bound<'_, PyDict>,
    way: &Way,
) -> PyResult<(Answer, Vec<Answer>)> {
    let study: S = depythonize(arguments)?;
    let (grid, mut found) = work(py, way, |progress| answer(&study, &scene.inner, progress))?;
    let remarks = found.remarks.iter().map(|remark| remark.text.to_string()).collect();
    let beside = std::mem::take(&mut found.beside).into_iter();
    let beside = beside.map(|table| Answer::new(py, table, scene.caption())).collect();
    let chart = found.chart.take();
    let answered = Answer::new(py, found.into_table(), scene.caption()).told(remarks);
    let Some(chart) = chart else { return Ok((answered, beside)) };
    let drawn = answered.drawn(move |rows, asked| {
        let (quantity, ranges, cancel) = (asked.quantity.as_deref(), asked.ranges, asked.cancel);
        study.can_draw(&grid).map_err(no_picture)?;
        chart(rows, &Framing { quantity, ranges, cancel })
    });
    Ok((drawn, beside))
}
