"""Dam break on a dry bed."""

from __future__ import annotations

import math

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

HEIGHT, GRAVITY = 0.3, 9.81


def run(variant: str) -> Result:
    resolution = number(variant)
    scene = kolk.load("dam-break").replace(spacing=HEIGHT / resolution)
    long = 20.0 if resolution >= 40 else 8.0
    watch = Watch(simulation(scene)).run(long * math.sqrt(HEIGHT / GRAVITY), 60)
    top = scene.wall[0].shape.shape.bounds()[1][1]  # type: ignore[union-attr]
    energy = 0.5 * 1000.0 * GRAVITY * HEIGHT**2 * 0.6
    return watch.result(
        variant,
        *watch.figures(speed=1.5 * math.sqrt(2.0 * GRAVITY * (HEIGHT + top))),
        Figure("growth of energy / initial", watch.growth / energy, most=1e-3),
    )


case = Case(
    title="Dam break on a dry bed",
    setup="The built-in dam break to 20 √(H/g), through impact, roll-over and sloshing.",
    failure="leaks through roof and corners, explosion where the cavity closes",
    run=run,
    short=("H/Δp = 20",),
    full=("H/Δp = 40", "H/Δp = 80", "H/Δp = 160", "H/Δp = 320"),
)
