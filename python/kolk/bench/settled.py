"""The flows that are measured: a tank half filled, out of order, whatever the first lattice was."""

from __future__ import annotations

from dataclasses import dataclass

from kolk.scene import Scene

SPACING = 0.01
"""m; speed does not depend on it."""

SETTLE = 60
"""Steps after which the first order is forgotten: the start displaces every particle at random."""


@dataclass(frozen=True)
class Flow:
    """One flow at any size."""

    name: str
    dimension: int
    smoothing_ratio: float
    """Smoothing length over spacing, which sets the number of neighbours."""
    most: int
    """Fluid particles where time allows."""


FLOWS = (
    Flow("3D, 75 neighbours", 3, 1.3, 200_000),
    Flow("3D, 163 neighbours", 3, 1.7, 171_000),
    Flow("2D, 20 neighbours", 2, 1.3, 80_000),
)


def scene(flow: Flow, particles: int) -> Scene:
    """A tank half filled with about ``particles`` of water, jittered, at rest.

    Artificial viscosity and Fourtakas' diffusion; no shifting, no acoustic damper: the effects that
    other codes have too, so that figures compare.
    """
    d = flow.dimension
    # Twice as wide as deep.
    across = max(8, round((2.0 * particles) ** (1.0 / d)))
    water = [across * SPACING] * (d - 1) + [max(4, across // 2) * SPACING]
    tank = [*water[:-1], 2.0 * water[-1]]
    origin = [0.0] * d
    return Scene(
        name="bench",
        dimension=d,
        spacing=SPACING,
        smoothing_ratio=flow.smoothing_ratio,
        gravity=[*origin[1:], -9.81],
        until=1e6,
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": origin, "to": water}},
                "viscosity": {"artificial": 0.02},
                "jitter": 0.2,
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": origin, "to": tank, "open": ["top"]}},
            }
        ],
        numerics={
            "density_diffusion": "fourtakas",
            "shifting": "none",
            "acoustic_damper": 0.0,
        },
    )
