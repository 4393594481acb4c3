"""Steps, outputs and restarts at awkward times."""

from __future__ import annotations

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import simulation


def scene() -> kolk.Scene:
    """A small dam break."""
    return kolk.load("dam-break").replace(spacing=0.03)


def differences(a: kolk.Simulation, b: kolk.Simulation) -> int:
    """Numbers in which two states differ."""
    first, second = a.state(), b.state()
    return sum(int(np.sum(first[name] != second[name])) for name in first)


def run(variant: str) -> Result:
    sim = simulation(scene())
    figures: list[Figure] = []
    if variant == "restart at every step":
        other = simulation(scene())
        for _ in range(40):
            sim.advance_to(1e9, 1)
            other.advance_to(1e9, 1)
            state, other = other.state(), simulation(scene())
            other.restore(state)
        figures.append(Figure("numbers that differ", differences(sim, other), most=0))
    elif variant == "outputs closer than a step":
        late = 0.0
        sim.advance(0.01)
        for k in range(1, 200):
            target = 0.01 + k * 1e-12
            sim.advance_to(target)
            late = max(late, abs(sim.time - target))
        figures.append(Figure("missed by", late, most=0.0, unit="s"))
        before = sim.bodies["water"].position
        sim.advance(0.05)
        moved = float(np.max(np.abs(sim.bodies["water"].position - before)))
        figures.append(Figure("moved in 0.05 s", moved, most=0.2, least=1e-4, unit="m"))
    elif variant == "no time at all":
        sim.advance(0.0)
        figures.append(Figure("steps", sim.step_count, most=0))
        sim.advance_to(1e-300)
        figures.append(Figure("time", sim.time, most=1e-300, least=1e-300, unit="s"))
    else:
        fixed = simulation(scene().replace({"numerics.time_step": 2e-4}))
        for k in range(1, 100):
            fixed.advance_to(k * 1e-3 / 3.0)
        error = abs(fixed.time - 33e-3)
        figures.append(Figure("time that adds up wrong", error, most=1e-15, unit="s"))
    return Result(variant, tuple(figures), steps=sim.step_count)


VARIANTS = ("restart at every step", "outputs closer than a step", "no time at all", "fixed steps")

case = Case(
    title="Awkward times",
    setup="A restart after every step, outputs 1e-12 s apart, runs of no length, fixed steps that "
    "do not fit the outputs.",
    failure="drift, off by one",
    run=run,
    short=VARIANTS,
    full=VARIANTS,
)
