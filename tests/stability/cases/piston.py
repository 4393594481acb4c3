"""A piston driven into still fluid."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, simulation

DENSITY, SOUND, GAMMA, LENGTH = 1000.0, 10.0, 7.0, 1.0


def shock(speed: float) -> tuple[float, float, float]:
    """Pressure (Pa), density and front speed (m/s) behind a piston: Hugoniot's relations for mass
    and momentum with Tait's equation."""

    def pressure(density: float) -> float:
        return DENSITY * SOUND**2 / GAMMA * ((density / DENSITY) ** GAMMA - 1.0)

    def mismatch(density: float) -> float:
        return pressure(density) - DENSITY * speed**2 / (1.0 - DENSITY / density)

    density = float(brentq(mismatch, 1.001 * DENSITY, 3.0 * DENSITY))
    return pressure(density), density, speed / (1.0 - DENSITY / density)


def scene(speed: float, across: int) -> kolk.Scene:
    """A closed tube along x, periodic across; its left end moves from the first moment."""
    spacing = LENGTH / across
    width = 10 * spacing
    return kolk.Scene(
        name="piston",
        dimension=2,
        spacing=spacing,
        until=1.0,
        periodic={"y": [0.0, width]},
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [LENGTH, width]}},
                "sound_speed": SOUND,
                "viscosity": {"artificial": 0.3},
            }
        ],
        wall=[
            {
                "name": "piston",
                "shape": {"box": {"from": [-5 * spacing, 0.0], "to": [0.0, width]}},
                "motion": {"translate": {"velocity": [speed, 0.0]}},
            },
            {
                "name": "end",
                "shape": {"box": {"from": [LENGTH, 0.0], "to": [LENGTH + 5 * spacing, width]}},
            },
        ],
        numerics={"free_surface": False},
    )


def run(variant: str) -> Result:
    share, across = (float(word) for word in variant.replace("c0, L/Δp =", "").split())
    speed = share * SOUND
    pressure, density, front = shock(speed)
    sim = simulation(scene(speed, int(across)))
    regular = 0.5 * sim.scene.smoothing_length / SOUND
    time = 0.5 * LENGTH / front
    watch = Watch(sim).run(time, 10)
    # Halfway between piston and front.
    middle = 0.5 * (speed + front) * time
    points = np.stack([np.full(5, middle), np.linspace(0.2, 0.8, 5) * 10 * LENGTH / across], axis=1)
    found = float(np.mean(sim.sample(points, ["pressure"])["pressure"]))
    limit = [figure for figure in watch.figures(speed=1.5 * speed) if "density" not in figure.name]
    return watch.result(
        variant,
        *limit,
        Figure("largest density", watch.high, most=1.2 * density / DENSITY, unit="ρ0"),
        Figure("error of the shock's pressure", abs(found / pressure - 1.0), most=0.03),
        Figure("last time step / that at rest", sim.time_step / regular, most=1.0),
    )


case = Case(
    title="Piston driven into still fluid",
    setup="A closed tube whose end moves at 0.3 c0 and at 0.9 c0 from the first moment.",
    failure="penetration, numbers that are none",
    run=run,
    short=("0.3 c0, L/Δp = 60",),
    full=("0.3 c0, L/Δp = 200", "0.9 c0, L/Δp = 200"),
)
