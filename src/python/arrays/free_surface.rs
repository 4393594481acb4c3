//! The free surface.

use super::input::Particles;
use super::output::array;
use super::with_dimension;
use crate::operators;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

/// `(on, normal, eigenvalue)` as NumPy arrays.
type Found<'py> = (
    Bound<'py, PyArrayDyn<bool>>,
    Bound<'py, PyArrayDyn<f64>>,
    Bound<'py, PyArrayDyn<f64>>,
);

/// Which particles lie on a free surface, and where it faces (Marrone et al. 2010).
///
/// The smallest eigenvalue of the gradient's moment matrix, -Σ V_j r_ij ⊗ ∇W_ij, says how well a particle is
/// surrounded: below 0.20 it is spray or surface, above 0.75 it lies inside. Between, it belongs to the surface where
/// no neighbour lies in the umbrella along the normal: a cone of 45° out to √2 h, capped by a ball of radius h around the
/// point h away. A gap is seen as a surface where it is wider than the umbrella, about 2 h.
///
/// Parameters
/// ----------
/// position : array_like, (n, D)
///     The particles' positions [m], D = 1, 2 or 3. Those of walls, too: a wall is no free surface.
/// mass : array_like, (n,)
///     Their masses [kg; kg/m in 2D], zero or positive.
/// density : array_like, (n,)
///     Their densities [kg/m^D], positive.
/// h : float
///     Smoothing length [m].
/// kernel : str, optional
///     Name of the kernel, as for :func:`kernel`.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// on : ndarray of bool, (n,)
///     Whether the particle belongs to the surface.
/// normal : ndarray, (n, D)
///     Unit vectors out of the fluid, meaningful near the surface; zero where the eigenvalue is uniform.
/// eigenvalue : ndarray, (n,)
///     Smallest eigenvalue: about 1 inside, 1/2 on a flat surface, 0 in spray.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content.
#[pyfunction]
#[pyo3(
    signature = (position, mass, density, h, kernel=None, *, periodic=None),
    text_signature = "(position, mass, density, h, kernel='wendland-c2', *, periodic=None)"
)]
pub(super) fn free_surface<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Found<'py>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let cloud = particles.columns();
    let (on, normal, eigenvalue) = py.detach(|| {
        with_dimension!(particles.dimension, D => {
            let found = operators::free_surface(&cloud.cloud::<D>());
            (found.on, found.normal.into_flattened(), found.eigenvalue)
        })
    });
    let (n, dimension) = (particles.count, particles.dimension);
    Ok((
        array(py, &[n], &on)?,
        array(py, &[n, dimension], &normal)?,
        array(py, &[n], &eigenvalue)?,
    ))
}
