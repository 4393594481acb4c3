"""Shapes made of shapes, shapes made of functions, and the table that holds any one shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt
from pydantic import ConfigDict, Field, PlainValidator, WithJsonSchema, model_validator

from kolk.errors import Problem, SceneError

from . import distance
from .base import Model, shown
from .expression import Expression
from .mesh import Mesh, Outline
from .shapes import (
    Axis,
    Bounds,
    Box,
    Cylinder,
    Disc,
    FromTo,
    Polygon,
    Shape,
    Sphere,
    Tank,
    problem,
)

FloatArray = npt.NDArray[np.float64]


class Difference(Shape):
    """One shape less others, on the lattice of the first."""

    of: ShapeTable
    minus: tuple[ShapeTable, ...] = Field(min_length=1)

    def distance(self, points: FloatArray) -> FloatArray:
        cuts = [-s.shape.distance(points) for s in self.minus]
        return np.asarray(np.maximum.reduce([self.of.shape.distance(points), *cuts]))

    def bounds(self, thickness: float = 0.0) -> Bounds:
        return self.of.shape.bounds(thickness)

    def size(self) -> float:
        return self.of.shape.size()

    def dimensions(self) -> set[int]:
        return set.intersection(*(s.shape.dimensions() for s in (self.of, *self.minus)))

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        return self.of.shape.axes(spacing, layers)


def _function(value: Any) -> Any:
    if isinstance(value, str):
        return Expression(value)
    if isinstance(value, Expression) or callable(value):
        return value
    raise ValueError(
        f"found {shown(value)}, must be an expression in quotes or, in Python, a function"
    )


class Function(FromTo):
    """Where a function of position is negative, within a box: the function need not be a distance.

    In Python ``value`` may be a callable from positions (m, D) to values (m,).
    """

    value: Annotated[
        Expression | Callable[[FloatArray], FloatArray],
        PlainValidator(_function),
        WithJsonSchema({"type": "string"}),
    ] = Field(description='expression of x, y, z: negative inside, e.g. "hypot(x, y) - 0.1"')

    def distance(self, points: FloatArray) -> FloatArray:
        value = np.asarray(self.value(points), np.float64)
        if value.shape != (len(points),):
            raise problem(
                "function.value",
                f"gave an array of shape {value.shape} for {len(points)} points: return one "
                "number for each",
            )
        if not np.isfinite(value).all():
            where = points[np.argmin(np.isfinite(value))].tolist()
            raise problem("function.value", f"is not finite at {where}: mend it there")
        return np.maximum(value, distance.box(points, *self.bounds()))


class ShapeTable(Model):
    """A shape as a scene file writes it: a table with exactly one key, the kind of shape."""

    model_config = ConfigDict(json_schema_extra={"minProperties": 1, "maxProperties": 1})

    box: Box | None = None
    sphere: Sphere | None = None
    disc: Disc | None = None
    cylinder: Cylinder | None = None
    polygon: Polygon | None = None
    tank: Tank | None = None
    mesh: Mesh | None = None
    outline: Outline | None = None
    union: tuple[ShapeTable, ...] | None = Field(default=None, min_length=1)
    difference: Difference | None = None
    function: Function | None = None

    @model_validator(mode="before")
    @classmethod
    def _bare(cls, data: Any) -> Any:
        """In Python a shape may stand for its table."""
        if isinstance(data, Union):
            return {"union": data.parts}
        if isinstance(data, Shape):
            return {type(data).__name__.lower(): data}
        return data

    @model_validator(mode="after")
    def _exactly_one(self) -> ShapeTable:
        given = [k for k in type(self).model_fields if getattr(self, k) is not None]
        if len(given) != 1:
            found = f"found {' and '.join(given)}" if given else "is empty"
            kinds = ", ".join(type(self).model_fields)
            raise SceneError(problems=[Problem((), f"{found}, must be exactly one of {kinds}")])
        return self

    @property
    def kind(self) -> str:
        """The one key that is given."""
        return next(k for k in type(self).model_fields if getattr(self, k) is not None)

    @property
    def shape(self) -> Shape:
        """The shape itself."""
        part = getattr(self, self.kind)
        return part if isinstance(part, Shape) else Union(part)


class Union(Shape):
    """Several shapes as one. ``parts`` are shapes or their tables."""

    parts: tuple[ShapeTable, ...] = Field(min_length=1)

    def __init__(self, parts: Sequence[Any] = (), /, **data: Any) -> None:
        super().__init__(**({"parts": parts} | data))

    def distance(self, points: FloatArray) -> FloatArray:
        return np.asarray(np.minimum.reduce([s.shape.distance(points) for s in self.parts]))

    def bounds(self, thickness: float = 0.0) -> Bounds:
        corners = [s.shape.bounds(thickness) for s in self.parts]
        return (
            np.min([low for low, _ in corners], axis=0),
            np.max([high for _, high in corners], axis=0),
        )

    def size(self) -> float:
        return sum(s.shape.size() for s in self.parts)

    def dimensions(self) -> set[int]:
        return set.intersection(*(s.shape.dimensions() for s in self.parts))


Difference.model_rebuild()
ShapeTable.model_rebuild()
