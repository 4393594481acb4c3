"""One particle, two, and three in a row."""

from __future__ import annotations

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, simulation

SPACING = 0.01


def scene(position: list[list[float]], gravity: bool) -> kolk.Scene:
    """Own particles in free space, all with the same velocity."""
    n = len(position)
    return kolk.Scene(
        name="few",
        dimension=2,
        spacing=SPACING,
        until=1e9,
        **({"gravity": [0.0, -9.81]} if gravity else {}),
        fluid=[
            kolk.Fluid.from_arrays(
                position=np.array(position),
                velocity=np.tile([1.0, 2.0], (n, 1)),
                sound_speed=20.0,
            )
        ],
    )


def run(variant: str) -> Result:
    kind, _, count = variant.partition(", steps ")
    steps = int(count)
    if kind == "one in free flight":
        sim = kolk.Simulation(scene([[0.0, 0.0]], True), precision="f64", threads=1)
        sim.advance_to(1e9, steps)
        t = sim.time
        exact = np.array([t, 2.0 * t - 0.5 * 9.81 * t * t])
        error = np.max(np.abs(sim.bodies["fluid"].position[0] - exact) / np.abs(exact))
        return Watch(sim).result(variant, Figure("error of the parabola", float(error), most=1e-12))
    apart = 1.9 * 2.0 * SPACING if kind == "two at 1.9 h" else SPACING
    many = 2 if kind == "two at 1.9 h" else 3
    sim = simulation(scene([[k * apart, 0.0] for k in range(many)], False))
    watch = Watch(sim).steps(steps, 5)
    fluid = sim.bodies["fluid"]
    centre = (
        fluid.position.mean(axis=0) - [0.5 * (many - 1) * apart, 0.0] - [sim.time, 2 * sim.time]
    )
    return watch.result(
        variant,
        Figure("drift of the centre / way", float(np.max(np.abs(centre))) / sim.time, most=1e-5),
        Figure("closest pair", watch.closest, least=0.3, unit="Δp"),
        Figure("largest speed", watch.speed, most=3.5, unit="m/s"),
    )


KINDS = ("one in free flight", "two at 1.9 h", "three in a row")

case = Case(
    title="Few particles",
    setup="One particle in free flight under gravity, two at a distance of 1.9 h, three in a row.",
    failure="divisions by sums over no neighbours, singular matrices, endless time steps",
    run=run,
    short=tuple(f"{kind}, steps 5000" for kind in KINDS),
    full=(f"{KINDS[0]}, steps 1000000", *(f"{kind}, steps 100000" for kind in KINDS[1:])),
)
