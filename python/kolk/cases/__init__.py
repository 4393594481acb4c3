"""Built-in scenes, each with what it shows, its source, its reference and its cost.

One file a case: ``dam_break.py`` is the case ``dam-break`` and defines ``case``; what a case reads
stands in a folder. A finer or
coarser one is ``case.scene.replace(spacing=...)``.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from kolk.errors import SceneError

if TYPE_CHECKING:
    from kolk.scene import Scene

Kind = Literal["band", "front", "series", "analytic"]


@dataclass(frozen=True)
class Comparison:
    """One quantity of a run that is set beside a reference."""

    quantity: str
    """pressure, level, front, force_x, velocity, velocity_x: what is compared."""
    probe: str | None
    """Probe that records it; None: the particles of the frames."""
    reference: str
    """Name of a table of ``kolk.references.load``, or of an analytic function there."""
    scale_time: float
    """Seconds per unit of the reference's time."""
    scale_value: float
    """SI units of the quantity per unit of the reference's value."""
    kind: Kind
    """band: share inside a percentile band, first peak and its time; front: RMS after alignment;
    series: RMS against points; analytic: L1 and L2 norms against a function."""
    column: str = ""
    """Column of the reference table, where it has several records."""
    parameters: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    """SI parameters of the analytic function, or of the alignment."""


@dataclass(frozen=True)
class Case:
    """A built-in scene and what is known about it."""

    name: str
    title: str
    shows: str
    """What one sees and learns."""
    source: str
    """Where the set-up comes from."""
    reference: str
    """What it is compared with."""
    cost: str
    """Particles, steps and time at default spacing, without the pictures."""
    scene: Scene
    """At default spacing."""
    comparisons: tuple[Comparison, ...] = ()


def names() -> list[str]:
    """Names of all built-in scenes, sorted."""
    found = (m for m in pkgutil.iter_modules(__path__) if not m.ispkg)
    return sorted(m.name.replace("_", "-") for m in found)


@cache
def get(name: str) -> Case:
    """The case called ``name``. Raises SceneError for an unknown name."""
    if name not in names():
        from kolk.scene.base import nearest

        raise SceneError(
            f"no built-in scene is called '{name}'{nearest(name, names()) or '.'} "
            f"There is {', '.join(names())}"
        )
    case = import_module(f"{__name__}.{name.replace('-', '_')}").case
    assert isinstance(case, Case)
    return case


__all__ = ["Case", "Comparison", "get", "names"]
