"""A finished run beside its reference: figures, each with a sentence that says what it means.

:func:`compare` does all that the run's case asks for; the other functions do one comparison each
on plain arrays.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import records
from .band import align, compare_band
from .drops import compare_capillary_drop, drop_of
from .fields import compare_channel, compare_hydrostatic, compare_taylor_green
from .front import ALIGNED_AT, compare_front
from .norms import Norms, norms
from .profiles import compare_slump, compare_yielding_channel
from .result import ComparisonResult
from .series import compare_series
from .waves import compare_standing_wave, wave_of

if TYPE_CHECKING:
    from kolk.cases import Comparison


def compare(run: records.RunLike) -> list[ComparisonResult]:
    """Every comparison that the run's built-in case asks for; none for a scene of one's own."""
    asked = records.comparisons(run)
    shift = common_shift(run, asked)
    results: list[ComparisonResult] = []
    for each in asked:
        if each.kind == "analytic":
            results += _analytic(run, each)
        else:
            results += _probe(run, each, shift)
    return results


def common_shift(run: records.RunLike, asked: list[Comparison]) -> float:
    """The one shift in time of a run, from its band, in the reference's unit; 0 without a band.

    The other sensors of the same experiment see the same gate, so they share it.
    """
    for each in asked:
        if each.kind == "band":
            time, value = records.record(run, each)
            reference = records.reference_of(each)
            return align(time, value, reference, each.scale_time, each.scale_value).shift
    return 0.0


def _probe(run: records.RunLike, asked: Comparison, shift: float) -> list[ComparisonResult]:
    time, value = records.record(run, asked)
    reference = records.reference_of(asked)
    scales = (asked.scale_time, asked.scale_value)
    name = str(asked.probe)
    if len(time) < 2:
        return []
    if asked.kind == "band":
        return compare_band(name, time, value, reference, *scales)
    if asked.kind == "front":
        given = asked.parameters
        return compare_front(
            name,
            time,
            value - given.get("origin", 0.0),
            reference,
            *scales,
            aligned_at=given.get("align", ALIGNED_AT),
            until=given.get("until", np.inf),
        )
    column = records.reference_column(asked)
    # a simulation has no gate: its clock starts with the release, as the run's does
    shift = shift if reference.kind == "experiment" else 0.0
    return compare_series(name, time, value, reference, column, *scales, shift=shift)


def _analytic(run: records.RunLike, asked: Comparison) -> list[ComparisonResult]:
    if len(run.frames) < 2:
        return []
    first, last = run.frames[0], run.frames[-1]
    given = dict(asked.parameters)
    if asked.reference == "taylor_green":
        return compare_taylor_green(
            first,
            last,
            viscosity=given["viscosity"],
            speed=given["speed"],
            length=given["length"],
        )
    if asked.reference in {"poiseuille", "couette"}:
        drive = given["acceleration" if asked.reference == "poiseuille" else "speed"]
        return compare_channel(
            last,
            asked.reference,
            width=given["width"],
            viscosity=given["viscosity"],
            drive=drive,
            origin=given.get("origin", 0.0),
        )
    if asked.reference == "herschel_bulkley":
        return compare_yielding_channel(last, **given)
    if asked.reference == "slump":
        return compare_slump(last, float(run.scene.spacing), **given)
    if asked.reference == "hydrostatic_pressure":
        return compare_hydrostatic(
            last,
            surface=given["surface"],
            bottom=given.get("bottom", 0.0),
            density=given["density"],
            gravity=given["gravity"],
        )
    if asked.reference == "standing_wave":
        return compare_standing_wave(run.frames, wave_of(given), given.get("bed", 0.0))
    if asked.reference == "CapillaryDrop":
        return compare_capillary_drop(run.frames, drop_of(given))
    return []


__all__ = [
    "ComparisonResult",
    "Norms",
    "common_shift",
    "compare",
    "compare_band",
    "compare_capillary_drop",
    "compare_channel",
    "compare_front",
    "compare_hydrostatic",
    "compare_series",
    "compare_slump",
    "compare_standing_wave",
    "compare_taylor_green",
    "compare_yielding_channel",
    "norms",
]
