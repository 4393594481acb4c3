"""Courant numbers from careful to absurd."""

from __future__ import annotations

import math

import kolk
from kolk.errors import InstabilityError

from ..suite import Case, Figure, Result
from ..watching import Watch, simulation

LADDER = (0.1, 0.4, 0.8, 1.2, 1.5, 2.0)


def scene(kind: str) -> kolk.Scene:
    """The flow of a variant, coarse."""
    if kind == "dam break":
        return kolk.load("dam-break").replace(spacing=0.3 / 20, until=0.6)
    return kolk.load("taylor-green").replace(spacing=1.0 / 30, until=0.5)


def energy(kind: str, courant: float) -> tuple[float, Watch]:
    """Kinetic energy at the end, J, and what was seen on the way."""
    sim = simulation(scene(kind).replace({"numerics.courant": courant}))
    watch = Watch(sim).run(sim.scene.until, 10)
    return sim.energy.kinetic, watch


def run(variant: str) -> Result:
    kind = variant
    careful, watch = energy(kind, 0.2)
    worst, retries, refused = 0.0, 0, 0
    for courant in LADDER:
        try:
            found, watch = energy(kind, courant)
        except InstabilityError:
            refused += 1
        else:
            worst = max(worst, abs(found / careful - 1.0))
            retries += sum(watch.sim.retries["retries"].values())
    return watch.result(
        variant,
        Figure("difference of kinetic energy to Courant 0.2", worst, most=0.1),
        Figure("runs stopped with a reason", refused),
        Figure("retries on the ladder", retries),
        Figure("not a number", float(math.isnan(worst)), most=0),
    )


case = Case(
    title="Courant numbers",
    setup=f"Taylor-Green vortex and dam break with Courant numbers {', '.join(map(str, LADDER))}.",
    failure="blows up unnoticed",
    run=run,
    short=("taylor-green",),
    full=("taylor-green", "dam break"),
)
