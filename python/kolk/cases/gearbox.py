"""Two gears that mesh, half in oil, in their housing; the torque that the oil costs either.

Spur gears of 14 and 21 teeth with more play than real ones have, so that the gap between two flanks
is resolved. Their outlines come from files (`kolk.cases.gears`). The driver turns at a constant
speed, the other with it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from kolk.cases import Case
from kolk.cases.gears import FOLDER, MODULE, TEETH
from kolk.scene import Scene

SPACING = 0.002
RATE = -12.0
"""Speed of the driver, rad/s: clockwise, so that both gears carry oil over to where they mesh."""
RUN_UP = 0.08
"""Until the driver has its speed, s."""
APART = 0.002
"""By how much the axes are further apart than the pitch circles touch, m."""
CENTRES = {
    "driver": (0.082, 0.112),
    "wheel": (0.082 + 0.5 * MODULE * sum(TEETH.values()) + APART, 0.112),
}
HOUSING = (0.334, 0.228)
LEVEL = 0.112
"""Of the oil, m: the axes'."""
VISCOSITY = 1e-4
"""Kinematic, m^2/s: gear oil at working temperature."""
DENSITY = 870.0


def rate(name: str) -> float:
    """Speed of a gear in rad/s: the teeth of both pass at the same rate."""
    return RATE if name == "driver" else -RATE * TEETH["driver"] / TEETH["wheel"]


def motion(name: str) -> dict[str, Any]:
    """A gear that gathers speed evenly and then keeps it: at full speed throughout, less what it
    lacks at the start."""
    centre, speed = list(CENTRES[name]), rate(name)
    time = [RUN_UP * k / 8 for k in range(13)]
    behind = [speed * (0.5 * t * t / RUN_UP - t) for t in time if t < RUN_UP]
    behind += [-0.5 * speed * RUN_UP] * (len(time) - len(behind))
    return {
        "rotate": {"centre": centre, "rate": speed},
        "table": {"centre": centre, "time": time, "angle": behind},
    }


def bodies(shapes: dict[str, dict[str, Any]], cuts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Fluid, walls and probes of the gearbox in 2D, with the gears' shapes."""
    return {
        "fluid": [
            {
                "name": "oil",
                "shape": {
                    "difference": {
                        "of": {"box": {"from": [0.0, 0.0], "to": [HOUSING[0], LEVEL]}},
                        "minus": list(cuts),
                    }
                },
                "density": DENSITY,
                "viscosity": {"laminar": VISCOSITY},
            }
        ],
        "wall": [
            {
                "name": "housing",
                "shape": {"tank": {"from": [0.0, 0.0], "to": list(HOUSING)}},
                "slip": "no",
            },
            *(
                {
                    "name": name,
                    "shape": shapes[name],
                    "slip": "no",
                    "motion": motion(name),
                }
                for name in TEETH
            ),
        ],
        "probe": [
            {"name": f"torque-{name}", "force": {"body": name, "about": list(CENTRES[name])}}
            for name in TEETH
        ],
    }


def outline_of(name: str, offset: float = 0.0) -> dict[str, Any]:
    """The shape of a gear from its file."""
    table: dict[str, Any] = {
        "file": str(FOLDER / f"{name}.csv"),
        "translate": list(CENTRES[name]),
    }
    return {"outline": table | ({"offset": offset} if offset else {})}


scene = Scene(
    name="gearbox",
    title="Two gears half in oil, driven at a constant speed",
    dimension=2,
    spacing=SPACING,
    gravity=[0.0, -9.81],
    until=RUN_UP + 2.0 * math.pi / abs(RATE),
    # Half a spacing between the oil's lattice and the gears', which do not match.
    **bodies({n: outline_of(n) for n in TEETH}, [outline_of(n, 0.5 * SPACING) for n in TEETH]),
    output={"every": 0.01},
)

case = Case(
    name="gearbox",
    title="Gears in oil",
    shows="oil dragged along, thrown off and squeezed out between meshing teeth; torque on either",
    source="made for kolk: involute gears of 14 and 21 teeth, module 8 mm, outlines from files",
    reference="none: no oil passes a flank, and either torque opposes its gear",
    cost="5,499 fluid and 5,036 wall particles, about 7,100 steps: 20 seconds on two cores",
    scene=scene,
)
