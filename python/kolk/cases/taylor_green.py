"""Decaying Taylor-Green vortices in a periodic square at Re = 100, from a jittered start."""

from __future__ import annotations

from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.scene import Scene

SPEED = 1.0
"""Largest speed at the start, m/s."""
REYNOLDS = 100.0
VISCOSITY = SPEED / REYNOLDS
"""Kinematic, m^2/s, for a period of 1 m."""

scene = Scene(
    name="taylor-green",
    title="Taylor-Green vortices at Re = 100",
    dimension=2,
    spacing=0.02,
    until=2.0,
    periodic={"x": [0.0, 1.0], "y": [0.0, 1.0]},
    fluid=[
        {
            "name": "fluid",
            "shape": {"box": {"from": [0.0, 0.0], "to": [1.0, 1.0]}},
            "density": 1000.0,
            "viscosity": {"laminar": VISCOSITY},
            "velocity": ["-cos(2*pi*x) * sin(2*pi*y)", "sin(2*pi*x) * cos(2*pi*y)"],
            "pressure": "-250 * (cos(4*pi*x) + cos(4*pi*y))",
            "jitter": 0.1,
            "seed": 1,
        }
    ],
    numerics={"expected_speed": SPEED},
    output={"every": 0.05},
)

case = Case(
    name="taylor-green",
    title="Taylor-Green vortices, periodic",
    shows="how truly viscosity acts, and whether particles stay evenly spread",
    source="Taylor and Green, Proc. R. Soc. A 158 (1937) 499-521, Re = 100, jittered start",
    reference="the exact solution: velocity decays as exp(-8 pi^2 t / Re)",
    cost="2,500 fluid particles, about 1,100 steps: 2 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison(
            "velocity",
            None,
            "taylor_green",
            1.0,
            1.0,
            "analytic",
            parameters=MappingProxyType({"viscosity": VISCOSITY, "speed": SPEED, "length": 1.0}),
        ),
    ),
)
