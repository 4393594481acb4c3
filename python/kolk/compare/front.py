"""The surge front of a collapsing column against Martin & Moyce or Koshizuka & Oka."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from kolk.references import Reference

from .align import crossing
from .result import ComparisonResult

FloatArray = npt.NDArray[np.float64]

ALIGNED_AT = 1.44
"""Front position, in column widths, at which the clocks are set equal: the release is unknown."""


@dataclass(frozen=True)
class AlignedFront:
    """A front in column widths on the reference's clock."""

    time: FloatArray
    front: FloatArray
    shift: float
    """Added to the run's own clock, in the reference's unit; NaN if the front never gets there."""


def align_front(
    time: FloatArray,
    front: FloatArray,
    reference: Reference,
    scale_time: float,
    width: float,
    aligned_at: float = ALIGNED_AT,
) -> AlignedFront:
    """Front (m from the wall behind the column) against time (s), aligned at ``aligned_at``.

    scale_time: s per unit of the reference's time; width: of the column, m.
    """
    t, z = time / scale_time, front / width
    ours = crossing(t, z, aligned_at)
    shift = crossing(reference.time, reference.values("front"), aligned_at) - ours
    return AlignedFront(t + (shift if math.isfinite(shift) else 0.0), z, shift)


def compare_front(
    probe: str,
    time: FloatArray,
    front: FloatArray,
    reference: Reference,
    scale_time: float,
    width: float,
    *,
    aligned_at: float = ALIGNED_AT,
    until: float = math.inf,
) -> list[ComparisonResult]:
    """RMS distance of the fronts, in column widths, over the times that both records cover.

    time (n,) s; front (n,) m from the wall behind the column; scale_time: s per unit of the
    reference's time; width: of the column, m. ``until``: the last front position
    of the run that counts, in column widths (the far wall of the tank stops the run's front).
    """
    run = align_front(time, front, reference, scale_time, width, aligned_at)
    if not math.isfinite(run.shift):
        return [
            ComparisonResult(
                name="surge front",
                probe=probe,
                value=math.nan,
                reference=None,
                unit="a",
                sentence=(
                    f"{probe}: the front stops at {run.front.max():.2f} a; it must pass "
                    f"{aligned_at} a to be set beside {reference.title}: run longer."
                ),
                source=reference.title,
            )
        ]
    end = run.time[-1]
    beyond = np.flatnonzero(run.front >= until)
    if len(beyond):
        end = min(end, run.time[beyond[0]])
    used = (reference.time >= run.time[0]) & (reference.time <= end)
    t, z = reference.time[used], reference.values("front")[used]
    error = np.interp(t, run.time, run.front) - z
    rms = float(np.sqrt(np.mean(error**2)))
    unit = reference.units["time"]
    return [
        ComparisonResult(
            name="surge front, RMS",
            probe=probe,
            value=rms,
            reference=None,
            unit="a",
            sentence=(
                f"{probe}: the surge front is {rms:.3f} a RMS from {reference.title} over "
                f"{len(t)} points from {z[0]:.2f} to {z[-1]:.2f} a (mean {error.mean():+.3f}), "
                f"aligned at {aligned_at} a by a shift of {run.shift:+.2f} {unit}."
            ),
            source=reference.title,
            details={
                "shift": run.shift,
                "mean_error": float(error.mean()),
                "largest_error": float(np.abs(error).max()),
                "front_from": float(z[0]),
                "front_to": float(z[-1]),
                "points": len(t),
            },
        )
    ]
