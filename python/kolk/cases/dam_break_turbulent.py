"""The dam break with water's own viscosity and, for the rest, eddies below the spacing."""

from __future__ import annotations

from kolk.cases import Case

from .dam_break import case as plain

WATER = 1.0e-6
"""Kinematic viscosity, m^2/s."""
SMAGORINSKY = 0.12
"""Constant of Gotoh, Shibahara and Sakai 2001 and of Dalrymple and Rogers 2006."""

case = Case(
    name="dam-break-turbulent",
    title="Dam break whose eddies are below the spacing",
    shows="what turbulence below the particle scale takes from a surge, an impact and the wave "
    "that returns; `kolk cases` has the same dam break with artificial viscosity",
    source="set-up as `dam-break`; the model of Dalrymple and Rogers, Coast. Eng. 53 (2006) 141",
    reference=plain.reference,
    cost="7,200 fluid and 2,280 wall particles, about 9,200 steps: 20 seconds on two cores",
    scene=plain.scene.replace(
        {
            "name": "dam-break-turbulent",
            "title": "Dam break with turbulence below the particle scale (Lobovsky et al. 2014)",
            "fluid.water.viscosity": {"laminar": WATER, "turbulence": SMAGORINSKY},
        }
    ),
    comparisons=plain.comparisons,
)
scene = case.scene
