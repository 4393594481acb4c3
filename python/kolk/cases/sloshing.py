"""Water in a tank that rolls, 2D: the geometry and the motion of SPHERIC's test 10.

The tank moves and gravity stands still. In the frame of the tank gravity would turn, and every
particle would feel the Euler, centrifugal and Coriolis forces as well; walls that move need none
of them, and the forces on them are those that the tank feels.
"""

from __future__ import annotations

import math

from kolk.cases import Case
from kolk.scene import Scene

LENGTH, HEIGHT, DEPTH = 0.9, 0.508, 0.093
"""Of the tank and of the water in it, m."""
ROLL = math.radians(4.0)
"""Amplitude, rad."""
WAVE = math.pi / LENGTH
PERIOD = 0.85 * 2.0 * math.pi / math.sqrt(9.81 * WAVE * math.tanh(WAVE * DEPTH))
"""Of the roll, s: 0.85 of that of the first sloshing mode (1.917 s)."""
RISE = PERIOD
"""Time in which the roll grows to its amplitude, s."""
STEPS = 40
"""Points of the table for one period."""

time = [k * PERIOD / STEPS for k in range(4 * STEPS + 1)]
angle = [
    ROLL
    * math.sin(2.0 * math.pi * t / PERIOD)
    * (min(t / RISE, 1.0) ** 2 * (3 - 2 * min(t / RISE, 1.0)))
    for t in time
]

scene = Scene(
    name="sloshing",
    title="Sloshing in a rolling tank (SPHERIC 10)",
    dimension=2,
    spacing=DEPTH / 18,
    gravity=[0.0, -9.81],
    until=4.0 * PERIOD,
    fluid=[
        {
            "name": "water",
            "shape": {"box": {"from": [0.0, 0.0], "to": [LENGTH, DEPTH]}},
            "density": 1000.0,
            "viscosity": {"artificial": 0.02},
        }
    ],
    wall=[
        {
            "name": "tank",
            "shape": {"tank": {"from": [0.0, 0.0], "to": [LENGTH, HEIGHT]}},
            "motion": {"table": {"time": time, "angle": angle, "centre": [LENGTH / 2, 0.0]}},
        }
    ],
    probe=[
        {"name": "left", "pressure": {"at": [0.0, DEPTH], "diameter": 0.009, "body": "tank"}},
        {"name": "load", "force": {"body": "tank", "about": [LENGTH / 2, 0.0]}},
    ],
    numerics={"expected_speed": 2.0},
    output={"every": PERIOD / 40},
)

case = Case(
    name="sloshing",
    title="Sloshing in a rolling tank, 2D",
    shows="walls in prescribed motion from a table: a bore that runs to and fro and hits the sides",
    source="Souto-Iglesias, Botia-Vera et al., SPHERIC benchmark 10: 900 x 508 mm, 93 mm of water",
    reference="none measured is shipped",
    cost="3,132 fluid and 2,240 wall particles, about 25,000 steps: 2 minutes on two cores",
    scene=scene,
)
