//! Errors of questions as Python exceptions.

use interwell_studies::questions::Error;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// The exception for an error: `SceneError` with its faults where scene or arguments are wrong,
/// `ComputationError` where there is no answer.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    if *error == Error::Cancelled {
        return PyKeyboardInterrupt::new_err(());
    }
    let exception = || -> PyResult<PyErr> {
        let errors = py.import("interwell._errors")?;
        let message = in_python(error.to_string());
        if !error.is_wrong_input() {
            return Ok(PyErr::from_value(errors.getattr("ComputationError")?.call1((message,))?));
        }
        let fault = errors.getattr("Fault")?;
        let faults = error.faults().into_iter().map(|found| {
            let (field, problem) = (in_python(found.field), in_python(found.problem));
            fault.call1((found.file, found.line, field, found.value, problem))
        });
        let faults = faults.collect::<PyResult<Vec<_>>>()?;
        Ok(PyErr::from_value(errors.getattr("SceneError")?.call1((message, faults))?))
    };
    exception().unwrap_or_else(|error| error)
}

/// The text with the names of arguments in Python, which differ where those of the library are keywords.
fn in_python(text: String) -> String {
    match text.as_str() {
        "from" => "start".to_owned(),
        "to" => "end".to_owned(),
        _ => text.replace("`from`", "`start`").replace("`to`", "`end`"),
    }
}

/// The variant that is called `word`, or the exception that lists all.
pub fn named<T: Copy>(
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

/// The error with the names that arguments have in Python, in place of those of the question.
pub fn renamed<const N: usize>(error: Error, names: [[&str; 2]; N]) -> Error {
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
