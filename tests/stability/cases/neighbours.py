"""The search for neighbours where it is hardest."""

from __future__ import annotations

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import simulation

SPACING = 0.01


def scene(position: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> kolk.Scene:
    """Own particles in free space."""
    return kolk.Scene(
        name="stress",
        dimension=2,
        spacing=SPACING,
        until=1e9,
        fluid=[
            kolk.Fluid.from_arrays(
                position=position,
                sound_speed=10.0,
                density=np.full(len(position), 1000.0),
                mass=np.full(len(position), 1000.0 * SPACING**2),
            )
        ],
    )


def run(variant: str) -> Result:
    count = int(variant.split()[0])
    random = np.random.default_rng(2)
    nominal = 300 * count
    if "one cell" in variant:
        position = SPACING * random.uniform(0.0, 1.0, (count, 2))
    elif "aspect" in variant:
        position = np.stack([1e6 * SPACING * np.linspace(0.0, 1.0, count), np.zeros(count)], axis=1)
    else:
        position = np.concatenate(
            [SPACING * random.uniform(0.0, 64.0**k, (count // 4, 2)) for k in range(4)]
        )
    sim = simulation(scene(position))
    sim.advance_to(1e9, 2)
    state = [v for v in sim.state().values() if v.dtype.kind == "f"]
    bad = sum(int((~np.isfinite(v)).sum()) for v in state)
    return Result(
        variant,
        (
            Figure("numbers that are none", bad, most=0),
            Figure("memory / nominal", sum(sim.memory.values()) / nominal, most=4.0),
        ),
        particles=count,
        steps=sim.step_count,
        retries=sum(sim.retries["retries"].values()),
    )


case = Case(
    title="Neighbour search under stress",
    setup="All particles in one cell, along a line of 1e6 spacings, and in clouds from one spacing "
    "to 64³ across. One smoothing length: other ratios do not exist.",
    failure="quadratic time, memory",
    run=run,
    short=("2000 in one cell", "2000 with an aspect of 1e6", "2000 in clouds"),
    full=("100000 in one cell", "100000 with an aspect of 1e6", "100000 in clouds"),
)
