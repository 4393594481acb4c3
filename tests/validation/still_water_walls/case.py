"""Water at rest against every kind of wall, over a flat bottom and around a wedge."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

import kolk

from ..running import simulation
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

H, GRAVITY, DENSITY = 0.5, 9.81, 1000.0
TIME = math.sqrt(H / GRAVITY)
KINDS = ("adami", "dynamic", "modified-dynamic", "semi-analytical", "penalty", "mirror")
PLANES = ("mirror",)
"""Kinds that need right angles."""
WEDGE = {"polygon": {"points": [[0.5 * H, 0.0], [1.5 * H, 0.0], [H, 0.5 * H]]}}
PLACES = ("flat", "wedge", "packed wedge")
"""Without a wedge; with one on the lattices of a scene's defaults; with packed particles."""
BOUNDS = {(kind, "packed wedge"): 0.005 for kind in KINDS[:3]}
"""Largest pressure error that passes, where it is judged."""


def scene(kind: str, place: str, resolution: int) -> kolk.Scene:
    """Water of depth H in a tank 2 H wide, a wedge of H/2 on its bottom."""
    still = kolk.load("still-water").replace(
        {"spacing": H / resolution, "numerics.wall": kind, "output.every": TIME}
    )
    if place == "flat":
        return still
    data: dict[str, Any] = still.plain()
    data["wall"].append({"name": "wedge", "shape": WEDGE})
    water = data["fluid"][0]
    water["shape"] = {"difference": {"of": water["shape"], "minus": [WEDGE]}}
    if place == "packed wedge":
        water["arrangement"] = "packed"
    data["probe"] = []
    return kolk.Scene(**data)


def measure(kind: str, place: str, resolution: int) -> tuple[float, float, float, int, int, int]:
    """Errors of pressure (L2 over ρgH) and at probes on the walls (largest, over ρgH), kinetic
    energy over m g H, leaks, particles and steps after 20 √(H/g)."""
    sim = simulation(scene(kind, place, resolution))
    sim.advance_to(20 * TIME)
    water = sim.bodies["water"]
    scale = DENSITY * GRAVITY * H
    exact = DENSITY * GRAVITY * (H - water.position[:, 1])
    error = float(np.sqrt(np.mean((water.pressure - exact) ** 2))) / scale
    places = [[0.25 * H, 0.0], [2 * H, 0.5 * H], [0.0, 0.25 * H], [2 * H, 0.0]]
    places += [[0.75 * H, 0.25 * H], [H, 0.5 * H]] if place != "flat" else [[H, 0.0]]
    at = np.array(places)
    read = sim.sample(at, ["pressure"])["pressure"]
    probes = float(np.abs(read - DENSITY * GRAVITY * (H - at[:, 1])).max()) / scale
    energy = sim.energy.kinetic / (float(water.mass.sum()) * GRAVITY * H)
    return error, probes, energy, sim.leaks, sum(sim.particles.values()), sim.step_count


def run(resolution: int) -> Level:
    figures: list[Figure] = []
    particles = steps = 0
    for place in PLACES:
        for kind in KINDS:
            if kind in PLANES and place != "flat":
                continue
            error, probes, energy, leaks, n, k = measure(kind, place, resolution)
            where, bound = f"{kind}, {place}", BOUNDS.get((kind, place))
            figures += [
                Figure(f"{where}: pressure, L2 over ρgH", error, bound, 0.005, "%"),
                Figure(f"{where}: probes on walls, largest over ρgH", probes, unit="%"),
                Figure(f"{where}: kinetic energy over mgH", energy, None, 1e-8),
                Figure(f"{where}: leaks", leaks, None, 0),
            ]
            particles, steps = max(particles, n), max(steps, k)
    return Level(resolution, tuple(figures), particles, steps)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    panels = canvas.subplots(1, 2)
    for axis, (quantity, stride, limit) in zip(
        panels,
        (("pressure, L2 over ρgH", 0, 0.005), ("kinetic energy over mgH", 2, 1e-8)),
        strict=True,
    ):
        for level in levels:
            values = [figure.value for figure in level.figures[stride::4]]
            names = [figure.name.partition(":")[0] for figure in level.figures[stride::4]]
            label = f"H/Δp = {level.resolution}"
            axis.semilogx(values, range(len(values)), "o", label=label)
            axis.set_yticks(range(len(names)), names if stride == 0 else [""] * len(names))
        axis.axvline(limit, color="k", linewidth=1, linestyle="--")
        axis.set(xlabel=quantity)
        axis.legend()


case = Case(
    title="Still water, every wall",
    setup="A tank 2 H wide with water of depth H = 0.5 m, with a flat bottom and around a wedge of "
    "height H/2 with faces of 45 degrees, from lattices and packed, for every wall method.",
    reference="Hydrostatic pressure of an incompressible fluid, no motion, after 20 √(H/g).",
    unit="H/Δp",
    short=(),
    full=(25, 50),
    run=run,
    draw=draw,
)
