"""A drop that its own motion stretches: Monaghan 1994."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.references import stretching_drop

from ..running import FloatArray, counts, simulation
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

RADIUS, RATE, DENSITY = 1.0, 100.0, 1000.0
UNTIL = 0.82 / RATE
"""s; the drop is then four times as long as wide."""
SAMPLES = 20


def scene(resolution: int) -> kolk.Scene:
    """A disc with the velocity (-A x, A y) and the pressure that belongs to it."""
    centre = 0.5 * DENSITY * (RATE * RADIUS) ** 2
    return kolk.Scene(
        name="stretching-drop",
        dimension=2,
        spacing=RADIUS / resolution,
        until=UNTIL,
        fluid=[
            {
                "name": "drop",
                "shape": {"disc": {"centre": [0.0, 0.0], "radius": RADIUS}},
                "density": DENSITY,
                "velocity": [f"{-RATE} * x", f"{RATE} * y"],
                "pressure": f"{centre} * (1 - (x*x + y*y) / {RADIUS**2})",
            }
        ],
    )


def semi_axes(body: kolk.simulation.BodyView) -> FloatArray:
    """(2,) semi-axes, m, of the ellipse with the second moments of the particles' mass."""
    mass, position = body.mass, body.position
    spread = (mass[:, None] * (position - position.mean(axis=0)) ** 2).sum(axis=0) / mass.sum()
    return np.asarray(2.0 * np.sqrt(spread))


@dataclass
class Stretching:
    """A drop that has stretched."""

    record: FloatArray
    """(n, 3) time (s) and both semi-axes over those at the start."""
    short: float
    """Largest error of the short semi-axis, as a share."""
    long: float
    """The same of the long one."""

    @property
    def axes(self) -> float:
        """The larger of both."""
        return max(self.short, self.long)


def stretch(sim: kolk.Simulation, look: Callable[[], object] = lambda: None) -> Stretching:
    """Lets the drop of `scene` stretch; ``look`` is called on the way."""
    drop = sim.bodies["drop"]
    # the lattice is no exact disc: what it lacks at the start is no error of the motion
    start = semi_axes(drop) / RADIUS
    records = []
    for step in range(SAMPLES + 1):
        sim.advance_to(step * UNTIL / SAMPLES)
        records.append((sim.time, *(semi_axes(drop) / start)))
        look()
    record = np.array(records)
    exact = stretching_drop(record[:, 0], radius=RADIUS, rate=RATE, density=DENSITY)
    x, y = np.abs(record[:, 1] / exact.x - 1.0), np.abs(record[:, 2] / exact.y - 1.0)
    return Stretching(record, float(x.max()), float(y.max()))


def run(resolution: int) -> Level:
    sim = simulation(scene(resolution))
    before = sim.energy.total
    found = stretch(sim)
    figures = (
        Figure("semi-axes, worst", found.axes, None, 0.01, "%"),
        Figure("long semi-axis, worst", found.long, unit="%"),
        Figure("energy lost", abs(1.0 - sim.energy.total / before), unit="%"),
    )
    curves = {"axes": found.record, "drop": sim.bodies["drop"].arrays()}
    return Level(resolution, figures, **counts(sim), curves=curves)


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes, field = canvas.subplots(1, 2)
    t = np.linspace(0.0, UNTIL, 100)
    exact = stretching_drop(t, radius=RADIUS, rate=RATE, density=DENSITY)
    axes.plot(t * RATE, exact.x, "k-", t * RATE, exact.y, "k-", linewidth=0.8)
    for level in levels:
        time, a, b = level.curves["axes"].T
        label = f"R/Δp = {level.resolution}"
        (line,) = axes.plot(time * RATE, b, "o", markersize=3, label=label)
        axes.plot(time * RATE, a, "o", markersize=3, color=line.get_color())
    axes.set(xlabel="t A", ylabel="semi-axes / R")
    axes.legend()
    drop = levels[-1].curves["drop"]
    points = field.scatter(*drop["position"].T, c=drop["pressure"] / 1e6, s=2.0)
    canvas.colorbar(points, label="p, MPa")
    field.set(aspect="equal", xlabel="x / R", title=f"t A = {UNTIL * RATE:g}")


case = Case(
    title="Stretching drop",
    setup="A free disc with the velocity (-A x, A y) and the pressure that belongs to it.",
    reference="The ordinary differential equation of Monaghan 1994, until the drop is four times "
    f"as long as wide (tA = {UNTIL * RATE:g}); semi-axes from the second moments of the mass.",
    unit="R/Δp",
    short=(20,),
    full=(25, 50),
    run=run,
    draw=draw,
)
