"""What a scene prescribes over time: the motion of walls, and gravity."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator, Field, model_validator
from pydantic.annotated_handlers import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from kolk.errors import Problem, SceneError

from .base import Model, Positive, Real, Vector, shown

FloatArray = npt.NDArray[np.float64]
Axis = Annotated[tuple[Real, Real, Real], Field(description="direction of the axis, in 3D")]


def _wrong(key: str, message: str) -> SceneError:
    return SceneError(problems=[Problem((key,) if key else (), message)])


def _several(value: Any) -> Any:
    """One table stands for a list of one."""
    return list(value) if isinstance(value, (list, tuple)) else [value]


class _Timed(Model):
    start: Real = Field(default=0.0, description="s; before it nothing has moved")
    end: Real | None = Field(default=None, description="s; after it all stays where it came to")

    @model_validator(mode="after")
    def _in_order(self) -> _Timed:
        if self.end is not None and self.end < self.start:
            raise _wrong("end", f"found {self.end:g}, must not be before the start {self.start:g}")
        return self

    def times(self) -> dict[str, Any]:
        """start and end for the engine."""
        return {"start": self.start, "end": self.end}


class _Turning(_Timed):
    centre: Vector | None = Field(default=None, description="a point of the axis at the start, m")
    axis: Axis | None = None

    def circle(self, dimension: int) -> dict[str, Any]:
        """The path of a rotation for the engine."""
        axis = None if dimension == 2 else self.axis
        assert self.centre is not None
        return {
            "kind": "rotate",
            "centre": list(self.centre),
            "axis": None if axis is None else list(axis),
        }

    def reach(self, position: FloatArray) -> float:
        """Distance in m from the centre to the farthest of the positions (n, D)."""
        assert self.centre is not None
        return float(np.max(np.linalg.norm(position - np.array(self.centre), axis=1)))


class Translate(_Timed):
    """A steady translation."""

    velocity: Vector = Field(description="m/s")


class Rotate(_Turning):
    """A steady rotation."""

    centre: Vector = Field(description="a point of the axis at the start, m")
    rate: Real = Field(description="rad/s; in 2D counter-clockwise")


class Sinus(_Turning):
    """An oscillation along a vector or about an axis: ``sin(2 pi frequency t + phase)``."""

    amplitude: Vector | None = Field(default=None, description="of a translation, m")
    angle: Real | None = Field(default=None, description="amplitude of a rotation, rad")
    frequency: Positive = Field(description="Hz")
    phase: Real = Field(default=0.0, description="rad; the wall is in its place at the start")

    @model_validator(mode="after")
    def _one_kind(self) -> Sinus:
        _either(self.amplitude, self.angle, "amplitude", self.centre)
        return self


class MotionTable(_Turning):
    """Points of a curve: displacements (m) or angles (rad) at times (s), in a list or a file."""

    time: tuple[Real, ...] = Field(min_length=2, description="ascending, s")
    displacement: tuple[Vector, ...] | None = Field(default=None, description="m, one per time")
    angle: tuple[Real, ...] | None = Field(default=None, description="rad, one per time")
    interpolation: Literal["cubic", "linear"] = "cubic"

    @model_validator(mode="before")
    @classmethod
    def _from_file(cls, data: Any) -> Any:
        return read_columns(data, "displacement")

    @model_validator(mode="after")
    def _fits(self) -> MotionTable:
        _either(self.displacement, self.angle, "displacement", self.centre)
        _ascending(self.time)
        for key in ("displacement", "angle"):
            _as_many(key, getattr(self, key), self.time)
        return self


def _either(line: Any, angle: Any, key: str, centre: Any) -> None:
    if (line is None) == (angle is None):
        found = "found neither" if line is None else "found both"
        raise _wrong("", f"{found}: give '{key}' for a translation, or 'angle' for a rotation")
    if angle is not None and centre is None:
        raise _wrong("centre", "is missing: give a point of the axis of rotation")


def _ascending(time: tuple[float, ...]) -> None:
    for before, after in itertools.pairwise(time):
        if after <= before:
            raise _wrong("time", f"found {after:g} after {before:g}, must be ascending")


def _as_many(key: str, values: Any, time: tuple[float, ...]) -> None:
    if values is not None and len(values) != len(time):
        raise _wrong(key, f"found {len(values)} entries for {len(time)} times: give one for each")


def read_columns(data: Any, vector: str) -> Any:
    """A table with its ``file`` read: columns time and one angle, or time and a vector."""
    if not isinstance(data, dict) or "file" not in data:
        return data
    data = dict(data)
    path, scale = data.pop("file"), data.pop("scale", 1.0)
    if not isinstance(path, (str, Path)):
        raise _wrong("file", f"found {shown(path)}, must be the path of a table in quotes")
    if not isinstance(scale, (int, float)) or not math.isfinite(scale):
        raise _wrong("scale", f"found {shown(scale)}, must be a number")
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise _wrong("file", f"{path} cannot be read: {error}") from None
    rows: list[list[float]] = []
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].replace(",", " ").replace(";", " ").split()
        if not words:
            continue
        try:
            rows.append([float(word) for word in words])
        except ValueError:
            if not rows and number == 1:
                continue  # the names of the columns
            raise _wrong(
                "file", f"{path}, line {number}: found {shown(line)}, must be numbers"
            ) from None
        if len(rows[-1]) != len(rows[0]):
            message = f"found {len(rows[-1])} columns, the first row has {len(rows[0])}"
            raise _wrong("file", f"{path}, line {number}: {message}")
    if not rows or len(rows[0]) not in (2, 3, 4):
        found = len(rows[0]) if rows else 0
        raise _wrong("file", f"{path}: found {found} columns, must be 2 (angle) to 4 (vector)")
    data["time"] = tuple(row[0] for row in rows)
    if len(rows[0]) == 2:
        data["angle"] = tuple(scale * row[1] for row in rows)
    else:
        data[vector] = tuple(tuple(scale * v for v in row[1:]) for row in rows)
    return data


class Motion(Model):
    """The motion of a wall: rotations in this order, then translations, all from its start.

    Each key takes one table or a list of them.
    """

    rotate: Annotated[tuple[Rotate, ...], BeforeValidator(_several)] = ()
    translate: Annotated[tuple[Translate, ...], BeforeValidator(_several)] = ()
    sinus: Annotated[tuple[Sinus, ...], BeforeValidator(_several)] = ()
    table: Annotated[tuple[MotionTable, ...], BeforeValidator(_several)] = ()

    @model_validator(mode="after")
    def _something(self) -> Motion:
        if not self.parts():
            raise _wrong("", "is empty: give 'rotate', 'translate', 'sinus' or 'table'")
        return self

    def parts(self) -> list[_Timed]:
        """All parts, in their order."""
        return [*self.rotate, *self.translate, *self.sinus, *self.table]

    @property
    def turns(self) -> bool:
        """Whether it has a rotation."""
        return any(getattr(part, "centre", None) is not None for part in self.parts())

    def engine(self, dimension: int) -> list[dict[str, Any]]:
        """The parts for the engine."""
        out: list[dict[str, Any]] = []

        def add(part: _Timed, path: dict[str, Any], signal: dict[str, Any]) -> None:
            out.append({"path": path, "signal": signal, **part.times()})

        for part in self.parts():
            if isinstance(part, Rotate):
                add(part, part.circle(dimension), {"kind": "rate", "rate": part.rate})
            elif isinstance(part, Translate):
                add(part, _line(part.velocity), {"kind": "rate", "rate": 1.0})
            elif isinstance(part, Sinus):
                path = part.circle(dimension) if part.amplitude is None else _line(part.amplitude)
                add(part, path, _wave(part.angle or 1.0, part.frequency, part.phase))
            elif isinstance(part, MotionTable):
                if part.angle is not None:
                    add(part, part.circle(dimension), _curve(part, part.angle))
                for axis in range(dimension if part.displacement is not None else 0):
                    assert part.displacement is not None
                    values = tuple(row[axis] for row in part.displacement)
                    add(part, _line(np.eye(dimension)[axis]), _curve(part, values))
        return out

    def largest_speed(self, position: FloatArray) -> float:
        """Bound in m/s on the speed of a wall that starts at ``position`` (n, D)."""
        speed = 0.0
        for part in self.parts():
            if isinstance(part, Rotate):
                speed += abs(part.rate) * part.reach(position)
            elif isinstance(part, Translate):
                speed += float(np.linalg.norm(part.velocity))
            elif isinstance(part, Sinus):
                omega = 2.0 * math.pi * part.frequency
                turn = 0.0 if part.angle is None else abs(part.angle) * part.reach(position)
                speed += omega * (turn + float(np.linalg.norm(part.amplitude or 0.0)))
            elif isinstance(part, MotionTable):
                values = np.array(part.angle if part.displacement is None else part.displacement)
                steps = np.diff(values.reshape(len(part.time), -1), axis=0)
                rates = np.linalg.norm(steps, axis=1) / np.diff(part.time)
                arm = part.reach(position) if part.angle is not None else 1.0
                speed += float(np.max(rates)) * arm
        return speed

    def vectors(self) -> list[tuple[tuple[str | int, ...], Any]]:
        """Every vector of as many numbers as the scene has dimensions, with its path."""
        found: list[tuple[tuple[str | int, ...], Any]] = []
        for key in ("rotate", "translate", "sinus", "table"):
            for number, part in enumerate(getattr(self, key)):
                for name in ("centre", "velocity", "amplitude"):
                    found.append(((key, number, name), getattr(part, name, None)))
                for row in getattr(part, "displacement", None) or ():
                    found.append(((key, number, "displacement"), row))
        return found


def _line(direction: Any) -> dict[str, Any]:
    return {"kind": "translate", "direction": [float(v) for v in direction]}


def _wave(amplitude: float, frequency: float, phase: float) -> dict[str, Any]:
    return {"kind": "sinus", "amplitude": amplitude, "frequency": frequency, "phase": phase}


def _curve(table: Any, values: tuple[float, ...]) -> dict[str, Any]:
    return {
        "kind": "table",
        "time": list(table.time),
        "value": list(values),
        "interpolation": table.interpolation,
    }


class GravitySinus(Model):
    """An oscillating part of gravity."""

    amplitude: Vector = Field(description="m/s^2")
    frequency: Positive = Field(description="Hz")
    phase: Real = Field(default=0.0, description="rad")


class GravityTable(Model):
    """A part of gravity as points of a curve, in a list or a file."""

    time: tuple[Real, ...] = Field(min_length=2, description="ascending, s")
    value: tuple[Vector, ...] = Field(description="m/s^2, one per time")
    interpolation: Literal["cubic", "linear"] = "cubic"

    @model_validator(mode="before")
    @classmethod
    def _from_file(cls, data: Any) -> Any:
        return read_columns(data, "value")

    @model_validator(mode="after")
    def _fits(self) -> GravityTable:
        _ascending(self.time)
        _as_many("value", self.value, self.time)
        return self


class Gravity(Model):
    """Gravity that changes with time: the sum of its parts."""

    base: Vector | None = Field(default=None, description="the constant part, m/s^2")
    sinus: Annotated[tuple[GravitySinus, ...], BeforeValidator(_several)] = ()
    table: Annotated[tuple[GravityTable, ...], BeforeValidator(_several)] = ()

    @model_validator(mode="after")
    def _changes(self) -> Gravity:
        if not (self.sinus or self.table):
            raise _wrong("", "does not change with time: give 'sinus' or 'table', or a list")
        return self

    def at_start(self) -> tuple[float, ...]:
        """At t = 0 s, m/s^2."""
        parts = [np.array(self.base)] if self.base is not None else []
        parts += [np.array(s.amplitude) * math.sin(s.phase) for s in self.sinus]
        for table in self.table:
            columns = np.array(table.value).T
            parts.append(np.array([np.interp(0.0, table.time, c) for c in columns]))
        return tuple(float(v) for v in sum(parts[1:], parts[0]))

    def engine(self) -> list[dict[str, Any]]:
        """The parts that change, for the engine."""
        out = [
            {"direction": list(s.amplitude), "signal": _wave(1.0, s.frequency, s.phase)}
            for s in self.sinus
        ]
        for table in self.table:
            dimension = len(table.value[0])
            for axis in range(dimension):
                values = tuple(row[axis] for row in table.value)
                direction = [float(axis == a) for a in range(dimension)]
                out.append({"direction": direction, "signal": _curve(table, values)})
        return out

    def vectors(self) -> list[tuple[tuple[str | int, ...], Any]]:
        """Every vector, with its path."""
        found: list[tuple[tuple[str | int, ...], Any]] = [(("base",), self.base)]
        found += [(("sinus", i, "amplitude"), s.amplitude) for i, s in enumerate(self.sinus)]
        for i, table in enumerate(self.table):
            found += [(("table", i, "value"), row) for row in table.value]
        return found


class _VectorOrTable:
    """A vector, or a table that becomes a `Gravity`; errors are those of the one that was meant."""

    @staticmethod
    def __get_pydantic_core_schema__(_: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        def choose(value: Any, vector: core_schema.ValidatorFunctionWrapHandler) -> Any:
            if isinstance(value, dict):
                return Gravity(**value)
            return value if isinstance(value, Gravity) else vector(value)

        def dump(value: Any) -> Any:
            return value.model_dump(exclude_unset=True) if isinstance(value, Gravity) else value

        return core_schema.no_info_wrap_validator_function(
            choose,
            handler.generate_schema(Vector),
            serialization=core_schema.plain_serializer_function_ser_schema(dump),
        )

    @staticmethod
    def __get_pydantic_json_schema__(
        schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        assert schema["type"] == "function-wrap"
        return {"anyOf": [handler(schema["schema"]), handler(Gravity.__pydantic_core_schema__)]}


GravityKey = Annotated[tuple[float, ...] | Gravity, _VectorOrTable]


def place_files(data: dict[str, Any], folder: Path) -> None:
    """Makes the paths of tables in the plain ``data`` of a scene relative to ``folder``."""
    walls = data.get("wall")
    owners = [data.get("gravity")]
    if isinstance(walls, list):
        owners += [w.get("motion") for w in walls if isinstance(w, dict)]
    for owner in owners:
        tables = owner.get("table") if isinstance(owner, dict) else None
        for table in _several(tables):
            if isinstance(table, dict) and isinstance(table.get("file"), str):
                table["file"] = str(folder / table["file"])
