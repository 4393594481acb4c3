"""What a run will cost, before it: particles, memory, steps and time, each with its interval.

Two pilots: one of the whole scene on a coarse spacing, one of a few seconds at the wanted spacing,
or the nearest that can be afforded. What they tell of the run is in `cost`.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kolk.errors import KolkError, RunError, SceneError

from .cost import AFFORDABLE, POWER, CostModel, Estimate, Interval, estimated
from .job import make_job
from .ladder import snapped
from .pilot import Pilot, fly

if TYPE_CHECKING:
    from kolk.scene import Fluid, Scene
    from kolk.simulation import Precision

SECONDS = 3.0
"""Of steps in each pilot, unless it is over before."""

PATIENCE = 2.0
"""Times the seconds that a pilot of the whole scene may take, since all of it is needed."""

WORTH = 0.5
"""Share of its seconds from which a pilot of the whole scene need not be flown again, finer."""

HINDERED = 2.0
"""Standard deviations by which a pilot is too slow beyond which it is flown again."""

COARSE = 600
"""Particles that the coarse pilot has at least, where the scene has so many at all."""

COARSEST_ACROSS = 8
"""Particles across the thinnest extent of the fluid below which a flow is another one."""


def estimate(
    scene: Scene | str | Path,
    *,
    precision: Precision | None = None,
    threads: int = 0,
    seconds: float = SECONDS,
) -> Estimate:
    """Particles, memory, steps and wall time of a run, and its error where a study exists.

    Takes two pilot runs of about `seconds` of steps each, and one more where something else on the
    machine got in the way of the second. Raises `SceneError` for a scene that
    cannot run, `RunError` where a pilot fails.
    """
    if isinstance(scene, (str, Path)):
        from kolk.scene import load

        scene = load(scene)
    if not seconds > 0.0:
        raise KolkError(f"seconds: found {seconds!r}, must be above 0")
    model = calibrate(scene, precision=precision, threads=threads, seconds=seconds)
    return model.at(scene.spacing)


def calibrate(
    scene: Scene,
    *,
    precision: Precision | None = None,
    threads: int = 0,
    seconds: float = SECONDS,
) -> CostModel:
    """The cost model of a scene around its spacing."""
    wanted = affordable(scene)
    job = make_job(wanted, precision, threads)
    fine = fly(job, seconds)
    if fine.whole:
        return CostModel(scene, fine, fine)
    coarse = survey(
        wanted, precision=precision, threads=threads, seconds=seconds, finest=wanted.spacing
    )
    model = CostModel(scene, coarse, fine)
    if model.hindrance < HINDERED:
        return model
    again = CostModel(scene, coarse, fly(job, seconds))
    return min(model, again, key=lambda found: found.hindrance)


def survey(
    scene: Scene, *, precision: Precision | None, threads: int, seconds: float, finest: float = 0.0
) -> Pilot:
    """A pilot of the whole scene, as fine as some seconds allow, but no finer than `finest` (m).

    Particles so few that a step is all overhead tell little of how its time changes on the way.
    """
    coarsest = coarse_scene(scene)
    first = fly(make_job(coarsest, precision, threads), PATIENCE * seconds)
    took = float(first.table[-1, 2:].sum())
    if not first.whole or took > WORTH * seconds:
        return first
    # Steps go with the spacing as their limit does, their time with the particles.
    power = scene.dimension + POWER[first.limits[-1]]
    spacing = first.spacing * (took / seconds) ** (1.0 / power)
    spacing = snapped(scene, max(spacing, finest))
    if spacing > first.spacing / 1.25:
        return first
    second = fly(make_job(scene.replace(spacing=spacing), precision, threads), PATIENCE * seconds)
    return second if second.whole else first


def coarse_scene(scene: Scene) -> Scene:
    """The scene at the spacing of the coarse pilot: about COARSE particles, if that is resolved."""
    factor = (estimated(scene) / COARSE) ** (1.0 / scene.dimension)
    thinnest = min((_thinnest(body) for body in scene.fluid), default=0.0)
    if not thinnest:
        return scene
    factor = min(factor, thinnest / COARSEST_ACROSS / scene.spacing)
    while factor > 1.25:
        try:
            coarser = scene.replace(spacing=snapped(scene, scene.spacing * factor))
            coarser.bodies()
        except SceneError:
            factor /= 1.3
            continue
        return coarser
    return scene


def affordable(scene: Scene) -> Scene:
    """The scene, or at the finest spacing that a pilot can run at: filling takes seconds."""
    if estimated(scene) <= AFFORDABLE:
        return scene
    factor = (estimated(scene) / AFFORDABLE) ** (1.0 / scene.dimension)
    if any(body.shape is None for body in (*scene.fluid, *scene.wall)):
        raise RunError(
            "a scene of so many own particles cannot be made coarser for a pilot: run it for a few "
            "steps instead"
        )
    return scene.replace(spacing=scene.spacing * factor)


def _thinnest(body: Fluid) -> float:
    """Least extent of a fluid, m; 0 for own particles, which have no other spacing."""
    if body.shape is None:
        return 0.0
    low, high = body.shape.shape.bounds()
    return float(np.min(high - low))


__all__ = ["CostModel", "Estimate", "Interval", "calibrate", "coarse_scene", "estimate", "survey"]
