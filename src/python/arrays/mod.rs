//! The array functions: SPH's building blocks on NumPy arrays, one file per thing.
//!
//! Every one checks its arguments, releases the interpreter, calls the Rust function of the same name on rayon's
//! threads, and returns new arrays.

mod density_diffusion;
mod derivatives;
mod eos;
mod free_surface;
mod input;
mod interpolate;
mod kernel;
mod neighbours;
mod output;
mod particle_shift;

use pyo3::prelude::*;

/// Evaluates an expression with the dimension, 1, 2 or 3, as a constant.
macro_rules! with_dimension {
    ($dimension:expr, $D:ident => $body:expr) => {
        match $dimension {
            1 => {
                const $D: usize = 1;
                $body
            }
            2 => {
                const $D: usize = 2;
                $body
            }
            _ => {
                const $D: usize = 3;
                $body
            }
        }
    };
}
use with_dimension;

/// Adds the array functions to the module.
pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<kernel::Kernel>()?;
    module.add_function(wrap_pyfunction!(kernel::kernel, module)?)?;
    module.add_function(wrap_pyfunction!(neighbours::neighbours, module)?)?;
    module.add_function(wrap_pyfunction!(neighbours::all_pairs, module)?)?;
    module.add_function(wrap_pyfunction!(eos::tait_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(eos::tait_density, module)?)?;
    module.add_function(wrap_pyfunction!(interpolate::interpolate, module)?)?;
    module.add_function(wrap_pyfunction!(derivatives::gradient, module)?)?;
    module.add_function(wrap_pyfunction!(derivatives::divergence, module)?)?;
    module.add_function(wrap_pyfunction!(derivatives::laplacian, module)?)?;
    module.add_function(wrap_pyfunction!(
        density_diffusion::density_diffusion,
        module
    )?)?;
    module.add_function(wrap_pyfunction!(particle_shift::particle_shift, module)?)?;
    module.add_function(wrap_pyfunction!(free_surface::free_surface, module)?)?;
    Ok(())
}
