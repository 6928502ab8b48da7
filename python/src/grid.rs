//! Sweeps.

use interwell_studies::output::{SweepPicture, sweep_chart};
use interwell_studies::questions::{Carry, Sweep, Uncertain};
use pyo3::prelude::*;

use crate::answer::{Answer, no_picture};
use crate::errors::named;
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
