"""Drops that stretch and oscillate."""

from __future__ import annotations

from ...validation.drop_central_force import case as oscillating
from ...validation.stretching_drop import case as stretching
from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

STRETCHING, OSCILLATING = "stretching, R/Δp =", "20 periods, R/Δp ="


def run(variant: str) -> Result:
    resolution = int(number(variant))
    return stretch(variant, resolution) if "stretch" in variant else oscillate(variant, resolution)


def stretch(variant: str, resolution: int) -> Result:
    sim = simulation(stretching.scene(resolution))
    watch = Watch(sim)
    watch.look()
    return watch.result(
        variant,
        Figure("error of the semi-axes", stretching.stretch(sim, watch.look).axes, most=0.01),
        # At the ends of the long axis.
        *watch.figures(speed=1.5 * stretching.RATE * 4.0 * stretching.RADIUS),
    )


def oscillate(variant: str, resolution: int) -> Result:
    sim = simulation(oscillating.stepped(oscillating.scene(resolution)))
    watch = Watch(sim)
    watch.look()
    found = oscillating.oscillate(sim, 20, watch.look)
    return watch.result(
        variant,
        Figure("error of the period", found.period, most=0.005),
        Figure("energy lost a period", found.lost, most=0.05, goal=0.01),
        Figure("error of the semi-axes", found.axes),
        *watch.figures(speed=1.5 * 1.5 * oscillating.RATE * oscillating.RADIUS),
    )


case = Case(
    title="Drops in motion",
    setup="A free disc of fluid that stretches until it is four times as long as wide (tA = 0.82), "
    "and one that oscillates under a central force for twenty periods.",
    failure="rotation, disintegration",
    run=run,
    short=(f"{STRETCHING} 20",),
    full=(f"{STRETCHING} 50", f"{OSCILLATING} 50"),
)
