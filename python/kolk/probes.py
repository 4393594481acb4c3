"""Probes: what a scene asks to be measured while it runs, evaluated from the present state.

A probe reads the simulation and never changes it, not even its time steps: a sample is taken at
the end of the first step at or after the moment it is due, and its row carries that step's time.
Pressures and forces, which have sound in them, are means of several readings over their interval.

| probe | value | unit |
|---|---|---|
| `WallPressure` | pressure averaged over a sensor's face on a wall | Pa |
| `WaterLevel` | height of the free surface above a base point | m |
| `SurgeFront` | coordinate of the tip of the connected flow | m |
| `WallForce` | force and moment of the fluid on a wall body | N, N m (in 2D per metre) |
| `FieldAt` | pressure, velocity or density at a point | SI |
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from kolk.scene import Scene
    from kolk.simulation import Simulation

Floats = NDArray[np.float64]

_AXES = "xyz"


@dataclass(frozen=True)
class Surroundings:
    """What probes need to know of a scene besides the running state.

    spacing, smoothing_length: m. gravity: at the start, (D,) or None. fluid, wall: positions at the
    start (n, D), m. kernel: name.
    """

    dimension: int
    spacing: float
    smoothing_length: float
    kernel: str
    gravity: Floats | None
    fluid: Floats
    wall: Floats

    @classmethod
    def of(cls, simulation: Simulation) -> Surroundings:
        """Reads them off a simulation's scene and its initial bodies."""
        scene = simulation.scene
        config = json.loads(scene.engine_config())
        dimension = int(config["dimension"])
        bodies = list(simulation.initial.values())

        def positions(kind: str) -> Floats:
            chosen = [np.asarray(b.position) for b in bodies if b.kind == kind]
            return np.concatenate([np.zeros((0, dimension)), *chosen])

        gravity = scene.gravity_at_start
        return cls(
            dimension=dimension,
            spacing=float(config["spacing"]),
            smoothing_length=float(config["smoothing_length"]),
            kernel=str(config["kernel"]),
            gravity=None if gravity is None else np.asarray(gravity, dtype=np.float64),
            fluid=positions("fluid"),
            wall=positions("wall"),
        )

    @property
    def up(self) -> Floats:
        """Unit vector against gravity; without gravity the last axis."""
        if self.gravity is not None and np.any(self.gravity):
            return np.asarray(-self.gravity / np.linalg.norm(self.gravity), dtype=np.float64)
        return np.asarray(np.eye(self.dimension)[-1])

    def wall_distance(self, points: Floats) -> Floats:
        """(m,) distance of points to the nearest wall particle, m; infinite without walls."""
        if not len(self.wall):
            return np.full(len(points), np.inf)
        from scipy.spatial import cKDTree

        distance, _ = cKDTree(self.wall).query(points)
        return np.asarray(distance, dtype=np.float64)

    def wall_fill(self, points: Floats) -> Floats:
        """(m,) the walls' own share Σ V W of the kernel at points, between 0 and 1."""
        fill = np.zeros(len(points))
        if not len(self.wall):
            return fill
        from scipy.spatial import cKDTree

        from kolk import _core

        kernel = _core.kernel(self.kernel, self.dimension)
        h = self.smoothing_length
        rows = cKDTree(self.wall).query_ball_point(points, float(kernel.support) * h)
        for index, row in enumerate(rows):
            if row:
                r = np.linalg.norm(self.wall[row] - points[index], axis=1)
                fill[index] = np.sum(kernel.value(r, h)) * self.spacing**self.dimension
        return np.clip(fill, 0.0, 1.0)


class Probe(Protocol):
    """Something measured: a name, columns of values, and a way to evaluate them."""

    name: str
    quantity: str
    unit: str
    columns: tuple[str, ...]
    readings: int
    """Readings whose mean makes a row."""

    def evaluate(self, simulation: Simulation) -> tuple[float, ...]:
        """The values of the present state, one per column."""
        ...


class WallPressure:
    """Pressure on a wall, averaged over the face of a sensor; no shift off the wall is needed.

    `at` lies on the wall, `diameter` (m) is the sensor's: the mean is taken over a segment (2D) or
    a disc (3D) in the plane of the wall; without it the pressure at the point. The engine
    extrapolates the fluid's pressure to each point with its hydrostatic part. Where the fluid fills
    hardly any of the kernel (a droplet in reach of a dry sensor) the pressure counts in proportion,
    and a dry part of the face counts as 0 Pa, as it does on a real sensor. Points of the face
    inside another wall are left out. With a `body`, that wall carries the sensor along. A row is
    the mean of 8 readings since the last.
    """

    WET = 0.2
    """Share of the kernel above which a point counts as fully wet (0.5 at a wall, 0.25 in a
    corner)."""
    POINTS: ClassVar = {2: 9, 3: 21}
    """Points on a sensor's face."""

    quantity, unit = "pressure", "Pa"
    readings = 8
    columns: tuple[str, ...] = ("value",)

    def __init__(
        self,
        name: str,
        at: Sequence[float],
        diameter: float | None,
        around: Surroundings,
        body: str | None = None,
    ) -> None:
        self.name, self.body = name, body
        centre = np.asarray(at, dtype=np.float64)
        face = centre[None, :]
        normal = wall_normal(centre, around)
        if diameter and normal is not None:
            face = centre + sensor_face(normal, diameter, self.POINTS[around.dimension])
            clear = around.wall_distance(face) > 0.4 * around.spacing
            face = face[clear] if clear.any() else centre[None, :]
        self.points = face

    def evaluate(self, simulation: Simulation) -> tuple[float, ...]:
        """Pressure, Pa."""
        points = self.points
        if self.body is not None:
            turn, offset = simulation.pose(self.body)
            points = points @ turn.T + offset
        found = simulation.sample(points, ["pressure", "fill"])
        wet = np.clip(found["fill"] / self.WET, 0.0, 1.0)
        return (float(np.mean(found["pressure"] * wet)),)


def wall_normal(point: Floats, around: Surroundings) -> Floats | None:
    """Unit normal (D,) of the wall at a point on it, into the fluid; None where no wall is near.

    The axis along which the way out of the wall is clearest; where two are as good as each other,
    as on an inclined wall, the direction away from the wall particles nearby.
    """
    s = around.spacing
    if not len(around.wall) or around.wall_distance(point[None, :])[0] > 1.5 * s:
        return None
    axes = np.concatenate([np.eye(around.dimension), -np.eye(around.dimension)])
    before = np.minimum(around.wall_distance(point + 0.5 * s * axes), 2.0 * s)
    behind = around.wall_distance(point - 0.5 * s * axes)
    gain = before - behind
    second, best = np.argsort(gain)[-2:]
    if gain[best] > 0.3 * s and gain[best] - gain[second] > 0.2 * s:
        return np.asarray(axes[best])
    offset = point - around.wall
    near = np.linalg.norm(offset, axis=1) < 2.0 * s
    mean = offset[near].mean(axis=0)
    length = float(np.linalg.norm(mean))
    return np.asarray(mean / length) if length > 0.0 else None


def sensor_face(normal: Floats, diameter: float, count: int) -> Floats:
    """(count, D) offsets of evenly spread points on a segment (2D) or disc (3D) across `normal`."""
    radius = 0.5 * diameter
    if len(normal) == 2:
        along = np.array([-normal[1], normal[0]])
        place = (np.arange(count) + 0.5) / count * 2.0 - 1.0
        return np.asarray(radius * place[:, None] * along)
    first = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    # Vogel's sunflower: equal areas, no direction preferred.
    k = np.arange(count)
    r, angle = radius * np.sqrt((k + 0.5) / count), k * np.pi * (3.0 - np.sqrt(5.0))
    face = r[:, None] * (np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second)
    return np.asarray(face)


class WaterLevel:
    """Height of the free surface above a base point, along a direction (default against gravity).

    Marches along the line in steps of half a spacing and reads the share of the kernel that fluid
    fills, in relation to what the walls leave of it, so that a gauge may stand on a floor or at a
    side wall. The level is where that share first falls through 0.5, by linear interpolation. A
    film thinner than the smoothing length, which may never reach 0.5, counts with its integral
    along the line (`film_of`); 0 where there is no fluid.
    """

    quantity, unit = "level", "m"
    readings = 1
    columns: tuple[str, ...] = ("value",)

    def __init__(
        self,
        name: str,
        at: Sequence[float],
        direction: Sequence[float] | None,
        around: Surroundings,
    ) -> None:
        self.name = name
        base = np.asarray(at, dtype=np.float64)
        along = around.up if direction is None else np.asarray(direction, dtype=np.float64)
        along = along / np.linalg.norm(along)
        everything = np.concatenate([around.fluid, around.wall])
        # Half as much again as the scene is high, for splashes that leave an open tank.
        reach = 1.5 * float(np.max((everything - base) @ along, initial=0.0))
        self.step = 0.5 * around.spacing
        count = int(np.ceil(max(reach, 4.0 * around.smoothing_length) / self.step)) + 1
        self.points = base + self.step * np.arange(count)[:, None] * along
        self.film = int(np.ceil(around.smoothing_length / self.step))
        free = 1.0 - around.wall_fill(self.points)
        # Points inside a wall tell nothing about the fluid.
        self.free = np.where(free > 0.25, free, 0.0)

    def evaluate(self, simulation: Simulation) -> tuple[float, ...]:
        """Height above the base point, m."""
        fill = simulation.sample(self.points, ["fill"])["fill"]
        return (level_of(fill, self.free, self.step, self.film),)


def level_of(fill: Floats, free: Floats, step: float, film: int) -> float:
    """Level (m) on a line of points `step` (m) apart.

    fill (n,): what fluid fills of the kernel; free (n,): what walls leave of it, 0 for points that
    do not count; film: steps in a smoothing length.
    """
    share = fill / np.where(free > 0.0, free, np.inf)
    wet = share >= 0.5
    surface = _surface(share, wet, step)
    if wet[: 2 * film + 1].any() and surface > film * step:
        return surface
    reach = slice(0, 3 * film + 1)
    return film_of(fill[reach], free[reach], step)


def film_of(fill: Floats, free: Floats, step: float) -> float:
    """Thickness (m) of the fluid between the first point and the others, from its integral.

    Kernels are symmetric: fluid up to a height t fills, summed along the line, what walls leave
    free of the kernel, summed up to t. That holds for any t, beside walls and away from them.
    """
    counted = np.where(free > 0.0, fill, 0.0)
    content = float(np.sum(counted) - 0.5 * counted[0]) * step
    if content <= 0.0:
        return 0.0
    room = np.concatenate([[0.0], np.cumsum(0.5 * (free[1:] + free[:-1]))]) * step
    return float(np.interp(content, room, step * np.arange(len(room))))


def _surface(share: Floats, wet: NDArray[np.bool_], step: float) -> float:
    """Where the share first falls through 0.5 after it was above it, m; 0 if it never is."""
    if not wet.any():
        return 0.0
    start = int(np.argmax(wet))
    dry = np.flatnonzero(~wet[start:])
    if not len(dry):
        return float((len(share) - 1) * step)
    above = start + int(dry[0])
    upper, lower = share[above], share[above - 1]
    return float((above - 1 + (lower - 0.5) / (lower - upper)) * step)


class SurgeFront:
    """Coordinate of the tip of the flow along an axis, without the drops that fly ahead of it.

    Takes the particles of the fluid in the lowest four spacings above its initial bottom (all of
    them without gravity, or along it), orders them along the axis, and cuts the row where a gap is
    wider than two spacings. The front is the end of the piece that holds most of them, half a
    spacing beyond its last particle. `sign` -1 looks towards smaller coordinates.
    """

    LAYER = 4.0
    GAP = 2.0

    quantity, unit = "front", "m"
    readings = 1
    columns: tuple[str, ...] = ("value",)

    def __init__(
        self, name: str, axis: int, bodies: Sequence[str], around: Surroundings, sign: int = 1
    ) -> None:
        self.name = name
        self.axis, self.sign, self.bodies = axis, sign, tuple(bodies)
        self.spacing = around.spacing
        across = around.gravity is not None and abs(around.up[axis]) < 0.5
        self.up = around.up if across else None
        if self.up is not None and len(around.fluid):
            self.bottom = float(np.min(around.fluid @ self.up)) - 0.5 * self.spacing

    def evaluate(self, simulation: Simulation) -> tuple[float, ...]:
        """Coordinate of the tip, m."""
        position = np.concatenate([simulation.bodies[name].position for name in self.bodies])
        if self.up is not None:
            low = position @ self.up < self.bottom + self.LAYER * self.spacing
            position = position[low] if low.any() else position
        along = self.sign * position[:, self.axis]
        return (self.sign * front_of(along, self.GAP * self.spacing, 0.5 * self.spacing),)


def front_of(coordinate: Floats, gap: float, half: float) -> float:
    """Upper end of the fullest piece of a row of coordinates cut at gaps, plus `half`."""
    row = np.sort(coordinate)
    cuts = np.flatnonzero(np.diff(row) > gap) + 1
    edges = np.concatenate([[0], cuts, [len(row)]])
    fullest = int(np.argmax(np.diff(edges)))
    return float(row[edges[fullest + 1] - 1]) + half


class WallForce:
    """Force of the fluid on a wall body and its moment about a point (the origin)."""

    quantity = "force"
    readings = 8

    def __init__(
        self,
        name: str,
        body: str,
        around: Surroundings,
        about: Sequence[float] | None = None,
    ) -> None:
        self.name, self.body = name, body
        self.about = np.zeros(3)
        self.about[: around.dimension] = 0.0 if about is None else about
        flat = around.dimension == 2
        self.unit = "N/m, N" if flat else "N, N m"
        moments = ("moment",) if flat else ("moment_x", "moment_y", "moment_z")
        self.columns: tuple[str, ...] = (*_AXES[: around.dimension], *moments)

    def evaluate(self, simulation: Simulation) -> tuple[float, ...]:
        """Components of the force, then of the moment."""
        found = simulation.force(self.body)
        force, moment = np.ravel(found["force"]), np.ravel(found["moment"])
        lever = np.cross(self.about, np.pad(force, (0, 3 - len(force))))
        moment = moment - lever[-len(moment) :]
        return tuple(map(float, np.concatenate([force, moment])))


class FieldAt:
    """Pressure, density or velocity of the fluid at a point; 0 where there is none."""

    readings = 1
    UNITS: ClassVar = {"pressure": "Pa", "density": "kg/m³", "velocity": "m/s"}

    def __init__(self, name: str, quantity: str, at: Sequence[float], around: Surroundings) -> None:
        self.name, self.quantity = name, quantity
        self.unit = self.UNITS[quantity]
        vector = quantity == "velocity"
        self.columns: tuple[str, ...] = tuple(_AXES[: around.dimension]) if vector else ("value",)
        self.points = np.asarray(at, dtype=np.float64)[None, :]

    def evaluate(self, simulation: Simulation) -> tuple[float, ...]:
        """The value, or the components."""
        value = simulation.sample(self.points, [self.quantity])[self.quantity]
        return tuple(map(float, np.ravel(value)))


def build_probes(scene: Scene, simulation: Simulation) -> list[tuple[Probe, float]]:
    """The scene's probes, each with its sampling interval (s)."""
    if not scene.probe:
        return []
    around = Surroundings.of(simulation)
    return [(_build(spec, around, simulation), scene.probe_interval(spec)) for spec in scene.probe]


def _build(spec: Any, around: Surroundings, simulation: Simulation) -> Probe:
    name, kind, what = spec.name, spec.kind, spec.what
    if kind == "pressure":
        return WallPressure(name, what.at, what.diameter, around, what.body)
    if kind == "level":
        return WaterLevel(name, what.at, what.direction, around)
    if kind == "front":
        fluids = [b.name for b in simulation.bodies.values() if b.kind == "fluid"]
        return SurgeFront(name, _AXES.index(what.axis), [what.body or fluids[0]], around)
    if kind == "force":
        return WallForce(name, what.body, around, what.about)
    return FieldAt(name, what.quantity, what.at, around)
