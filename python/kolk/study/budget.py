"""The finest run within a budget of time, by the estimate, piloted where it leads to."""

from __future__ import annotations

import math
import time as clock

from kolk.progress import duration
from kolk.scene import Scene

from .estimate import CostModel, calibrate
from .known import study_of
from .ladder import DEFAULT, Variant, fits, snapped_finer
from .promise import USED, Limits, Promise, PromiseError
from .study import Study
from .words import percent

PILOT = 3.0
"""Seconds of a pilot, at most a fiftieth of the budget, but at least half a second."""

NEAR = 0.1
"""Logarithm of a ratio of spacings within which another pilot would tell nothing new."""

SHARE_OF_PILOTS = 0.15
"""Share of a budget after which no further pilot is flown."""

FEWEST_ACROSS = 8
"""Particles across the thinnest extent of the fluid in the coarsest run that a budget may get."""


def for_budget(scene: Scene, budget: float, quantity: str | None, limits: Limits) -> Promise:
    """See `promise.choose`; raises what it raises."""
    begun, threads = limits.begun, limits.threads
    study = study_of(scene)
    variant = _best_for(study, budget) if study is not None else Variant(DEFAULT)
    base = variant.scene(scene, scene.spacing)
    precision = variant.precision or limits.precision
    seconds = min(PILOT, max(0.5, budget / 50.0))
    model = calibrate(base, precision=precision, threads=threads, seconds=seconds)
    spacing = base.spacing
    for _ in range(2):
        spent = clock.perf_counter() - begun
        spacing = _spacing_within(model, USED * (budget - spent))
        if abs(math.log(spacing / model.fine.spacing)) < NEAR or spent > SHARE_OF_PILOTS * budget:
            break
        # Again where the run will be: what a step costs changes with the number of particles.
        coarse = model.coarse if not model.fine.whole else None
        model = calibrate(
            base.replace(spacing=spacing),
            precision=precision,
            threads=threads,
            seconds=seconds,
            coarse=coarse if coarse is not None else model.fine,
        )
    left = USED * (budget - (clock.perf_counter() - begun))
    spacing = snapped_finer(base, _spacing_within(model, left))
    if model.wall(spacing) > left:
        spacing = _spacing_within(model, left)
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
        begun=begun,
    )


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
    low, high = math.log(coarsest) - math.log(64.0), math.log(coarsest)
    for _ in range(40):
        middle = 0.5 * (low + high)
        if model.wall(math.exp(middle)) > seconds:
            low = middle
        else:
            high = middle
        if high - low < 0.002:
            break
    spacing = math.exp(high)
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
