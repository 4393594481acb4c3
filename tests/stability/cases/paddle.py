"""A paddle that passes a fixed wall at half a spacing."""

from __future__ import annotations

import math

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

SIDE, GRAVITY, LENGTH = 0.4, 9.81, 0.15


def scene(resolution: float) -> kolk.Scene:
    """A closed tank with a paddle that turns in its middle, half a spacing off the bottom."""
    spacing = SIDE / resolution
    middle = [0.5 * SIDE, LENGTH + 0.5 * spacing]
    thick = 4.0 * spacing
    blade = {
        "box": {
            "from": [middle[0] - LENGTH, middle[1] - 0.5 * thick],
            "to": [middle[0] + LENGTH, middle[1] + 0.5 * thick],
        }
    }
    return kolk.Scene(
        name="paddle",
        dimension=2,
        spacing=spacing,
        gravity=[0.0, -GRAVITY],
        until=10.0,
        fluid=[
            {
                "name": "water",
                "shape": {
                    "difference": {
                        "of": {"box": {"from": [0.0, 0.0], "to": [SIDE, 0.6 * SIDE]}},
                        "minus": [blade],
                    }
                },
                "viscosity": {"artificial": 0.02},
            }
        ],
        wall=[
            {
                "name": "tank",
                # Closed: what splashes over a rim would be lost and no leak.
                "shape": {"tank": {"from": [0.0, 0.0], "to": [SIDE, SIDE], "open": []}},
            },
            {
                "name": "paddle",
                "shape": blade,
                "motion": {"rotate": {"centre": middle, "rate": 2.0 * math.pi}},
            },
        ],
    )


def run(variant: str) -> Result:
    turns = number(variant)
    sim = simulation(scene(40 if turns < 2 else 80))
    watch = Watch(sim).run(turns, 20)
    tip = 2.0 * math.pi * LENGTH
    n = len(sim.bodies["water"])
    limits = [f for f in watch.figures(speed=5.0 * tip) if f.name != "leaks"]
    return watch.result(
        variant,
        *limits,
        Figure("share of particles that leaked", watch.leaks / n, most=1e-3),
    )


case = Case(
    title="Paddle past a wall",
    setup="A paddle turns once a second in a closed tank and passes its bottom at half a spacing.",
    failure="squeezed particles explode",
    run=run,
    short=("turns 0.5",),
    full=("turns 4",),
)
