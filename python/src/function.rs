//! Functions of Python that a question calls.

use std::sync::{Mutex, PoisonError};

use interwell_studies::questions::Error;
use pyo3::prelude::*;

use crate::errors::raised;

/// A Python function of a number.
pub struct Function {
    function: Py<PyAny>,
    argument: &'static str,
    /// Its first exception, after which its values are NaN.
    failed: Mutex<Option<PyErr>>,
}

impl Function {
    pub fn new(function: &Bound<'_, PyAny>, argument: &'static str) -> Self {
        Self { function: function.clone().unbind(), argument, failed: Mutex::default() }
    }

    /// Its value.
    pub fn value(&self, at: f64) -> f64 {
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
    pub fn unless_failed<T>(self, made: PyResult<T>) -> PyResult<T> {
        self.failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(made, Err)
    }
}
