"""Force of a surge on a square column in 3D: Yeh and Petroff."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.references import load

from ..running import counts, finished_run, probe
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

DEPTH = 0.3
"""Of the water, m."""
PLATEAU = (0.52, 0.75)
"""s: the force falls slowly there."""
SMOOTHED = 0.01
"""s: about the distance of the record's points at the peak."""


def run(resolution: int) -> Level:
    scene = kolk.load("dam-break-column").replace(
        {"spacing": DEPTH / resolution, "until": 0.8, "output.every": 0.1}
    )
    with finished_run(scene) as result:
        time, force = probe(result, "load", "x")
        clock = np.arange(0.0, time[-1], 0.001)
        window = round(SMOOTHED / 0.001)
        smooth = np.convolve(np.interp(clock, time, force), np.ones(window) / window, "same")
        record = load("yeh-petroff-force")
        peak = record.peak("force")[0]
        plateau = (record.time >= PLATEAU[0]) & (record.time <= PLATEAU[1])
        ours = (clock >= PLATEAU[0]) & (clock <= PLATEAU[1])
        level = float(record.values("force")[plateau].mean())
        figures = (
            Figure("peak", abs(float(smooth.max()) / peak - 1.0), None, 0.15, "%"),
            Figure("plateau", abs(float(smooth[ours].mean()) / level - 1.0), None, 0.1, "%"),
        )
        curves = {"time": clock, "force": smooth}
        return Level(resolution, figures, **counts(result), curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes = canvas.subplots()
    for level in levels:
        label = f"kolk, Δp = {1000 * DEPTH / level.resolution:g} mm"
        axes.plot(level.curves["time"], level.curves["force"], label=label)
    record = load("yeh-petroff-force")
    axes.plot(record.time, record.values("force"), "ko", markersize=4, label="experiment")
    axes.set(xlabel="t, s", ylabel="force on the column, N", xlim=(0.2, 0.8), ylim=(-5.0, 60.0))
    axes.legend()


case = Case(
    title="Force on a column, Yeh and Petroff",
    setup="The built-in scene `dam-break-column` (3D, dry bed) for 0.8 s.",
    reference="The measured force along the tank (over a bed with 1 cm of water): its peak, and "
    f"its mean from {PLATEAU[0]} to {PLATEAU[1]} s. The run's force is averaged over "
    f"{1000 * SMOOTHED:g} ms.",
    unit="0.3 m/Δp",
    short=(),
    full=(15, 20),
    run=run,
    draw=draw,
)
