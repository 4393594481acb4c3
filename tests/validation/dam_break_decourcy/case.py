"""The dam break of De Courcy et al. 2024: four pressures against a fine δ-SPH run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.compare import compare_series
from kolk.references import load

from ..running import counts, finished_run, probe
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

H, GRAVITY, DENSITY = 0.6, 9.81, 1000.0
TIME, PRESSURE = math.sqrt(H / GRAVITY), DENSITY * GRAVITY * H
SENSORS = {"P1": 0.006, "P2": 0.030, "P3": 0.060, "P4": 0.160}
"""Heights of the discs' centres over the bottom of the end wall, m."""
GOALS = {"P1": 0.19, "P2": 0.21, "P3": 0.25, "P4": 0.12}
"""RMS in ρgH at H/Δp = 80: what the best code elsewhere reaches."""
PEAK = 1.5
"""No peak should be higher than so many of the reference's."""
UNTIL = 7.0
"""sqrt(H/g)"""


def scene(resolution: int) -> kolk.Scene:
    """A column 2H x H in a tank 5.366H x 3H with sensors of 8.4 mm on its end wall."""
    length = 5.366 * H
    return kolk.Scene(
        name="dam-break-decourcy",
        dimension=2,
        spacing=H / resolution,
        gravity=[0.0, -GRAVITY],
        until=UNTIL * TIME,
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [2 * H, H]}},
                "density": DENSITY,
                "viscosity": {"artificial": 0.02},
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [length, 3 * H], "open": ["top"]}},
            }
        ],
        probe=[
            {"name": name, "pressure": {"at": [length, height], "diameter": 0.0084}}
            for name, height in SENSORS.items()
        ],
        output={"every": 0.2 * TIME},
    )


def run(resolution: int) -> Level:
    figures, peaks, curves = [], [], {}
    with finished_run(scene(resolution)) as result:
        for name in SENSORS:
            time, pressure = probe(result, name)
            curves[name] = (time / TIME, pressure / PRESSURE)
            record = load(f"decourcy-{name.lower()}")
            column = record.columns[0]
            rms = compare_series(name, time, pressure, record, column, TIME, PRESSURE)[0]
            goal = GOALS[name] if resolution == 80 else None
            figures.append(Figure(f"{name}, RMS", rms.value, None, goal, "ρgH"))
            peaks.append(float(pressure.max()) / PRESSURE / record.peak(column)[0])
        size = counts(result)
    goal = PEAK if resolution == 80 else None
    figures.append(Figure("highest peak over the reference's", max(peaks), None, goal))
    return Level(resolution, tuple(figures), **size, curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    for axes, name in zip(np.ravel(canvas.subplots(2, 2, sharex=True)), SENSORS, strict=True):
        for level in levels:
            axes.plot(*level.curves[name], linewidth=0.6, label=f"H/Δp = {level.resolution}")
        record = load(f"decourcy-{name.lower()}")
        axes.plot(record.time, record.values(), "k-", linewidth=1, label="De Courcy")
        axes.set(title=name, ylim=(-0.5, 2.0 * record.peak()[0]), xlim=(2.0, UNTIL))
    axes.legend(fontsize="small")
    canvas.supxlabel("t √(g/H)")
    canvas.supylabel("p / ρgH")


case = Case(
    title="Dam break, De Courcy",
    setup="A column 2H x H, H = 0.6 m, in a tank 5.366H x 3H; sensors of 8.4 mm at 6, 30, 60 and "
    "160 mm on the end wall.",
    reference="δ-SPH with H/Δp = 400 (De Courcy et al. 2024); RMS over the times of its record.",
    unit="H/Δp",
    short=(20,),
    full=(40, 80),
    run=run,
    draw=draw,
)
