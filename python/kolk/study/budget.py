"""The finest run within a budget of time, by the estimate, piloted where it leads to."""

from __future__ import annotations

import math
import time as clock

from kolk.progress import duration
from kolk.scene import Scene
from kolk.simulation import Precision

from .cost import CostModel
from .estimate import HINDERED, affordable, survey
from .job import make_job
from .known import study_of
from .ladder import DEFAULT, Variant, fits, snapped
from .pilot import fly
from .promise import USED, Limits, Promise, PromiseError
from .study import Study
from .words import percent

SHARE_OF_SURVEY = 0.05
"""Share of a budget for a pilot of the whole scene."""

SHARE_OF_PILOT = 0.1
"""Share of a budget for a pilot at the spacing that is likely."""

SHORTEST = 0.5
"""Seconds that a pilot gets at least."""

LONGEST = 60.0
"""Seconds that the pilot at the likely spacing gets at most: then it knows what a step costs."""

NEAR = 0.2
"""Logarithm of a ratio of spacings within which another pilot would tell nothing new."""

MOST_PILOTS = 3
"""Pilots at a likely spacing at most."""

SHARE_OF_PILOTS = 0.3
"""Share of a budget after which no further pilot is flown."""

SNAPPED = 0.92
"""Least share of the time that is left that a spacing takes which fills the fluid evenly."""

FEWEST_ACROSS = 8
"""Particles across the thinnest extent of the fluid in the coarsest run that a budget may get."""


def for_budget(scene: Scene, budget: float, quantity: str | None, limits: Limits) -> Promise:
    """See `promise.choose`; raises what it raises."""
    begun = limits.begun
    study = study_of(scene)
    variant = _best_for(study, budget) if study is not None else Variant(DEFAULT)
    base = variant.scene(scene, scene.spacing)
    precision = variant.precision or limits.precision
    model = _piloted(base, budget, precision, limits)
    left = USED * (budget - (clock.perf_counter() - begun))
    spacing = _spacing_within(model, left)
    # One that fills the fluid with whole particles, where it takes about as long.
    even = snapped(base, spacing)
    if SNAPPED < model.wall(even) / left <= 1.0 / USED:
        spacing = even
    found = model.at(spacing)
    settings = "" if variant.label == DEFAULT else f" and {variant.label}"
    reasons = [
        f"Within {duration(budget)}: spacing {spacing:.4g} m{settings}, "
        f"{found.particles.value:,.0f} particles, about {found.steps.value:,.0f} steps, "
        f"{duration(found.wall.value)} ({duration(found.wall.low)} to "
        f"{duration(found.wall.high)}).",
        f"Why: the finest that a pilot on this machine leaves room for, of which "
        f"{duration(clock.perf_counter() - begun)} went into choosing. Pictures come after it.",
    ]
    promised = expected = None
    of = ""
    if study is not None:
        curve = study.curve(quantity, variant.label)
        of = curve.name
        promised, expected = curve.promised(spacing), curve.expected(spacing)
        if math.isfinite(promised):
            reasons.append(
                f"Its error ({of}) will be about {percent(expected)}, at most {percent(promised)}."
            )
        else:
            promised = expected = None
            reasons.append("The study that there is says nothing about so fine a spacing.")
    return Promise(
        scene=base.replace(spacing=spacing),
        precision=precision,
        tolerance=None,
        budget=budget,
        error=promised,
        expected=expected,
        of=of,
        wall=found.wall,
        reasons=tuple(reasons),
        study=study,
        variant=variant.label,
        steps=found.steps.value,
        begun=begun,
    )


def _piloted(base: Scene, budget: float, precision: Precision | None, limits: Limits) -> CostModel:
    """The cost model by pilots that go nearer and nearer to what the budget leads to.

    First the whole scene, coarse: how its steps change on the way. Then the first seconds at the
    spacing that this leads to: what a step costs there; and again where that leads far away, or
    where something else on the machine got in its way.
    """
    whole = survey(
        base,
        precision=precision,
        threads=limits.threads,
        seconds=max(SHORTEST, SHARE_OF_SURVEY * budget),
    )
    model = CostModel(base, whole, whole)
    seconds = min(max(SHORTEST, SHARE_OF_PILOT * budget), LONGEST)
    for _ in range(MOST_PILOTS):
        spacing = _spacing_within(model, USED * (limits.left - seconds))
        there = affordable(base.replace(spacing=spacing))
        settled = abs(math.log(there.spacing / model.fine.spacing)) < NEAR
        if settled and model.hindrance < HINDERED:
            break
        again = CostModel(base, whole, fly(make_job(there, precision, limits.threads), seconds))
        # Of two at about the same spacing the one that was less hindered.
        if not settled or again.hindrance < model.hindrance:
            model = again
        if limits.left < (1.0 - SHARE_OF_PILOTS) * budget:
            break
    return model


def _best_for(study: Study, seconds: float) -> Variant:
    """The variant with the least error for a time, as far as the study's laws go."""
    best, least = study.variants[0], math.inf
    for variant in study.variants:
        rungs = study.ladders[variant.label]
        if len(rungs.records) < 2 or rungs.cost is None or rungs.cost.order >= 0.0:
            continue
        law = study.curve(variant=variant.label).law
        if law is None or law.order <= 0.0:
            continue
        error = law.value(rungs.cost.spacing_for(seconds))
        # Only what pays for sure: a tenth, where the scatter of an error is more.
        if error < (least if variant is best else 0.9 * least):
            best, least = variant, error
    return best


def _spacing_within(model: CostModel, seconds: float) -> float:
    """The spacing (m) whose run takes so long. Raises `PromiseError` where the coarsest takes
    longer, or the memory does not hold the finest."""
    from kolk.scene.memory import available

    scene = model.scene
    coarsest = _coarsest(scene)
    shortest = model.at(coarsest).wall
    if shortest.value > seconds:
        raise PromiseError(
            f"budget: {duration(max(seconds, 0.0))} are left for the run, but the coarsest that "
            f"still is one ({coarsest:.3g} m, {FEWEST_ACROSS} particles across the fluid) takes "
            f"about {duration(shortest.value)}: give it {duration(2.0 * shortest.high)} or more"
        )
    spacing = model.spacing_for(seconds, coarsest)
    memory = model.at(spacing).memory
    if memory.high > available():
        raise PromiseError(
            f"budget: the finest run in {duration(seconds)} needs about {memory.value / 1e9:.2g} "
            f"GB, more than is free: choose a smaller budget, or a spacing (--spacing)"
        )
    return spacing


def _coarsest(scene: Scene) -> float:
    """The coarsest spacing (m) that still makes a flow."""
    body = scene.fluid[0]
    if body.shape is None:
        return scene.spacing
    low, high = body.shape.shape.bounds()
    spacing = float(min(high - low)) / FEWEST_ACROSS
    while spacing > scene.spacing and not fits(scene, spacing):
        spacing /= 1.2
    return max(spacing, scene.spacing)
