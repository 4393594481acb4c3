//! The extension module `kolk._core`: thin bindings, one file per thing. Everything under this folder needs the cargo
//! feature `python`; nothing outside it knows Python.

mod arrays;
mod peak;
mod simulation;

use pyo3::prelude::*;

/// The engine of kolk.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<simulation::PySimulation>()?;
    module.add_function(wrap_pyfunction!(peak::peak_flops, module)?)?;
    module.add_function(wrap_pyfunction!(peak::simd_level, module)?)?;
    arrays::register(module)
}
