"""A drop that oscillates under a central force: Monaghan and Rafiee 2013."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.references import oscillating_drop, oscillating_drop_period

from ..running import FloatArray, counts, simulation
from ..stretching_drop.case import semi_axes
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

RADIUS, RATE, FORCE, DENSITY = 1.0, 1.0, 1.0, 1000.0
PERIOD = oscillating_drop_period(RATE, FORCE)
PERIODS = 2


def scene(resolution: int) -> kolk.Scene:
    """A disc with the velocity (-A x, A y), in balance with the force and its own motion."""
    centre = 0.5 * DENSITY * RADIUS**2 * (RATE**2 + FORCE**2)
    return kolk.Scene(
        name="drop-central-force",
        dimension=2,
        spacing=RADIUS / resolution,
        until=PERIODS * PERIOD,
        fluid=[
            {
                "name": "drop",
                "shape": {"disc": {"centre": [0.0, 0.0], "radius": RADIUS}},
                "density": DENSITY,
                "velocity": [f"{-RATE} * x", f"{RATE} * y"],
                "pressure": f"{centre} * (1 - (x*x + y*y) / {RADIUS**2})",
            }
        ],
        numerics={"expected_speed": 1.5 * RATE * RADIUS},
    )


def stepped(plain: kolk.Scene) -> kolk.Scene:
    """The scene with a fixed step: half a step of force, a step of the fluid, half a step of force
    are of second order in time."""
    step = 0.4 * plain.smoothing_length / plain.sound_speed
    return plain.replace({"numerics.time_step": PERIOD / math.ceil(PERIOD / step)})


def kick(sim: kolk.Simulation, duration: float) -> None:
    """Lets the force -B² r act for ``duration`` (s): a scene knows uniform gravity only."""
    state = sim.state()
    for axis in range(2):
        pull = FORCE**2 * state[f"position_{axis}"]
        state[f"velocity_{axis}"] = state[f"velocity_{axis}"] - duration * pull
    sim.restore(state)


def energy(sim: kolk.Simulation) -> float:
    """Kinetic, elastic and the force's energy, J per metre."""
    drop = sim.bodies["drop"]
    outer = 0.5 * FORCE**2 * float(np.sum(drop.mass[:, None] * drop.position**2))
    return sim.energy.total + outer


@dataclass
class Oscillation:
    """A drop that has oscillated."""

    sim: kolk.Simulation
    record: FloatArray
    """(n, 3) time (s) and both semi-axes over those at the start."""
    axes: float
    """Largest error of a semi-axis, as a share."""
    period: float
    """Error of the period, as a share."""
    lost: float
    """Share of its energy that it lost in each period."""


def oscillate(
    sim: kolk.Simulation, periods: int, look: Callable[[], object] = lambda: None
) -> Oscillation:
    """Lets the drop of `scene` oscillate; ``look`` is called after each period."""
    step = sim.scene.numerics.time_step
    assert step is not None
    steps = round(periods * PERIOD / step)
    drop = sim.bodies["drop"]
    round_axes, whole = semi_axes(drop) / RADIUS, energy(sim)
    kick(sim, 0.5 * step)
    records = [(0.0, *(semi_axes(drop) / round_axes))]
    every, beat = max(1, steps // (200 * periods)), steps // periods
    for taken in range(1, steps + 1):
        sim.advance_to(taken * step)
        kick(sim, step if taken < steps else 0.5 * step)
        if taken % every == 0:
            records.append((sim.time, *(semi_axes(drop) / round_axes)))
        if taken % beat == 0:
            look()
    record = np.array(records)
    exact = oscillating_drop(record[:, 0], radius=RADIUS, rate=RATE, force=FORCE)
    error = np.maximum(np.abs(record[:, 1] / exact.x - 1.0), np.abs(record[:, 2] / exact.y - 1.0))
    return Oscillation(
        sim,
        record,
        float(error.max()),
        abs(period(record) / PERIOD - 1.0),
        abs(1.0 - energy(sim) / whole) / periods,
    )


def run(resolution: int) -> Level:
    found = oscillate(simulation(stepped(scene(resolution))), PERIODS)
    judged = resolution == 50
    figures = (
        Figure("semi-axes, worst", found.axes, None, 0.01 if judged else None, "%"),
        Figure("period", found.period, None, 0.005 if judged else None, "%"),
        Figure("energy lost a period", found.lost, None, 0.01 if judged else None, "%"),
    )
    curves = {"axes": found.record, "drop": found.sim.bodies["drop"].arrays()}
    return Level(resolution, figures, **counts(found.sim), curves=curves)


def period(record: FloatArray) -> float:
    """Period (s) from the times at which the axes are equal: a = b twice a period, downwards."""
    time, ratio = record[:, 0], np.log(record[:, 1] / record[:, 2])
    after = np.flatnonzero((ratio[1:-1] >= 0.0) & (ratio[2:] < 0.0)) + 1
    if not len(after):
        return math.nan
    i = int(after[-1])
    crossing = time[i] + (time[i + 1] - time[i]) * ratio[i] / (ratio[i] - ratio[i + 1])
    # the motion starts with such a crossing
    return float(crossing / len(after))


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes, field = canvas.subplots(1, 2)
    t = np.linspace(0.0, PERIODS * PERIOD, 300)
    exact = oscillating_drop(t, radius=RADIUS, rate=RATE, force=FORCE)
    axes.plot(t / PERIOD, exact.x, "k-", linewidth=0.8, label="exact")
    for level in levels:
        time, a, _ = level.curves["axes"].T
        axes.plot(time / PERIOD, a, ".", markersize=2, label=f"R/Δp = {level.resolution}")
    axes.set(xlabel="t / period", ylabel="semi-axis along x / R")
    axes.legend()
    drop = levels[-1].curves["drop"]
    points = field.scatter(*drop["position"].T, c=drop["pressure"], s=2.0)
    canvas.colorbar(points, label="p, Pa")
    field.set(aspect="equal", xlabel="x / R", title=f"after {PERIODS} periods")


case = Case(
    title="Drop in a central force",
    setup="A free disc under the force -B² r per mass with the velocity (-A x, A y), A = B. A "
    "scene knows uniform gravity only, so the force acts between the steps, through `state()` "
    "and `restore()`.",
    reference=f"The ordinary differential equation of Monaghan and Rafiee 2013, {PERIODS} periods "
    "of 4.827/B.",
    unit="R/Δp",
    short=(20,),
    full=(25, 50),
    run=run,
    draw=draw,
)
