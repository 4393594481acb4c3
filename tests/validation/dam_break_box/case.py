"""SPHERIC test 2: a dam break over a box in 3D, levels and pressures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.cases.dam_break_box import GAUGES
from kolk.compare.align import crossing
from kolk.references import Reference, load

from ..running import FloatArray, counts, finished_run, probe
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

DEFAULT = 50
"""The built-in scene's resolution: a spacing of 0.02 m."""
SENSORS = ("P1", "P2", "P3", "P4")
BIN, SAMPLE = 0.02, 0.001
"""What the record and the samples that its peaks are from are means over, s."""
PEAK_WITHIN = 0.1
"""The first peak is looked for from the arrival on, so long, in s."""


def means(time: FloatArray, value: FloatArray, middle: FloatArray, width: float) -> FloatArray:
    """Means of a series over ``width`` (s) around each of the times ``middle``."""
    area = np.concatenate([[0.0], np.cumsum(0.5 * (value[1:] + value[:-1]) * np.diff(time))])
    ends = [np.interp(middle + half, time, area) for half in (-0.5 * width, 0.5 * width)]
    return np.asarray((ends[1] - ends[0]) / width, np.float64)


def level_error(time: FloatArray, level: FloatArray, record: Reference, name: str) -> float:
    """Mean distance from the record over the times that both cover, over its largest level."""
    measured = record.values(name)
    used = record.time <= time[-1]
    error = np.abs(means(time, level, record.time[used], BIN) - measured[used])
    return float(error.mean() / measured[used].max())


def impact(
    time: FloatArray, pressure: FloatArray, record: Reference, name: str
) -> tuple[float, float]:
    """Relative errors of the first peak and of the time of arrival, at a quarter of the peak.

    Both are taken as in the experiment: the peak from means over a sample, the arrival from those
    of the record.
    """
    peak, _ = record.peak(name)
    ours = crossing(record.time, means(time, pressure, record.time, BIN), 0.25 * peak)
    theirs = crossing(record.time, record.values(name), 0.25 * peak)
    if not math.isfinite(ours):
        return math.nan, math.nan
    window = np.arange(ours - BIN, ours + PEAK_WITHIN, SAMPLE)
    highest = float(means(time, pressure, window, SAMPLE).max())
    return abs(highest / peak - 1.0), abs(ours / theirs - 1.0)


def run(resolution: int) -> Level:
    scene = kolk.load("dam-break-box").replace({"spacing": 1.0 / resolution, "output.every": 0.1})
    judged = resolution == DEFAULT
    figures, curves = [], {}
    with finished_run(scene) as result:
        levels, pressures = load("spheric2-level"), load("spheric2-pressure")
        for name in GAUGES:
            curves[name] = probe(result, name)
            error = level_error(*curves[name], levels, name)
            figures.append(
                Figure(f"level {name}, mean", error, None, 0.05 if judged else None, "%")
            )
        for name in SENSORS:
            curves[name] = probe(result, name)
            peak, arrival = impact(*curves[name], pressures, name)
            figures += [
                Figure(f"first peak of {name}", peak, None, 0.2 if judged else None, "%"),
                Figure(f"arrival at {name}", arrival, None, 0.05 if judged else None, "%"),
            ]
        return Level(resolution, tuple(figures), **counts(result), curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    panels = canvas.subplots(2, 4, sharex=True)
    for row, names, table in ((0, list(GAUGES), "level"), (1, list(SENSORS), "pressure")):
        record = load(f"spheric2-{table}")
        for axes, name in zip(panels[row], names, strict=True):
            for level in levels:
                label = f"Δp = {1000 / level.resolution:g} mm"
                axes.plot(*level.curves[name], linewidth=0.7, label=label)
            axes.plot(record.time, record.values(name), "k.", markersize=2, label="experiment")
            axes.set(title=name, xlim=(0.0, 3.0))
            if row == 1:
                axes.set_ylim(-1000.0, 1.5 * record.peak(name)[0])
    panels[0, 0].set_ylabel("level, m")
    panels[1, 0].set_ylabel("pressure, Pa")
    panels[0, 0].legend(fontsize="small")
    canvas.supxlabel("t, s")


case = Case(
    title="Dam break over a box, SPHERIC test 2",
    setup="The built-in scene `dam-break-box` (3D) for 3 s.",
    reference="The experiment of Kleefsman et al. 2005: mean error of the levels over the largest "
    "one; first peak and arrival of the pressures on the box's face, no shift.",
    unit="1 m/Δp",
    short=(),
    full=(25, 50),
    run=run,
    draw=draw,
)
