"""A standing wave that viscosity damps: frequency and rate against the linear roots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import kolk
from kolk.references import standing_wave

from ..running import FloatArray, counts, simulation
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

H, GRAVITY, DENSITY, REYNOLDS = 1.0, 9.81, 1000.0, 250.0
AMPLITUDE = 0.025 * H
"""Small: the frequency of a wave of this height is 0.1 % off the linear one."""
PERIODS, SAMPLES = 4, 24
VISCOSITY = H * math.sqrt(GRAVITY * H) / REYNOLDS
WAVE = standing_wave(
    wavelength=2 * H, depth=H, amplitude=AMPLITUDE, viscosity=VISCOSITY, gravity=GRAVITY
)


def mode(position: FloatArray) -> FloatArray:
    """Velocity (n, 2), m/s, of the wave as it starts, at ``position`` (n, 2), the bed at y = 0."""
    return WAVE.velocity(position - [0.0, H], 0.0)


def scene(resolution: int) -> kolk.Scene:
    """One wavelength of it, periodic, over a slipping bed; flat at first, in motion."""
    return kolk.Scene(
        name="standing-wave",
        dimension=2,
        spacing=H / resolution,
        gravity=[0.0, -GRAVITY],
        until=PERIODS * WAVE.period,
        periodic={"x": [0.0, 2 * H]},
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [2 * H, H]}},
                "density": DENSITY,
                "velocity": mode,
                "viscosity": {"laminar": VISCOSITY},
            }
        ],
        wall=[
            {
                "name": "bed",
                "shape": {"box": {"from": [0.0, -4.0 * H / resolution], "to": [2 * H, 0.0]}},
            }
        ],
    )


def fit(time: FloatArray, share: FloatArray) -> tuple[float, float]:
    """Angular frequency (rad/s) and damping (1/s) of ``share`` = a e^(nt) cos(wt + b)."""
    from scipy.optimize import curve_fit

    def decaying(t: FloatArray, a: float, n: float, w: float, b: float) -> FloatArray:
        return np.asarray(a * np.exp(n * t) * np.cos(w * t + b))

    guess = (1.0, WAVE.damping, WAVE.frequency, 0.0)
    found, _ = curve_fit(decaying, time, share, p0=guess)
    return float(found[2]), float(found[1])


def run(resolution: int) -> Level:
    sim = simulation(scene(resolution))
    water = sim.bodies["water"]
    records = []
    for step in range(PERIODS * SAMPLES + 1):
        sim.advance_to(step * WAVE.period / SAMPLES)
        shape = mode(water.position)
        records.append((sim.time, float(np.sum(water.velocity * shape) / np.sum(shape**2))))
    record = np.array(records)
    try:
        frequency, damping = fit(*record.T)
    except RuntimeError:  # the fit found no wave
        frequency = damping = math.nan
    figures = (
        Figure(
            "damping rate", abs(damping / WAVE.damping - 1.0), None, _goal(resolution, 0.05), "%"
        ),
        Figure(
            "frequency", abs(frequency / WAVE.frequency - 1.0), None, _goal(resolution, 0.005), "%"
        ),
    )
    return Level(resolution, figures, **counts(sim), curves={"share": record})


def _goal(resolution: int, goal: float) -> float | None:
    return goal if resolution == 50 else None


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes = canvas.subplots()
    for level in levels:
        t, share = level.curves["share"].T
        axes.plot(t / WAVE.period, share, ".-", markersize=3, label=f"H/Δp = {level.resolution}")
    exact = np.exp(WAVE.damping * t) * np.cos(WAVE.frequency * t)
    axes.plot(t / WAVE.period, exact, "k--", linewidth=1, label="linear theory")
    axes.set(xlabel="t / period", ylabel="share of the mode in the velocity")
    axes.legend()


case = Case(
    title="Standing wave, Re 250",
    setup="Water of depth H and one wavelength 2H, periodic, over a slipping bed; it starts flat "
    f"with the velocity of a linear wave of amplitude {AMPLITUDE / H:g} H.",
    reference="Frequency and damping rate of the exact linear viscous root, fitted to the share "
    f"of that mode in the velocity over {PERIODS} periods.",
    unit="H/Δp",
    short=(20,),
    full=(25, 50),
    run=run,
    draw=draw,
)
