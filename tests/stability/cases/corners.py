"""Tanks with corners that are not right angles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, simulation

DEPTH, GRAVITY, DENSITY = 0.3, 9.81, 1000.0


def toe() -> list[list[float]]:
    """An acute toe of 30 degrees in the lower right corner."""
    return [
        [0.0, 0.0],
        [0.3 + DEPTH / math.tan(math.radians(30.0)), 0.0],
        [0.3, DEPTH],
        [0.0, DEPTH],
    ]


def step() -> list[list[float]]:
    """A step in the bottom: a re-entrant corner of 270 degrees."""
    return [[0.0, 0.0], [0.3, 0.0], [0.3, 0.12], [0.6, 0.12], [0.6, DEPTH], [0.0, DEPTH]]


def wedge() -> list[list[float]]:
    """A bottom that ends in a wedge of 15 degrees."""
    half = DEPTH * math.tan(math.radians(7.5))
    return [[0.0, -0.3], [half * 2.0, DEPTH], [-half * 2.0, DEPTH]]


SHAPES = {"toe of 30°": toe, "step of 270°": step, "wedge of 15°": wedge}


def scene(corners: list[list[float]], spacing: float, packed: bool) -> kolk.Scene:
    """Water at rest that fills the shape; walls all around, and above where it ends."""
    water: dict[str, Any] = {"polygon": {"points": corners}}
    # A whole number of spacings beyond: walls and water on one lattice.
    beyond = spacing * round(0.2 / spacing)
    low, high = np.min(corners, axis=0) - beyond, np.max(corners, axis=0) + beyond
    # The shape's sides carried on upwards, so that the surface is free.
    points = np.array(corners)
    top = points[points[:, 1] > DEPTH - 1e-9]
    (left, right), under, over = sorted(top[:, 0].tolist()), DEPTH - 1e-6, float(high[1])
    up = [[left, under], [right, under], [right, over], [left, over]]
    solid = {"box": {"from": low.tolist(), "to": high.tolist()}}
    return kolk.Scene(
        name="corner",
        dimension=2,
        spacing=spacing,
        gravity=[0.0, -GRAVITY],
        until=10.0,
        fluid=[
            {
                "name": "water",
                "shape": water,
                "viscosity": {"artificial": 0.02},
                "arrangement": "packed" if packed else "lattice",
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {
                    "difference": {"of": solid, "minus": [water, {"polygon": {"points": up}}]}
                },
            }
        ],
    )


def level(sim: kolk.Simulation) -> float:
    """Height in m of the surface in the middle: where half of the kernel is filled."""
    heights = np.linspace(0.8, 1.2, 401) * DEPTH
    middle = 0.0 if sim.initial["water"].position[:, 0].min() < -0.01 else 0.15
    points = np.stack([np.full(len(heights), middle), heights], axis=1)
    fill = sim.sample(points, ["fill"])["fill"]
    return float(heights[np.argmin(np.abs(fill - 0.5))])


def run(variant: str) -> Result:
    kind, _, resolution = variant.partition(", H/Δp = ")
    spacing = DEPTH / float(resolution)
    shape, _, packed = kind.partition(", ")
    sim = simulation(scene(SHAPES[shape](), spacing, bool(packed)))
    time = math.sqrt(DEPTH / GRAVITY)
    watch = Watch(sim).run((20.0 if float(resolution) > 30 else 8.0) * time, 10)
    # Along x = 0, the left wall or the wedge's middle, away from any corner. The level
    # is measured: how much of the space a wall made of particles takes is another matter.
    heights = np.linspace(0.35, 0.7, 8) * DEPTH
    points = np.stack([np.zeros(len(heights)), heights], axis=1)
    errors = np.zeros(len(heights))
    for _ in range(20):
        sim.advance(0.05 * time)
        pressure = sim.sample(points, ["pressure"])["pressure"]
        errors += (pressure - DENSITY * GRAVITY * (level(sim) - heights)) / 20
    error = float(np.max(np.abs(errors))) / (DENSITY * GRAVITY * DEPTH)
    water = sim.bodies["water"]
    mass = float(water.mass.sum())
    return watch.result(
        variant,
        *watch.figures(speed=0.3 * math.sqrt(2.0 * GRAVITY * DEPTH)),
        Figure("error of pressure / (ρgH)", error, most=0.03),
        Figure(
            "kinetic energy / (m g H)", sim.energy.kinetic / (mass * GRAVITY * DEPTH), goal=1e-6
        ),
    )


KINDS = (*SHAPES, "wedge of 15°, packed")

case = Case(
    title="Acute, re-entrant and wedge-shaped corners",
    setup="Water at rest over a toe of 30°, a step with a corner of 270°, in a wedge of 15°.",
    failure="particles stuck in the corner, leaks",
    run=run,
    short=tuple(f"{kind}, H/Δp = 20" for kind in KINDS),
    full=tuple(f"{kind}, H/Δp = 50" for kind in KINDS),
    remarks="""A lattice does not fit a wedge of 15°: particles of wall and water start nearer than
half a spacing to each other and fly apart, and the water swells. `kolk check` counts them
beforehand and names the remedy, `arrangement = "packed"`; the guard goes back twice and ends in a
sound state that is not the right one. Tried with the lattice at H/Δp = 20, 8 √(H/g), error of the
pressure / ρgH: default 15 %, `dynamic` walls 4.1 %, `modified-dynamic` 8.8 %, `semi-analytical`
45 %, `penalty` 6.3 %, Courant number 0.2 9.7 %, no shifting 1.6 % (but speeds of 0.9 of the
limit); `mirror` is for right angles. Packed: default 0.17 %, `dynamic` 0.21 %, `modified-dynamic`
0.28 %, `semi-analytical` 3.3 %, `penalty` 5.1 %.""",
)
