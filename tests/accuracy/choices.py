"""What is studied: the choices of numerics, on the cases that they matter for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import kolk


@dataclass(frozen=True)
class Subject:
    """One case with its ladder and the alternatives that are tried on it."""

    case: str
    spacings: tuple[float, ...]
    """The reduced ladder, m."""
    full: tuple[float, ...]
    """The whole one."""
    vary: Mapping[str, tuple[Any, ...]]
    quantity: str | None = None
    sound_speeds: tuple[float, ...] = ()
    """Factors of the automatic sound speed."""
    changes: Mapping[str, Any] = field(default_factory=dict)

    @property
    def scene(self) -> kolk.Scene:
        """The scene at its own spacing."""
        return kolk.load(self.case).replace(self.changes)

    @property
    def alternatives(self) -> dict[str, list[Any]]:
        """The keys with their values, the sound speeds in m/s."""
        found = {key: list(values) for key, values in self.vary.items()}
        if self.sound_speeds:
            scene = self.scene
            key = f"fluid.{scene.fluid[0].name}.sound_speed"
            found[key] = [round(f * scene.sound_speed, 3) for f in self.sound_speeds]
        return found


EVERYWHERE: dict[str, tuple[Any, ...]] = {
    "kernel": ("wendland-c4", "cubic"),
    "smoothing_ratio": (1.5, 2.5),
    "precision": ("f64",),
    "density_diffusion": ("molteni", "none"),
    "shifting": ("none",),
    "integrator": ("predictor-corrector", "rk4"),
    "courant": (0.25,),
}
"""Choices that every flow has; half the Courant number shows what the time step is wrong by."""

SURFACE: dict[str, tuple[Any, ...]] = {
    "wall": ("dynamic", "modified-dynamic"),
    "acoustic_damper": (0.0,),
}
"""Choices of flows with walls and a free surface."""

SUBJECTS = (
    Subject(
        "taylor-green",
        spacings=(1 / 25, 1 / 35, 1 / 50),
        full=(1 / 25, 1 / 35, 1 / 50, 1 / 71, 1 / 100),
        # Without walls and a free surface Wendland C4 is the default.
        vary=EVERYWHERE | {"kernel": ("wendland-c2", "cubic")},
        sound_speeds=(0.5, 2.0),
    ),
    Subject(
        "still-water",
        spacings=(0.5 / 12, 0.5 / 17, 0.5 / 24),
        full=(0.5 / 12, 0.5 / 17, 0.5 / 24, 0.5 / 34, 0.5 / 48),
        vary=EVERYWHERE | SURFACE,
        sound_speeds=(0.5, 2.0),
    ),
    Subject(
        "standing-wave",
        spacings=(1 / 15, 1 / 21, 1 / 30),
        full=(1 / 15, 1 / 21, 1 / 30, 1 / 42, 1 / 60),
        vary=EVERYWHERE | SURFACE,
        sound_speeds=(0.5, 2.0),
    ),
    Subject(
        "dam-break",
        spacings=(0.3 / 20, 0.3 / 28, 0.3 / 40),
        full=(0.3 / 20, 0.3 / 28, 0.3 / 40, 0.3 / 60, 0.3 / 85),
        vary=EVERYWHERE | SURFACE,
        quantity="P2: RMS",
        sound_speeds=(0.5,),
    ),
    Subject(
        "dam-break-decourcy",
        spacings=(0.6 / 20, 0.6 / 28, 0.6 / 40),
        full=(0.6 / 20, 0.6 / 28, 0.6 / 40, 0.6 / 60, 0.6 / 80),
        vary={"kernel": ("cubic",), "smoothing_ratio": (1.5,), "shifting": ("none",)},
        quantity="P2: RMS",
    ),
    Subject(
        "dam-break-box",
        spacings=(0.55 / 10, 0.55 / 14),
        full=(0.55 / 10, 0.55 / 14, 0.55 / 20, 0.55 / 28),
        vary={"kernel": ("cubic",), "smoothing_ratio": (1.5, 2.0), "precision": ("f64",)},
        quantity="H2: RMS",
        changes={"until": 2.0},
    ),
)
