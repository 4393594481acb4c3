//! Particle shifting.

use super::input::{self, Particles};
use super::output::array;
use super::with_dimension;
use crate::operators::{self, Shift};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

/// Small displacements that keep the particles evenly spread: down the gradient of their concentration.
///
/// Parameters
/// ----------
/// position : array_like, (n, D)
///     The fluid particles' positions [m], D = 1, 2 or 3.
/// mass : array_like, (n,)
///     Their masses [kg; kg/m in 2D], zero or positive.
/// density : array_like, (n,)
///     Their densities [kg/m^D], positive.
/// h : float
///     Smoothing length [m].
/// spacing : float
///     The particles' distance at rest [m], below the radius of the kernel's support.
/// kernel : str, optional
///     Name of the kernel, as for :func:`kernel`.
/// form : str, optional
///     ``"sun"`` (Sun et al. 2017): in proportion to time_step and speed, at most half the way of a particle of that
///     speed. ``"lind"`` (Lind et al. 2012): the diffusive bound h²/2, at most 0.2 h; needs neither.
/// time_step : float, optional
///     Time step [s]; for Sun's form only.
/// speed : float, optional
///     Largest speed of the flow [m/s]; for Sun's form only.
/// free_surface : bool, optional
///     Find the free surface (Marrone et al. 2010); particles near it move along it only, and those in spray not at all.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// ndarray, (n, D)
///     Displacements [m], to be added to the positions.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content, or a parameter that the form needs and that is missing.
#[pyfunction]
#[pyo3(
    signature = (position, mass, density, h, spacing, kernel=None, *, form=None, time_step=None, speed=None, free_surface=true, periodic=None),
    text_signature = "(position, mass, density, h, spacing, kernel='wendland-c2', *, form='sun', time_step=None, speed=None, free_surface=True, periodic=None)"
)]
pub(super) fn particle_shift<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    spacing: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    form: Option<&Bound<'py, PyAny>>,
    time_step: Option<&Bound<'py, PyAny>>,
    speed: Option<&Bound<'py, PyAny>>,
    free_surface: bool,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let spacing = input::positive("spacing", spacing)?;
    if spacing >= particles.radius() {
        let allowed = format!(
            "less than the radius of the kernel's support, {}",
            particles.radius()
        );
        return Err(input::wrong("spacing", spacing, &allowed));
    }
    let needed = |name: &str, object: Option<&Bound<'py, PyAny>>| match object {
        Some(object) => input::not_negative(name, object),
        None => Err(input::wrong(
            name,
            "None",
            "a number: form \"sun\" needs it",
        )),
    };
    let form = match input::word("form", form, &["sun", "lind"])?.as_str() {
        "lind" => Shift::Lind,
        _ => Shift::Sun {
            time_step: needed("time_step", time_step)?,
            speed: needed("speed", speed)?,
        },
    };
    let cloud = particles.columns();
    let found = py.detach(|| {
        with_dimension!(particles.dimension, D => {
            let cloud = cloud.cloud::<D>();
            operators::particle_shift(&cloud, form, spacing, free_surface).into_flattened()
        })
    });
    array(py, &[particles.count, particles.dimension], &found)
}
