"""Curves of probes with their reference drawn in."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
from matplotlib.axes import Axes

from kolk.cases import Comparison
from kolk.compare import records
from kolk.compare.align import crossing
from kolk.compare.band import align, first_peak
from kolk.compare.front import ALIGNED_AT, align_front
from kolk.references import Reference

from . import style

FloatArray = npt.NDArray[np.float64]

UNITS = {
    "sqrt(H/g)": r"$t\,\sqrt{g/H}$",
    "sqrt(a/2g)": r"$t\,\sqrt{2g/a}$",
    "s": "t [s]",
    "rho g H": r"$p\,/\,\rho g H$",
    "a": r"$x\,/\,a$",
    "Pa": "p [kPa]",
    "m": "height [m]",
    "N": "force [N]",
    "m/s": "velocity [m/s]",
}
"""Axis labels by the unit of the reference."""


def draw(
    axes: Axes,
    table: pd.DataFrame,
    match: Comparison | None,
    about: str = "",
    shift: float = 0.0,
    legend: float = 8.5,
    also: Sequence[Comparison] = (),
) -> None:
    """The record of a probe, with its reference where there is one.

    about: axis label of a probe without one. shift: see :func:`kolk.compare.common_shift`.
    also: further references of a front.
    """
    time = table["time"].to_numpy(np.float64)
    style.plot_axes(axes)
    if match is None:
        _draw_plain(axes, time, table, about)
    else:
        value = table[records.probe_column(match)].to_numpy(np.float64)
        if match.kind == "band":
            _draw_band(axes, time, value, match)
        elif match.kind == "front":
            _draw_front(axes, time, value, match, also)
        else:
            _draw_series(axes, time, value, match, shift)
    axes.legend(loc="best", handlelength=1.4, fontsize=legend)


def _draw_plain(axes: Axes, time: FloatArray, table: pd.DataFrame, about: str) -> None:
    columns = [c for c in table.columns if c != "time"]
    inks = (style.RUN, style.SECOND, style.REFERENCE, style.QUIET)
    moments = [c for c in columns if c.startswith("moment")]
    for column, ink in zip([c for c in columns if c not in moments], inks, strict=False):
        value = table[column].to_numpy(np.float64)
        label = "kolk" if column == "value" else f"kolk, {column}"
        axes.plot(time, value, color=ink, lw=1.2, label=label)
    if moments:
        # A moment is no force: it has a scale of its own.
        about, _, unit = about.partition(", ")
        about += "]" if unit else ""
        right = axes.twinx()
        right.tick_params(length=0)
        right.set_ylabel(f"moment [{unit}" if unit else "moment")
        for column, ink in zip(moments, inks[2:] + inks[:2], strict=False):
            value = table[column].to_numpy(np.float64)
            right.plot(time, value, color=ink, lw=1.0, ls="--")
            axes.plot([], [], color=ink, lw=1.0, ls="--", label=f"kolk, {column} (right)")
    axes.set_xlabel("t [s]")
    axes.set_ylabel(about)


def _draw_band(axes: Axes, time: FloatArray, value: FloatArray, match: Comparison) -> None:
    reference = records.reference_of(match)
    run = align(time, value, reference, match.scale_time, match.scale_value)
    clock = reference.time
    axes.fill_between(
        clock,
        reference.values("low"),
        reference.values("high"),
        color=style.BAND,
        lw=0,
        label="experiment, 2.5 to 97.5 percentile",
    )
    axes.plot(clock, reference.values("median"), color=style.REFERENCE, label="experiment, median")
    label = f"kolk, shifted by {run.shift:+.2f}" if run.shift else "kolk"
    axes.plot(run.time, run.value, color=style.RUN, lw=1.1, label=label)
    peak, when = first_peak(run)
    if math.isfinite(peak):
        axes.plot(when, peak, "o", ms=4.5, mfc="white", mec=style.RUN, mew=1.2, zorder=4)
        axes.annotate(
            f"{peak:.2f} at {when:.2f}",
            (when, peak),
            textcoords="offset points",
            xytext=(7, 3),
            fontsize=8,
            color=style.RUN,
        )
    axes.set_xlim(clock[0] - 0.15, clock[-1])
    top = max(float(reference.values("high").max()), peak if math.isfinite(peak) else 0.0)
    axes.set_ylim(-0.12 * top, 1.15 * top)
    _labels(axes, reference, "median")


def _draw_front(
    axes: Axes,
    time: FloatArray,
    value: FloatArray,
    match: Comparison,
    also: Sequence[Comparison] = (),
) -> None:
    reference = records.reference_of(match)
    level = match.parameters.get("align", ALIGNED_AT)
    run = align_front(
        time,
        value - match.parameters.get("origin", 0.0),
        reference,
        match.scale_time,
        match.scale_value,
        level,
    )
    label = "kolk"
    if math.isfinite(run.shift):
        label += f", aligned at {level} (shift {run.shift:+.2f})"
        axes.axhline(level, color=style.QUIET, lw=0.7, ls=(0, (4, 3)))
    axes.plot(run.time, run.front, color=style.RUN, label=label)
    _points(axes, reference, 0.0, style.REFERENCE)
    meet = crossing(reference.time, reference.values("front"), level)
    for further in also:
        other = records.reference_of(further)
        late = crossing(other.time, other.values("front"), level) - meet
        _points(axes, other, -late, style.SECOND)
    reached = float(run.front.max())
    axes.set_ylim(0.9, 1.1 * reached)
    axes.set_xlim(min(0.0, float(run.time[0])), float(run.time[-1]) * 1.02)
    _labels(axes, reference, "front")


def _draw_series(
    axes: Axes, time: FloatArray, value: FloatArray, match: Comparison, shift: float
) -> None:
    reference = records.reference_of(match)
    column = records.reference_column(match)
    kilo = 1e-3 if reference.units[column] == "Pa" else 1.0
    shift = shift if reference.kind == "experiment" else 0.0
    t = time / match.scale_time + shift
    label = f"kolk, shifted by {shift:+.2f}" if shift else "kolk"
    axes.plot(t, value / match.scale_value * kilo, color=style.RUN, lw=1.1, label=label)
    end = max(float(t[-1]), min(float(reference.time[-1]), 1.15 * float(t[-1])))
    # what lies beyond the picture must not stretch its other axis
    shown = reference.time <= end
    clock, values = reference.time[shown], reference.values(column)[shown] * kilo
    if reference.kind == "experiment":
        axes.plot(clock, values, "o-", ms=2.8, lw=0.8, color=style.REFERENCE, label="experiment")
    else:
        axes.plot(clock, values, lw=1.1, color=style.SECOND, label=reference.title)
    if column in reference.peaks and reference.peaks[column][1] <= end:
        peak, when = reference.peaks[column]
        axes.plot(
            when,
            peak * kilo,
            "D",
            ms=4.5,
            mfc="white",
            mec=style.REFERENCE,
            label="experiment, peak of the full record",
        )
    axes.set_xlim(0.0, end)
    _labels(axes, reference, column)


def _points(axes: Axes, reference: Reference, shift: float, ink: str) -> None:
    axes.plot(
        reference.time + shift,
        reference.values("front"),
        "o",
        ms=4.5,
        mfc="white",
        mec=ink,
        mew=1.2,
        label=reference.title,
        zorder=4,
    )


def _labels(axes: Axes, reference: Reference, column: str) -> None:
    axes.set_xlabel(UNITS.get(reference.units["time"], reference.units["time"]))
    axes.set_ylabel(UNITS.get(reference.units[column], reference.units[column]))


def probe_picture(
    name: str,
    table: pd.DataFrame,
    path: Path,
    match: Comparison | None = None,
    about: str = "",
    shift: float = 0.0,
    also: Sequence[Comparison] = (),
) -> Path:
    """One probe as a PNG, its reference drawn in where there is one."""
    with style.look():
        made = style.figure(7.0, 3.8)
        scales = 1 + any(column.startswith("moment") for column in table.columns)
        axes = made.add_axes((0.1, 0.14, 0.94 - 0.07 * scales, 0.75))
        draw(axes, table, match, about, shift, also=also)
        axes.set_title(name if match is None else f"{name}: {records.reference_of(match).title}")
        return style.save(made, path)


def pressure_sheet(
    tables: Mapping[str, pd.DataFrame],
    matches: Sequence[Comparison],
    path: Path,
    title: str = "",
    shift: float = 0.0,
) -> Path:
    """Pressure probes against their references: a band large, further sensors below it.

    ``matches`` in the order to show, at least one; ``tables`` by probe. ``shift``: see
    :func:`kolk.compare.common_shift`.
    """
    first, rest = (matches[0], matches[1:]) if matches[0].kind == "band" else (None, matches)
    columns = 3 if len(rest) == 3 else 2
    rows = math.ceil(len(rest) / columns)
    width, big, small = 9.5, 3.6 if first else -0.75, 2.1
    gap, top, bottom = 0.75, 0.8, 0.55
    height = top + big + rows * (small + gap) + bottom
    with style.look():
        made = style.figure(width, height)
        made.text(0.08, 1 - 0.3 / height, title, weight="bold", fontsize=12, va="center")
        y = height - top - big
        if first:
            axes = made.add_axes((0.08, y / height, 0.89, big / height))
            draw(axes, tables[str(first.probe)], first, shift=shift)
            axes.set_title(_sensor(first))
        inner = (0.89 - 0.08 * (columns - 1)) / columns
        for k, match in enumerate(rest):
            row, column = divmod(k, columns)
            x = 0.08 + column * (inner + 0.08)
            low = y - (row + 1) * (small + gap)
            axes = made.add_axes((x, low / height, inner, small / height))
            draw(axes, tables[str(match.probe)], match, shift=shift, legend=7.0)
            axes.set_title(_sensor(match))
        return style.save(made, path)


def _sensor(match: Comparison) -> str:
    # a table with a column per sensor is named in the sheet's title already
    if match.column:
        return str(match.probe)
    return f"{match.probe}: {records.reference_of(match).title}"
