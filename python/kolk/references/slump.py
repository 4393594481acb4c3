"""Where a heap of a liquid with yield stress comes to rest."""

from __future__ import annotations

import math


def slump(*, volume: float, density: float, yield_stress: float, gravity: float = 9.81) -> float:
    """How far a heap of Bingham mud has run on a level floor when it stops, m from its back wall.

    The weight of the slope is carried by the yield stress at the floor, ``rho g h h' = -tau_y``,
    hence ``h^2 = 2 tau_y (x_f - x)/(rho g)`` and with the volume (m^2 in 2D)
    ``x_f = (3/2 V sqrt(rho g/(2 tau_y)))^(2/3)``. For slopes that are not steep, and a liquid that
    comes to rest slowly: inertia carries it further. Source: Liu and Mei, J. Fluid Mech. 207 (1989)
    505-529.
    """
    steep = math.sqrt(density * gravity / (2.0 * yield_stress))
    return float((1.5 * volume * steep) ** (2.0 / 3.0))
