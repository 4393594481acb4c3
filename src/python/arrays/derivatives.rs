//! Gradient, divergence and Laplacian.

use super::input::{Numbers, Particles, vectors};
use super::output::array;
use super::with_dimension;
use crate::operators;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

/// Gradient of a field at the particles, Σ V_j (f_j - f_i) L_i ∇W_ij with V = m/ρ.
///
/// Parameters
/// ----------
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
/// correct : bool, optional
///     Correct the kernel's gradient (Randles & Libersky 1996; Bonet & Lok 1999): exact for linear fields whatever
///     the particles' arrangement. Where neighbours lie on a line or a plane, the gradient across it is zero.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// ndarray, (n, D) or (n, k, D)
///     ∂f/∂x, in the unit of value per metre.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content.
#[pyfunction]
#[pyo3(
    signature = (position, value, mass, density, h, kernel=None, *, correct=true, periodic=None),
    text_signature = "(position, value, mass, density, h, kernel='wendland-c2', *, correct=True, periodic=None)"
)]
pub(super) fn gradient<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    value: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    correct: bool,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let value = Numbers::read("value", value)?;
    let columns = value.columns(particles.count)?;
    let (cloud, f) = (particles.columns(), value.values());
    let found = py.detach(|| {
        with_dimension!(particles.dimension, D =>
            operators::gradient(&cloud.cloud::<D>(), f, columns, correct))
    });
    let shape = [value.shape(), &[particles.dimension]].concat();
    array(py, &shape, &found)
}

/// Divergence of a vector field at the particles, Σ V_j (u_j - u_i) · L_i ∇W_ij with V = m/ρ.
///
/// Parameters
/// ----------
/// position : array_like, (n, D)
///     The particles' positions [m], D = 1, 2 or 3.
/// value : array_like, (n, D)
///     The vectors at the particles.
/// mass : array_like, (n,)
///     The particles' masses [kg; kg/m in 2D], zero or positive.
/// density : array_like, (n,)
///     The particles' densities [kg/m^D], positive.
/// h : float
///     Smoothing length [m].
/// kernel : str, optional
///     Name of the kernel, as for :func:`kernel`.
/// correct : bool, optional
///     Correct the kernel's gradient, as for :func:`gradient`: exact for linear fields.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// ndarray, (n,)
///     ∇·u, in the unit of value per metre.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content.
#[pyfunction]
#[pyo3(
    signature = (position, value, mass, density, h, kernel=None, *, correct=true, periodic=None),
    text_signature = "(position, value, mass, density, h, kernel='wendland-c2', *, correct=True, periodic=None)"
)]
pub(super) fn divergence<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    value: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    correct: bool,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let value = Numbers::read("value", value)?;
    value.vector_each(particles.count, particles.dimension)?;
    let (cloud, u) = (particles.columns(), value.values());
    let found = py.detach(|| {
        with_dimension!(particles.dimension, D =>
            operators::divergence(&cloud.cloud::<D>(), vectors(u), correct))
    });
    array(py, &[particles.count], &found)
}

/// Laplacian of a field at the particles, 2 Σ V_j (f_i - f_j) (W'/r)_ij with V = m/ρ.
///
/// Parameters
/// ----------
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
/// correct : bool, optional
///     Take out the linear part of the field and normalise (after Schwaiger 2008): zero for linear fields, and of
///     the right size where neighbours are missing.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// ndarray, (n,) or (n, k)
///     ∇²f, in the unit of value per square metre.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content.
#[pyfunction]
#[pyo3(
    signature = (position, value, mass, density, h, kernel=None, *, correct=true, periodic=None),
    text_signature = "(position, value, mass, density, h, kernel='wendland-c2', *, correct=True, periodic=None)"
)]
pub(super) fn laplacian<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    value: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    correct: bool,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let value = Numbers::read("value", value)?;
    let columns = value.columns(particles.count)?;
    let (cloud, f) = (particles.columns(), value.values());
    let found = py.detach(|| {
        with_dimension!(particles.dimension, D =>
            operators::laplacian(&cloud.cloud::<D>(), f, columns, correct))
    });
    array(py, value.shape(), &found)
}
