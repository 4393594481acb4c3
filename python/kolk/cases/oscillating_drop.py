"""A drop of water of 1 mm radius that surface tension makes oscillate, 2D, without gravity."""

from __future__ import annotations

from types import MappingProxyType

from kolk.cases import Case, Comparison
from kolk.references import CapillaryDrop
from kolk.scene import Scene

DROP = CapillaryDrop(radius=1e-3, tension=0.072, density=1000.0, viscosity=1e-6)
"""Water in air."""
AMPLITUDE = 0.05
"""Of the axes, over the radius."""
PERIODS = 3
RATE = AMPLITUDE * DROP.frequency
"""Of strain at the start, 1/s."""

scene = Scene(
    name="oscillating-drop",
    title="A drop of water oscillates",
    dimension=2,
    spacing=DROP.radius / 25,
    until=PERIODS * DROP.period,
    fluid=[
        {
            "name": "drop",
            "shape": {"disc": {"centre": [0.0, 0.0], "radius": DROP.radius}},
            "arrangement": "packed",
            "density": DROP.density,
            "surface_tension": DROP.tension,
            "viscosity": {"laminar": DROP.viscosity},
            # Round at first, and in motion: the velocity of the mode n = 2.
            "velocity": [f"{RATE!r} * x", f"-{RATE!r} * y"],
            "pressure": f"{DROP.pressure!r} + 0*x",
        }
    ],
    probe=[
        {"name": "along", "front": {"axis": "x", "body": "drop"}},
        {"name": "across", "front": {"axis": "y", "body": "drop"}},
        {"name": "centre", "field": {"quantity": "pressure", "at": [0.0, 0.0]}},
    ],
    output={"every": DROP.period / 32},
)

case = Case(
    name="oscillating-drop",
    title="Oscillating drop",
    shows="surface tension: a drop of water that stretches and shrinks, and the pressure in it",
    source="water in air, radius 1 mm, amplitude 0.05 R; Rayleigh, Proc. R. Soc. 29 (1879) 71-97",
    reference="frequency sqrt(6 sigma/(rho R^3)) of a disc, pressure sigma/R at its centre",
    cost="1,963 fluid particles, about 2,800 steps: 10 seconds on two cores",
    scene=scene,
    comparisons=(
        Comparison(
            "velocity",
            None,
            "CapillaryDrop",
            1.0,
            1.0,
            "analytic",
            parameters=MappingProxyType(
                {
                    "radius": DROP.radius,
                    "tension": DROP.tension,
                    "density": DROP.density,
                    "viscosity": DROP.viscosity,
                }
            ),
        ),
    ),
)
