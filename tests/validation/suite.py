"""What a validation case is: figures with bounds, at one or more resolutions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Figure:
    """One error of a run: the smaller the better, and not a number where the run fell short."""

    name: str
    value: float
    bound: float | None = None
    """Largest value that passes the test; None: recorded, not judged."""
    goal: float | None = None
    """Largest value that the project aims at. Shown as met or not met, never a test."""
    unit: str = ""
    """"%" shows a share as per cent; else the unit."""

    def within(self, limit: float) -> bool:
        """Whether the value is a number no larger than ``limit``."""
        return math.isfinite(self.value) and self.value <= limit

    @property
    def passed(self) -> bool:
        """Whether the value is within the bound, if there is one."""
        return self.bound is None or self.within(self.bound)

    def shown(self, value: float | None) -> str:
        """``value`` as the report writes a figure of this kind."""
        if value is None:
            return ""
        if not math.isfinite(value):
            return "none"
        if self.unit == "%":
            return f"{100 * value:.3g} %"
        return f"{value:.3g} {self.unit}".strip()


@dataclass(frozen=True)
class Level:
    """A case at one resolution."""

    resolution: int
    figures: tuple[Figure, ...]
    """The first one is the case's leading error, whose order is observed."""
    particles: int
    steps: int
    curves: Mapping[str, Any] = field(default_factory=dict)
    """What the case's picture needs."""
    seconds: float = 0.0

    @property
    def missed(self) -> list[Figure]:
        """The figures beyond their bounds."""
        return [figure for figure in self.figures if not figure.passed]


@dataclass(frozen=True)
class Case:
    """A validation case; ``resolution`` counts the particles along the length named in ``unit``."""

    title: str
    setup: str
    """What is set up, in a sentence or two."""
    reference: str
    """What it is compared with, and how."""
    unit: str
    """Meaning of the resolution, such as "H/Δp"."""
    short: tuple[int, ...]
    """Resolutions in the test command; empty: the case runs in full only."""
    full: tuple[int, ...]
    run: Callable[[int], Level]
    draw: Callable[[Sequence[Level], Canvas], None]
    remarks: str = ""
    """What the figures do not say: why a goal is not met, what was tried."""


def names() -> list[str]:
    """Names of all cases, sorted: the folders with a ``case.py``."""
    return sorted(path.parent.name for path in FOLDER.glob("*/case.py"))


@cache
def get(name: str) -> Case:
    """The case in the folder ``name``."""
    case = import_module(f"{__package__}.{name}.case").case
    assert isinstance(case, Case)
    return case


def observed_order(levels: Sequence[Level]) -> float:
    """Order of the leading error between the two finest levels; NaN with fewer than two."""
    if len(levels) < 2:
        return math.nan
    coarse, fine = sorted(levels, key=lambda level: level.resolution)[-2:]
    errors = coarse.figures[0].value, fine.figures[0].value
    if not all(math.isfinite(e) and e > 0.0 for e in errors):
        return math.nan
    return math.log(errors[0] / errors[1]) / math.log(fine.resolution / coarse.resolution)
