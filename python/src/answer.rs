//! Tables of answers, with their pictures.

use std::sync::atomic::AtomicBool;

use interwell_studies::output::{
    Caption, Chart, Format, NoPicture, Ranges, Sheet, SheetError, SheetText, Theme, header, rows,
};
use interwell_studies::questions::{Error, Table, Values};
use interwell_studies::study::label_and_unit;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList};

use crate::errors::raised;
use crate::work::{Way, work};

/// What a picture shows.
pub struct Asked<'a> {
    /// A column, or the panels of a run.
    pub quantity: Option<String>,
    /// Ranges of the axes.
    pub ranges: Ranges,
    /// Ends a run that is made for the picture.
    pub cancel: &'a AtomicBool,
}

/// Makes the chart of a table.
type Charted = Box<dyn Fn(&Table, &Asked) -> Result<Chart, Error> + Send + Sync>;

/// The error of a table that cannot be shown.
pub fn no_picture(problem: NoPicture) -> Error {
    match problem {
        NoPicture::Quantity { name, problem } => Error::argument("quantity", name, problem),
        other => Error::argument("plot", "", other),
    }
}

/// The values of a column: numbers are an array of NumPy, which Python shares and cannot write to.
enum Held {
    Numbers(Py<PyArray1<f64>>),
    Other(Values),
}

/// The table of an answer.
#[pyclass(frozen, module = "interwell._interwell")]
pub struct Answer {
    columns: Vec<(String, Held)>,
    chart: Option<Charted>,
    caption: Box<dyn Fn() -> Caption + Send + Sync>,
    words: Vec<String>,
}

impl Answer {
    /// An answer whose table has no picture; `caption` is that of one.
    pub fn new(py: Python<'_>, table: Table, caption: impl Fn() -> Caption + Send + Sync + 'static) -> Self {
        let caption = Box::new(caption);
        let held = |values: Values| match values {
            Values::Numbers(numbers) => {
                let array = PyArray1::from_vec(py, numbers);
                array.readwrite().make_nonwriteable();
                Held::Numbers(array.unbind())
            }
            other => Held::Other(other),
        };
        let columns = table.into_columns().into_iter().map(|column| (column.name, held(column.values)));
        Self { columns: columns.collect(), chart: None, caption, words: Vec::new() }
    }

    /// The same with a picture.
    pub fn drawn(
        self,
        chart: impl Fn(&Table, &Asked) -> Result<Chart, Error> + Send + Sync + 'static,
    ) -> Self {
        Self { chart: Some(Box::new(chart)), ..self }
    }

    /// The same with sentences about it.
    pub fn told(self, words: Vec<String>) -> Self {
        Self { words, ..self }
    }

    /// A copy of a column of numbers.
    pub fn numbers(&self, py: Python<'_>, name: &str) -> PyResult<Vec<f64>> {
        let found = self.columns.iter().find(|(column, _)| column == name);
        match found {
            Some((_, Held::Numbers(array))) => Ok(array.bind(py).to_vec()?),
            _ => Err(PyKeyError::new_err(format!("no column {name:?} of numbers"))),
        }
    }

    /// The table, with copies of the arrays.
    fn table(&self, py: Python<'_>) -> PyResult<Table> {
        let mut table = Table::new();
        for (name, held) in &self.columns {
            let values = match held {
                Held::Numbers(array) => Values::Numbers(array.bind(py).to_vec()?),
                Held::Other(values) => values.clone(),
            };
            table = table.with(name, values);
        }
        Ok(table)
    }
}

#[pymethods]
impl Answer {
    /// Names of the columns.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.columns.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Units of the columns as a person writes them; empty for a pure number, a count or a word.
    #[getter]
    fn units(&self) -> Vec<&'static str> {
        self.columns.iter().map(|(name, _)| label_and_unit(name).1).collect()
    }

    /// Sentences about the answer.
    #[getter]
    fn words(&self) -> Vec<String> {
        self.words.clone()
    }

    /// The values of a column: an array of numbers, or a list of counts (None is missing) or of words.
    fn values<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let found = self.columns.iter().find(|(column, _)| column == name);
        let (_, held) = found.ok_or_else(|| {
            PyKeyError::new_err(format!("no column {name:?}; there are {}", self.names().join(", ")))
        })?;
        Ok(match held {
            Held::Numbers(array) => array.bind(py).clone().into_any(),
            Held::Other(Values::Counts(counts)) => PyList::new(py, counts)?.into_any(),
            Held::Other(Values::Words(words)) => PyList::new(py, words)?.into_any(),
            Held::Other(Values::Names(names)) => PyList::new(py, names)?.into_any(),
            Held::Other(Values::Numbers(numbers)) => PyList::new(py, numbers)?.into_any(),
        })
    }

    /// The table as CSV, as the command line writes it.
    fn csv(&self, py: Python<'_>) -> PyResult<String> {
        let table = self.table(py)?;
        work(py, &Way::default(), |_| Ok(header(&table) + &rows(&table, 0..usize::MAX)))
    }

    /// The picture as a file of this kind: png, svg or pdf.
    #[pyo3(signature = (kind, quantity=None, x=None, y=None, dark=false, width_mm=None, height_mm=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn picture<'py>(
        &self,
        py: Python<'py>,
        kind: &str,
        quantity: Option<String>,
        x: Option<(f64, f64)>,
        y: Option<(f64, f64)>,
        dark: bool,
        width_mm: Option<f64>,
        height_mm: Option<f64>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let wrong = |name: &str, value: &str, problem: String| Error::argument(name, value, problem);
        let format = Format::of(format!("picture.{kind}").as_ref());
        let format = format.map_err(|problem| raised(py, &wrong("kind", kind, problem.to_string())))?;
        let chart = self.chart.as_ref().ok_or_else(|| {
            let problem = "this table has no picture; draw its columns with matplotlib";
            raised(py, &wrong("plot", "", problem.to_owned()))
        })?;
        let sheet = width_mm.map(|width_mm| {
            let (width, height) = (width_mm.to_string(), height_mm.map(|height| height.to_string()));
            let height_mm = height.as_deref();
            let text = SheetText { width_mm: &width, height_mm, font_pt: "8", dpi: None, titled: true };
            Sheet::read(&text, format == Format::Png)
        });
        let sheet = sheet.transpose();
        let sheet = sheet.map_err(|SheetError { argument, value, problem }| {
            // text and resolution are no arguments here: the picture is too small or too large for them
            let width = || width_mm.unwrap_or_default().to_string();
            let error = match argument {
                "height_mm" => wrong(argument, &value, problem),
                "font_pt" => wrong("width_mm", &width(), format!("{problem}, and it has {value}")),
                _ => wrong("width_mm", &width(), problem),
            };
            raised(py, &error)
        })?;
        let table = self.table(py)?;
        let bytes = work(py, &Way::default(), |progress| {
            let asked = Asked { quantity, ranges: Ranges { x, y }, cancel: progress.stop() };
            let figure = chart(&table, &asked)?.figure(&(self.caption)(), &Theme::of(dark, sheet));
            format.bytes(&figure).map_err(|problem| wrong("kind", kind, problem.to_string()))
        })?;
        Ok(PyBytes::new(py, &bytes))
    }
}
