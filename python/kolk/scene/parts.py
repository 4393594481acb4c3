"""The tables of a scene file: fluids, walls, probes, numerics, output."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import numpy.typing as npt
from pydantic import Field, PlainSerializer, PlainValidator, WithJsonSchema, model_validator

from kolk.errors import Problem, SceneError

from .arrays import Particles, load_particles
from .base import (
    Flag,
    Interval,
    Model,
    Name,
    NotNegative,
    Positive,
    Real,
    Text,
    Vector,
    Whole,
    shown,
    within_range,
)
from .composed import ShapeTable
from .expression import Expression
from .motion import Motion
from .rheology import Viscosity

FloatArray = npt.NDArray[np.float64]
OfPosition = Callable[[FloatArray], FloatArray]


def _number(value: Any) -> float | None:
    if isinstance(value, np.generic):
        value = value.item()
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return None
    try:
        return within_range(float(value))
    except (OverflowError, ValueError):
        return None


def _sound_speed(value: Any) -> Any:
    number = _number(value)
    if (isinstance(value, str) and value == "auto") or (number is not None and number > 0.0):
        return value if number is None else number
    raise ValueError(f'found {shown(value)}, must be "auto" or a speed greater than 0 in m/s')


def _velocity(value: Any) -> Any:
    if callable(value):
        return value
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, (list, tuple)) or len(value) not in (2, 3):
        raise ValueError(
            f"found {shown(value)}, must be a list of 2 or 3 numbers or expressions in quotes"
        )
    parts: list[float | Expression] = []
    for part in value:
        number = _number(part)
        if number is None and not isinstance(part, (str, Expression)):
            raise ValueError(
                f"found {shown(part)}, must be a finite number or an expression in quotes"
            )
        parts.append(
            number
            if number is not None
            else part
            if isinstance(part, Expression)
            else Expression(part)
        )
    return tuple(parts)


def _pressure(value: Any) -> Any:
    if callable(value):
        return value
    if isinstance(value, str):
        return value if value in ("hydrostatic", "zero") else Expression(value)
    raise ValueError(
        f'found {shown(value)}, must be "hydrostatic", "zero" or an expression in quotes (Pa)'
    )


SoundSpeed = Annotated[
    float | Literal["auto"],
    PlainValidator(_sound_speed),
    WithJsonSchema({"anyOf": [{"const": "auto"}, {"type": "number", "exclusiveMinimum": 0}]}),
]
Velocity = Annotated[
    tuple[float | Expression, ...] | OfPosition,
    PlainValidator(_velocity),
    PlainSerializer(lambda value: value),
    WithJsonSchema(
        {
            "type": "array",
            "items": {"type": ["number", "string"]},
            "minItems": 2,
            "maxItems": 3,
        }
    ),
]
Pressure = Annotated[
    Literal["hydrostatic", "zero"] | Expression | OfPosition,
    PlainValidator(_pressure),
    PlainSerializer(lambda value: value),
    WithJsonSchema({"type": "string"}),
]


def _particles(value: Any) -> Any:
    if isinstance(value, Particles):
        return value
    if isinstance(value, (str, Path)):
        return load_particles(Path(value))
    raise ValueError(f"found {shown(value)}, must be the path of an .npz file in quotes")


OwnParticles = Annotated[
    Particles,
    PlainValidator(_particles),
    PlainSerializer(lambda value: value),
    WithJsonSchema({"type": "string"}),
]


class _Body(Model):
    name: Name = Field(description="unique among bodies")
    shape: ShapeTable | None = Field(default=None, description="what to fill with particles")
    particles: OwnParticles | None = Field(
        default=None, description="own particles instead of a shape: path of an .npz file"
    )

    @model_validator(mode="after")
    def _shape_or_particles(self) -> _Body:
        if (self.shape is None) == (self.particles is None):
            found = "is missing" if self.shape is None else "found both 'shape' and 'particles'"
            raise SceneError(
                problems=[Problem(("shape",), f"{found}: give a shape, or own particles instead")]
            )
        if self.particles is not None and getattr(self, "arrangement", None) == "packed":
            message = 'found "packed", but own particles stay where they are: leave it out'
            raise SceneError(problems=[Problem(("arrangement",), message)])
        return self


class Fluid(_Body):
    """A body of fluid."""

    density: Positive = Field(default=1000.0, description="reference density, kg/m^3")
    sound_speed: SoundSpeed = Field("auto", description='m/s, or "auto"')
    viscosity: Viscosity | None = Field(default=None, description="leave it out for none")
    surface_tension: Positive | None = Field(
        default=None, description="of a free surface, N/m; leave it out for none"
    )
    drag: Positive | None = Field(
        default=None,
        description="rate in 1/s at which a porous bed slows it, viscosity over permeability; "
        "leave it out for none",
    )
    velocity: Velocity | None = Field(
        default=None, description="at the start, m/s: numbers or expressions"
    )
    pressure: Pressure | None = Field(
        default=None,
        description='at the start: "hydrostatic" (the default with gravity), "zero", or an '
        "expression in Pa",
    )
    eos: Literal["tait", "linear"] = "tait"
    gamma: Annotated[Real, Field(ge=1)] = Field(
        default=7.0, description="exponent of the Tait equation"
    )
    arrangement: Literal["lattice", "packed"] = Field(
        default="lattice",
        description="of the particles at the start: on a lattice, or relaxed (packed), for shapes "
        "that are curved or slanted: then of walls, too; a box and a tank keep their lattice",
    )
    jitter: Annotated[Real, Field(ge=0, lt=0.5)] = Field(
        default=0.0, description="largest random shift of a particle at the start, in spacings"
    )
    seed: Annotated[Whole, Field(ge=0)] = Field(default=0, description="of the jitter")

    @classmethod
    def from_arrays(
        cls,
        position: Any,
        velocity: Any = None,
        density: Any = None,
        mass: Any = None,
        *,
        name: str = "fluid",
        reference_density: float = 1000.0,
        **keys: Any,
    ) -> Fluid:
        """A fluid of the user's own particles.

        position (n, D) in m; velocity (n, D) in m/s, at rest if None; density (n,) in kg/m^3, from
        the pressure at the start if None, or one number: the reference density; mass (n,) in kg
        (per metre in 2D), one cell of the scene's spacing each if None. ``keys`` are the other
        keys of a fluid. The arrays are copied. Raises ArrayError, SceneError.
        """
        number = _number(density)
        if number is not None:
            reference_density, density = number, None
        return cls(
            name=name,
            particles=Particles(position, velocity, density, mass),
            density=reference_density,
            **keys,
        )


class Wall(_Body):
    """A solid that the fluid does not enter."""

    slip: Literal["free", "no"] = Field("free", description='"no": the fluid sticks to it')
    velocity: Vector | None = Field(
        default=None, description="m/s: the wall slides in its own plane; its particles stay"
    )
    motion: Motion | None = Field(default=None, description="how it moves; at rest if absent")

    @classmethod
    def from_arrays(
        cls, position: Any, mass: Any = None, *, name: str = "wall", **keys: Any
    ) -> Wall:
        """A wall of the user's own particles: position (n, D) in m, mass (n,) in kg.

        Mass is density times volume, with the fluid's reference density; one cell of the scene's
        spacing each if None. Raises ArrayError, SceneError.
        """
        return cls(name=name, particles=Particles(position, mass=mass), **keys)


class PressureProbe(Model):
    """Mean pressure over a sensor's face, or at a point."""

    at: Vector = Field(description="m; on a wall: its very surface")
    diameter: Positive | None = Field(
        default=None, description="of the sensor's face, m; a point if absent"
    )
    body: Text | None = Field(default=None, description="name of a wall that carries it along")


class LevelProbe(Model):
    """Height of the water over a base point."""

    at: Vector = Field(description="base point, m")
    direction: Vector | None = Field(default=None, description="upwards; against gravity if absent")

    @model_validator(mode="after")
    def _has_direction(self) -> LevelProbe:
        if self.direction is not None and not any(self.direction):
            raise SceneError(
                problems=[Problem(("direction",), "found no direction, must not be all zeros")]
            )
        return self


class FrontProbe(Model):
    """Farthest coordinate that a fluid has reached along an axis."""

    axis: Literal["x", "y", "z"] = "x"
    body: Text | None = Field(default=None, description="name of a fluid; the first one if absent")


class ForceProbe(Model):
    """Force of the fluid on a wall."""

    body: Text = Field(description="name of a wall")
    about: Vector | None = Field(
        default=None, description="point of the moment, m; the origin if absent"
    )


class FieldProbe(Model):
    """A field of the fluid at a point."""

    quantity: Literal["velocity", "pressure", "density"]
    at: Vector = Field(description="m")


PROBE_KINDS = ("pressure", "level", "front", "force", "field")


class Probe(Model):
    """A quantity recorded over time, of exactly one kind."""

    name: Name = Field(description="unique among probes")
    pressure: PressureProbe | None = None
    level: LevelProbe | None = None
    front: FrontProbe | None = None
    force: ForceProbe | None = None
    field: FieldProbe | None = None
    every: Positive | None = Field(
        default=None,
        description="interval of rows, s, over which pressures and forces are averaged; "
        "output.every / 20 if absent",
    )

    @model_validator(mode="after")
    def _exactly_one(self) -> Probe:
        given = [k for k in PROBE_KINDS if getattr(self, k) is not None]
        if len(given) != 1:
            found = f"found {' and '.join(given)}" if given else "measures nothing"
            allowed = f"{found}, must be exactly one of {', '.join(PROBE_KINDS)}"
            raise SceneError(problems=[Problem((), allowed)])
        return self

    @property
    def kind(self) -> str:
        """pressure, level, front, force or field."""
        return next(k for k in PROBE_KINDS if getattr(self, k) is not None)

    @property
    def what(self) -> PressureProbe | LevelProbe | FrontProbe | ForceProbe | FieldProbe:
        """The table of its kind."""
        part = getattr(self, self.kind)
        assert isinstance(part, (PressureProbe, LevelProbe, FrontProbe, ForceProbe, FieldProbe))
        return part


class Numerics(Model):
    """How the equations are solved. The defaults suit free-surface flow."""

    scheme: Literal["auto", "delta-sph", "edac", "riemann"] = Field(
        default="auto",
        description="what keeps pressure smooth: density diffusion of the form asked for "
        "(delta-sph), the diffusion of pressure of EDAC, or a Riemann problem between particles; "
        "auto: delta-sph",
    )
    density_diffusion: Literal["auto", "antuono", "molteni", "fourtakas", "none"] = Field(
        default="auto",
        description="of delta-sph; auto: antuono, but molteni without free surface and weight",
    )
    delta: Annotated[Real, Field(gt=0, le=0.2)] = Field(
        default=0.1, description="of the density diffusion"
    )
    shifting: Literal[
        "auto", "none", "sun", "gentle", "lind", "consistent", "transport-velocity"
    ] = Field(
        default="auto",
        description="gentle: as sun, with 0.3 of the strength and near a surface only along it; "
        "consistent: as sun, and particles take velocity and density along; transport-velocity: by "
        "a background pressure, without a free surface only; auto: sun, but gentle with surface "
        "tension and consistent between walls on all sides",
    )
    shifting_interval: Annotated[int, Field(ge=1, le=4)] = Field(
        default=1,
        description="steps from one shift to the next, which does the work of all of them: 2 saves "
        "up to a sixth of the time, and the energy budget closes less well",
    )
    tensile_control: Literal["auto", "none", "sun", "monaghan"] = Field(
        default="auto",
        description="what keeps fluid under tension from clumping: differences of pressure (sun) "
        "or artificial stress (monaghan); auto: sun where the fluid starts under a tension that no "
        "motion explains and has no free surface, else none",
    )
    acoustic_damper: Annotated[Real, Field(ge=0, le=0.5)] | Literal["auto"] = Field(
        default="auto",
        description="bulk viscosity over h c0 that takes up sound; auto: 0.3 in flows with a free "
        "surface, else 0",
    )
    free_surface: Flag | None = Field(
        default=None,
        description="whether the fluid has one; if absent: under gravity, or without walls",
    )
    wall: Literal[
        "auto", "adami", "dynamic", "modified-dynamic", "semi-analytical", "penalty", "mirror"
    ] = Field(default="auto", description="mirror: planes at right angles only; auto: adami")
    integrator: Literal["auto", "symplectic", "predictor-corrector", "rk2", "rk4"] = Field(
        default="auto", description="in time; auto: symplectic"
    )
    courant: Annotated[Real, Field(gt=0, le=2)] | None = Field(
        default=None, description="the integrator's own if absent"
    )
    time_step: Positive | None = Field(default=None, description="fixed, s; adaptive if absent")
    guard: Literal["on", "off"] = Field(
        default="on",
        description="keep a state in memory to go back to, with a shorter step, on trouble; off: "
        "trouble ends the run at once",
    )
    expected_speed: Positive | None = Field(
        default=None, description="largest speed that the flow will reach, m/s: for the sound speed"
    )
    background_pressure: NotNegative = Field(
        default=0.0, description="Pa: only for flows without surface"
    )


FieldName = Literal["velocity", "density", "pressure", "mass", "id"]
FIELDS: tuple[FieldName, ...] = ("velocity", "density", "pressure", "mass", "id")


class Output(Model):
    """What a run leaves behind, and how often."""

    every: Positive | None = Field(
        default=None, description="interval of frames, s; until / 100 if absent"
    )
    fields: tuple[FieldName, ...] = Field(default=FIELDS, description="columns of a frame")
    checkpoint_every: Positive | None = Field(
        default=None,
        description="interval, s of the simulation, counted at frames; if absent as often as takes "
        "at most 5 % of the running time. Always one at the start, at the end and on Ctrl-C",
    )
    pictures: Flag = True


class Periodic(Model):
    """Axes along which the domain repeats: from, to in m."""

    x: Interval | None = None
    y: Interval | None = None
    z: Interval | None = None

    @model_validator(mode="after")
    def _ordered(self) -> Periodic:
        for axis in "xyz":
            interval = getattr(self, axis)
            if interval is not None and not interval[1] > interval[0]:
                raise SceneError(
                    problems=[
                        Problem(
                            (axis,), f"found {list(interval)}, must be [low, high] with low < high"
                        )
                    ]
                )
        return self

    def axes(self, dimension: int) -> Sequence[tuple[float, float] | None]:
        """The interval of each axis, None where it does not repeat."""
        return [getattr(self, axis) for axis in "xyz"[:dimension]]
