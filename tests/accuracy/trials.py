"""The cases of the trials: scenes whose probes have exact solutions, with the reference withheld.

Under another name kolk knows no reference for them, so that everything rests on extrapolation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import kolk
from kolk import references
from kolk.cases import poiseuille, standing_wave, still_water, taylor_green

Floats = NDArray[np.float64]
Exact = Callable[[Floats], Floats]

POINTS = {"A": (0.25, 0.0), "B": (0.6, 0.3)}
"""Where the velocity of the Taylor-Green vortex is probed, m."""


@dataclass(frozen=True)
class Trial:
    """A case with the exact records of its probes."""

    case: str
    ladder: tuple[float, ...]
    """m, four levels."""
    exact: Mapping[str, Exact]
    """By the name of a quantity: times (m,) s to values (m,)."""
    probes: tuple[dict[str, Any], ...] = ()
    """Further probes."""
    without: tuple[str, ...] = ()
    """Probes left out, which have no exact record."""

    @property
    def known(self) -> kolk.Scene:
        """The built-in scene, whose reference kolk knows."""
        return kolk.load(self.case)

    @property
    def blind(self) -> kolk.Scene:
        """The same under another name."""
        scene = self.known
        kept = [p for p in scene.plain().get("probe", []) if p["name"] not in self.without]
        return scene.replace({"name": f"blind-{self.case}", "probe": [*kept, *self.probes]})


def _vortex(point: tuple[float, float], axis: int) -> Exact:
    def exact(time: Floats) -> Floats:
        found = [
            references.taylor_green(
                np.array([point]), t, viscosity=taylor_green.VISCOSITY, speed=1.0, length=1.0
            )[0][0, axis]
            for t in time
        ]
        return np.array(found)

    return exact


def _channel(height: float) -> Exact:
    def exact(time: Floats) -> Floats:
        found = [
            references.poiseuille(
                np.array([height]),
                t,
                width=poiseuille.WIDTH,
                viscosity=poiseuille.VISCOSITY,
                acceleration=poiseuille.ACCELERATION,
            )[0]
            for t in time
        ]
        return np.array(found)

    return exact


def _constant(value: float) -> Exact:
    return lambda time: np.full(len(time), value)


def _node(time: Floats) -> Floats:
    at = np.array([[standing_wave.LENGTH / 4, -standing_wave.H / 2]])
    return np.array([standing_wave.WAVE.velocity(at, t)[0, 0] for t in time])


def _level(time: Floats) -> Floats:
    return np.array([standing_wave.H + float(standing_wave.WAVE.elevation(0.0, t)) for t in time])


def trials() -> tuple[Trial, ...]:
    """The four cases of the promises."""
    weight = still_water.DENSITY * still_water.GRAVITY * still_water.H
    return (
        Trial(
            "taylor-green",
            (1 / 20, 1 / 28, 1 / 40, 1 / 56),
            {
                f"{name}.{'xy'[axis]}": _vortex(point, axis)
                for name, point in POINTS.items()
                for axis in (0, 1)
            },
            tuple(
                {"name": name, "field": {"quantity": "velocity", "at": list(point)}}
                for name, point in POINTS.items()
            ),
        ),
        Trial(
            "poiseuille",
            (4e-4 / 10, 4e-4 / 14, 4e-4 / 20, 4e-4 / 28),
            {"middle.x": _channel(0.5e-3), "quarter.x": _channel(0.25e-3)},
            without=("drag",),
        ),
        Trial(
            "still-water",
            (0.5 / 12, 0.5 / 17, 0.5 / 24, 0.5 / 34),
            {
                "bottom": _constant(weight),
                "side": _constant(0.5 * weight),
                "level": _constant(still_water.H),
            },
        ),
        Trial(
            "standing-wave",
            (1 / 15, 1 / 21, 1 / 30, 1 / 42),
            {"node.x": _node, "level": _level},
        ),
    )
