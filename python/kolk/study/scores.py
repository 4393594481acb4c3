"""The errors of a finished run against the references of its case, as shares."""

from __future__ import annotations

import math

import numpy as np

from kolk.cases import Comparison
from kolk.compare import ComparisonResult, common_shift, compare, records
from kolk.compare.band import align

from .record import Basis, Score


def scores(run: records.RunLike) -> list[Score]:
    """Relative errors of a run, the leading one first; none for a scene without a reference."""
    asked = records.comparisons(run)
    if not asked:
        return []
    found = [_against_median(run, each) for each in asked if each.kind == "band"]
    basis = {each.probe: _basis(each) for each in asked}
    for result in compare(run):
        error = _relative(result)
        if error is not None:
            kind = basis.get(result.probe, "analytic")
            found.append(Score(_title(result), error, kind, result.sentence))
    finite = [score for score in found if math.isfinite(score.error)]
    # A norm over the whole field says more than one figure of it.
    return sorted(finite, key=lambda score: not score.name.endswith(("L2", "RMS")))


def _basis(asked: Comparison) -> Basis:
    if asked.kind == "analytic":
        return "analytic"
    return "experiment"


def _title(result: ComparisonResult) -> str:
    return result.name if result.probe in result.name else f"{result.probe}: {result.name}"


def _relative(result: ComparisonResult) -> float | None:
    """The figure as a share of what it should be, or None for one that is no error."""
    details = result.details
    for key in ("relative_error", "relative_to_peak", "relative_to_median"):
        if key in details:
            return abs(details[key])
    if result.name in ("arrival", "time of the first peak"):
        return None
    if result.reference is None:
        return result.value
    if isinstance(result.reference, float) and result.reference and result.name == "peak":
        return abs(result.value / result.reference - 1.0)
    return None


def _against_median(run: records.RunLike, asked: Comparison) -> Score:
    """RMS distance from the median of a repeated experiment, over its peak."""
    time, value = records.record(run, asked)
    reference = records.reference_of(asked)
    ours = align(time, value, reference, asked.scale_time, asked.scale_value)
    shift = common_shift(run, [asked])
    median = reference.values("median")
    used = (reference.time >= ours.time[0]) & (reference.time <= ours.time[-1])
    distance = np.interp(reference.time[used], ours.time, ours.value) - median[used]
    error = float(np.sqrt(np.mean(distance**2)) / np.max(np.abs(median)))
    sentence = (
        f"{asked.probe}: {error:.0%} of its peak (RMS) from {reference.title}, median, shifted by "
        f"{shift:+.2f} {reference.units['time']}."
    )
    return Score(f"{asked.probe}: RMS", error, "experiment", sentence)


__all__ = ["scores"]
