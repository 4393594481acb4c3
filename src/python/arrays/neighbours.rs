//! Neighbour search.

use super::input::{self, first, vectors};
use super::output::array;
use super::with_dimension;
use crate::neighbours::brute;
use crate::neighbours::search::{self, Neighbours};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

type Rows<'py> = (Bound<'py, PyArrayDyn<i64>>, Bound<'py, PyArrayDyn<u32>>);

/// All pairs of points within a radius, in compressed rows; time and memory grow with points and pairs.
///
/// Parameters
/// ----------
/// position : array_like, (n, D)
///     Points [m], D = 1, 2 or 3. There is no domain: points may lie anywhere.
/// radius : float
///     Search radius [m]; a pair exactly at the radius belongs.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m], at least two radii apart; the nearest image counts.
///
/// Returns
/// -------
/// offsets : ndarray of int64, (n + 1,)
///     Row i is ``indices[offsets[i]:offsets[i + 1]]``.
/// indices : ndarray of uint32
///     Neighbours, ascending within a row. A point is not its own neighbour; points in the same place are
///     neighbours of each other.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For positions of another shape or not finite, or a radius that is not positive.
#[pyfunction]
#[pyo3(signature = (position, radius, periodic=None))]
pub(super) fn neighbours<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    radius: &Bound<'py, PyAny>,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Rows<'py>> {
    let (position, dimension) = input::positions("position", position)?;
    let radius = input::length("radius", radius)?;
    let periods = input::periods(periodic, dimension, radius)?;
    let x = position.values();
    let found = py.detach(|| {
        with_dimension!(dimension, D =>
            search::neighbours::<D>(vectors(x), radius, &first(&periods)))
    });
    rows(py, &found)
}

/// The same as :func:`neighbours` by comparing every point with every other: slow, and simple enough to trust.
///
/// Parameters
/// ----------
/// position : array_like, (n, D)
///     Points [m], D = 1, 2 or 3.
/// radius : float
///     Search radius [m]; a pair exactly at the radius belongs.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m], at least two radii apart; the nearest image counts.
///
/// Returns
/// -------
/// offsets : ndarray of int64, (n + 1,)
///     Row i is ``indices[offsets[i]:offsets[i + 1]]``.
/// indices : ndarray of uint32
///     Neighbours, ascending within a row.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For positions of another shape or not finite, or a radius that is not positive.
#[pyfunction]
#[pyo3(signature = (position, radius, periodic=None))]
pub(super) fn all_pairs<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    radius: &Bound<'py, PyAny>,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Rows<'py>> {
    let (position, dimension) = input::positions("position", position)?;
    let radius = input::length("radius", radius)?;
    let periods = input::periods(periodic, dimension, radius)?;
    let x = position.values();
    let found = py.detach(|| {
        with_dimension!(dimension, D => brute::all_pairs::<D>(vectors(x), radius, &first(&periods)))
    });
    rows(py, &found)
}

fn rows<'py>(py: Python<'py>, found: &Neighbours) -> PyResult<Rows<'py>> {
    let offsets = array(py, &[found.offsets.len()], &found.offsets)?;
    Ok((offsets, array(py, &[found.indices.len()], &found.indices)?))
}
