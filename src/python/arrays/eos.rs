//! Tait's equation of state.

use super::input::{self, Numbers};
use super::output::array_or_number;
use crate::eos::{EquationOfState, Tait};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Pressure at a density by Tait's equation, B [(ρ/ρ0)^γ - 1] with B = c0² ρ0 / γ.
///
/// Parameters
/// ----------
/// density : array_like
///     Densities [kg/m³; kg/m² in 2D], positive, of any shape.
/// reference_density : float
///     Density ρ0 at which the pressure is zero.
/// sound_speed : float
///     Speed of sound c0 at that density [m/s].
/// gamma : float, optional
///     Exponent γ; 7 for water.
///
/// Returns
/// -------
/// float or ndarray
///     Pressures [Pa], of density's shape.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For any number that is not positive and finite.
#[pyfunction]
#[pyo3(
    signature = (density, reference_density, sound_speed, gamma=None),
    text_signature = "(density, reference_density, sound_speed, gamma=7.0)"
)]
pub(super) fn tait_pressure<'py>(
    py: Python<'py>,
    density: &Bound<'py, PyAny>,
    reference_density: &Bound<'py, PyAny>,
    sound_speed: &Bound<'py, PyAny>,
    gamma: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let density = Numbers::read("density", density)?;
    density.each(|rho| rho > 0.0, "positive densities")?;
    let tait = tait(reference_density, sound_speed, gamma)?;
    let values = density.values();
    let pressure: Vec<f64> = py.detach(|| {
        values
            .par_iter()
            .with_min_len(4096)
            .map(|&rho| tait.pressure_at(rho))
            .collect()
    });
    array_or_number(py, density.shape(), &pressure)
}

/// Density at a pressure by Tait's equation: the inverse of :func:`tait_pressure`.
///
/// Parameters
/// ----------
/// pressure : array_like
///     Pressures [Pa] above -B = -c0² ρ0 / γ, of any shape.
/// reference_density : float
///     Density ρ0 at which the pressure is zero.
/// sound_speed : float
///     Speed of sound c0 at that density [m/s].
/// gamma : float, optional
///     Exponent γ; 7 for water.
///
/// Returns
/// -------
/// float or ndarray
///     Densities, in the unit of reference_density and of pressure's shape.
///
/// Raises
/// ------
/// kolk.ArrayError
///     For pressures at or below -B, which no density has, and for parameters that are not positive and finite.
#[pyfunction]
#[pyo3(
    signature = (pressure, reference_density, sound_speed, gamma=None),
    text_signature = "(pressure, reference_density, sound_speed, gamma=7.0)"
)]
pub(super) fn tait_density<'py>(
    py: Python<'py>,
    pressure: &Bound<'py, PyAny>,
    reference_density: &Bound<'py, PyAny>,
    sound_speed: &Bound<'py, PyAny>,
    gamma: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let pressure = Numbers::read("pressure", pressure)?;
    let tait = tait(reference_density, sound_speed, gamma)?;
    let lowest = -tait.stiffness();
    pressure.each(
        |p| p > lowest,
        &format!("pressures above {lowest} Pa, where the density is zero"),
    )?;
    let values = pressure.values();
    let density: Vec<f64> = py.detach(|| {
        values
            .par_iter()
            .with_min_len(4096)
            .map(|&p| tait.density_at(p))
            .collect()
    });
    array_or_number(py, pressure.shape(), &density)
}

fn tait(
    reference_density: &Bound<'_, PyAny>,
    sound_speed: &Bound<'_, PyAny>,
    gamma: Option<&Bound<'_, PyAny>>,
) -> PyResult<Tait> {
    Ok(Tait {
        reference_density: input::positive("reference_density", reference_density)?,
        sound_speed: input::positive("sound_speed", sound_speed)?,
        gamma: input::or(7.0, "gamma", gamma, input::positive)?,
        background: 0.0,
    })
}
