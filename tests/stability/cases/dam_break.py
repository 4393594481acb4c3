"""Dam break on a dry bed."""

from __future__ import annotations

import math

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

HEIGHT, GRAVITY, TANK = 0.3, 9.81, (1.61, 0.6)


def run(variant: str) -> Result:
    resolution = number(variant)
    # With a roof: what splashes over the open tank's wall would be lost and no leak.
    roofed = {"tank": {"from": [0.0, 0.0], "to": list(TANK), "open": []}}
    scene = kolk.load("dam-break").replace(
        {"spacing": HEIGHT / resolution, "wall.tank.shape": roofed}
    )
    long = 20.0 if resolution >= 40 else 8.0
    watch = Watch(simulation(scene)).run(long * math.sqrt(HEIGHT / GRAVITY), 60)
    energy = 0.5 * 1000.0 * GRAVITY * HEIGHT**2 * 0.6
    return watch.result(
        variant,
        *watch.figures(speed=1.5 * math.sqrt(2.0 * GRAVITY * (HEIGHT + TANK[1]))),
        Figure("growth of energy / initial", watch.growth / energy, most=1e-3),
    )


case = Case(
    title="Dam break on a dry bed",
    setup="The built-in dam break under a roof to 20 √(H/g), through impact, roll-over, sloshing.",
    failure="leaks through roof and corners, explosion where the cavity closes",
    run=run,
    short=("H/Δp = 20",),
    full=("H/Δp = 40", "H/Δp = 80", "H/Δp = 160", "H/Δp = 320"),
)
