"""Start-up flows between two plates: Poiseuille (body force) and Couette (sliding plate)."""

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
