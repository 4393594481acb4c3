"""The Taylor-Green vortex: a periodic array of vortices that decays by viscosity alone."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def taylor_green_decay_rate(viscosity: float, length: float = 1.0) -> float:
    """Rate b of the velocity, u ~ exp(b t), in 1/s: ``b = -8 pi^2 nu / L^2``.

    viscosity: kinematic, m^2/s; length: period of the box, m. The kinetic energy decays at 2 b.
    """
    return -8.0 * np.pi**2 * viscosity / length**2


def taylor_green(
    position: npt.ArrayLike,
    time: float,
    *,
    viscosity: float,
    speed: float = 1.0,
    length: float = 1.0,
    density: float = 1.0,
) -> tuple[FloatArray, FloatArray]:
    """Velocity (n, 2) in m/s and pressure (n,) in Pa at ``position`` (n, 2) in m.

    With k = 2 pi / L and b = -8 pi^2 nu / L^2::

        u = -U e^(bt) cos(kx) sin(ky)      v = U e^(bt) sin(kx) cos(ky)
        p = -rho U^2 e^(2bt) / 4 (cos 2kx + cos 2ky)

    Exact for the incompressible Navier-Stokes equations in a box of period ``length``.
    Source: Taylor and Green, Proc. R. Soc. A 158 (1937) 499-521.
    """
    x = np.asarray(position, np.float64)
    k = 2.0 * np.pi / length
    decay = np.exp(taylor_green_decay_rate(viscosity, length) * time)
    kx, ky = k * x[..., 0], k * x[..., 1]
    velocity = speed * decay * np.stack([-np.cos(kx) * np.sin(ky), np.sin(kx) * np.cos(ky)], -1)
    pressure = -0.25 * density * (speed * decay) ** 2 * (np.cos(2 * kx) + np.cos(2 * ky))
    return velocity, pressure
