"""The dam break of Lobovsky et al. 2014: pressure at sensor 2 against 100 repetitions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.cases.dam_break import PRESSURE, TIME, H
from kolk.compare import compare_band
from kolk.compare.band import align
from kolk.references import load

from ..running import counts, finished_run, probe
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

BAND = "lobovsky-sensor2-band"
DEFAULT = 60
"""The built-in scene's resolution: coarser ones are shown, not judged."""


def run(resolution: int) -> Level:
    scene = kolk.load("dam-break").replace(spacing=H / resolution)
    with finished_run(scene) as result:
        time, pressure = probe(result, "P2")
        found = {r.name: r for r in compare_band("P2", time, pressure, load(BAND), TIME, PRESSURE)}
        size = counts(result)
    curves = {"time": time, "pressure": pressure}
    judged = resolution >= DEFAULT
    if "first peak" not in found:
        figures = (
            Figure(
                "first peak, beyond the band's height", math.nan, 0.25 if judged else None, unit="%"
            ),
        )
        return Level(resolution, figures, **size, curves=curves)
    peak, when = found["first peak"], found["time of the first peak"]
    assert isinstance(peak.reference, tuple) and isinstance(when.reference, float)
    low, high = peak.reference
    share = found["share of time inside the band"]
    figures = (
        Figure(
            "first peak, beyond the band's height",
            max(peak.value / high - 1.0, 1.0 - peak.value / low, 0.0),
            0.25 if judged else None,
            unit="%",
        ),
        # by the run's own clock: no shift helps this figure
        Figure(
            "time of the first peak, off by",
            abs(when.details["unshifted"] - when.reference),
            0.3 if judged else None,
            unit="√(H/g)",
        ),
        Figure(
            "shift to arrive with the experiment",
            abs(share.details["shift"]),
            0.4 if judged else None,
            unit="√(H/g)",
        ),
        Figure("share of time outside the band", 1.0 - share.value, None, 0.2, "%"),
    )
    return Level(resolution, figures, **size, curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes = canvas.subplots()
    band = load(BAND)
    axes.fill_between(
        band.time, band.values("low"), band.values("high"), color="0.8", label="100 repetitions"
    )
    axes.plot(band.time, band.values("median"), "k-", linewidth=1, label="their median")
    for level in levels:
        ours = align(level.curves["time"], level.curves["pressure"], band, TIME, PRESSURE)
        label = f"kolk, H/Δp = {level.resolution}, shifted by {ours.shift:+.2f}"
        axes.plot(ours.time, ours.value, linewidth=0.8, label=label)
    top = 1.6 * float(np.max(band.values("high")))
    axes.set(xlabel="t √(g/H)", ylabel="p / ρgH at sensor 2", xlim=(2.0, 7.1), ylim=(-0.3, top))
    axes.legend()


case = Case(
    title="Dam break, Lobovsky sensor 2",
    setup="The built-in scene `dam-break`: H = 0.3 m, tank 1.61 m long; the water is free at once.",
    reference="The band of 100 repetitions at sensor 2, 15 mm above the bottom. The record is "
    "shifted once to arrive with the experiment, for the gate's motion; the time of the peak is "
    "judged without the shift.",
    unit="H/Δp",
    short=(60,),
    full=(30, 60, 120),
    run=run,
    draw=draw,
)
