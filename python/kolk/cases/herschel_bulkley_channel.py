"""Steady flow of a liquid with yield stress between two plates, 2D: a plug glides in the middle."""

from __future__ import annotations

from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.references import herschel_bulkley
from kolk.scene import Scene

WIDTH = 0.1
"""Between the plates, m."""
PERIOD = 0.06
"""Of the channel, m."""
FLOW = MappingProxyType(
    {
        "width": WIDTH,
        "density": 1000.0,
        "acceleration": 0.4,
        "yield_stress": 5.0,
        "consistency": 2.0,
        "index": 0.8,
    }
)
"""The plug is a quarter of the width across: tau_y / (rho F) = 12.5 mm to each side."""
SPEED = float(herschel_bulkley(WIDTH / 2, **FLOW))
"""Of the plug, m/s."""

scene = Scene(
    name="herschel-bulkley-channel",
    title="A liquid with yield stress between two plates (Herschel-Bulkley)",
    dimension=2,
    spacing=WIDTH / 32,
    # Rows of particles that slide past each other stay rows: on them the pair sum misses 4 % of the
    # viscosity at a ratio of 2, and 3 % at this one.
    smoothing_ratio=2.15,
    gravity=[FLOW["acceleration"], 0.0],
    until=3.0,
    periodic={"x": [0.0, PERIOD]},
    fluid=[
        {
            "name": "paste",
            "shape": {"box": {"from": [0.0, 0.0], "to": [PERIOD, WIDTH]}},
            "density": FLOW["density"],
            "viscosity": {
                "herschel_bulkley": {
                    "yield_stress": FLOW["yield_stress"],
                    "consistency": FLOW["consistency"],
                    "index": FLOW["index"],
                    "max_viscosity": 25.0,
                }
            },
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
        {"name": "plug", "field": {"quantity": "velocity", "at": [PERIOD / 2, WIDTH / 2]}},
        {"name": "drag", "force": {"body": "plates"}},
    ],
    numerics={"expected_speed": SPEED},
    output={"every": 0.2},
)

case = Case(
    name="herschel-bulkley-channel",
    title="A liquid with yield stress between two plates",
    shows="a plug that glides between sheared layers; a viscosity that depends on the flow",
    source="Herschel and Bulkley, Kolloid-Z. 39 (1926) 291-300; Bird et al. 1987, ch. 4",
    reference="the exact steady profile",
    cost="608 fluid and 190 wall particles, about 37,000 steps: 30 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison("velocity_x", None, "herschel_bulkley", 1.0, 1.0, "analytic", parameters=FLOW),
    ),
)
