//! Errors of questions as Python exceptions.

use interwell_studies::questions::Error;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Arguments that Python calls otherwise than the library, some of which are its keywords.
const NAMES: [[&str; 2]; 5] =
    [["from", "start"], ["to", "end"], ["v", "v_m_per_s"], ["plot_y", "y"], ["ranges", "x"]];

/// The exception for an error: `SceneError` with its faults where scene or arguments are wrong,
/// `ComputationError` where there is no answer.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    if *error == Error::Cancelled {
        return PyKeyboardInterrupt::new_err(());
    }
    let exception = || -> PyResult<PyErr> {
        let errors = py.import("interwell._errors")?;
        let error = error.clone().renamed(&NAMES);
        let message = error.to_string();
        if !error.is_wrong_input() {
            return Ok(PyErr::from_value(errors.getattr("ComputationError")?.call1((message,))?));
        }
        let fault = errors.getattr("Fault")?;
        let faults = error
            .faults()
            .into_iter()
            .map(|found| fault.call1((found.file, found.line, found.field, found.value, found.problem)));
        let faults = faults.collect::<PyResult<Vec<_>>>()?;
        Ok(PyErr::from_value(errors.getattr("SceneError")?.call1((message, faults))?))
    };
    exception().unwrap_or_else(|error| error)
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
