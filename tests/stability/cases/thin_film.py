"""A film of two or three particles on a plate."""

from __future__ import annotations

import math

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, simulation

SPACING, GRAVITY, LENGTH = 0.01, 9.81, 0.4


def scene(layers: int, share: float) -> kolk.Scene:
    """A periodic film; share: its velocity in units of the speed of sound."""
    sound = 2.0
    return kolk.Scene(
        name="film",
        dimension=2,
        spacing=SPACING,
        gravity=[0.0, -GRAVITY],
        until=10.0,
        periodic={"x": [0.0, LENGTH]},
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [LENGTH, layers * SPACING]}},
                "velocity": [share * sound, 0.0],
                "viscosity": {"artificial": 0.02},
                "sound_speed": sound,
            }
        ],
        wall=[
            {
                "name": "plate",
                "shape": {"box": {"from": [0.0, -0.06], "to": [LENGTH, 0.0]}},
                "slip": "no" if share else "free",
            }
        ],
    )


def widest_gap(position: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
    """Largest distance along the plate between a particle and the next, in spacings."""
    x = np.sort(np.mod(position[:, 0], LENGTH))
    return float(np.max(np.diff(np.append(x, x[0] + LENGTH)))) / SPACING


def run(variant: str) -> Result:
    words = variant.split()
    layers, sheared, long = int(words[0]), words[2] == "sheared,", float(words[-1])
    sim = simulation(scene(layers, 0.1 if sheared else 0.0))
    watch = Watch(sim).run(long * math.sqrt(layers * SPACING / GRAVITY), 20)
    gap = widest_gap(sim.bodies["water"].position)
    return watch.result(
        variant,
        *watch.figures(speed=1.5 * (0.2 if sheared else 0.1)),
        Figure("widest gap", gap, most=2.5, unit="Δp"),
    )


KINDS = [f"{n} layers {how}," for n in (2, 3) for how in ("rest", "sheared")]

case = Case(
    title="Thin film",
    setup="A film two and three particles deep on a plate, at rest and sheared at 0.1 c0, for "
    "100 √(H/g).",
    failure="evaporation, clumps",
    run=run,
    short=tuple(f"{kind} √(H/g) x 20" for kind in KINDS),
    full=tuple(f"{kind} √(H/g) x 100" for kind in KINDS),
)
