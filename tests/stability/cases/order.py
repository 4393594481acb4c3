"""Threads, and the order in which particles are given."""

from __future__ import annotations

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import number


def scene(
    spacing: float, order: np.ndarray[tuple[int], np.dtype[np.int64]] | None = None
) -> kolk.Scene:
    """A small dam break; the water's particles in another order."""
    plain = kolk.load("dam-break").replace(spacing=spacing)
    if order is None:
        return plain
    body = plain.bodies()[0]
    water = plain.fluid[0]
    return plain.replace(
        fluid=[
            kolk.Fluid.from_arrays(
                name="water",
                position=body.position[order],
                velocity=body.velocity[order],
                density=body.density[order],
                mass=body.mass[order],
                sound_speed=plain.sound_speed,
                viscosity=water.viscosity,
            )
        ]
    )


def run(variant: str) -> Result:
    steps = int(number(variant))
    # 1000 steps of the finer one end before the water is at the end wall.
    spacing = 0.005 if "before" in variant else 0.02
    plain = scene(spacing)
    if variant.startswith("threads"):
        ends = []
        for threads in (1, 2, 3, 8):
            sim = kolk.Simulation(plain, threads=threads)
            sim.advance_to(1e9, steps)
            ends.append(sim.state())
        differing = sum(
            int(np.sum(ends[0][name] != end[name])) for end in ends[1:] for name in ends[0]
        )
        figures = (Figure("numbers that differ", differing, most=0),)
        return Result(variant, figures, steps=steps)
    n = len(plain.bodies()[0])
    order = np.random.default_rng(5).permutation(n)
    first = kolk.Simulation(scene(spacing, np.arange(n)), precision="f64", threads=1)
    second = kolk.Simulation(scene(spacing, order), precision="f64", threads=1)
    first.advance_to(1e9, steps)
    second.advance_to(1e9, steps)
    apart = first.bodies["water"].position[order] - second.bodies["water"].position
    worst = float(np.max(np.abs(apart))) / plain.spacing
    most, goal = (None, 1e-9) if "through" in variant else (1e-9, None)
    figure = Figure("positions differ by", worst, most=most, goal=goal, unit="Δp")
    return Result(variant, (figure,), steps=steps)


case = Case(
    title="Threads and order",
    setup="A dam break on 1, 2, 3 and 8 threads; in double precision with shuffled particles.",
    failure="races",
    run=run,
    short=("threads, steps 60", "shuffled, steps 100"),
    full=(
        "threads, steps 1000",
        "shuffled, before the impact, steps 1000",
        "shuffled, through the impact, steps 1000",
    ),
    remarks="Bits are the same for any number of threads. Particles in another order are summed in "
    "another order: equal to rounding, until the flow, which is chaotic from the impact on, "
    "magnifies it; after that 1e-9 is a goal.",
)
