"""A plate of one layer between two tanks."""

from __future__ import annotations

import math

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

GRAVITY, DENSITY, HIGH, LOW, WIDTH = 9.81, 1000.0, 0.3, 0.15, 0.3


def scene(resolution: float) -> kolk.Scene:
    """Water at two levels, held apart by a plate one spacing thick."""
    spacing = HIGH / resolution
    left = {"box": {"from": [0.0, 0.0], "to": [WIDTH, HIGH]}}
    right = {"box": {"from": [WIDTH + spacing, 0.0], "to": [2 * WIDTH + spacing, LOW]}}
    return kolk.Scene(
        name="plate",
        dimension=2,
        spacing=spacing,
        gravity=[0.0, -GRAVITY],
        until=10.0,
        fluid=[
            {"name": "high", "shape": left, "viscosity": {"artificial": 0.02}},
            {"name": "low", "shape": right, "viscosity": {"artificial": 0.02}},
        ],
        wall=[
            {
                "name": "tank",
                "shape": {
                    "tank": {"from": [0.0, 0.0], "to": [2 * WIDTH + spacing, 0.45], "open": ["top"]}
                },
            },
            {
                "name": "plate",
                "shape": {"box": {"from": [WIDTH, 0.0], "to": [WIDTH + spacing, 0.45]}},
            },
        ],
    )


def run(variant: str) -> Result:
    resolution = number(variant)
    sim = simulation(scene(resolution))
    unit = math.sqrt(HIGH / GRAVITY)
    watch = Watch(sim).run((20.0 if resolution > 25 else 8.0) * unit, 10)
    total = 0.0
    for _ in range(20):
        sim.advance(0.05 * unit)
        total += float(sim.force("plate")["force"][0])
    exact = 0.5 * DENSITY * GRAVITY * (HIGH**2 - LOW**2)
    side = WIDTH + 0.5 * HIGH / resolution
    across = int(np.sum(sim.bodies["high"].position[:, 0] > side))
    across += int(np.sum(sim.bodies["low"].position[:, 0] < side))
    return watch.result(
        variant,
        *watch.figures(speed=0.5 * math.sqrt(GRAVITY * HIGH)),
        Figure("particles on the other side", across, most=0),
        Figure("error of the force on the plate", abs(total / 20 / exact - 1.0), most=0.02),
    )


case = Case(
    title="Plate of one layer",
    setup="Two tanks with water at 0.3 m and 0.15 m, held apart by a plate one spacing thick.",
    failure="leaks, and fluid that feels the fluid on the other side",
    run=run,
    short=("H/Δp = 20",),
    full=("H/Δp = 40",),
)
