"""Any probe against a digitised series on the same clock."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from kolk.references import Reference

from .result import ComparisonResult

FloatArray = npt.NDArray[np.float64]


def compare_series(
    probe: str,
    time: FloatArray,
    value: FloatArray,
    reference: Reference,
    column: str,
    scale_time: float = 1.0,
    scale_value: float = 1.0,
    *,
    shift: float = 0.0,
) -> list[ComparisonResult]:
    """RMS distance, and the peaks with their times.

    time (n,) s and value (n,) SI of one probe; ``column`` of the reference, in units of
    ``scale_time`` s and ``scale_value``. ``shift`` is added to
    the run's clock, in the unit of the reference's. The RMS is taken over the reference's own
    points that the run covers; the peaks over the stretch of time that both cover.
    """
    unit, clock = reference.units[column], reference.units["time"]
    t = time / scale_time + shift
    ours = value / scale_value
    used = (reference.time >= t[0]) & (reference.time <= t[-1])
    theirs = reference.values(column)[used]
    if used.sum() < 2:
        return [
            ComparisonResult(
                name="RMS",
                probe=probe,
                value=math.nan,
                reference=None,
                unit=unit,
                sentence=(
                    f"{probe}: the run ends at {t[-1]:.3g} {clock}, before {reference.title} says "
                    "anything: run longer."
                ),
                source=reference.title,
            )
        ]
    error = np.interp(reference.time[used], t, ours) - theirs
    rms = float(np.sqrt(np.mean(error**2)))
    peak, peak_time = reference.peak(column)
    end = float(reference.time[used][-1])
    shifted = f", shifted by {shift:+.2f} {clock}" if shift else ""
    results = [
        ComparisonResult(
            name="RMS",
            probe=probe,
            value=rms,
            reference=None,
            unit=unit,
            sentence=(
                f"{probe}: {_say(rms, unit)} RMS from {reference.title} up to {_say(end, clock)}"
                f"{shifted} ({rms / abs(peak):.0%} of its peak)."
            ),
            source=reference.title,
            details={
                "relative_to_peak": rms / abs(peak),
                "mean_error": float(error.mean()),
                "to": end,
            },
        )
    ]
    if peak_time <= t[-1]:
        inside = np.flatnonzero((t >= reference.time[0]) & (t <= reference.time[-1]))
        i = inside[int(np.argmax(ours[inside]))]
        results.append(
            ComparisonResult(
                name="peak",
                probe=probe,
                value=float(ours[i]),
                reference=peak,
                unit=unit,
                sentence=(
                    f"{probe}: peak {_say(float(ours[i]), unit)} at {_say(float(t[i]), clock)}; "
                    f"{reference.title}: {_say(peak, unit)} at {_say(peak_time, clock)} "
                    f"({ours[i] / peak - 1.0:+.0%})."
                ),
                source=reference.title,
                details={"time": float(t[i]), "reference_time": peak_time, "shift": shift},
            )
        )
    return results


def _say(x: float, unit: str) -> str:
    """A figure with its unit; kilopascals from 1000 Pa on."""
    if unit == "Pa" and abs(x) >= 1000.0:
        return f"{x / 1000.0:.3g} kPa"
    return f"{x:.3g} {unit}"
