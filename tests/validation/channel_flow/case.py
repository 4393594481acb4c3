"""Poiseuille and Couette flow from rest, against their series."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.cases.poiseuille import ACCELERATION, SPEED, VISCOSITY, WIDTH
from kolk.compare import compare_channel
from kolk.compare.fields import fluid
from kolk.references import couette, poiseuille

from ..running import FloatArray, counts, finished_run
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

TIMES = (0.05, 0.1, 0.2, 0.5, 1.0)
"""s; the momentum crosses the channel within L²/ν = 1 s."""


def poiseuille_scene(resolution: int) -> kolk.Scene:
    """The built-in scene with frames at every time compared."""
    return kolk.load("poiseuille").replace({"spacing": WIDTH / resolution, "output.every": 0.05})


def couette_scene(resolution: int) -> kolk.Scene:
    """The same channel without a force, its upper plate sliding with `SPEED`."""
    spacing = WIDTH / resolution
    length = max(10.0, 0.4 * resolution) * spacing
    thick = 4.0 * spacing
    plates = {"lower": (-thick, 0.0, 0.0), "upper": (WIDTH, WIDTH + thick, SPEED)}
    return kolk.Scene(
        name="couette",
        dimension=2,
        spacing=spacing,
        until=TIMES[-1],
        periodic={"x": [0.0, length]},
        fluid=[
            {
                "name": "fluid",
                "shape": {"box": {"from": [0.0, 0.0], "to": [length, WIDTH]}},
                "viscosity": {"laminar": VISCOSITY},
            }
        ],
        wall=[
            {
                "name": name,
                "shape": {"box": {"from": [0.0, low], "to": [length, high]}},
                "slip": "no",
                "velocity": [speed, 0.0],
            }
            for name, (low, high, speed) in plates.items()
        ],
        numerics={"expected_speed": SPEED},
        output={"every": 0.05},
    )


def run(resolution: int) -> Level:
    figures: list[Figure] = []
    curves: dict[str, list[tuple[float, FloatArray, FloatArray]]] = {}
    goal = 0.002 if resolution == 40 else None
    # (kind, scene, drive, bound): the first issue judges Poiseuille only
    flows = (
        ("poiseuille", poiseuille_scene(resolution), ACCELERATION, 0.01),
        ("couette", couette_scene(resolution), SPEED, None),
    )
    for kind, scene, drive, bound in flows:
        with finished_run(scene) as result:
            errors, curves[kind] = [], []
            for frame in result.frames[1:]:
                error = compare_channel(frame, kind, width=WIDTH, viscosity=VISCOSITY, drive=drive)[
                    0
                ]
                errors.append(error.value)
                if any(abs(frame.time - t) < 1e-9 for t in TIMES):
                    position, velocity = fluid(frame, "velocity")
                    curves[kind].append((frame.time, position[:, 1], velocity[:, 0]))
            name = f"{kind.capitalize()}, L2 over the largest velocity, worst time"
            figures.append(Figure(name, float(max(errors)), bound, goal, "%"))
            size = counts(result)
    return Level(resolution, tuple(figures), **size, curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    panels = canvas.subplots(1, 2)
    level = levels[-1]
    y = np.linspace(0.0, WIDTH, 200)
    for axes, (kind, profiles) in zip(panels, level.curves.items(), strict=True):
        for time, height, velocity in profiles:
            axes.plot(velocity / SPEED, height / WIDTH, ".", markersize=3, label=f"t = {time:g} s")
            if kind == "poiseuille":
                exact = poiseuille(
                    y, time, width=WIDTH, viscosity=VISCOSITY, acceleration=ACCELERATION
                )
            else:
                exact = couette(y, time, width=WIDTH, viscosity=VISCOSITY, speed=SPEED)
            axes.plot(exact / SPEED, y / WIDTH, "k-", linewidth=0.8)
        axes.set(xlabel="u / U", ylabel="y / L", title=f"{kind.capitalize()}, {level.resolution}")
        axes.legend(fontsize="small")


case = Case(
    title="Poiseuille and Couette flow, Re 0.025 and 0.025",
    setup="Fluid between plates 1 mm apart, from rest to the steady profile (1 s): the built-in "
    "scene `poiseuille`, and the same channel with a sliding plate instead of a force.",
    reference="The series of Morris et al. 1997; the worst of 20 times.",
    unit="L/Δp",
    short=(40,),
    full=(20, 40),
    run=run,
    draw=draw,
)
