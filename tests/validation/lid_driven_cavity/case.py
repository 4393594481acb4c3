"""The lid-driven cavity at Re 100 and 400: velocity on the centre lines of the steady flow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy.spatial import cKDTree

import kolk

from ..running import FloatArray, simulation
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

UNTIL = {100: 12.0, 400: 25.0}
"""L/U by Reynolds number: the centre lines then change by less than the goal's tenth."""
AVERAGED, SAMPLES = 2.0, 20
"""The last stretch, L/U, over which the profiles are averaged, and its samples."""


def scene(resolution: int, reynolds: int) -> kolk.Scene:
    """A unit square whose upper wall slides with 1 m/s."""
    spacing = 1.0 / resolution
    thick = 4.0 * spacing
    return kolk.Scene(
        name="lid-driven-cavity",
        dimension=2,
        spacing=spacing,
        until=UNTIL[reynolds],
        fluid=[
            {
                "name": "fluid",
                "shape": {"box": {"from": [0.0, 0.0], "to": [1.0, 1.0]}},
                "viscosity": {"laminar": 1.0 / reynolds},
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [1.0, 1.0], "open": ["top"]}},
                "slip": "no",
            },
            {
                "name": "lid",
                "shape": {"box": {"from": [-thick, 1.0], "to": [1.0 + thick, 1.0 + thick]}},
                "slip": "no",
                "velocity": [1.0, 0.0],
            },
        ],
    )


@cache
def reference(reynolds: int) -> pd.DataFrame:
    """Columns s, u(0.5, s) and v(s, 0.5) between the walls."""
    table = pd.read_csv(Path(__file__).with_name("reference.csv"), comment="#")
    inside = (table["s"] > 0.0) & (table["s"] < 1.0)
    return table[(table["Re"] == reynolds) & inside].reset_index(drop=True)


def quadratic_fit(
    points: FloatArray, position: FloatArray, value: FloatArray, radius: float
) -> FloatArray:
    """(m,) value at points (m, 2) of the quadric fitted to the particles within ``radius`` of each.

    A plain kernel mean is off near walls, where there are particles on one side only, and a plane
    smooths the layer under the lid by as much as the simulation is off there.
    """
    fitted = np.empty(len(points))
    for row, near in enumerate(cKDTree(position).query_ball_point(points, radius)):
        x, y = (position[near] - points[row]).T / radius
        weight = np.sqrt(np.maximum(1.0 - x**2 - y**2, 0.0))
        terms = np.column_stack([np.ones(len(near)), x, y, x**2, x * y, y**2])
        fitted[row] = np.linalg.lstsq(terms * weight[:, None], weight * value[near], rcond=None)[0][
            0
        ]
    return fitted


def run(resolution: int) -> Level:
    figures: list[Figure] = []
    curves: dict[str, FloatArray] = {}
    steps = 0
    for reynolds, until in UNTIL.items():
        exact = reference(reynolds)
        s = exact["s"].to_numpy()
        middle = np.full_like(s, 0.5)
        sim = simulation(scene(resolution, reynolds))
        sums = np.zeros((2, len(s)))
        for sample in range(SAMPLES):
            sim.advance_to(until - AVERAGED * (1.0 - (sample + 1) / SAMPLES))
            fluid = sim.bodies["fluid"].arrays()
            h = sim.scene.smoothing_length
            places = (np.stack([middle, s], axis=1), np.stack([s, middle], axis=1))
            for axis, points in enumerate(places):
                velocity = fluid["velocity"][:, axis]
                sums[axis] += quadratic_fit(points, fluid["position"], velocity, 1.25 * h)
        found = sums / SAMPLES
        for axis, column in enumerate(("u_at_x0.5_y=s", "v_at_x=s_y0.5")):
            rms = math.sqrt(float(np.mean((found[axis] - exact[column].to_numpy()) ** 2)))
            goal = 0.004 if resolution == 100 else None
            figures.append(Figure(f"{'uv'[axis]} at Re {reynolds}, RMS over U", rms, None, goal))
        curves[str(reynolds)] = np.stack([s, *found])
        steps += sim.step_count
    total = sum(sim.particles.values())
    return Level(resolution, tuple(figures), total, steps, curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    panels = canvas.subplots(1, 2)
    for axes, reynolds in zip(panels, UNTIL, strict=True):
        for level in levels:
            s, u, v = level.curves[str(reynolds)]
            (line,) = axes.plot(s, u, ".", markersize=3, label=f"L/Δp = {level.resolution}")
            axes.plot(s, v, ".", markersize=3, color=line.get_color())
        exact = reference(reynolds)
        axes.plot(exact["s"], exact.iloc[:, 2], "k-", exact["s"], exact.iloc[:, 3], "k-", lw=0.8)
        axes.set(title=f"Re {reynolds}", xlabel="s / L", ylabel="u(0.5, s) and v(s, 0.5) over U")
        axes.legend()


case = Case(
    title="Lid-driven cavity, Re 100 and 400",
    setup="A square of side L whose lid slides with U, from rest to "
    f"{UNTIL[100]:g} L/U at Re 100 and {UNTIL[400]:g} L/U at Re 400; profiles averaged over the "
    f"last {AVERAGED:g} L/U.",
    reference="Finite differences, Richardson-extrapolated from 128 and 256 cells.",
    unit="L/Δp",
    short=(),
    full=(25, 50, 100),
    run=run,
    draw=draw,
)
