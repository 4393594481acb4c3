"""What the fluid is made of: equation of state, sound speed, pressure at the start."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

MACH = 0.1
"""Largest Mach number that the automatic sound speed aims at: density varies by about Mach^2."""


def density_at(
    pressure: FloatArray,
    *,
    reference_density: float,
    sound_speed: float,
    eos: str = "tait",
    gamma: float = 7.0,
    background_pressure: float = 0.0,
) -> FloatArray:
    """Density (n,) in kg/m^3 under ``pressure`` (n,) in Pa: the inverse of the equation of state.

    Tait: ``rho = rho0 (1 + gamma (p - p_b) / (rho0 c0^2))^(1/gamma)``; linear:
    ``rho = rho0 + (p - p_b) / c0^2``. Source: Macdonald, Proc. Phys. Soc. A 64 (1951), as used by
    Monaghan, J. Comput. Phys. 110 (1994).
    Raises ValueError for a tension beyond what the equation can bear.
    """
    strain = (pressure - background_pressure) / (reference_density * sound_speed**2)
    base = 1.0 + (gamma * strain if eos == "tait" else strain)
    if base.size and not base.min() > 0.0:
        worst = float(np.asarray(pressure)[np.argmin(base)])
        raise ValueError(
            f"found {worst:g} Pa, which would need a density of zero or less at a sound speed of "
            f"{sound_speed:g} m/s: raise the pressure or the sound speed"
        )
    return np.asarray(reference_density * (base ** (1.0 / gamma) if eos == "tait" else base))


def pressure_at(
    density: FloatArray,
    *,
    reference_density: float,
    sound_speed: float,
    eos: str = "tait",
    gamma: float = 7.0,
    background_pressure: float = 0.0,
) -> FloatArray:
    """Pressure (n,) in Pa at ``density`` (n,) in kg/m^3: the inverse of :func:`density_at`."""
    ratio = density / reference_density
    strain = (ratio**gamma - 1.0) / gamma if eos == "tait" else ratio - 1.0
    return np.asarray(background_pressure + reference_density * sound_speed**2 * strain)


def hydrostatic_pressure(
    height: FloatArray,
    surface: float,
    *,
    gravity: float,
    reference_density: float,
    sound_speed: float,
    eos: str = "tait",
    gamma: float = 7.0,
) -> FloatArray:
    """Pressure (n,) in Pa at ``height`` (n,) in m under a free surface at height ``surface``.

    In balance with the compressed fluid's own weight, dp/dz = -rho(p) g, hence with
    depth d: Tait ``p = B ((1 + (gamma-1) g d / c0^2)^(gamma/(gamma-1)) - 1)``, B = rho0 c0^2/gamma;
    linear ``p = rho0 c0^2 (exp(g d / c0^2) - 1)``. Both tend to rho0 g d for a stiff fluid.
    """
    depth = np.maximum(surface - height, 0.0)
    strain = gravity * depth / sound_speed**2
    if eos == "linear" or gamma == 1.0:
        return np.asarray(reference_density * sound_speed**2 * np.expm1(strain))
    stiffness = reference_density * sound_speed**2 / gamma
    growth = np.log1p((gamma - 1.0) * strain) * (gamma / (gamma - 1.0))
    return np.asarray(stiffness * np.expm1(growth))


def capillary_speed(tension: float, density: float, radius: float, dimension: int) -> float:
    """Speed in m/s that capillary pressure gives: ``sqrt(2 p/rho)``, p = (D - 1) sigma/R (Laplace).

    tension in N/m, radius of the surface in m.
    """
    return float(np.sqrt(2.0 * (dimension - 1) * tension / (density * radius)))


def sound_speed(expected_speed: float, drop: float, gravity: float) -> float:
    """Sound speed in m/s that keeps the flow weakly compressible.

    ``c0 = max(U, 2 sqrt(g H)) / 0.1``: U is the largest speed expected or given at the start, and
    H (``drop``, m) the height through which the fluid can fall, from its highest point to the
    lowest it can reach. 2 sqrt(g H) is the speed of the front of a collapsing column (Ritter 1892),
    more than that of a free fall, and bounds sqrt(p/rho0) of the fluid at rest.
    Source: Monaghan, J. Comput. Phys. 110 (1994). Zero where nothing sets a speed.
    """
    return max(expected_speed, 2.0 * float(np.sqrt(gravity * max(drop, 0.0)))) / MACH
