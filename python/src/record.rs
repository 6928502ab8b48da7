//! Questions about measured records.

use std::path::PathBuf;

use interwell_studies::output::{Caption, identified, identified_chart};
use interwell_studies::questions::{Identify, Identity, Table, WhatToIdentify};
use pyo3::prelude::*;

use crate::answer::{Answer, Asked};
use crate::errors::named;
use crate::scene::{VERSION, origin};
use crate::work::{Way, work};

/// Identifies a quantity from a record; the summary is JSON as the command line writes it.
#[pyfunction]
#[pyo3(signature = (path, of, time, column, position, base, between, impact_times, points=None))]
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
    points: Option<u32>,
) -> PyResult<(Answer, String, Option<f64>)> {
    let of = named(py, "of", of, &WhatToIdentify::ALL, WhatToIdentify::name)?;
    let question = Identify { of, time, column, position, base, between, impact_times, points };
    let answer = work(py, &Way::default(), |progress| question.run(&path, progress))?;
    let summary = identified(of.name(), &answer.found, answer.timing.as_ref(), &origin(f64::NAN));
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let caption = Caption::of_record(&name, of.name(), VERSION);
    let identities = answer.found.summary.iter().map(Identity::describe);
    let words = std::iter::once(answer.columns.clone()).chain(identities);
    let words = words.chain(answer.found.remarks.iter().cloned()).collect();
    let tolerance = answer.found.tolerance;
    let rows = Answer::new(py, answer.found.rows.clone(), move || caption.clone()).told(words);
    let drawn = move |_: &Table, asked: &Asked| {
        let record = (&answer.across[..], &answer.values.values[..]);
        Ok(identified_chart(of.name(), &answer.found, record, answer.values.quantity, asked.ranges))
    };
    Ok((rows.drawn(drawn), summary, tolerance))
}
