"""A study in plain sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from kolk.progress import duration

from .curve import Curve, Ladder
from .quantity import Quantity

if TYPE_CHECKING:
    from .study import Study

TARGETS = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
"""Errors that sentences are made for, where the ladder reaches them."""

MOST_TARGETS = 3

ALIKE = 0.05
"""Factors closer to 1 than this are not worth a word."""


def sentences(study: Study) -> list[str]:
    """What the study shows, the leading error first."""
    base = study.base
    if not base.records:
        return ["No run reached its end, so that there is nothing to say.", *_failures(study)]
    curve = study.curve()
    found = [_what(study, curve), order_sentence(curve)]
    found += _targets(study, curve)
    found += _alternatives(study)
    found += _bars(study)
    if curve.basis == "extrapolation" and base.records[0].scores:
        found += _experiment(base)
    return [*found, *_failures(study), *_remarks(study)]


def percent(share: float) -> str:
    """A share as per cent with two digits."""
    if not math.isfinite(share):
        return "an unknown share"
    return f"{100.0 * share:.2g} %" if share < 0.0995 else f"{100.0 * share:.0f} %"


def _what(study: Study, curve: Curve) -> str:
    runs = sum(map(len, study.records.values()))
    what = {
        "analytic": f"against the exact solution ({curve.name})",
        "experiment": f"against the experiment ({curve.name})",
        "extrapolation": f"of {curve.name}, against their extrapolation to spacing zero",
    }[curve.basis]
    spacing = curve.spacing
    return (
        f"{study.scene.title or study.scene.name}: {runs} run{'s' * (runs != 1)} at spacings from "
        f"{spacing[0]:.4g} to {spacing[-1]:.4g} m; errors are {what}, "
        f"{percent(curve.error[0])} at the coarsest and {percent(_finest(curve))} at the finest."
    )


def _finest(curve: Curve) -> float:
    known = [float(e) for e in curve.error if math.isfinite(e)]
    return known[-1] if known else math.nan


def order_sentence(curve: Curve) -> str:
    """The observed order with its interval, or why there is none."""
    if not curve.verdict.sound:
        return f"No order can be stated: {curve.verdict.reason}."
    order, low, high = curve.order
    if math.isfinite(low) and math.isfinite(high):
        return f"The error falls with order {order:.2f} (95 %: {low:.2f} to {high:.2f})."
    return (
        f"The error falls with order {order:.2f}; three levels leave nothing over to tell how "
        "surely."
    )


def _targets(study: Study, curve: Curve) -> list[str]:
    reachable = [(target, h) for target in TARGETS if math.isfinite(h := curve.spacing_for(target))]
    if not reachable:
        best = curve.promised(float(curve.spacing[-1]))
        told = f"; the finest run is within {percent(best)}" if math.isfinite(best) else ""
        return [f"No error can be promised from this ladder{told}."]
    # An error that the coarsest level meets already is worth a word only if it is the last.
    met = [h >= curve.spacing[0] * (1 - 1e-9) for _, h in reachable]
    asked = [pair for pair, early in zip(reachable, met, strict=True) if not early] or reachable[
        -1:
    ]
    cost = study.base.cost
    found = []
    for target, h in asked[-MOST_TARGETS:]:
        seconds = "" if cost is None else f": about {duration(cost.value(h))}"
        found.append(
            f"For {percent(target)} take a spacing of {h:.3g} m{seconds} "
            f"({percent(curve.expected(h))} to be expected)."
        )
    return found


def _alternatives(study: Study) -> list[str]:
    found = []
    for label, rungs in study.ladders.items():
        if rungs is not study.base and rungs.records:
            found.append(alternative(study, label))
    return found


def alternative(study: Study, label: str) -> str:
    """One variant against the scene as it is: by which factor it is cheaper, and why."""
    rungs, base = study.ladders[label], study.base
    theirs, ours = study.curve(variant=label), study.curve()
    time, error = _at_same_spacing(base, rungs, ours, theirs)
    gain = saving(base, rungs, ours, theirs)
    because = (
        f"at the same spacing its runs take {time:.2f} times the time and have {error:.2f} times "
        "the error"
    )
    if not math.isfinite(gain):
        return f"{label}: {because}; for the same error no time can be told from these levels."
    if abs(gain - 1.0) < ALIKE:
        return f"{label} costs as much as the scene as it is for the same error: {because}."
    word = (
        f"cheaper by a factor of {gain:.2f}"
        if gain > 1.0
        else (f"dearer by a factor of {1.0 / gain:.2f}")
    )
    return f"{label} is {word} than the scene as it is for the same error, because {because}."


def _at_same_spacing(
    base: Ladder, rungs: Ladder, ours: Curve, theirs: Curve
) -> tuple[float, float]:
    """Geometric means over the common spacings of the ratios of time and of error."""
    wall = {round(math.log(r.spacing), 6): r.costs.wall for r in base.records}
    error = {round(math.log(h), 6): e for h, e in zip(ours.spacing, ours.error, strict=True)}
    times = [
        r.costs.wall / wall[k]
        for r in rungs.records
        if (k := round(math.log(r.spacing), 6)) in wall
    ]
    errors = [
        e / error[k]
        for h, e in zip(theirs.spacing, theirs.error, strict=True)
        if error.get(k := round(math.log(h), 6), 0.0) > 0.0 and e > 0.0
    ]
    return _mean(times), _mean(errors)


def _mean(ratios: Sequence[float]) -> float:
    return math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else math.nan


def saving(base: Ladder, rungs: Ladder, ours: Curve, theirs: Curve) -> float:
    """Time of the base over the variant's for the same error, in the middle of both curves.

    NaN where the curves do not overlap, or one of them does not fall.
    """
    laws = (ours.law, theirs.law, base.cost, rungs.cost)
    if any(law is None for law in laws) or min(ours.spacing.size, theirs.spacing.size) < 2:
        return math.nan
    our_law, their_law, our_cost, their_cost = laws
    assert our_law and their_law and our_cost and their_cost
    if our_law.order <= 0.2 or their_law.order <= 0.2:
        return math.nan
    low = max(min(ours.error), min(theirs.error))
    high = min(max(ours.error), max(theirs.error))
    if low > 2.0 * high:
        return math.nan
    middle = math.sqrt(low * high)
    return our_cost.value(our_law.spacing_for(middle)) / their_cost.value(
        their_law.spacing_for(middle)
    )


def _bars(study: Study) -> list[str]:
    """The error bar of every probe at the scene's own spacing, or at the nearest level."""
    base = study.base
    if len(base.records) < 3:
        return []
    spacing = base.spacing
    level = int(
        min(range(len(spacing)), key=lambda i: abs(math.log(spacing[i] / study.scene.spacing)))
    )
    bars = [
        f"{q.name} ± {percent(q.level_bar(level))}" + _order_of(q)
        for q in base.quantities
        if math.isfinite(q.level_bar(level))
    ]
    if not bars:
        return []
    return [
        f"Error bars at {spacing[level]:.4g} m, of each probe's largest value, over the whole "
        f"record: {', '.join(bars)}."
    ]


def _order_of(quantity: Quantity) -> str:
    if not quantity.verdict.sound or quantity.expansion is None:
        return ""
    return f" (order {quantity.expansion.free_order:.1f})"


def _experiment(base: Ladder) -> list[str]:
    return [score.sentence for score in base.records[-1].scores[:1]]


def _failures(study: Study) -> list[str]:
    return [
        f"{label} at {record.spacing:.4g} m ended early ({record.outcome}): {record.reason}"
        for label, rungs in study.ladders.items()
        for record in rungs.failed
    ]


def _remarks(study: Study) -> list[str]:
    records = [r for runs in study.records.values() for r in runs]
    apart = sum(not record.alone for record in records)
    busy = sum(record.disturbed for record in records) - apart
    found = []
    if apart:
        found.append(
            f"{apart} of {len(records)} runs shared their machine with others of the study: their "
            "times are no measure of speed."
        )
    if busy:
        found.append(
            f"Other programs took part of the machine during {busy} of {len(records)} runs: their "
            "wall times are too long; CPU times are nearer to the truth."
        )
    return [*found, *study.notes]
