//! The Python package: scenes, questions and tables of `interwell-studies` as Python objects.
//!
//! Nothing is computed here.

mod answer;
mod declared;
mod errors;
mod function;
mod grid;
mod motion;
mod record;
mod scene;
mod work;

use pyo3::prelude::*;

/// The compiled part of the package.
#[pymodule]
fn _interwell(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<scene::Simulation>()?;
    module.add_class::<scene::Run>()?;
    module.add_class::<answer::Answer>()?;
    module.add_function(wrap_pyfunction!(scene::presets, module)?)?;
    module.add_function(wrap_pyfunction!(grid::sweep, module)?)?;
    module.add_function(wrap_pyfunction!(declared::ask, module)?)?;
    module.add_function(wrap_pyfunction!(motion::compare, module)?)?;
    module.add_function(wrap_pyfunction!(motion::best, module)?)?;
    module.add_function(wrap_pyfunction!(record::identify, module)?)?;
    Ok(())
}
