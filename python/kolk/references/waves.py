"""Water under gravity: the hydrostatic pressure and the linear standing wave."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def hydrostatic_pressure(
    height: npt.ArrayLike, *, surface: float, density: float = 1000.0, gravity: float = 9.81
) -> FloatArray:
    """Pressure (Pa) of still water at ``height`` (m): ``p = rho g (surface - height)``, 0 above."""
    depth = np.maximum(surface - np.asarray(height, np.float64), 0.0)
    return np.asarray(density * gravity * depth)


@dataclass(frozen=True)
class StandingWave:
    """Linear standing wave in a basin of finite depth with a slipping bed, SI units."""

    wavelength: float
    depth: float
    gravity: float
    amplitude: float
    """Largest surface elevation without viscosity, m."""
    frequency: float
    """Angular frequency with viscosity, rad/s."""
    damping: float
    """Rate of the amplitude, 1/s, below 0; the energy decays at twice this rate."""

    @property
    def number(self) -> float:
        """Wave number k, rad/m."""
        return 2.0 * np.pi / self.wavelength

    @property
    def period(self) -> float:
        """Period, s."""
        return 2.0 * np.pi / self.frequency

    def elevation(self, x: npt.ArrayLike, time: float) -> FloatArray:
        """Surface elevation (m): ``A e^(nt) cos(kx) sin(wt)``, flat at t = 0."""
        decay = self.amplitude * np.exp(self.damping * time)
        return np.asarray(
            decay * np.cos(self.number * np.asarray(x, float)) * np.sin(self.frequency * time)
        )

    def velocity(self, position: npt.ArrayLike, time: float) -> FloatArray:
        """Velocity (n, 2), m/s, at ``position`` (n, 2), the still surface at y = 0, bed y = -depth.

        Potential flow: ``phi = (A w / k) cosh k(y+d)/sinh kd cos kx cos wt`` with the same decay.
        """
        x = np.asarray(position, np.float64)
        k = self.number
        scale = self.amplitude * self.frequency / np.sinh(k * self.depth)
        scale *= np.exp(self.damping * time) * np.cos(self.frequency * time)
        kx, ky = k * x[..., 0], k * (x[..., 1] + self.depth)
        return np.asarray(
            scale * np.stack([-np.sin(kx) * np.cosh(ky), np.cos(kx) * np.sinh(ky)], axis=-1)
        )


def standing_wave(
    *,
    wavelength: float,
    depth: float,
    amplitude: float,
    viscosity: float = 0.0,
    gravity: float = 9.81,
) -> StandingWave:
    """Frequency and damping of a linear standing wave, ``viscosity`` kinematic in m^2/s.

    Inviscid: ``w^2 = g k tanh(k d)``. With viscosity n = damping + i w is the root of ::

        (n + 2 nu k^2)^2 + g k tanh(kd) = 4 nu^2 k^3 m coth(md) tanh(kd),   m^2 = k^2 + n/nu

    (linearised Navier-Stokes, free-slip bed and sides). Lighthill's rate -2 nu k^2 that is often
    used instead is 33 % too fast at Re = d sqrt(g d)/nu = 50.
    """
    k = 2.0 * np.pi / wavelength
    tanh = np.tanh(k * depth)
    root = complex(0.0, np.sqrt(gravity * k * tanh))
    if viscosity > 0.0:
        root = _viscous_root(root - 2.0 * viscosity * k**2, k, depth, viscosity, gravity)
    return StandingWave(
        wavelength=wavelength,
        depth=depth,
        gravity=gravity,
        amplitude=amplitude,
        frequency=root.imag,
        damping=root.real,
    )


def _viscous_root(guess: complex, k: float, depth: float, nu: float, gravity: float) -> complex:
    """Secant iteration from the inviscid root with Lighthill's damping: 5 to 8 rounds."""
    tanh = np.tanh(k * depth)

    def residual(n: complex) -> complex:
        m = np.sqrt(k**2 + n / nu)
        # coth(z) by decaying exponentials: tanh of a large complex argument overflows
        decay = np.exp(-2.0 * m * depth)
        coth = (1.0 + decay) / (1.0 - decay)
        viscous = 4.0 * nu**2 * k**3 * m * coth * tanh
        return complex((n + 2.0 * nu * k**2) ** 2 + gravity * k * tanh - viscous)

    older, newer = guess, guess * (1.0 + 1e-4)
    f_older, f_newer = residual(older), residual(newer)
    for _ in range(60):
        if f_newer == f_older or abs(newer - older) <= 1e-15 * abs(newer):
            break
        older, newer = newer, newer - f_newer * (newer - older) / (f_newer - f_older)
        f_older, f_newer = f_newer, residual(newer)
    return newer
