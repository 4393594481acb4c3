"""Dam break against a tall square column, 3D: the experiment of Yeh and Petroff.

In the experiment about 1 cm of water lay on the bed before the gate; here the bed is dry.
"""

from __future__ import annotations

from kolk.cases import Case, Comparison
from kolk.scene import Scene

WIDTH = 0.61
"""Of the tank, m."""
SIDE = 0.12
"""Of the column, m."""
FACE = 0.9
"""x of the column's front face, 0.5 m behind the gate, m."""

scene = Scene(
    name="dam-break-column",
    title="Dam break against a square column (Yeh and Petroff)",
    dimension=3,
    spacing=0.00722,
    gravity=[0.0, 0.0, -9.81],
    until=0.5,
    fluid=[
        {
            "name": "water",
            "shape": {"box": {"from": [0.0, 0.0, 0.0], "to": [0.4, WIDTH, 0.3]}},
            "density": 1000.0,
            "viscosity": {"artificial": 0.02},
        }
    ],
    wall=[
        {
            "name": "tank",
            "shape": {"tank": {"from": [0.0, 0.0, 0.0], "to": [1.6, WIDTH, 0.75], "open": ["top"]}},
        },
        {
            "name": "column",
            "shape": {
                "box": {
                    "from": [FACE, (WIDTH - SIDE) / 2, 0.0],
                    "to": [FACE + SIDE, (WIDTH + SIDE) / 2, 0.75],
                }
            },
        },
    ],
    probe=[
        {"name": "load", "force": {"body": "column"}, "every": 0.001},
        {"name": "front", "front": {"axis": "x", "body": "water"}},
        {"name": "speed", "field": {"quantity": "velocity", "at": [0.814, WIDTH / 2, 0.026]}},
    ],
    output={"every": 0.01},
)

case = Case(
    name="dam-break-column",
    title="Dam break against a square column, 3D",
    shows="a surge that splits at a tall column; the force on it",
    source="Yeh and Petroff, as in Raad and Bidoae, J. Comput. Phys. 203 (2005) 668-699",
    reference="the measured force: peak 33.1 N at 0.396 s over a bed with 1 cm of water",
    cost="194,000 fluid and 368,200 wall particles, about 3,100 steps: 7 minutes on two cores",
    scene=scene,
    comparisons=(Comparison("force_x", "load", "yeh-petroff-force", 1.0, 1.0, "series"),),
)
