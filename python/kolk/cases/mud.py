"""A heap of mud let go on a dry floor, 2D: it slumps, and its yield stress holds it on a slope."""

from __future__ import annotations

from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.scene import Scene

LENGTH, HEIGHT = 0.2, 0.1
"""Of the heap, m."""
DENSITY = 1500.0
YIELD_STRESS = 60.0
"""Pa: a tenth of the weight of a column of 4 cm of this mud."""

scene = Scene(
    name="mud",
    title="The slump of a heap of mud",
    dimension=2,
    spacing=0.005,
    gravity=[0.0, -9.81],
    until=1.0,
    fluid=[
        {
            "name": "mud",
            "shape": {"box": {"from": [0.0, 0.0], "to": [LENGTH, HEIGHT]}},
            "density": DENSITY,
            "viscosity": {
                "herschel_bulkley": {
                    "yield_stress": YIELD_STRESS,
                    "consistency": 2.0,
                    "index": 1.0,
                    "max_viscosity": 300.0,
                }
            },
        }
    ],
    wall=[
        {
            "name": "flume",
            "shape": {"tank": {"from": [0.0, 0.0], "to": [0.8, 0.15], "open": ["top"]}},
            "slip": "no",
        }
    ],
    probe=[
        {"name": "front", "front": {"axis": "x", "body": "mud"}},
        {"name": "height", "level": {"at": [0.0, 0.0]}},
    ],
    output={"every": 0.02},
)

case = Case(
    name="mud",
    title="The slump of a heap of mud",
    shows="a liquid with yield stress that runs and comes to rest on a slope of its own",
    source="Liu and Mei, J. Fluid Mech. 207 (1989) 505-529: the shape at which Bingham mud stops",
    reference="the run-out of the final shape h^2 = 2 tau_y (x_f - x)/(rho g)",
    cost="800 fluid and 912 wall particles, about 44,000 steps: 60 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison(
            "front_x",
            None,
            "slump",
            1.0,
            1.0,
            "analytic",
            parameters=MappingProxyType(
                {
                    "volume": LENGTH * HEIGHT,
                    "density": DENSITY,
                    "yield_stress": YIELD_STRESS,
                    "gravity": 9.81,
                }
            ),
        ),
    ),
)
