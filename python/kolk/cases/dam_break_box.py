"""Dam break over a box in a tank, 3D: SPHERIC benchmark test 2.

The experiment of MARIN, described by Kleefsman et al. (2005). x counts from the wall far from the
water, z upwards; the box's face towards the water is the one at high x.
"""

from __future__ import annotations

from kolk.cases import Case, Comparison
from kolk.scene import Scene

FACE = 0.8245
"""x of the box's face towards the water, m."""
TOP = 0.161
"""Height of the box, m."""
MIDDLE = 0.5
"""y of the tank's mid-plane, m."""
RUNG = (0.021, 0.061, 0.101, 0.141)
"""Heights of P1 to P4 on the face, and distances of P5 to P8 behind its upper edge, m."""
GAUGES = {"H1": 0.496, "H2": 0.992, "H3": 1.488, "H4": 2.638}

scene = Scene(
    name="dam-break-box",
    title="Dam break over a box (SPHERIC test 2, Kleefsman et al. 2005)",
    dimension=3,
    spacing=0.02,
    gravity=[0.0, 0.0, -9.81],
    until=3.0,
    fluid=[
        {
            "name": "water",
            "shape": {"box": {"from": [1.992, 0.0, 0.0], "to": [3.22, 1.0, 0.55]}},
            "density": 1000.0,
            "viscosity": {"artificial": 0.02},
        }
    ],
    wall=[
        {
            "name": "tank",
            "shape": {"tank": {"from": [0.0, 0.0, 0.0], "to": [3.22, 1.0, 1.0], "open": ["top"]}},
        },
        {
            "name": "box",
            "shape": {
                "box": {
                    "from": [FACE - 0.161, MIDDLE - 0.2015, 0.0],
                    "to": [FACE, MIDDLE + 0.2015, TOP],
                }
            },
        },
    ],
    probe=[
        *({"name": f"P{i}", "pressure": {"at": [FACE, MIDDLE, z]}} for i, z in enumerate(RUNG, 1)),
        *(
            {"name": f"P{i}", "pressure": {"at": [FACE - x, MIDDLE, TOP]}}
            for i, x in enumerate(RUNG, 5)
        ),
        *({"name": name, "level": {"at": [x, MIDDLE, 0.0]}} for name, x in GAUGES.items()),
        {"name": "load", "force": {"body": "box"}},
    ],
    output={"every": 0.04},
)

case = Case(
    name="dam-break-box",
    title="Dam break over a box, 3D",
    shows="a surge that hits a box and closes over it; pressures on the box and water levels",
    source="Kleefsman et al., J. Comput. Phys. 206 (2005) 363-393 (SPHERIC benchmark test 2)",
    reference="the experiment's pressures P1 to P8 and levels H1 to H4; it lasts 6 s (--until 6)",
    cost="85,400 fluid and 128,100 wall particles, about 9,000 steps: 9 minutes on two cores",
    scene=scene,
    comparisons=(
        *(
            Comparison("pressure", f"P{i}", "spheric2-pressure", 1.0, 1.0, "series", f"P{i}")
            for i in range(1, 9)
        ),
        *(Comparison("level", name, "spheric2-level", 1.0, 1.0, "series", name) for name in GAUGES),
    ),
)
