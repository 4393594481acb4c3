"""A standing wave of small amplitude over a slipping bed, 2D, periodic, at Re = 250."""

from __future__ import annotations

import math
from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.references import standing_wave
from kolk.scene import Scene

H = 1.0
"""Depth, m."""
LENGTH = 2.0 * H
"""Of the wave, m."""
GRAVITY = 9.81
DENSITY = 1000.0
REYNOLDS = 250.0
"""H sqrt(g H) / ν."""
AMPLITUDE = 0.025 * H
"""m. Small: the frequency of a wave of this height is 0.1 % off the linear one."""
PERIODS = 4
VISCOSITY = H * math.sqrt(GRAVITY * H) / REYNOLDS
"""Kinematic, m^2/s."""

WAVE = standing_wave(
    wavelength=LENGTH, depth=H, amplitude=AMPLITUDE, viscosity=VISCOSITY, gravity=GRAVITY
)
_K = f"(2*pi/{LENGTH})"
_SCALE = f"{AMPLITUDE * WAVE.frequency!r} / sinh({_K}*{H})"

scene = Scene(
    name="standing-wave",
    title="Standing wave that viscosity damps, Re = 250",
    dimension=2,
    spacing=H / 25,
    gravity=[0.0, -GRAVITY],
    until=PERIODS * WAVE.period,
    periodic={"x": [0.0, LENGTH]},
    fluid=[
        {
            "name": "water",
            "shape": {"box": {"from": [0.0, 0.0], "to": [LENGTH, H]}},
            "density": DENSITY,
            # Flat at first, and in motion: the velocity of the linear wave, the bed at y = 0.
            "velocity": [
                f"-{_SCALE} * sin({_K}*x) * cosh({_K}*y)",
                f"{_SCALE} * cos({_K}*x) * sinh({_K}*y)",
            ],
            "viscosity": {"laminar": VISCOSITY},
        }
    ],
    wall=[
        {
            "name": "bed",
            "shape": {
                "tank": {
                    "from": [0.0, 0.0],
                    "to": [LENGTH, 1.2 * H],
                    "open": ["left", "right", "top"],
                }
            },
        }
    ],
    probe=[
        {"name": "level", "level": {"at": [0.0, 0.0]}},
        # Where the surface stands still and the water moves to and fro.
        {"name": "node", "field": {"quantity": "velocity", "at": [LENGTH / 4, H / 2]}},
    ],
    output={"every": WAVE.period / 24},
)

case = Case(
    name="standing-wave",
    title="Standing wave",
    shows="how long waves keep their energy and their beat: what dissipates, and how much",
    source="linear wave of amplitude 0.025 H in water as deep as half its length, Re = 250",
    reference="damping rate and frequency: the root of the linearised Navier-Stokes equations",
    cost="1,250 fluid and 200 wall particles, about 7,200 steps: 3 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison(
            "velocity",
            None,
            "standing_wave",
            1.0,
            1.0,
            "analytic",
            parameters=MappingProxyType(
                {
                    "wavelength": LENGTH,
                    "depth": H,
                    "amplitude": AMPLITUDE,
                    "viscosity": VISCOSITY,
                    "gravity": GRAVITY,
                }
            ),
        ),
    ),
)
