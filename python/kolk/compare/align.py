"""Setting two records on one clock: by their arrival, with one stated and bounded shift."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

LARGEST_SHIFT = 0.4
"""Largest shift in sqrt(H/g): the gate of the experiment takes 0.2 to 0.3 to rise."""


def crossing(time: FloatArray, value: FloatArray, level: float) -> float:
    """First time at which ``value`` rises to ``level``, linear between samples; NaN if never."""
    above = np.flatnonzero(value >= level)
    if not len(above):
        return math.nan
    i = int(above[0])
    if i == 0:
        return float(time[0])
    share = (level - value[i - 1]) / (value[i] - value[i - 1])
    return float(time[i - 1] + share * (time[i] - time[i - 1]))


def arrival_level(reference: FloatArray) -> float:
    """Level that counts as arrival: a quarter of the reference's largest value.

    High enough to pass over spray and sensor noise, low enough to lie on the steep front.
    """
    return 0.25 * float(np.max(reference))


def shift_at_arrival(
    time: FloatArray,
    value: FloatArray,
    reference_time: FloatArray,
    reference: FloatArray,
    largest: float = LARGEST_SHIFT,
) -> tuple[float, float, float]:
    """Shift to add to ``time`` so that both records arrive together, at most ``largest`` in size.

    Returns (shift, arrival of the run before it, arrival of the reference), all in the unit of the
    two clocks; the first two are NaN where the run never arrives.
    """
    level = arrival_level(reference)
    ours, theirs = crossing(time, value, level), crossing(reference_time, reference, level)
    shift = min(max(theirs - ours, -largest), largest) if math.isfinite(ours) else math.nan
    return shift, ours, theirs
