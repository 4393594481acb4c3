"""Water at rest: it must stay so, under hydrostatic pressure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.compare import compare_hydrostatic
from kolk.compare.fields import fluid
from kolk.references import hydrostatic_pressure

from ..running import counts, finished_run
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

H, GRAVITY, DENSITY = 0.5, 9.81, 1000.0
TIME = math.sqrt(H / GRAVITY)


def run(resolution: int) -> Level:
    scene = kolk.load("still-water").replace({"spacing": H / resolution, "output.every": TIME})
    with finished_run(scene) as result:
        history = []
        for frame in result.frames:
            pressure, energy = compare_hydrostatic(
                frame, surface=H, bottom=0.0, density=DENSITY, gravity=GRAVITY
            )
            history.append((frame.time / TIME, pressure.value, energy.value))
        position, last = fluid(result.frames[-1], "pressure")
        figures = (
            Figure("pressure, L2 over ρgH, at 20 √(H/g)", history[-1][1], 0.02, 0.005, "%"),
            Figure("kinetic energy over mgH, at 20 √(H/g)", history[-1][2], 1e-6, 1e-8),
            Figure("largest kinetic energy over mgH on the way", max(e for _, _, e in history)),
        )
        curves = {"history": np.array(history), "y": position[:, 1], "p": last}
        return Level(resolution, figures, **counts(result), curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    profile, energy = canvas.subplots(1, 2)
    scale = DENSITY * GRAVITY * H
    for level in levels:
        c = level.curves
        label = f"H/Δp = {level.resolution}"
        profile.plot(c["p"] / scale, c["y"] / H, ".", markersize=2, label=label)
        energy.semilogy(c["history"][1:, 0], c["history"][1:, 2], label=label)
    y = np.linspace(0.0, H, 3)
    exact = hydrostatic_pressure(y, surface=H, density=DENSITY, gravity=GRAVITY)
    profile.plot(exact / scale, y / H, "k-", linewidth=1, label="ρg(H - y)")
    profile.set(xlabel="p / ρgH", ylabel="y / H")
    energy.axhline(1e-6, color="k", linewidth=1, linestyle="--")
    energy.set(xlabel="t √(g/H)", ylabel="kinetic energy / mgH")
    profile.legend()
    energy.legend()


case = Case(
    title="Still water",
    setup="The built-in scene `still-water`: a tank 2 H wide with water of depth H = 0.5 m.",
    reference="Hydrostatic pressure of an incompressible fluid, no motion, after 20 √(H/g).",
    unit="H/Δp",
    short=(25,),
    full=(25, 50),
    run=run,
    draw=draw,
)
