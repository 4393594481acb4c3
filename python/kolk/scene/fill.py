"""From shapes to particles, and the checks that need them.

Fluid is filled on a cell-centred lattice, half a cell from the faces of a box. A wall is filled
with as many layers behind its surface as the kernel reaches, the first half a cell behind it.
Where a scene asks for it, particles in shapes that no lattice fits are packed instead (`packing`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from kolk.errors import Problem, SceneError

from . import material
from .automatic import FACETS
from .base import LARGEST
from .expression import Expression
from .memory import check_memory
from .model import Scene
from .overlap import check_places
from .packing import Distance, Placed, Unsettled, pack
from .parts import Fluid, Wall
from .shapes import Box, Shape, Tank
from .surface import wall_surface

FloatArray = npt.NDArray[np.float64]

ON_SURFACE = 1e-6
"""Spacings from a surface within which a point of the lattice is on it: it is the wall's."""
FEWEST_ACROSS = 2
"""Particles that the thinnest extent of a fluid must have: fewer are no fluid."""


@dataclass(frozen=True)
class Body:
    """One body as particles, in the order in which the engine numbers them."""

    name: str
    kind: Literal["fluid", "wall"]
    position: FloatArray
    """(n, D) in m."""
    velocity: FloatArray
    """(n, D) in m/s; of a wall, its own."""
    density: FloatArray
    """(n,) in kg/m^3; of a wall, the reference density."""
    mass: FloatArray
    """(n,) in kg, per metre in 2D."""
    surface: FloatArray | None = None
    """Of a wall: its facets (m, D, D) in m, corners so that the normal points into the fluid."""

    def __len__(self) -> int:
        return len(self.position)


@dataclass(frozen=True)
class Filling:
    """All bodies of a scene and what depends on all of them."""

    bodies: tuple[Body, ...]
    sound_speed: float
    """c0 in m/s."""
    expected_speed: float
    """Largest speed that the sound speed was chosen for, in m/s; 0 where the scene gives c0."""


@dataclass
class _Part:
    """A body on its way: what the lattice gives before velocities and densities are known."""

    position: FloatArray
    volume: float
    steps: FloatArray
    bounds: tuple[FloatArray, FloatArray] | None = None
    """Corners of a packed shape, from whose top its particles are not half a step away."""


def fill(scene: Scene) -> Filling:
    """All particles of ``scene``, checked. Raises SceneError."""
    check_memory(scene)
    walls = [_wall_part(scene, w) for w in scene.wall]
    # Walls of facets have no particles that fluid could feel: a solid without gaps.
    felt = [] if scene.numerics.wall in FACETS else zip(scene.wall, walls, strict=True)
    placed = [other for wall, part in felt for other in _placed(wall, part)]
    fluids: list[_Part] = []
    for fluid in scene.fluid:
        fluids.append(_fluid_part(scene, fluid, placed))
        placed += _placed(fluid, fluids[-1])
    check_places(scene, [p.position for p in fluids], [p.position for p in walls])
    velocities = [_velocity(scene, f, p.position) for f, p in zip(scene.fluid, fluids, strict=True)]
    speed = _expected_speed(scene, velocities, walls)
    sound_speed, expected = _sound_speed(scene, fluids, speed)
    bodies = [
        _fluid_body(scene, f, p, v, sound_speed)
        for f, p, v in zip(scene.fluid, fluids, velocities, strict=True)
    ]
    surfaces = wall_surface(scene, [p.position for p in walls])
    bodies += [
        _wall_body(scene, w, p, s) for w, p, s in zip(scene.wall, walls, surfaces, strict=True)
    ]
    for body in bodies:
        for column in (body.position, body.velocity, body.density, body.mass, body.surface):
            if column is not None:
                column.flags.writeable = False
    return Filling(tuple(bodies), sound_speed, expected)


def lattice(shape: Shape, spacing: float, layers: int = 0) -> tuple[FloatArray, FloatArray]:
    """All lattice points (n, D) around ``shape`` and the steps (D,) of the lattice, in m."""
    axes = shape.axes(spacing, layers)
    grid = np.meshgrid(*(axis.at for axis in axes), indexing="ij")
    points = np.stack([g.ravel() for g in grid], axis=1)
    return points, np.array([axis.step for axis in axes])


def _error(path: tuple[str, ...], message: str) -> SceneError:
    return SceneError(problems=[Problem(path, message)])


def _placed(body: Fluid | Wall, part: _Part) -> list[Placed]:
    """A body as others are packed against it: none where the steps of its lattice leave gaps."""
    if body.shape is None:
        return []
    shape = body.shape.shape
    if part.bounds is None and not isinstance(shape, (Box, Tank)):
        return []
    return [Placed(shape.distance, part.position, part.volume)]


def _fluid_part(scene: Scene, fluid: Fluid, others: Sequence[Placed]) -> _Part:
    cell = np.full(scene.dimension, scene.spacing)
    if fluid.particles is not None:
        part = _Part(fluid.particles.position.copy(), scene.spacing**scene.dimension, cell)
    else:
        assert fluid.shape is not None
        where = ("fluid", fluid.name, "shape", fluid.shape.kind)
        shape = fluid.shape.shape
        if isinstance(shape, Tank):
            raise _error(where, "is a shape for walls: fill fluid from a 'box'")
        low, high = shape.bounds()
        thinnest = float(np.min(high - low))
        if thinnest < FEWEST_ACROSS * scene.spacing * (1 - 1e-9):
            raise _error(
                ("spacing",),
                f"found {scene.spacing:g} m, too coarse for fluid '{fluid.name}', which is "
                f"{thinnest:g} m across at its thinnest: use {thinnest / 10:.2g} m for ten "
                f"particles across, at most {thinnest / FEWEST_ACROSS:.2g} m",
            )
        if fluid.arrangement == "packed" and not isinstance(shape, Box):
            part = _packed(scene, fluid, shape.distance, (low, high), shape.exact_size(), others)
        else:
            points, steps = lattice(shape, scene.spacing)
            if not isinstance(shape, Box):
                # Else rounding would say on which side a point of a slanted surface is.
                points = points[shape.distance(points) < -ON_SURFACE * scene.spacing]
            part = _Part(points, float(np.prod(steps)), steps)
        if len(part.position) == 0:
            raise _empty(scene, where)
    if fluid.jitter > 0.0:
        shift = np.random.default_rng(fluid.seed).uniform(-1.0, 1.0, part.position.shape)
        part.position = _wrapped(scene, part.position + fluid.jitter * scene.spacing * shift)
    return part


def _empty(scene: Scene, where: tuple[str, ...]) -> SceneError:
    return _error(
        where,
        f"is empty: no particle fits into it at a spacing of {scene.spacing:g} m. "
        "Check its corners, or refine spacing",
    )


def _packed(
    scene: Scene,
    body: Fluid | Wall,
    distance: Distance,
    bounds: tuple[FloatArray, FloatArray],
    volume: float | None,
    others: Sequence[Placed] = (),
) -> _Part:
    try:
        position, own = pack(
            distance, *bounds, scene.spacing, volume=volume, others=others, name=body.name
        )
    except Unsettled as error:
        kind = "fluid" if isinstance(body, Fluid) else "wall"
        raise _error(
            (kind, body.name, "arrangement"),
            f'found "packed", but the particles find no even distribution: {error}. Refine '
            "spacing, so that the thinnest parts of the shape are several particles across, or use "
            '"lattice"',
        ) from None
    return _Part(position, own, np.full(scene.dimension, scene.spacing), bounds)


def _wrapped(scene: Scene, position: FloatArray) -> FloatArray:
    for axis, interval in enumerate(scene.periodic_axes):
        if interval is not None:
            low, high = interval
            position[:, axis] = low + np.mod(position[:, axis] - low, high - low)
    return position


def _is_packed(scene: Scene) -> bool:
    """Whether walls are packed: packed fluid and the steps of a lattice do not fit each other."""
    return scene.numerics.wall not in FACETS and any(f.arrangement == "packed" for f in scene.fluid)


def _wall_part(scene: Scene, wall: Wall) -> _Part:
    if wall.particles is not None:
        cell = np.full(scene.dimension, scene.spacing)
        return _Part(wall.particles.position.copy(), scene.spacing**scene.dimension, cell)
    assert wall.shape is not None
    shape = wall.shape.shape
    where = ("wall", wall.name, "shape", wall.shape.kind)
    if _is_packed(scene) and not isinstance(shape, (Box, Tank)):
        # What lies deeper than the kernel reaches is never felt.
        thickness = scene.wall_layers * scene.spacing

        def layer(points: FloatArray) -> FloatArray:
            depth = shape.distance(points)
            return np.maximum(depth, -depth - thickness)

        part = _packed(scene, wall, layer, shape.bounds(thickness), None)
        if len(part.position) == 0:
            raise _empty(scene, where)
        return part
    along = shape.layers(scene.spacing, scene.wall_layers)
    if along is not None and len(along):
        cell = np.full(scene.dimension, scene.spacing)
        return _Part(along, scene.spacing**scene.dimension, cell)
    points, steps = lattice(shape, scene.spacing, scene.wall_layers)
    distance = shape.distance(points)
    keep = distance < ON_SURFACE * scene.spacing
    if not isinstance(shape, Tank):
        # What lies deeper than the kernel reaches is never felt.
        keep &= distance > -scene.wall_layers * scene.spacing
    if not keep.any():
        raise _empty(scene, where)
    return _Part(points[keep], float(np.prod(steps)), steps)


def _values(
    path: tuple[str, ...], of: Callable[[FloatArray], Any], position: FloatArray, columns: int
) -> FloatArray:
    """What a function of position gives, (n,) for one column, else (n, columns); checked."""
    shape = (len(position),) if columns == 1 else (len(position), columns)
    try:
        value = np.array(of(position.copy()), np.float64)
    except (TypeError, ValueError) as error:
        raise _error(path, f"cannot be evaluated: {error}") from None
    if value.shape != shape:
        raise _error(
            path,
            f"gave an array of shape {value.shape} for {len(position)} positions, must be {shape}",
        )
    # Not a number fails the comparison, too.
    sane = np.abs(value) <= LARGEST
    if not sane.all():
        i = int(np.argmin(sane.reshape(len(value), -1).all(axis=1)))
        raise _error(path, f"is not finite at {position[i].tolist()}: found {value[i]}")
    return value


def _velocity(scene: Scene, fluid: Fluid, position: FloatArray) -> FloatArray:
    given = fluid.velocity
    if given is None:
        own = fluid.particles.velocity if fluid.particles is not None else None
        return np.zeros_like(position) if own is None else own.copy()
    path = ("fluid", fluid.name, "velocity")
    if callable(given):
        return _values(path, given, position, scene.dimension)
    parts = [
        _values(path, p, position, 1) if isinstance(p, Expression) else np.full(len(position), p)
        for p in given
    ]
    return np.stack(parts, axis=1)


def _expected_speed(scene: Scene, velocities: list[FloatArray], walls: list[_Part]) -> float:
    speeds = [float(np.sqrt(np.max(np.sum(v**2, axis=1)))) for v in velocities]
    speeds += [float(np.linalg.norm(w.velocity)) for w in scene.wall if w.velocity is not None]
    for wall, part in zip(scene.wall, walls, strict=True):
        if wall.motion is not None:
            speeds.append(wall.motion.largest_speed(part.position))
    return max(*speeds, scene.numerics.expected_speed or 0.0, 0.0)


def capillary_speed(scene: Scene, fluids: Sequence[FloatArray]) -> float:
    """Speed in m/s that surface tension gives the thinnest fluid, as a round one; 0 without.

    fluids: positions (n, D) in m.
    """
    fluid = scene.fluid[0]
    if fluid.surface_tension is None:
        return 0.0
    thinnest = min(float(np.min(np.ptp(p, axis=0))) for p in fluids) + scene.spacing
    return material.capillary_speed(
        fluid.surface_tension, fluid.density, 0.5 * thinnest, scene.dimension
    )


def fall_height(scene: Scene, fluids: Sequence[FloatArray]) -> float:
    """Height in m through which fluid at ``fluids``, positions (n, D) in m, can fall: to the floor
    of a tank, the top of another wall."""
    strength = float(np.linalg.norm(scene.weight))
    if strength == 0.0:
        return 0.0
    up = -scene.weight / strength
    half = 0.5 * scene.spacing
    highest = max(float(np.max(p @ up)) for p in fluids) + half
    lowest = min(float(np.min(p @ up)) for p in fluids) - half
    for wall in scene.wall:
        if wall.shape is None:
            continue
        low, high = wall.shape.shape.bounds()
        corners = np.stack([g.ravel() for g in np.meshgrid(*zip(low, high, strict=True))], axis=1)
        heights = corners @ up
        floor = heights.min() if wall.shape.shape.hollow() else heights.max()
        lowest = min(lowest, float(floor))
    return highest - lowest


def _sound_speed(scene: Scene, fluids: list[_Part], speed: float) -> tuple[float, float]:
    given = scene.fluid[0].sound_speed
    if given != "auto":
        return float(given), 0.0
    gravity = float(np.linalg.norm(scene.weight))
    positions = [p.position for p in fluids]
    speed = max(speed, capillary_speed(scene, positions))
    c0 = material.sound_speed(speed, fall_height(scene, positions), gravity)
    if c0 == 0.0:
        raise _error(
            ("fluid", scene.fluid[0].name, "sound_speed"),
            'found "auto", but nothing says how fast the flow will be: no fall under gravity, no '
            "velocity at the start, no surface tension. Give a number, or numerics.expected_speed",
        )
    return c0, c0 * material.MACH


def _fluid_body(
    scene: Scene, fluid: Fluid, part: _Part, velocity: FloatArray, sound_speed: float
) -> Body:
    n = len(part.position)
    own = fluid.particles
    mass = np.full(n, fluid.density * part.volume)
    if own is not None and own.mass is not None:
        mass = own.mass.copy()
    if own is not None and own.density is not None:
        density = own.density.copy()
    else:
        try:
            density = material.density_at(
                _pressure(scene, fluid, part, sound_speed),
                reference_density=fluid.density,
                sound_speed=sound_speed,
                eos=fluid.eos,
                gamma=fluid.gamma,
            )
        except SceneError:
            raise
        except ValueError as error:
            raise _error(("fluid", fluid.name, "pressure"), str(error)) from None
    return Body(fluid.name, "fluid", np.ascontiguousarray(part.position), velocity, density, mass)


def _pressure(scene: Scene, fluid: Fluid, part: _Part, sound_speed: float) -> FloatArray:
    """Pressure at the start (n,) in Pa, above the background pressure."""
    strength = float(np.linalg.norm(scene.weight))
    given = fluid.pressure
    if given is None:
        given = "hydrostatic" if strength > 0.0 else "zero"
    if given == "zero":
        return np.zeros(len(part.position))
    if callable(given):
        return _values(("fluid", fluid.name, "pressure"), given, part.position, 1)
    up = -scene.weight / strength
    height = part.position @ up
    surface = float(height.max() + 0.5 * np.abs(up) @ part.steps)
    if part.bounds is not None and np.count_nonzero(up) == 1:
        surface = max(float(corner @ up) for corner in part.bounds)
    return material.hydrostatic_pressure(
        height,
        surface,
        gravity=strength,
        reference_density=fluid.density,
        sound_speed=sound_speed,
        eos=fluid.eos,
        gamma=fluid.gamma,
    )


def _wall_body(scene: Scene, wall: Wall, part: _Part, surface: FloatArray) -> Body:
    n = len(part.position)
    reference = scene.fluid[0].density
    mass = np.full(n, reference * part.volume)
    if wall.particles is not None and wall.particles.mass is not None:
        mass = wall.particles.mass.copy()
    own = np.zeros(scene.dimension) if wall.velocity is None else np.array(wall.velocity)
    return Body(
        wall.name,
        "wall",
        np.ascontiguousarray(part.position),
        np.tile(own, (n, 1)),
        np.full(n, reference),
        mass,
        surface,
    )
