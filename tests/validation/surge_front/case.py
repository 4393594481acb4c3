"""The surge front of a collapsing column: Martin and Moyce, Koshizuka and Oka."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import kolk
from kolk.cases.surge_front import TIME, A
from kolk.compare import compare_front
from kolk.compare.front import align_front
from kolk.references import load

from ..running import counts, finished_run, probe
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

DEFAULT = 40
"""The built-in scene's resolution; coarser ones cannot resolve the friction of the bed."""
RECORDS = {
    "martin-moyce-2.25in": "Martin-Moyce, a = 2.25 in",
    "martin-moyce-1.125in": "Martin-Moyce, a = 1.125 in",
    "koshizuka-oka": "Koshizuka-Oka",
}


def run(resolution: int) -> Level:
    scene = kolk.load("surge-front").replace(spacing=A / resolution)
    with finished_run(scene) as result:
        time, front = probe(result, "front")
        figures = []
        for name, label in RECORDS.items():
            error = compare_front("front", time, front, load(name), TIME, A)[0]
            # the scene's column is the one of 2.25 inches: that record is the one judged
            judged = name == "martin-moyce-2.25in" and resolution >= DEFAULT
            bound = 0.15 if judged else None
            figures.append(Figure(f"front, RMS from {label}", error.value, bound, 0.08, "a"))
        curves = {"time": time, "front": front}
        return Level(resolution, tuple(figures), **counts(result), curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes = canvas.subplots()
    shown = load("martin-moyce-2.25in")
    for level in levels:
        ours = align_front(level.curves["time"], level.curves["front"], shown, TIME, A)
        axes.plot(ours.time, ours.front, label=f"kolk, a/Δp = {level.resolution}")
    for (name, label), mark in zip(RECORDS.items(), "os^", strict=True):
        record = load(name)
        # each record has its own unknown release: bring it to the clock of the first
        shift = align_front(record.time * TIME, record.values("front") * A, shown, TIME, A).shift
        axes.plot(record.time + shift, record.values("front"), mark, label=label)
    axes.set(xlabel="t √(2g/a), aligned at Z = 1.44", ylabel="Z = front / a", ylim=(1.0, 10.0))
    axes.set_xlim(0.0, math.ceil(ours.time[-1]))
    axes.legend()


case = Case(
    title="Surge front",
    setup="The built-in scene `surge-front`: a column a wide and 2a high, a = 57.15 mm.",
    reference="Martin and Moyce 1952 (two columns) and Koshizuka and Oka 1996, each aligned at "
    "Z = 1.44, over the times that both cover; RMS distance in a.",
    unit="a/Δp",
    short=(40,),
    full=(20, 40),
    run=run,
    draw=draw,
)
