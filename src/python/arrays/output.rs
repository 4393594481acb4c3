//! New arrays that own their memory.

use numpy::{Element, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;

/// A NumPy array of `shape` with `values` in C order.
pub(super) fn array<'py, T: Element + Copy>(
    py: Python<'py>,
    shape: &[usize],
    values: &[T],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = PyArrayDyn::<T>::zeros(py, shape, false);
    array
        .try_readwrite()?
        .as_slice_mut()?
        .copy_from_slice(values);
    Ok(array)
}

/// The same; a plain number where the shape is that of one.
pub(super) fn array_or_number<'py>(
    py: Python<'py>,
    shape: &[usize],
    values: &[f64],
) -> PyResult<Bound<'py, PyAny>> {
    match (shape, values) {
        ([], &[value]) => Ok(value.into_pyobject(py)?.into_any()),
        _ => Ok(array(py, shape, values)?.into_any()),
    }
}
