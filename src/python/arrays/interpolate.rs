//! Interpolation.

use super::input::{self, Numbers, Particles, vectors};
use super::output::array;
use super::with_dimension;
use crate::operators;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

/// Values of a field at any points, Σ V_j f_j W(x - x_j) with V = m/ρ.
///
/// Parameters
/// ----------
/// points : array_like, (m, D)
///     Where to interpolate [m].
/// position : array_like, (n, D)
///     The particles' positions [m], D = 1, 2 or 3.
/// value : array_like, (n,) or (n, k)
///     The field at the particles, one number or k numbers each.
/// mass : array_like, (n,)
///     The particles' masses [kg; kg/m in 2D], zero or positive.
/// density : array_like, (n,)
///     The particles' densities [kg/m^D], positive.
/// h : float
///     Smoothing length [m].
/// kernel : str, optional
///     Name of the kernel, as for :func:`kernel`.
/// normalise : bool, optional
///     Divide by Σ V_j W (Shepard 1968), which makes constant fields exact also at surfaces.
/// outside : float, optional
///     What points get that no particle's kernel reaches; may be NaN.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// ndarray, (m,) or (m, k)
///     The field at the points, in the unit of value.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content.
#[pyfunction]
#[pyo3(
    signature = (points, position, value, mass, density, h, kernel=None, *, normalise=true, outside=None, periodic=None),
    text_signature = "(points, position, value, mass, density, h, kernel='wendland-c2', *, normalise=True, outside=0.0, periodic=None)"
)]
pub(super) fn interpolate<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    position: &Bound<'py, PyAny>,
    value: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    normalise: bool,
    outside: Option<&Bound<'py, PyAny>>,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let dimension = particles.dimension;
    let points = Numbers::read("points", points)?;
    let [count, columns_of_points] = *points.shape() else {
        return Err(points.wrong_shape(&format!("(m, {dimension}), as the particles")));
    };
    if columns_of_points != dimension {
        return Err(points.wrong_shape(&format!("(m, {dimension}), as the particles")));
    }
    let value = Numbers::read("value", value)?;
    let columns = value.columns(particles.count)?;
    let outside = input::or(0.0, "outside", outside, |name, object| {
        object
            .extract()
            .map_err(|_| input::wrong(name, input::kind_of(object), "one number"))
    })?;
    let (cloud, x, f) = (particles.columns(), points.values(), value.values());
    let found = py.detach(|| {
        with_dimension!(dimension, D => operators::interpolate(
            &cloud.cloud::<D>(), vectors(x), f, columns, normalise, outside))
    });
    let shape = [count, columns];
    array(py, &shape[..value.shape().len()], &found)
}
