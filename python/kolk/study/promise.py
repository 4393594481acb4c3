"""Choosing the spacing for a tolerance or a budget, and saying at the end what became of it.

A tolerance is met by the study of the scene: the one that is there, or one made now, on levels that
grow finer until the wanted error is within reach. A budget is met by the estimate, piloted at the
spacing that it leads to. What neither can promise is refused with the nearest thing that they can.
"""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kolk.errors import KolkError
from kolk.progress import duration

from .estimate import Interval
from .ladder import DEFAULT
from .study import Study
from .words import percent

if TYPE_CHECKING:
    from kolk.results import Run
    from kolk.scene import Scene
    from kolk.simulation import Precision

LONGEST_LEVEL = 1800.0
"""Seconds that one more level of the study may take where there is no budget."""

SHARE_OF_STUDY = 0.25
"""Share of a budget that one more level of the study may take."""

USED = 0.96
"""Share of the remaining budget that a run is planned for."""


class PromiseError(KolkError):
    """What was asked for cannot be promised; the message says why, and what can be."""


@dataclass(frozen=True)
class Promise:
    """A run that was chosen, and what is promised of it."""

    scene: Scene
    precision: Precision | None
    tolerance: float | None
    budget: float | None
    """s"""
    error: float | None
    """Share that the error stays within, as the study says; None where no study says anything."""
    expected: float | None
    of: str
    """What the error is of."""
    wall: Interval
    """s, of the run alone."""
    reasons: tuple[str, ...]
    study: Study | None = field(default=None, repr=False)
    variant: str = DEFAULT
    steps: float = math.nan
    """Expected; NaN where nothing was piloted."""
    begun: float = field(default_factory=clock.perf_counter)
    """When the command began, by the clock of `time.perf_counter`."""

    def __str__(self) -> str:
        return "\n".join(self.reasons)


def choose(
    scene: Scene,
    *,
    tolerance: float | None = None,
    budget: float | None = None,
    quantity: str | None = None,
    precision: Precision | None = None,
    threads: int = 0,
    store: Path | None = None,
    quiet: bool = False,
) -> Promise:
    """The cheapest run that promises a tolerance (a share), or the finest within a budget (s).

    With both, the tolerance is met and the run must fit into the budget. quantity: see `accuracy`.
    Raises `PromiseError` for what cannot be promised, `SceneError`, `RunError`.
    """
    from .budget import for_budget
    from .tolerance import for_tolerance

    limits = Limits(budget, clock.perf_counter(), threads, precision, store, quiet)
    if tolerance is not None:
        if not 0.0 < tolerance < 1.0:
            raise PromiseError(f"tolerance: found {tolerance:g}, must be a share such as 2%")
        return for_tolerance(scene, tolerance, quantity, limits)
    if budget is None or not budget > 0.0:
        raise PromiseError(f"budget: found {budget!r}, must be a time above 0 such as 10min")
    return for_budget(scene, budget, quantity, limits)


@dataclass(frozen=True)
class Limits:
    """What a choice may spend, and how runs are made."""

    budget: float | None
    begun: float
    threads: int
    precision: Precision | None
    store: Path | None
    quiet: bool

    @property
    def left(self) -> float:
        """Seconds of the budget that are left; infinite without one."""
        if self.budget is None:
            return math.inf
        return self.budget - (clock.perf_counter() - self.begun)

    @property
    def longest_level(self) -> float:
        """Seconds that a further level of the study may take."""
        return LONGEST_LEVEL if self.budget is None else SHARE_OF_STUDY * self.left


def outcome(promise: Promise, run: Run) -> list[str]:
    """What became of a promise: the run's error and time beside what was said before."""
    found = []
    error = _error_of(promise, run)
    if promise.tolerance is not None or promise.error is not None:
        limit = promise.tolerance if promise.tolerance is not None else promise.error
        assert limit is not None
        if math.isfinite(error):
            kept = "kept" if error <= limit else "NOT kept"
            found.append(
                f"Promised: {promise.of} within {percent(limit)}. Found: {percent(error)}. {kept}."
            )
        else:
            found.append(f"Promised: {promise.of} within {percent(limit)}. The run shows no such.")
    seconds = float(run.summary["seconds"]["total"])
    pictures = sum(
        float(run.summary["seconds"]["phases"].get(name, {"seconds": 0.0})["seconds"])
        for name in ("pictures", "comparison")
    )
    took = seconds - pictures
    inside = "as estimated" if promise.wall.holds(took) else "outside the estimate"
    found.append(
        f"Estimated: {duration(promise.wall.value)} ({duration(promise.wall.low)} to "
        f"{duration(promise.wall.high)}). Found: {duration(took)}, {inside}."
    )
    if inside != "as estimated" and math.isfinite(promise.steps):
        steps = int(run.summary["steps"]["total"])
        pace = took / steps * promise.steps / promise.wall.value
        found.append(
            f"Steps: {steps:,}, {promise.steps:,.0f} were expected; the machine took {pace:.2f} "
            "times as long for each as in the pilots."
        )
    if promise.budget is not None:
        used = clock.perf_counter() - promise.begun - pictures
        found.append(
            f"Budget: {duration(promise.budget)}. Used, choosing included: {duration(used)} "
            f"({used / promise.budget:.0%})."
        )
    return found


def _error_of(promise: Promise, run: Run) -> float:
    """The run's error of the promised kind, share; NaN where it cannot be told."""
    from .curve import distance
    from .quantity import Quantity, quantities
    from .scores import scores
    from .worker import tracks

    for score in scores(run):
        if score.name == promise.of:
            return score.error
    if promise.study is None:
        return math.nan
    base = promise.study.base
    try:
        parts = base.curve(promise.of).parts
    except KeyError:
        return math.nan
    one = _Shown(promise.scene.spacing, tracks(run))
    own: dict[str, Quantity] = {q.name: q for q in quantities([one])}
    errors = []
    for part in parts:
        statistic = promise.of.removeprefix(part.name.rsplit(" ", 1)[0]).strip()
        mine = own.get(part.name) or own.get(part.name.rsplit(" ", 1)[0])
        if mine is not None:
            if mine.name != part.name:
                mine = mine.reduced(statistic)
            errors.append(float(distance(mine, part)[0]))
    return max(errors, default=math.nan)


@dataclass(frozen=True)
class _Shown:
    """As much of a record as `quantities` looks at."""

    spacing: float
    tracks: Any
    compression: float = 0.0


__all__ = ["Promise", "PromiseError", "choose", "outcome"]
