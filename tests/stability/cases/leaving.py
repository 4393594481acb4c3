"""Particles that leave, and particles exactly on the ends of a period."""

from __future__ import annotations

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import simulation

SPACING = 0.02


def blob(position: np.ndarray[tuple[int, int], np.dtype[np.float64]], **keys: object) -> kolk.Scene:
    """Own particles that fly to all sides."""
    middle = position.mean(axis=0)
    return kolk.Scene(
        name="leaving",
        dimension=2,
        spacing=SPACING,
        until=1e9,
        fluid=[
            kolk.Fluid.from_arrays(
                position=position, velocity=30.0 * (position - middle), sound_speed=30.0
            )
        ],
        **keys,  # type: ignore[arg-type]
    )


def run(variant: str) -> Result:
    at = SPACING * np.arange(12)
    if variant == "on the ends of a period":
        length = 12 * SPACING
        # Columns at both ends of the period would be one: those at the upper end are half between.
        position = np.stack([g.ravel() for g in np.meshgrid(at, at)], axis=1)
        position[position[:, 0] == 0.0, 0] = np.where(np.arange(12) % 2 == 0, 0.0, length)
        scene = blob(position, periodic={"x": [0.0, length], "y": [0.0, length]})
    else:
        scene = blob(np.stack([g.ravel() for g in np.meshgrid(at, at)], axis=1))
    sim = simulation(scene)
    before = sim.bodies["fluid"].mass
    if variant == "far away":
        state = sim.state()
        state["position_0"][5], state["position_1"][7] = 1e12, -1e15
        sim.restore(state)
    sim.advance_to(1e9, 600)
    fluid = sim.bodies["fluid"]
    numbers = [fluid.position, fluid.velocity, fluid.density]
    return Result(
        variant,
        (
            Figure(
                "numbers that are none", sum(int((~np.isfinite(n)).sum()) for n in numbers), most=0
            ),
            Figure("particles lost", len(before) - len(np.unique(fluid.id)), most=0),
            Figure("change of mass", abs(float(fluid.mass.sum() / before.sum()) - 1.0), most=0.0),
        ),
        particles=len(before),
        steps=sim.step_count,
        retries=sum(sim.retries["retries"].values()),
    )


VARIANTS = ("bursting", "far away", "on the ends of a period")

case = Case(
    title="Particles that leave",
    setup="A bursting blob in free space, particles 1e12 m and more away, and particles exactly "
    "on the ends of a period.",
    failure="overflow of the grid, panic",
    run=run,
    short=VARIANTS,
    full=VARIANTS,
    remarks="kolk has no domain to leave: the grid is a torus, and nothing is removed.",
)
