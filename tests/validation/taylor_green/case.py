"""The Taylor-Green vortex at Re 100 from a jittered start."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.compare import compare_taylor_green
from kolk.compare.fields import fluid
from kolk.references import taylor_green_decay_rate

from ..running import counts, finished_run
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

VISCOSITY = 0.01
GOALS = {50: 0.01, 100: 0.004}
"""Of the L1 error of the velocity over its mean at t = 2 s."""


def run(resolution: int) -> Level:
    scene = kolk.load("taylor-green").replace({"spacing": 1.0 / resolution, "output.every": 0.1})
    with finished_run(scene) as result:
        frames = result.frames
        decay, error = compare_taylor_green(
            frames[0], frames[-1], viscosity=VISCOSITY, speed=1.0, length=1.0
        )
        speed = [(f.time, float(np.sqrt(np.mean(fluid(f, "velocity")[1] ** 2)))) for f in frames]
        wrong = abs(decay.details["relative_error"])
        figures = (
            Figure(
                "velocity, L1 over its mean, at t = 2",
                error.details["l1"],
                goal=GOALS.get(resolution),
                unit="%",
            ),
            Figure("decay of the velocity (RMS) at t = 2", wrong, 0.05, unit="%"),
        )
        position, velocity = fluid(frames[-1], "velocity")
        curves = {"speed": np.array(speed), "x": position, "u": velocity}
        return Level(resolution, figures, **counts(result), curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    decay, field = canvas.subplots(1, 2)
    for level in levels:
        t, speed = level.curves["speed"].T
        decay.semilogy(t, speed / speed[0], label=f"L/Δp = {level.resolution}")
    exact = np.exp(taylor_green_decay_rate(VISCOSITY) * t)
    decay.semilogy(t, exact, "k--", linewidth=1, label="exact")
    decay.set(xlabel="t U/L", ylabel="velocity (RMS) over its start")
    decay.legend()
    last = levels[-1].curves
    points = field.scatter(*last["x"].T, c=np.linalg.norm(last["u"], axis=1), s=4.0)
    canvas.colorbar(points, label="speed / U")
    field.set(aspect="equal", title=f"t = {t[-1]:g}, U e^bt = {math.exp(-1.58):.3f} U")


case = Case(
    title="Taylor-Green vortex, Re 100",
    setup="The built-in scene `taylor-green`: a periodic square of side L, particles jittered by "
    "a tenth of the spacing.",
    reference="The exact solution, u ~ exp(-8π²t/Re), at t = 2 L/U.",
    unit="L/Δp",
    short=(50,),
    full=(50, 100),
    run=run,
    draw=draw,
)
