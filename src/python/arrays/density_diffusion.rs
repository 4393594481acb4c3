//! Density diffusion.

use super::input::{self, Numbers, Particles};
use super::output::array;
use super::with_dimension;
use crate::operators::{self, Diffusion};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

const FORMS: [&str; 3] = ["antuono", "molteni", "fourtakas"];

/// Rate of change of density by numerical diffusion, δ h c0 Σ V_j ψ_ij · ∇W_ij with V = m/ρ.
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
/// sound_speed : float
///     Speed of sound c0 [m/s].
/// kernel : str, optional
///     Name of the kernel, as for :func:`kernel`.
/// form : str, optional
///     ``"molteni"`` (Molteni & Colagrossi 2009): smooths all differences. ``"antuono"`` (Antuono et al. 2010): smooths
///     what corrected gradients do not explain. ``"fourtakas"`` (Fourtakas et al. 2019): smooths what hydrostatics does
///     not explain; needs gravity and reference_density.
/// delta : float, optional
///     Coefficient δ, zero or positive.
/// gravity : array_like, (D,), optional
///     Acceleration of gravity [m/s²]; for Fourtakas' form only.
/// reference_density : float, optional
///     Density at rest; for Fourtakas' form only.
/// gamma : float, optional
///     Exponent of Tait's equation; for Fourtakas' form only.
/// periodic : sequence, optional
///     For each axis None or (low, high) [m].
///
/// Returns
/// -------
/// ndarray, (n,)
///     dρ/dt [kg/m^D/s]. Σ m/ρ dρ/dt is zero for Molteni's and Antuono's forms.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For an array of the wrong shape, type or content, or a parameter that the form needs and that is missing.
#[pyfunction]
#[pyo3(
    signature = (position, mass, density, h, sound_speed, kernel=None, *, form=None, delta=None, gravity=None, reference_density=None, gamma=None, periodic=None),
    text_signature = "(position, mass, density, h, sound_speed, kernel='wendland-c2', *, form='antuono', delta=0.1, gravity=None, reference_density=None, gamma=7.0, periodic=None)"
)]
pub(super) fn density_diffusion<'py>(
    py: Python<'py>,
    position: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    density: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    sound_speed: &Bound<'py, PyAny>,
    kernel: Option<&Bound<'py, PyAny>>,
    form: Option<&Bound<'py, PyAny>>,
    delta: Option<&Bound<'py, PyAny>>,
    gravity: Option<&Bound<'py, PyAny>>,
    reference_density: Option<&Bound<'py, PyAny>>,
    gamma: Option<&Bound<'py, PyAny>>,
    periodic: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let particles = Particles::read(position, mass, density, h, kernel, periodic)?;
    let sound_speed = input::positive("sound_speed", sound_speed)?;
    let delta = input::or(0.1, "delta", delta, input::not_negative)?;
    let form = match input::word("form", form, &FORMS)?.as_str() {
        "molteni" => Form::Molteni,
        "antuono" => Form::Antuono,
        _ => Form::Fourtakas {
            gravity: vector_of_gravity(gravity, particles.dimension)?,
            reference_density: input::positive(
                "reference_density",
                needed("reference_density", reference_density)?,
            )?,
            gamma: input::or(7.0, "gamma", gamma, input::positive)?,
        },
    };
    let cloud = particles.columns();
    let found = py.detach(|| {
        with_dimension!(particles.dimension, D =>
            operators::density_diffusion(&cloud.cloud::<D>(), form.with_axes::<D>(), delta, sound_speed))
    });
    array(py, &[particles.count], &found)
}

/// [`Diffusion`] before the dimension is a constant.
#[derive(Clone, Copy)]
enum Form {
    Molteni,
    Antuono,
    Fourtakas {
        gravity: [f64; 3],
        reference_density: f64,
        gamma: f64,
    },
}

impl Form {
    fn with_axes<const D: usize>(self) -> Diffusion<D> {
        match self {
            Form::Molteni => Diffusion::Molteni,
            Form::Antuono => Diffusion::Antuono,
            Form::Fourtakas {
                gravity,
                reference_density,
                gamma,
            } => Diffusion::Fourtakas {
                gravity: std::array::from_fn(|a| gravity[a]),
                reference_density,
                gamma,
            },
        }
    }
}

fn needed<'a, 'py>(
    name: &str,
    object: Option<&'a Bound<'py, PyAny>>,
) -> PyResult<&'a Bound<'py, PyAny>> {
    object.ok_or_else(|| input::wrong(name, "None", "a value: form \"fourtakas\" needs it"))
}

fn vector_of_gravity(object: Option<&Bound<'_, PyAny>>, dimension: usize) -> PyResult<[f64; 3]> {
    let gravity = Numbers::read("gravity", needed("gravity", object)?)?;
    if gravity.shape() != [dimension] {
        return Err(gravity.wrong_shape(&format!("({dimension},), as the positions")));
    }
    let mut vector = [0.0; 3];
    vector[..dimension].copy_from_slice(gravity.values());
    Ok(vector)
}
