"""Dam break against a far end wall, 2D: the comparison of De Courcy et al.

Twice the size of the experiment of Lobovsky et al., in the same proportions as in the publications
that compare codes on it.
"""

from __future__ import annotations

import math

from kolk.cases import Case, Comparison
from kolk.scene import Scene

H = 0.6
"""Depth of the water, m."""
LENGTH = 5.366 * H
"""Inner length of the tank, m."""
GRAVITY = 9.81
DENSITY = 1000.0
SENSOR = 0.0084
"""Diameter of a sensor's face, m."""
SENSORS = {"P1": 0.006, "P2": 0.030, "P3": 0.060, "P4": 0.160}
"""Heights of the sensors' centres over the bottom, m."""

TIME = math.sqrt(H / GRAVITY)
PRESSURE = DENSITY * GRAVITY * H

scene = Scene(
    name="dam-break-decourcy",
    title="Dam break against a far end wall (De Courcy et al. 2024)",
    dimension=2,
    spacing=H / 40,
    gravity=[0.0, -GRAVITY],
    until=7 * TIME,
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
            "shape": {"tank": {"from": [0.0, 0.0], "to": [LENGTH, 3 * H], "open": ["top"]}},
        }
    ],
    probe=[
        {
            "name": name,
            "pressure": {"at": [LENGTH, height], "diameter": SENSOR},
            "every": 0.02 * TIME,
        }
        for name, height in SENSORS.items()
    ],
    output={"every": 0.2 * TIME},
)

case = Case(
    name="dam-break-decourcy",
    title="Dam break against a far end wall",
    shows="the same surge and impact in a longer tank, beside a fine run of another code",
    source="De Courcy et al., Comput. Methods Appl. Mech. Eng. 420 (2024) 116700: H = 0.6 m",
    reference="pressures of their δ-SPH run with H/Δp = 400",
    cost="3,200 fluid and 1,852 wall particles, about 5,900 steps: 8 seconds on two cores",
    scene=scene,
    comparisons=tuple(
        Comparison("pressure", name, f"decourcy-{name.lower()}", TIME, PRESSURE, "series")
        for name in SENSORS
    ),
)
