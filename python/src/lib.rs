//! What the Python package `pbrdf` is made of beneath its Python: arrays in and out of the core, fits that Ctrl-C stops, and the core's
//! errors as exceptions. `python/pbrdf/__init__.py` has what people call.

mod error;
mod fitting;
mod many;
mod measurement;
mod metals;
mod names;
mod picture;
mod pixels;
mod planning;
mod posterior;
mod program;
mod surface;
mod watched;

use pyo3::prelude::*;

/// The compiled part of the package `pbrdf`.
#[pymodule]
fn _pbrdf(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("PbrdfError", module.py().get_type::<error::PbrdfError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<measurement::Measurement>()?;
    module.add_class::<surface::Prepared>()?;
    module.add_class::<fitting::Fitted>()?;
    module.add_function(wrap_pyfunction!(names::models, module)?)?;
    module.add_function(wrap_pyfunction!(names::parameters, module)?)?;
    module.add_function(wrap_pyfunction!(surface::evaluate, module)?)?;
    module.add_function(wrap_pyfunction!(measurement::read, module)?)?;
    module.add_function(wrap_pyfunction!(fitting::fit, module)?)?;
    module.add_class::<many::Stop>()?;
    module.add_function(wrap_pyfunction!(many::fit_row_columns, module)?)?;
    module.add_function(wrap_pyfunction!(many::thread_count, module)?)?;
    module.add_function(wrap_pyfunction!(many::fit_rows, module)?)?;
    module.add_function(wrap_pyfunction!(metals::metals, module)?)?;
    module.add_function(wrap_pyfunction!(picture::picture, module)?)?;
    module.add_function(wrap_pyfunction!(pixels::fit_pixels, module)?)?;
    module.add_function(wrap_pyfunction!(program::main, module)?)?;
    module.add_function(wrap_pyfunction!(planning::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(planning::choose_angles, module)?)?;
    module.add_class::<posterior::Drawn>()?;
    module.add_function(wrap_pyfunction!(posterior::posterior, module)?)?;
    Ok(())
}
