"""A pressure record against the band of a repeated experiment (Lobovsky's sensor 2)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from kolk.references import Reference

from .align import arrival_level, shift_at_arrival
from .result import ComparisonResult

FloatArray = npt.NDArray[np.float64]

PEAK_WINDOW = 0.5
"""The first peak is looked for from the arrival on, so long, in sqrt(H/g)."""

SAMPLE = 0.005
"""Interval of the clock on which the share of time is counted, in sqrt(H/g)."""


@dataclass(frozen=True)
class Aligned:
    """A record in the reference's scales, moved so that it arrives with the reference."""

    time: FloatArray
    value: FloatArray
    shift: float
    """Added to the run's own clock; 0 if the run never arrives."""
    arrival: float
    """Arrival by the run's own clock; NaN if it never arrives."""
    reference_arrival: float


def align(
    time: FloatArray,
    value: FloatArray,
    reference: Reference,
    scale_time: float,
    scale_value: float,
) -> Aligned:
    """The record (s, SI value) in the scales of ``reference``, shifted to arrive together.

    scale_time, scale_value: SI values of one of the reference's units. The column compared is
    ``median`` of a band, else the reference's only column.
    """
    column = "median" if "median" in reference.columns else reference.columns[0]
    t, p = time / scale_time, value / scale_value
    shift, ours, theirs = shift_at_arrival(t, p, reference.time, reference.values(column))
    shift = shift if math.isfinite(shift) else 0.0
    return Aligned(t + shift, p, shift, ours, theirs)


def compare_band(
    probe: str,
    time: FloatArray,
    value: FloatArray,
    reference: Reference,
    scale_time: float,
    scale_value: float,
) -> list[ComparisonResult]:
    """Arrival, share of time inside the band, first peak and its time.

    time (n,) s and value (n,) Pa of one probe; the reference has columns low, median and high in
    units of ``scale_time`` s and ``scale_value`` Pa.
    """
    run = align(time, value, reference, scale_time, scale_value)
    unit = reference.units["time"]
    if not math.isfinite(run.arrival):
        level = arrival_level(reference.values("median"))
        return [
            ComparisonResult(
                name="arrival",
                probe=probe,
                value=math.nan,
                reference=run.reference_arrival,
                unit=unit,
                sentence=(
                    f"{probe}: the surge does not reach the sensor before the run ends at "
                    f"{run.time[-1]:.2f} {unit} (pressure stays below {level:.2f} "
                    f"{reference.units['median']}); in the experiment it arrives at "
                    f"{run.reference_arrival:.2f}."
                ),
                source=reference.title,
            )
        ]
    return [
        _arrival(probe, run, reference),
        _share(probe, run, reference),
        *_first_peak(probe, run, reference),
    ]


def _arrival(probe: str, run: Aligned, reference: Reference) -> ComparisonResult:
    unit = reference.units["time"]
    rest = run.arrival + run.shift - run.reference_arrival
    capped = f", the largest allowed; {abs(rest):.2f} remain" if abs(rest) > 1e-9 else ""
    early = run.reference_arrival - run.arrival
    return ComparisonResult(
        name="arrival",
        probe=probe,
        value=run.arrival,
        reference=run.reference_arrival,
        unit=unit,
        sentence=(
            f"{probe}: the surge arrives at {run.arrival:.2f} {unit}, {abs(early):.2f} "
            f"{'before' if early >= 0 else 'after'} the experiment's {run.reference_arrival:.2f}; "
            f"the series below is shifted by {run.shift:+.2f} {unit}{capped}."
        ),
        source=reference.title,
        details={"shift": run.shift},
    )


def _share(probe: str, run: Aligned, reference: Reference) -> ComparisonResult:
    begin = max(run.time[0], reference.time[0])
    end = min(run.time[-1], reference.time[-1])
    clock = np.arange(begin, end, SAMPLE)
    low, high = (np.interp(clock, reference.time, reference.values(c)) for c in ("low", "high"))
    ours = np.interp(clock, run.time, run.value)
    share = float(np.mean((ours >= low) & (ours <= high))) if len(clock) else math.nan
    # the floor of the band before the arrival is sensor noise: count the wet part on its own too
    wet = clock >= run.reference_arrival
    inside = ((ours >= low) & (ours <= high))[wet]
    after = float(np.mean(inside)) if len(inside) else math.nan
    return ComparisonResult(
        name="share of time inside the band",
        probe=probe,
        value=share,
        reference=0.95,
        unit="1",
        sentence=(
            f"{probe}: inside the experiment's 2.5 to 97.5 percentile band for {share:.0%} of the "
            f"time from {begin:.2f} to {end:.2f} {reference.units['time']} ({after:.0%} after the "
            "arrival); one more repetition of the experiment would be inside for 95 %."
        ),
        source=reference.title,
        details={"shift": run.shift, "from": begin, "to": end, "share_after_arrival": after},
    )


def first_peak(run: Aligned) -> tuple[float, float]:
    """Largest value within PEAK_WINDOW after the arrival, and its time on the shifted clock."""
    start = run.arrival + run.shift
    window = np.flatnonzero((run.time >= start - 1e-12) & (run.time <= start + PEAK_WINDOW))
    if not len(window):
        return math.nan, math.nan
    i = window[int(np.argmax(run.value[window]))]
    return float(run.value[i]), float(run.time[i])


def _first_peak(probe: str, run: Aligned, reference: Reference) -> list[ComparisonResult]:
    peak, when = first_peak(run)
    low, high = float(reference.values("low").max()), float(reference.values("high").max())
    median, median_time = reference.peak("median")
    unit, clock = reference.units["median"], reference.units["time"]
    where = "within" if low <= peak <= high else "above" if peak > high else "below"
    return [
        ComparisonResult(
            name="first peak",
            probe=probe,
            value=peak,
            reference=(low, high),
            unit=unit,
            sentence=(
                f"{probe}: first peak {peak:.2f} {unit}, {where} the experiment's {low:.2f} to "
                f"{high:.2f} (median {median:.2f}, {peak / median - 1.0:+.0%})."
            ),
            source=reference.title,
            details={"median": median, "relative_to_median": peak / median - 1.0},
        ),
        ComparisonResult(
            name="time of the first peak",
            probe=probe,
            value=when,
            reference=median_time,
            unit=clock,
            sentence=(
                f"{probe}: first peak at {when:.2f} {clock} after the shift of {run.shift:+.2f} "
                f"({when - run.shift:.2f} by the run's own clock); the experiment's median peaks "
                f"at {median_time:.2f}."
            ),
            source=reference.title,
            details={"shift": run.shift, "unshifted": when - run.shift},
        ),
    ]


__all__ = ["Aligned", "align", "compare_band", "first_peak"]
