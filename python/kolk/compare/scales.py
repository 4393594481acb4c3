"""The scales in which experiments give their figures, from the scene's own sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from kolk.errors import KolkError


@dataclass(frozen=True)
class Scales:
    """Length (m), density (kg/m^3) and gravity (m/s^2) that make figures dimensionless."""

    length: float = 1.0
    density: float = 1000.0
    gravity: float = 9.81

    def of(self, unit: str) -> float:
        """SI value of one ``unit`` as the reference tables name it.

        ``sqrt(H/g)`` and ``sqrt(a/2g)`` are times, ``rho g H`` is a pressure, ``a`` a length; SI
        units count 1. Raises KolkError for any other name.
        """
        known = {
            "sqrt(H/g)": math.sqrt(self.length / self.gravity),
            "sqrt(a/2g)": math.sqrt(0.5 * self.length / self.gravity),
            "rho g H": self.density * self.gravity * self.length,
            "a": self.length,
        }
        if unit in known:
            return known[unit]
        if unit in {"s", "m", "m/s", "Pa", "N", "1"}:
            return 1.0
        raise KolkError(f"unknown unit {unit!r}; known are {', '.join(known)} and SI units")
