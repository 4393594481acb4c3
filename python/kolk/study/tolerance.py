"""The cheapest run that promises a tolerance, by the study of the scene."""

from __future__ import annotations

import math

from kolk.errors import SceneError
from kolk.output.folder import safe_name
from kolk.progress import duration
from kolk.scene import Scene

from .curve import REACH, Curve
from .estimate import Interval
from .known import study_of
from .ladder import DEFAULT, RATIO, default_spacings, snapped, snapped_finer
from .promise import USED, Limits, Promise, PromiseError
from .store import STUDIES
from .study import Study, accuracy
from .words import percent

FIRST_LEVELS = 3
"""Levels of the study that a tolerance begins with; finer ones follow as they are needed."""

MOST_ROUNDS = 6
"""Levels that are added to it at most."""


def for_tolerance(scene: Scene, tolerance: float, quantity: str | None, limits: Limits) -> Promise:
    """See `promise.choose`; raises what it raises."""
    study = study_of(scene)
    if study is None or (quantity and quantity not in study.base.names):
        study = _study(scene, default_spacings(scene)[:FIRST_LEVELS], quantity, limits)
    elif quantity:
        study = _study(scene, study.base.spacing.tolist(), quantity, limits)
    for _ in range(MOST_ROUNDS):
        if not study.base.records:
            raise PromiseError("\n".join(["no run of the study reached its end", *study.sentences]))
        found = _cheapest(study, tolerance)
        if found is not None:
            return _promise(study, tolerance, found, limits)
        following = _next_level(study, tolerance)
        cost, curve = study.base.cost, study.curve()
        # The study would have to come within its reach of the spacing that the law leads to.
        wanted = math.nan if curve.law is None else REACH * curve.law.spacing_for(tolerance)
        needed = min(following, wanted) if 0.0 < wanted < following else following
        seconds = cost.value(needed) if cost is not None else 0.0
        if seconds > limits.longest_level:
            raise PromiseError(_refusal(study, curve, tolerance, seconds, limits))
        if curve.verdict.kind == "not falling" and len(study.base.records) > FIRST_LEVELS:
            raise PromiseError(_refusal(study, curve, tolerance, 0.0, limits))
        study = _study(scene, [*study.base.spacing.tolist(), following], quantity, limits)
    raise PromiseError(_refusal(study, study.curve(), tolerance, 0.0, limits))


def _study(scene: Scene, spacings: list[float], quantity: str | None, limits: Limits) -> Study:
    if not spacings:
        raise SceneError(f"spacing: found {scene.spacing:g} m, too coarse to be studied: refine it")
    return accuracy(
        scene,
        spacings,
        quantity=quantity,
        # Beside a study of the user's own, which may have tried settings.
        out=STUDIES / f"{safe_name(scene.name)}-for-tolerance",
        precision=limits.precision,
        threads=limits.threads,
        store=limits.store,
        quiet=limits.quiet,
    )


def _cheapest(study: Study, tolerance: float) -> tuple[str, float, float] | None:
    """Variant, spacing (m) and seconds of the cheapest run that promises the tolerance."""
    found: list[tuple[float, str, float]] = []
    for label, rungs in study.ladders.items():
        if len(rungs.records) < 2 or rungs.cost is None:
            continue
        spacing = study.curve(variant=label).spacing_for(tolerance)
        if math.isfinite(spacing):
            found.append((rungs.cost.value(spacing), label, spacing))
    if not found:
        return None
    seconds, label, spacing = min(found)
    return label, spacing, seconds


def _next_level(study: Study, tolerance: float) -> float:
    """The spacing that the study goes on with: where its law would have the tolerance, at most a
    halving finer and at least a fifth."""
    curve = study.curve()
    finest = float(curve.spacing[-1])
    wanted = curve.law.safe_spacing_for(tolerance) if curve.law is not None else math.nan
    if not math.isfinite(wanted):
        wanted = finest / RATIO
    following = snapped(study.scene, min(max(wanted, finest / 2.0), finest / 1.2))
    return following if following < finest * 0.99 else finest / RATIO


def _promise(
    study: Study, tolerance: float, found: tuple[str, float, float], limits: Limits
) -> Promise:
    label, spacing, _ = found
    variant = next(v for v in study.variants if v.label == label)
    rungs, curve = study.ladders[label], study.curve(variant=label)
    spacing = snapped_finer(study.scene, spacing)
    assert rungs.cost is not None
    low, high = rungs.cost.interval(spacing)
    wall = Interval(rungs.cost.value(spacing), low, high)
    if wall.value > limits.left:
        raise PromiseError(_too_dear(study, tolerance, wall, limits))
    promised, expected = curve.promised(spacing), curve.expected(spacing)
    settings = "" if label == DEFAULT else f" and {label}"
    reasons = [
        f"For {percent(tolerance)}: spacing {spacing:.4g} m{settings}, about "
        f"{duration(wall.value)}.",
        f"Why: over {len(rungs.records)} runs from {curve.spacing[0]:.4g} to "
        f"{curve.spacing[-1]:.4g} m the error ({curve.name}) leads to {percent(expected)} there, "
        f"and to no more than {percent(promised)} with 95 % certainty.",
    ]
    if settings:
        reasons.append(f"{label} has shown to pay in the study {study.folder}.")
    return Promise(
        scene=variant.scene(study.scene, spacing),
        precision=variant.precision or limits.precision,
        tolerance=tolerance,
        budget=limits.budget,
        error=promised,
        expected=expected,
        of=curve.name,
        wall=wall,
        reasons=tuple(reasons),
        study=study,
        variant=label,
        begun=limits.begun,
    )


def _nearest(study: Study) -> str:
    """The least error that the study can promise, and where."""
    curve = study.curve()
    best = curve.promised(curve.finest)
    where = curve.finest
    finest = float(curve.spacing[-1])
    if curve.promised(finest) < best:
        best, where = curve.promised(finest), finest
    if not math.isfinite(best):
        return "Nothing can be promised from this study."
    cost = study.base.cost
    time = f", about {duration(cost.value(where))}" if cost is not None else ""
    text = f"What can be promised is {percent(best)} at a spacing of {where:.3g} m{time}"
    others = [
        (study.curve(q.name).promised(finest), q.name)
        for q in study.base.quantities
        if q.verdict.sound and q.name != curve.name
    ]
    if others and curve.basis != "analytic":
        share, name = min(others)
        text += f"; of the probe {name} alone (--quantity {name}) {percent(share)}"
    return text + "."


def _refusal(study: Study, curve: Curve, tolerance: float, seconds: float, limits: Limits) -> str:
    if seconds:
        why = (
            f"the finest level that the study needs would take about {duration(seconds)}, and "
            f"{duration(max(limits.longest_level, 0.0))} are allowed for it"
        )
    elif curve.verdict.sound:
        why = f"the error ({curve.name}) does not come down to it within {MOST_ROUNDS} levels more"
    else:
        why = f"{curve.name}: {curve.verdict.reason}"
    return f"{percent(tolerance)} cannot be promised: {why}. {_nearest(study)}"


def _too_dear(study: Study, tolerance: float, wall: Interval, limits: Limits) -> str:
    cost, curve = study.base.cost, study.curve()
    left = max(limits.left, 0.0)
    nearest = _nearest(study)
    if cost is not None and left > 0.0 and cost.order < 0.0:
        affordable = max(cost.spacing_for(USED * left), curve.finest)
        if affordable <= float(curve.spacing[0]):
            promised = curve.promised(affordable)
            nearest = (
                f"Within the budget {percent(promised)} can be promised, at a spacing of "
                f"{affordable:.3g} m."
            )
    assert limits.budget is not None
    return (
        f"{percent(tolerance)} within {duration(limits.budget)} cannot be promised: the run would "
        f"take about {duration(wall.value)}, and {duration(left)} are left of the budget. {nearest}"
    )
