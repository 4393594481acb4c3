"""Water at rest in a tank, 2D: nothing may move, and the pressure is hydrostatic."""

from __future__ import annotations

import math
from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.scene import Scene

H = 0.5
"""Depth, m."""
GRAVITY = 9.81
DENSITY = 1000.0

scene = Scene(
    name="still-water",
    title="Water at rest in a tank",
    dimension=2,
    spacing=H / 25,
    gravity=[0.0, -GRAVITY],
    until=20 * math.sqrt(H / GRAVITY),
    fluid=[
        {
            "name": "water",
            "shape": {"box": {"from": [0.0, 0.0], "to": [2 * H, H]}},
            "density": DENSITY,
            "viscosity": {"artificial": 0.02},
        }
    ],
    wall=[
        {
            "name": "tank",
            "shape": {"tank": {"from": [0.0, 0.0], "to": [2 * H, 1.4 * H], "open": ["top"]}},
        }
    ],
    probe=[
        {"name": "bottom", "pressure": {"at": [H, 0.0]}},
        {"name": "side", "pressure": {"at": [2 * H, H / 2]}},
        {"name": "level", "level": {"at": [H, 0.0]}},
    ],
    output={"every": 0.1},
)

case = Case(
    name="still-water",
    title="Water at rest",
    shows="that still water stays still: the first thing that a scheme must do",
    source="20 sqrt(H/g) of rest at a depth of H = 0.5 m",
    reference="hydrostatic pressure; kinetic energy against m g H",
    cost="1,250 fluid and 512 wall particles, about 10,100 steps: 4 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison(
            "pressure",
            None,
            "hydrostatic_pressure",
            1.0,
            1.0,
            "analytic",
            parameters=MappingProxyType({"surface": H, "density": DENSITY, "gravity": GRAVITY}),
        ),
    ),
)
