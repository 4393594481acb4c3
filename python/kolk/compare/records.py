"""What the case of a run asks to be compared, and the records that answer it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from kolk import cases
from kolk.references import Reference, load

from .fields import FrameLike

if TYPE_CHECKING:
    import pandas as pd

    from kolk.cases import Case, Comparison

FloatArray = npt.NDArray[np.float64]


class RunLike(Protocol):
    """What comparisons and pictures need of a run: :class:`kolk.results.Run` has it."""

    @property
    def folder(self) -> Any: ...
    @property
    def scene(self) -> Any: ...
    @property
    def probes(self) -> Mapping[str, pd.DataFrame]: ...
    @property
    def frames(self) -> Sequence[FrameLike]: ...


def case_of(run: RunLike) -> Case | None:
    """The built-in case that a run is one of, or None.

    The name alone does not make it one: where the bodies' shapes or gravity were changed, a
    reference measured on the original would mislead. Spacing and numerics may differ.
    """
    scene = run.scene
    if scene.name not in cases.names():
        return None
    case = cases.get(scene.name)
    return case if _set_up(scene) == _set_up(case.scene) else None


def _set_up(scene: Any) -> tuple[object, ...]:
    """What must agree for a reference to hold: the dimension, gravity and every body's shape."""
    bodies = [*(scene.fluid or ()), *(scene.wall or ())]
    gravity = None if scene.gravity is None else tuple(map(float, scene.gravity))
    return (scene.dimension, gravity, [(body.name, body.shape) for body in bodies])


def comparisons(run: RunLike) -> list[Comparison]:
    """The case's comparisons that the run has records for."""
    case = case_of(run)
    asked = case.comparisons if case else ()
    return [c for c in asked if c.probe is None or c.probe in run.probes]


def record(run: RunLike, asked: Comparison) -> tuple[FloatArray, FloatArray]:
    """Time (n,) s and value (n,) SI of the probe that ``asked`` names."""
    table = run.probes[str(asked.probe)]
    return table["time"].to_numpy(np.float64), table[probe_column(asked)].to_numpy(np.float64)


def probe_column(asked: Comparison) -> str:
    """Column of the probe's table: ``force_x`` and ``velocity_x`` lie in ``x``."""
    tail = asked.quantity.rpartition("_")[2]
    return tail if tail in {"x", "y", "z"} else "value"


def reference_of(asked: Comparison) -> Reference:
    """The table that ``asked`` names."""
    return load(asked.reference)


def reference_column(asked: Comparison) -> str:
    """Its column: the one named, the median of a band, or the only one."""
    columns = reference_of(asked).columns
    return asked.column or ("median" if "median" in columns else columns[0])
