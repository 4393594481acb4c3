"""Drops that surface tension holds together: their pressure, and how they oscillate."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CapillaryDrop:
    """A free drop of little viscosity and its mode of order n, of small amplitude. SI units."""

    radius: float
    """m, at rest."""
    tension: float
    """N/m."""
    density: float
    viscosity: float = 0.0
    """Kinematic, m^2/s."""
    dimension: int = 2
    mode: int = 2
    """n: 2 is the change from a round drop to an elliptic one and back."""

    @property
    def pressure(self) -> float:
        """Over that of the air, Pa: ``(D - 1) sigma/R``. Laplace 1806."""
        return (self.dimension - 1) * self.tension / self.radius

    @property
    def frequency(self) -> float:
        """Angular, rad/s: ``n (n^2 - 1)`` in 2D, ``n (n - 1)(n + 2)`` in 3D, times
        ``sigma/(rho R^3)``, under the root. Rayleigh, Proc. R. Soc. 29 (1879) 71-97."""
        n = self.mode
        shape = n * (n * n - 1) if self.dimension == 2 else n * (n - 1) * (n + 2)
        return math.sqrt(shape * self.tension / (self.density * self.radius**3))

    @property
    def period(self) -> float:
        """s."""
        return 2.0 * math.pi / self.frequency

    @property
    def damping(self) -> float:
        """Of the amplitude, 1/s: ``2 n (n - 1) nu/R^2`` in 2D, ``(n - 1)(2 n + 1) nu/R^2`` in 3D,
        from what the inviscid flow dissipates. Lamb, Hydrodynamics (1932), sections 348 and 355."""
        n = self.mode
        shape = 2 * n * (n - 1) if self.dimension == 2 else (n - 1) * (2 * n + 1)
        return shape * self.viscosity / self.radius**2
