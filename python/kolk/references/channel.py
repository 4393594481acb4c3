"""Flows between two plates: the start-up under a body force (Poiseuille) or by a sliding plate
(Couette), and the steady flow of a liquid with yield stress (Herschel and Bulkley)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

TERMS = 200
"""Terms of the series: at t = 1e-4 L^2/nu the first one left out is below 1e-13 of the sum."""


def poiseuille(
    y: npt.ArrayLike, time: float, *, width: float, viscosity: float, acceleration: float
) -> FloatArray:
    """Velocity along the channel, m/s, at heights ``y`` (m, 0 to ``width``) at ``time`` (s).

    Fluid at rest is driven from t = 0 by a body force (m/s^2) between plates at rest::

        u = F/(2 nu) y (L - y)
            - sum_n 4 F L^2 / (nu pi^3 (2n+1)^3) sin(pi y (2n+1)/L) exp(-(2n+1)^2 pi^2 nu t / L^2)

    ``viscosity`` is kinematic, m^2/s. Source: Morris, Fox and Zhu, J. Comput. Phys. 136 (1997)
    214-226. For t to infinity pass ``math.inf``.
    """
    height = np.asarray(y, np.float64)
    odd = 2.0 * np.arange(TERMS) + 1.0
    weight = 4.0 * acceleration * width**2 / (viscosity * np.pi**3 * odd**3)
    weight = weight * np.exp(-(odd**2) * np.pi**2 * viscosity * time / width**2)
    steady = acceleration / (2.0 * viscosity) * height * (width - height)
    return np.asarray(steady - np.sin(np.pi * height[..., None] * odd / width) @ weight)


def couette(
    y: npt.ArrayLike, time: float, *, width: float, viscosity: float, speed: float
) -> FloatArray:
    """Velocity along the channel, m/s, at heights ``y`` (m, 0 to ``width``) at ``time`` (s).

    The plate at y = ``width`` slides with ``speed`` (m/s) from t = 0, the other one is at rest::

        u = V y/L + sum_n 2 V/(n pi) (-1)^n sin(n pi y/L) exp(-nu n^2 pi^2 t / L^2)

    ``viscosity`` is kinematic, m^2/s. Source: Morris, Fox and Zhu, J. Comput. Phys. 136 (1997)
    214-226. For t to infinity pass ``math.inf``.
    """
    height = np.asarray(y, np.float64)
    n = np.arange(1, 2 * TERMS + 1, dtype=np.float64)
    weight = 2.0 * speed / (n * np.pi) * np.where(n % 2 == 0, 1.0, -1.0)
    weight = weight * np.exp(-viscosity * n**2 * np.pi**2 * time / width**2)
    return np.asarray(
        speed * height / width + np.sin(np.pi * height[..., None] * n / width) @ weight
    )


def herschel_bulkley(
    y: npt.ArrayLike,
    *,
    width: float,
    density: float,
    acceleration: float,
    yield_stress: float,
    consistency: float,
    index: float,
) -> FloatArray:
    """Velocity of the steady flow, m/s, at heights ``y`` (m, 0 to ``width``) between two plates.

    A body force (m/s^2) drives a liquid with the law ``tau = tau_y + K shear_rate^n``. With the
    distance r from the middle, half the width H, and the plug's half width r_p = tau_y/(rho F)::

        u = n/(n+1) (rho F/K)^(1/n) [(H - r_p)^(1/n + 1) - max(r - r_p, 0)^(1/n + 1)]

    at rest where the wall's stress rho F H does not reach tau_y. Source: Bird, Armstrong and
    Hassager, Dynamics of Polymeric Liquids 1 (1987), ch. 4; Bingham's liquid for n = 1.
    """
    drive = density * acceleration
    plug = yield_stress / drive
    power = 1.0 / index + 1.0
    r = np.abs(np.asarray(y, np.float64) - 0.5 * width)
    sheared = np.maximum(0.5 * width - plug, 0.0) ** power - np.maximum(r - plug, 0.0) ** power
    scale = index / (index + 1.0) * (drive / consistency) ** (1.0 / index)
    return np.asarray(scale * np.maximum(sheared, 0.0))
