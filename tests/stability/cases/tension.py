"""Fluid under tension in a periodic square."""

from __future__ import annotations

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

DENSITY, SOUND, GAMMA = 1000.0, 10.0, 7.0
TENSION = 0.1
"""Tension in units of ρ0 c0²."""


def scene(across: int, remedy: str = "auto") -> kolk.Scene:
    """Particles (1 % jitter) whose density makes the pressure -0.1 ρ0 c0² everywhere."""
    spacing = 1.0 / across
    density = DENSITY * (1.0 - GAMMA * TENSION) ** (1.0 / GAMMA)
    at = (np.arange(across) + 0.5) * spacing
    position = np.stack([g.ravel() for g in np.meshgrid(at, at)], axis=1)
    position += 0.01 * spacing * np.random.default_rng(1).uniform(-1.0, 1.0, position.shape)
    n = len(position)
    return kolk.Scene(
        name="tension",
        dimension=2,
        spacing=spacing,
        until=1e6,
        periodic={"x": [0.0, 1.0], "y": [0.0, 1.0]},
        fluid=[
            kolk.Fluid.from_arrays(
                position=position,
                density=np.full(n, density),
                mass=np.full(n, density * spacing**2),
                reference_density=DENSITY,
                sound_speed=SOUND,
            )
        ],
        numerics={"tensile_control": remedy},
    )


def watched(across: int, steps: int, remedy: str, variant: str) -> Result:
    """The square after a number of steps."""
    watch = Watch(simulation(scene(across, remedy))).steps(steps, 10)
    sound = 0.5 * DENSITY * SOUND**2
    return watch.result(
        variant,
        Figure("closest pair", watch.closest, least=0.6, unit="Δp"),
        Figure("voids", watch.voids, most=0),
        Figure("kinetic energy / (½ρc0²)", watch.sim.energy.kinetic / sound, most=1e-5),
        Figure("retries", sum(watch.sim.retries["retries"].values()), most=0),
    )


def run(variant: str) -> Result:
    steps = int(number(variant))
    return watched(50 if steps > 5000 else 20, steps, "auto", variant)


case = Case(
    title="Fluid under tension",
    setup="A periodic square at a pressure of -0.1 ρ0 c0², particles jittered by 1 %.",
    failure="tensile clumping in less than 500 steps",
    run=run,
    short=("steps 1000",),
    full=("steps 50000",),
    without=lambda: watched(20, 1000, "none", "steps 1000"),
    remedy="tensile control",
)
