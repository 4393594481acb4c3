"""Shapes that bodies are filled from, each with a signed distance, bounds, a size and a lattice.

A shape is a table with exactly one key in a scene file, ``{ box = { from = ..., to = ... } }``; in
Python it may also be the shape itself, ``kolk.Box(from_=..., to=...)``. Lengths are in metres.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from kolk.errors import Problem, SceneError

from . import distance
from .base import Model, Positive, Real, Vector

FloatArray = npt.NDArray[np.float64]
Bounds = tuple[FloatArray, FloatArray]


class Axis(NamedTuple):
    """Lattice points along one axis."""

    at: FloatArray
    step: float


Side = Literal["left", "right", "bottom", "top", "front", "back"]


class Shape(Model):
    """A solid: what :meth:`distance` says is the truth, the rest describes it."""

    @abstractmethod
    def distance(self, points: FloatArray) -> FloatArray:
        """Signed distance (m,) of ``points`` (m, D) from the surface in m: negative inside."""

    @abstractmethod
    def bounds(self, thickness: float = 0.0) -> Bounds:
        """Lowest and highest corner (D,) of a box around the shape.

        Of a tank, whose solid has no end, ``thickness`` (m) is kept beyond each closed face.
        """

    def size(self) -> float:
        """Area (2D) or volume (3D), exact or an upper bound."""
        low, high = self.bounds()
        return float(np.prod(np.maximum(high - low, 0.0)))

    def exact_size(self) -> float | None:
        """:meth:`size` where that is exact, else None."""
        return None

    def layers(self, spacing: float, count: int) -> FloatArray | None:
        """Particles (n, D) of a wall in ``count`` layers along the surface, the first half a
        spacing behind it; None for those of the lattice."""
        return None

    def hollow(self) -> bool:
        """Whether the solid is what lies outside of a closed space, as a vessel's wall does."""
        return False

    def dimensions(self) -> set[int]:
        """The dimensions in which the shape exists."""
        return {2, 3}

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        """The lattice that a body is filled from: cell-centred from the low corner."""
        low, high = self.bounds(layers * spacing)
        # Decimal fractions are inexact: 0.3 / 0.1 must not become four cells.
        counts = np.ceil((high - low) / spacing - 1e-6).astype(int)
        return [
            Axis(np.asarray(a + spacing * (np.arange(max(n, 1)) + 0.5), np.float64), spacing)
            for a, n in zip(low, counts, strict=True)
        ]

    def contains(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Which of ``points`` (m, D) lie inside (m,)."""
        return self.distance(points) < 0.0


def problem(key: str, message: str) -> SceneError:
    """An error at one key of a shape."""
    return SceneError(problems=[Problem((key,), message)])


def fitted(low: float, high: float, spacing: float) -> Axis:
    """Cell centres from ``low`` to ``high``, as near to ``spacing`` apart as divides the length."""
    n = max(1, round((high - low) / spacing))
    step = (high - low) / n
    return Axis(np.asarray(low + step * (np.arange(n) + 0.5), np.float64), step)


class FromTo(Shape):
    """What has a low and a high corner."""

    from_: Vector = Field(alias="from", description="low corner, m")
    to: Vector = Field(description="high corner, m")

    @model_validator(mode="after")
    def _ordered(self) -> FromTo:
        if len(self.from_) != len(self.to):
            raise problem(
                "to", f"found {len(self.to)} numbers, must have {len(self.from_)} as 'from' has"
            )
        for axis, a, b in zip("xyz", self.from_, self.to, strict=False):
            if not b > a:
                raise problem(
                    "to",
                    f"found {axis} = {b:g}, must be greater than 'from', which has {axis} = {a:g}: "
                    "the shape is empty",
                )
        return self

    def _corners(self) -> Bounds:
        return np.array(self.from_), np.array(self.to)

    def bounds(self, thickness: float = 0.0) -> Bounds:
        return self._corners()

    def dimensions(self) -> set[int]:
        return {len(self.from_)}


class Box(FromTo):
    """An axis-parallel rectangle (2D) or box (3D)."""

    def distance(self, points: FloatArray) -> FloatArray:
        return distance.box(points, *self.bounds())

    def exact_size(self) -> float | None:
        return self.size()

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        """The lattice is stretched to divide the box: particles keep half a cell to every face."""
        return [fitted(a, b, spacing) for a, b in zip(self.from_, self.to, strict=True)]


class Tank(FromTo):
    """Walls around a box: the solid is everything beyond its closed faces."""

    open: tuple[Side, ...] = Field(
        default=(), description="sides without a wall: left, right, bottom, top, front, back"
    )

    def sides(self) -> dict[str, tuple[int, int]]:
        """Side name to (axis, 0 low | 1 high): left and right along x, bottom and top along the
        last axis, front and back along y in 3D."""
        last = len(self.from_) - 1
        names = {"left": (0, 0), "right": (0, 1), "bottom": (last, 0), "top": (last, 1)}
        return names | ({"front": (1, 0), "back": (1, 1)} if last == 2 else {})

    @model_validator(mode="after")
    def _sides_exist(self) -> Tank:
        for side in self.open:
            if side not in self.sides():
                raise problem(
                    "open",
                    f'found "{side}", which a tank in 2D does not have: {", ".join(self.sides())}',
                )
        if len(set(self.open)) == len(self.sides()):
            raise problem("open", "found every side: a tank without walls. Leave one side out")
        return self

    def inner(self) -> Bounds:
        """Corners of the space that the walls leave, open faces moved to infinity."""
        low, high = self._corners()
        for axis, end in (self.sides()[side] for side in self.open):
            (low, high)[end][axis] = math.inf if end else -math.inf
        return low, high

    def bounds(self, thickness: float = 0.0) -> Bounds:
        low, high = self._corners()
        is_open = {self.sides()[side] for side in self.open}
        for axis in range(len(low)):
            low[axis] -= 0.0 if (axis, 0) in is_open else thickness
            high[axis] += 0.0 if (axis, 1) in is_open else thickness
        return low, high

    def hollow(self) -> bool:
        return True

    def distance(self, points: FloatArray) -> FloatArray:
        return -distance.box(points, *self.inner())

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        """The lattice of the inner box, carried on for ``layers`` beyond every closed face."""
        low, high = self._corners()
        is_open = {self.sides()[side] for side in self.open}
        axes = []
        for axis, (a, b) in enumerate(zip(low, high, strict=True)):
            n = max(1, round((b - a) / spacing))
            below = 0 if (axis, 0) in is_open else layers
            above = 0 if (axis, 1) in is_open else layers
            step = (b - a) / n
            at = a + step * (np.arange(-below, n + above) + 0.5)
            axes.append(Axis(np.asarray(at, np.float64), float(step)))
        return axes


class Sphere(Shape):
    """A ball; in 2D a disc."""

    centre: Vector = Field(description="m")
    radius: Positive = Field(description="m")

    def distance(self, points: FloatArray) -> FloatArray:
        return distance.ball(points, np.array(self.centre), self.radius)

    def bounds(self, thickness: float = 0.0) -> Bounds:
        centre = np.array(self.centre)
        return centre - self.radius, centre + self.radius

    def size(self) -> float:
        return (
            math.pi if len(self.centre) == 2 else 4 / 3 * math.pi * self.radius
        ) * self.radius**2

    def exact_size(self) -> float | None:
        return self.size()

    def dimensions(self) -> set[int]:
        return {len(self.centre)}

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        """Symmetric about the centre, so that a ball at rest stays where it is."""
        n = max(1, round(2 * self.radius / spacing))
        offsets = spacing * (np.arange(n + 2) - (n + 1) / 2)
        return [Axis(np.asarray(c + offsets, np.float64), spacing) for c in self.centre]


class Disc(Sphere):
    """A disc: the sphere's name in 2D."""

    @model_validator(mode="after")
    def _flat(self) -> Disc:
        if len(self.centre) != 2:
            raise problem(
                "centre", "found 3 numbers, but a disc is flat: use 'sphere' or 'cylinder'"
            )
        return self


class Cylinder(Shape):
    """A flat-ended cylinder between two points of its axis (3D)."""

    from_: Vector = Field(alias="from", description="centre of one end, m")
    to: Vector = Field(description="centre of the other end, m")
    radius: Positive = Field(description="m")

    @model_validator(mode="after")
    def _has_length(self) -> Cylinder:
        for key, value in (("from", self.from_), ("to", self.to)):
            if len(value) != 3:
                raise problem(
                    key, f"found {len(value)} numbers, must have 3: in 2D use 'disc' or 'box'"
                )
        if self.from_ == self.to:
            raise problem("to", "is the same point as 'from': the cylinder is empty")
        return self

    def distance(self, points: FloatArray) -> FloatArray:
        return distance.cylinder(points, np.array(self.from_), np.array(self.to), self.radius)

    def bounds(self, thickness: float = 0.0) -> Bounds:
        a, b = np.array(self.from_), np.array(self.to)
        axis = (b - a) / np.linalg.norm(b - a)
        reach = self.radius * np.sqrt(np.maximum(1.0 - axis**2, 0.0))
        return np.minimum(a, b) - reach, np.maximum(a, b) + reach

    def size(self) -> float:
        return math.pi * self.radius**2 * math.dist(self.from_, self.to)

    def exact_size(self) -> float | None:
        return self.size()

    def dimensions(self) -> set[int]:
        return {3}

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        """Fitted between the bounds, hence symmetric about the axis."""
        return [fitted(a, b, spacing) for a, b in zip(*self.bounds(), strict=True)]


class Polygon(Shape):
    """A polygon; in 3D with ``from`` and ``to``: the prism over it along the z axis."""

    points: tuple[Vector, ...] = Field(min_length=3, description="corners [x, y] in order, m")
    from_: Real | None = Field(default=None, alias="from", description="lowest z of a prism, m")
    to: Real | None = Field(default=None, description="highest z of a prism, m")

    @model_validator(mode="after")
    def _simple(self) -> Polygon:
        import shapely

        if any(len(p) != 2 for p in self.points):
            raise problem("points", "found a corner of 3 numbers, must be [x, y] each")
        if (self.from_ is None) != (self.to is None):
            raise problem(
                "to", "'from' and 'to' belong together: give both for a prism, none in 2D"
            )
        if self.from_ is not None and self.to is not None and not self.to > self.from_:
            raise problem("to", f"found {self.to:g}, must be greater than 'from' ({self.from_:g})")
        ring = shapely.Polygon(self.points)
        if not ring.is_valid or ring.area == 0.0:
            reason = shapely.is_valid_reason(ring) if not ring.is_valid else "no area"
            raise problem("points", f"is no simple polygon ({reason}): order the corners around it")
        return self

    def distance(self, points: FloatArray) -> FloatArray:
        flat = distance.polygon(points[:, :2], np.array(self.points))
        if self.from_ is None or self.to is None:
            return flat
        ends = np.maximum(self.from_ - points[:, 2], points[:, 2] - self.to)
        beyond = np.stack([flat, ends], axis=1)
        outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
        return np.asarray(outside + np.minimum(beyond.max(axis=1), 0.0))

    def bounds(self, thickness: float = 0.0) -> Bounds:
        corners = np.array(self.points)
        low, high = corners.min(axis=0), corners.max(axis=0)
        if self.from_ is None or self.to is None:
            return low, high
        return np.append(low, self.from_), np.append(high, self.to)

    def size(self) -> float:
        area = abs(distance.polygon_area(np.array(self.points)))
        return (
            area * (self.to - self.from_)
            if self.to is not None and self.from_ is not None
            else area
        )

    def exact_size(self) -> float | None:
        return self.size()

    def dimensions(self) -> set[int]:
        return {2} if self.from_ is None else {3}
