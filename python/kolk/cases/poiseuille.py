"""Start-up of the flow between two plates under a body force, 2D, at Re = 0.025."""

from __future__ import annotations

from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.scene import Scene

WIDTH = 1e-3
"""Between the plates, m."""
PERIOD = 4e-4
"""Of the channel, m."""
VISCOSITY = 1e-6
"""Kinematic, m^2/s."""
ACCELERATION = 2e-4
"""Body force, m/s^2."""
SPEED = ACCELERATION * WIDTH**2 / (8 * VISCOSITY)
"""In the middle of the steady flow, m/s."""

scene = Scene(
    name="poiseuille",
    title="Flow between two plates under a body force (Poiseuille)",
    dimension=2,
    spacing=WIDTH / 50,
    gravity=[ACCELERATION, 0.0],
    until=1.0,
    periodic={"x": [0.0, PERIOD]},
    fluid=[
        {
            "name": "fluid",
            "shape": {"box": {"from": [0.0, 0.0], "to": [PERIOD, WIDTH]}},
            "density": 1000.0,
            "viscosity": {"laminar": VISCOSITY},
        }
    ],
    wall=[
        {
            "name": "plates",
            "shape": {
                "tank": {"from": [0.0, 0.0], "to": [PERIOD, WIDTH], "open": ["left", "right"]}
            },
            "slip": "no",
        }
    ],
    probe=[
        {"name": "middle", "field": {"quantity": "velocity", "at": [PERIOD / 2, WIDTH / 2]}},
        {"name": "quarter", "field": {"quantity": "velocity", "at": [PERIOD / 2, WIDTH / 4]}},
        {"name": "drag", "force": {"body": "plates"}},
    ],
    numerics={"expected_speed": SPEED},
    output={"every": 0.05},
)

case = Case(
    name="poiseuille",
    title="Flow between two plates",
    shows="laminar viscosity and no-slip walls, from rest to the steady parabola",
    source="Morris, Fox and Zhu, J. Comput. Phys. 136 (1997) 214-226: L = 1 mm, Re = 0.025",
    reference="the exact series in time and height",
    cost="1,000 fluid and 160 wall particles, about 5,300 steps: 2 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison(
            "velocity_x",
            None,
            "poiseuille",
            1.0,
            1.0,
            "analytic",
            parameters=MappingProxyType(
                {"width": WIDTH, "viscosity": VISCOSITY, "acceleration": ACCELERATION}
            ),
        ),
    ),
)
