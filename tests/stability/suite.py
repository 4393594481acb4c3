"""What a hard case is: figures with limits, for one or more variants of a set-up."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from pathlib import Path

from kolk.errors import InstabilityError

FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Figure:
    """One measured quantity and what it may be."""

    name: str
    value: float
    most: float | None = None
    """Largest value that passes the test; None: no upper limit."""
    least: float | None = None
    """Smallest value that passes."""
    goal: float | None = None
    """What the project aims at where the limit is not that yet: shown as met or not, no test."""
    unit: str = ""

    @property
    def passed(self) -> bool:
        """Whether the value is a number within its limits."""
        fits = self.most is None or self.value <= self.most
        fits = fits and (self.least is None or self.value >= self.least)
        return fits and not math.isnan(self.value)

    @property
    def limit(self) -> str:
        """The limits in words."""
        parts = [] if self.most is None else [f"≤ {shown(self.most)}"]
        parts += [] if self.least is None else [f"≥ {shown(self.least)}"]
        parts += [] if self.goal is None else [f"goal {shown(self.goal)}"]
        return ", ".join(parts)

    def __str__(self) -> str:
        return f"{self.name}: {shown(self.value)} {self.unit}".strip()


def shown(value: float) -> str:
    """A number in four digits at most."""
    if not math.isfinite(value):
        return str(value)
    return f"{value:,.0f}" if float(value).is_integer() and abs(value) < 1e9 else f"{value:.3g}"


@dataclass(frozen=True)
class Result:
    """A variant that has run."""

    variant: str
    figures: tuple[Figure, ...]
    particles: int = 0
    steps: int = 0
    retries: int = 0
    seconds: float = 0.0
    stopped: str = ""
    """What the guard said where it stopped the run; such a result misses its limits."""

    @property
    def failed(self) -> bool:
        """Whether the guard stopped it or a figure is beyond its limits."""
        return bool(self.stopped or self.missed)

    @property
    def missed(self) -> list[Figure]:
        """The figures beyond their limits."""
        return [figure for figure in self.figures if not figure.passed]


@dataclass(frozen=True)
class Case:
    """A hard case. A variant is a word that `run` knows, such as "H/Δp = 40"."""

    title: str
    setup: str
    failure: str
    """What typically goes wrong."""
    run: Callable[[str], Result]
    short: tuple[str, ...]
    """Variants in the test command."""
    full: tuple[str, ...]
    without: Callable[[], Result] | None = None
    """The case without the remedy that keeps it alive: must miss one of its limits."""
    remedy: str = ""
    """That remedy."""
    remarks: str = ""
    """What the figures do not say."""


def names() -> list[str]:
    """Names of all cases, sorted: the files in `cases`."""
    return sorted(p.stem for p in (FOLDER / "cases").glob("*.py") if p.stem != "__init__")


@cache
def get(name: str) -> Case:
    """The case in the file ``name``."""
    case = import_module(f"{__package__}.cases.{name}").case
    assert isinstance(case, Case)
    return case


def timed(run: Callable[[], Result], variant: str = "") -> Result:
    """The result with the seconds that it took; a run that the guard stops is one, too."""
    begun = time.perf_counter()
    try:
        result = run()
    except InstabilityError as error:
        result = Result(variant, (), steps=error.step or 0, stopped=str(error))
    return replace(result, seconds=time.perf_counter() - begun)
