"""Particles in one place."""

from __future__ import annotations

import numpy as np

import kolk
from kolk.check import check

from ..suite import Case, Figure, Result
from ..watching import Watch, simulation

SPACING = 0.02


def run(variant: str) -> Result:
    apart = float(variant.removesuffix(" m apart"))
    at = SPACING * (np.arange(16) + 0.5)
    position = np.stack([g.ravel() for g in np.meshgrid(at, at)], axis=1)
    for a, b in ((40, 41), (100, 117), (200, 201), (200, 202)):
        position[a] = position[b] + [apart, 0.0]
    scene = kolk.Scene(
        name="coincident",
        dimension=2,
        spacing=SPACING,
        gravity=[0.0, -9.81],
        until=1.0,
        fluid=[kolk.Fluid.from_arrays(position=position, sound_speed=30.0, name="water")],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [0.32, 0.6], "open": ["top"]}},
            }
        ],
    )
    watch = Watch(simulation(scene)).steps(400, 8)
    water = watch.sim.bodies["water"]
    numbers = [water.position, water.velocity, water.density, water.pressure]
    bad = sum(int(np.sum(~np.isfinite(column))) for column in numbers)
    told = any("nearer than half a spacing" in w for w in check(scene).warnings)
    return watch.result(
        variant,
        Figure("numbers that are none", bad, most=0),
        Figure("told by kolk check", float(told), least=1),
        Figure("leaks", watch.leaks, most=0),
        Figure("largest density", watch.high, most=1.5, unit="ρ0"),
    )


VARIANTS = tuple(f"{apart:g} m apart" for apart in (0.0, 1e-300, 1e-16))

case = Case(
    title="Particles in one place",
    setup="Pairs and a heap of three in one place, or 1e-300 and 1e-16 m apart.",
    failure="zero divided by zero",
    run=run,
    short=VARIANTS,
    full=VARIANTS,
)
