"""The scene: everything that a run depends on, validated, immutable."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from kolk.errors import Problem, SceneError

from .base import Model, Name, Positive, Real, Text, nearest
from .motion import Gravity, GravityKey
from .parts import Fluid, Numerics, Output, Periodic, Probe, Wall

if TYPE_CHECKING:
    from .fill import Body, Filling

DEFAULT_SMOOTHING_RATIO = {2: 2.0, 3: 1.7}
"""Smoothing length over spacing by dimension: about 50 neighbours in 2D and 165 in 3D.

Below 2, a sheared lattice of Wendland's C2 resists like a solid, and its errors do not fall with
the spacing; in 3D the step to 2 would cost 1.6 times the time."""

KERNEL_SUPPORT = {
    "wendland-c2": 2.0,
    "wendland-c4": 2.0,
    "wendland-c6": 2.0,
    "cubic": 2.0,
    "quintic": 3.0,
}
"""Support radius of each kernel over the smoothing length."""

FRAMES = 100
"""Frames of a run whose scene does not say how often."""

PROBE_SAMPLES = 20
"""Samples of a probe between two frames, where the scene does not say."""


class Scene(Model):
    """A scene: bodies, forces, probes and numerics, in SI units.

    The same keys as a scene file. Raises SceneError for whatever is wrong, all at once where
    possible. A scene never changes; :meth:`replace` makes another one.
    """

    name: Name = Field(description="of the run's folder")
    title: Text | None = Field(default=None, description="one line for people")
    dimension: Literal[2, 3]
    spacing: Positive = Field(description="initial particle spacing, m")
    smoothing_ratio: Annotated[Real, Field(ge=0.8, le=4.0)] | None = Field(
        default=None, description="smoothing length over spacing; 2 in 2D and 1.7 in 3D if absent"
    )
    kernel: Literal["auto", "wendland-c2", "wendland-c4", "wendland-c6", "cubic", "quintic"] = (
        Field(
            default="auto",
            description="smoothing kernel; auto: wendland-c2, but wendland-c4 without a "
            "free surface, a yield stress and packed particles",
        )
    )
    gravity: GravityKey | None = Field(
        default=None, description="m/s^2; a table if it changes with time; leave it out for none"
    )
    until: Positive = Field(description="end of the run, s")
    periodic: Periodic | None = Field(
        default=None, description="axes along which the domain repeats"
    )
    fluid: tuple[Fluid, ...] = Field(min_length=1)
    wall: tuple[Wall, ...] = ()
    probe: tuple[Probe, ...] = ()
    numerics: Numerics = Numerics()
    output: Output = Output()

    def __init__(self, /, **data: Any) -> None:
        from .checks import check_consistency

        super().__init__(**data)
        if self.smoothing_ratio is None:
            self.__dict__["smoothing_ratio"] = DEFAULT_SMOOTHING_RATIO[self.dimension]
            self.model_fields_set.discard("smoothing_ratio")
        left_open = self.kernel == "auto"
        if left_open:
            # For the checks; all kernels that kolk may choose have its support.
            self.__dict__["kernel"] = "wendland-c2"
            self.model_fields_set.discard("kernel")
        check_consistency(self)
        if left_open:
            from .automatic import kernel

            self.__dict__["kernel"] = kernel(self).value
        if self.output.every is None:
            # Resolved once, here, so that nothing later has to know the rule.
            output = self.output.model_copy(update={"every": self.until / FRAMES})
            output.model_fields_set.discard("every")
            self.__dict__["output"] = output

    # Lengths and directions

    @property
    def smoothing_length(self) -> float:
        """h in m."""
        assert self.smoothing_ratio is not None, "resolved when the scene is made"
        return self.smoothing_ratio * self.spacing

    @property
    def support(self) -> float:
        """Radius in m within which particles interact."""
        return KERNEL_SUPPORT[self.kernel] * self.smoothing_length

    @property
    def wall_layers(self) -> int:
        """Layers of wall particles that fill the support behind a surface."""
        return math.ceil(self.support / self.spacing - 1e-6)

    @property
    def periodic_axes(self) -> list[tuple[float, float] | None]:
        """The interval of each axis in m, None where it does not repeat."""
        none: list[tuple[float, float] | None] = [None] * self.dimension
        return none if self.periodic is None else list(self.periodic.axes(self.dimension))

    @property
    def gravity_at_start(self) -> tuple[float, ...] | None:
        """Gravity (D,) in m/s^2 at t = 0 s, None without any."""
        return self.gravity.at_start() if isinstance(self.gravity, Gravity) else self.gravity

    @property
    def weight(self) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """The part of gravity (D,) in m/s^2 that makes a depth: none along a periodic axis."""
        start = self.gravity_at_start
        gravity = np.zeros(self.dimension) if start is None else np.array(start)
        return np.where([p is None for p in self.periodic_axes], gravity, 0.0)

    @property
    def free_surface(self) -> bool:
        """Whether the fluid has one: as the scene says, else under gravity or without walls."""
        from .automatic import free_surface

        return bool(free_surface(self).value)

    # Particles and the engine

    @cached_property
    def filling(self) -> Filling:
        """All particles and the sound speed, checked; made on first use."""
        from .fill import fill

        return fill(self)

    def bodies(self) -> list[Body]:
        """The bodies filled with particles: fluids, then walls, in the order of the scene.

        Raises SceneError where a shape is empty, bodies overlap, fluid lies outside its tank, the
        spacing is too coarse, or the memory would not do. The arrays are read-only.
        """
        return list(self.filling.bodies)

    @property
    def sound_speed(self) -> float:
        """c0 in m/s, the automatic choice included."""
        return self.filling.sound_speed

    def engine_config(self) -> str:
        """What the engine needs beside the particles, as JSON; every number resolved."""
        from .engine import engine_config

        return json.dumps(engine_config(self))

    def probe_interval(self, probe: Probe) -> float:
        """Seconds between two samples of ``probe``."""
        assert self.output.every is not None
        return probe.every or self.output.every / PROBE_SAMPLES

    # Other scenes and files

    def replace(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> Scene:
        """A scene with some keys changed: ``scene.replace(spacing=0.01)``.

        Keys may be dotted and name list items by their names, as in
        ``scene.replace({"fluid.water.viscosity.artificial": 0.05})``. None takes a key out.
        Raises SceneError as a new scene would.
        """
        data = self.plain()
        for key, value in {**(changes or {}), **more}.items():
            _put(data, key, value)
        return Scene(**data)

    def plain(self) -> dict[str, Any]:
        """The keys that were given, as nested dicts and lists; Python objects as they are."""
        data: dict[str, Any] = _listed(self.model_dump(exclude_unset=True, exclude_none=True))
        return data

    def to_toml(self) -> str:
        """The complete scene as a scene file, defaults written out: it reproduces the run.

        Raises SceneError where the scene has Python functions or own particles, which no text
        holds: :meth:`save` then keeps those particles in files of their own.
        """
        from .toml import to_toml

        return to_toml(self)

    def save(self, path: str | Path) -> None:
        """Write :meth:`to_toml` to ``path``, and beside it ``NAME.npz`` for each body of own
        particles or of Python functions. Each file is written whole or not at all."""
        from .toml import save

        save(self, Path(path))


def _listed(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _listed(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_listed(v) for v in value]
    return value


def _put(data: dict[str, Any], key: str, value: Any) -> None:
    """Set the dotted ``key`` in nested dicts; items of lists are found by name or number."""
    parts = key.split(".")
    here: Any = data
    for depth, part in enumerate(parts):
        last = depth == len(parts) - 1
        path = tuple(parts[: depth + 1])
        if isinstance(here, list):
            names = [str(item.get("name")) if isinstance(item, dict) else "" for item in here]
            if part in names:
                index = names.index(part)
            elif part.isdecimal() and int(part) < len(here):
                index = int(part)
            else:
                known = [n for n in names if n] or [str(i) for i in range(len(here))]
                hint = nearest(part, known) or "."
                raise SceneError(
                    problems=[
                        Problem(
                            path,
                            f"names nothing{hint} There is {', '.join(known)}",
                        )
                    ]
                )
            if last:
                here[index] = value
            else:
                here = here[index]
        elif isinstance(here, dict):
            if last and value is None:
                here.pop(part, None)
            elif last:
                here[part] = value
            else:
                here = here.setdefault(part, [] if depth == 0 and part in _LISTS else {})
        else:
            raise SceneError(
                problems=[
                    Problem(path, f"'{parts[depth - 1]}' is no table: it has no keys below it")
                ]
            )


_LISTS = {"fluid", "wall", "probe"}
