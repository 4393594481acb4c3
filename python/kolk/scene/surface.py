"""The surface of all walls of a scene as facets, each body's own part of it.

Every shape gives the facets of its faces (`facets`); what lies inside another wall, or where two
walls touch, is cut away, so that the facets left are what the fluid can meet. Walls of own
particles, whose shape nobody knows, get the surface half a spacing in front of their outermost
particles.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from . import distance, facets
from .composed import Difference, Function, ShapeTable, Union
from .mesh import Mesh, Outline
from .model import Scene
from .shapes import Box, Cylinder, Polygon, Shape, Sphere, Tank

FloatArray = npt.NDArray[np.float64]
Solid = Callable[[FloatArray], FloatArray]

EPSILON = 1e-6
"""Distance in spacings at which a point is in front of a facet or behind it."""

STEP = 0.5
"""Cell in spacings over which a function's surface is sought."""

FINEST = 0.25
"""Facets that another wall cuts are halved to this many spacings, then cut straight."""


BISECTIONS = 30
"""Halvings that find where an edge meets another wall."""


def wall_surface(scene: Scene, positions: Sequence[FloatArray]) -> list[FloatArray]:
    """Facets (m, D, D) in m of each wall of ``scene``; ``positions`` are the particles of each."""
    thickness = scene.wall_layers * scene.spacing
    solids: list[Solid] = []
    raw: list[FloatArray] = []
    for wall, position in zip(scene.wall, positions, strict=True):
        if wall.shape is None:
            solid = _of_particles(position, scene.spacing)
            low, high = position.min(axis=0) - scene.spacing, position.max(axis=0) + scene.spacing
            raw.append(facets.level_set(solid, low, high, STEP * scene.spacing))
        else:
            solid = _solid(wall.shape.shape, thickness)
            raw.append(_faces(wall.shape.shape, scene.spacing, thickness))
        solids.append(_repeated(scene, solid))
    return [_exposed(scene, own, i, solids) for i, own in enumerate(raw)]


def _solid(shape: Shape, thickness: float) -> Solid:
    """The distance from a shape; a vessel ends ``thickness`` behind its faces, as its particles."""
    if not shape.hollow():
        return shape.distance
    bounds = shape.bounds(thickness)
    return lambda points: np.maximum(shape.distance(points), distance.box(points, *bounds))


def _repeated(scene: Scene, solid: Solid) -> Solid:
    """The solid and its periodic images."""
    axes = [(a, i) for a, i in enumerate(scene.periodic_axes) if i is not None]
    if not axes:
        return solid

    def wrapped(points: FloatArray) -> FloatArray:
        inside = points.copy()
        for axis, (low, high) in axes:
            inside[:, axis] = low + np.mod(points[:, axis] - low, high - low)
        return solid(inside)

    return wrapped


def _of_particles(position: FloatArray, spacing: float) -> Solid:
    """A function that is negative within half a spacing of particles in order: the kernel sum less
    half of what it is deep inside."""
    from scipy.spatial import cKDTree

    from kolk import _core

    tree = cKDTree(position)
    kernel = _core.kernel("wendland-c2", position.shape[1])
    h = spacing
    cell = spacing ** position.shape[1]

    def value(points: FloatArray) -> FloatArray:
        pairs = cKDTree(points).sparse_distance_matrix(tree, 2.0 * h, output_type="coo_matrix")
        weight = np.asarray(kernel.value(pairs.data, h)) * cell
        return np.asarray(0.5 - np.bincount(pairs.row, weight, len(points)))

    return value


def _faces(shape: Shape, spacing: float, thickness: float) -> FloatArray:
    """The faces of one shape, curves as polygons."""
    if isinstance(shape, Tank):
        closed = {face for side, face in shape.sides().items() if side not in shape.open}
        inner = facets.box(np.array(shape.from_), np.array(shape.to), closed)
        return inner[:, [1, 0, *range(2, inner.shape[1])]]
    if isinstance(shape, Box):
        return facets.box(*shape.bounds())
    if isinstance(shape, Sphere):
        centre = np.array(shape.centre)
        curved = facets.disc if len(centre) == 2 else facets.sphere
        return curved(centre, shape.radius, spacing)
    if isinstance(shape, Cylinder):
        return facets.cylinder(np.array(shape.from_), np.array(shape.to), shape.radius, spacing)
    if isinstance(shape, Polygon):
        corners = np.array(shape.points)
        if shape.from_ is None or shape.to is None:
            return facets.polygon(corners)
        return facets.prism(corners, shape.from_, shape.to)
    if isinstance(shape, Mesh):
        outer = shape.triangles()
        return outer[:, [1, 0, 2]] if shape.hollow() else outer
    if isinstance(shape, Outline):
        edges = np.concatenate([facets.polygon(ring) for ring in shape.rings()])
        # A ring within a ring is a hole.
        ahead = edges.mean(axis=1) + EPSILON * spacing * facets.normals(edges)
        inwards = shape.distance(ahead) < 0.0
        return np.where(inwards[:, None, None], edges[:, ::-1], edges)
    if isinstance(shape, Union):
        return _composed(shape.parts, [], spacing, thickness)
    if isinstance(shape, Difference):
        return _composed((shape.of,), shape.minus, spacing, thickness)
    assert isinstance(shape, Function)
    return facets.level_set(shape.distance, *shape.bounds(), STEP * spacing)


def _composed(
    plus: Sequence[ShapeTable], minus: Sequence[ShapeTable], spacing: float, thickness: float
) -> FloatArray:
    """The faces of shapes together, less others."""
    added = [_solid(s.shape, thickness) for s in plus]
    taken = [_solid(s.shape, thickness) for s in minus]
    found = []
    for i, table in enumerate(plus):
        own = _faces(table.shape, spacing, thickness)
        others = [s for k, s in enumerate(added) if k != i]
        earlier = [k < i for k in range(len(added)) if k != i]
        own = _outside(own, others, earlier, spacing)
        # What is left of a face has its solid outside all that is taken away.
        found.append(_outside(own, taken, [False] * len(taken), spacing, side=-1.0))
    for i, table in enumerate(minus):
        own = _faces(table.shape, spacing, thickness)
        own = own[:, [1, 0, *range(2, own.shape[1])]]
        others = [s for k, s in enumerate(taken) if k != i]
        own = _outside(own, others, [False] * len(others), spacing, side=-1.0)
        inverse = [lambda p: -np.minimum.reduce([s(p) for s in added])]
        found.append(_outside(own, inverse, [False], spacing, side=-1.0))
    return np.concatenate(found)


def _exposed(scene: Scene, own: FloatArray, i: int, solids: Sequence[Solid]) -> FloatArray:
    """What of the facets of wall ``i`` the fluid can meet."""
    others = [s for k, s in enumerate(solids) if k != i]
    earlier = [k < i for k in range(len(solids)) if k != i]
    left = _outside(own, others, earlier, scene.spacing)
    for axis, interval in enumerate(scene.periodic_axes):
        if interval is not None and len(left):
            # A face at the end of a period, with the wall's own image behind it, is none.
            centre, normal = left.mean(axis=1), facets.normals(left)
            front = solids[i](centre + EPSILON * scene.spacing * normal) > 0.0
            at_end = np.abs(normal[:, axis]) > 0.5
            left = left[front | ~at_end]
    return np.ascontiguousarray(left)


def _outside(
    own: FloatArray,
    others: Sequence[Solid],
    earlier: Sequence[bool],
    spacing: float,
    side: float = 1.0,
) -> FloatArray:
    """The parts of facets that lie outside of ``others``, tested a little in front of them
    (``side`` 1) or behind (-1). Where faces coincide, those of ``earlier`` solids stand."""
    if not others or not len(own):
        return own
    tiny = EPSILON * spacing

    def clearance(points: FloatArray, normal: FloatArray) -> FloatArray:
        moved = points + side * tiny * normal
        return np.asarray(
            np.minimum.reduce(
                [
                    s(moved) - (2.0 * tiny if e else 0.0)
                    for s, e in zip(others, earlier, strict=True)
                ]
            )
        )

    done: list[FloatArray] = []
    todo = own
    while len(todo):
        normal = facets.normals(todo)
        corners = np.stack([clearance(todo[:, k], normal) for k in range(todo.shape[1])], axis=1)
        centre = todo.mean(axis=1)
        middle = clearance(centre, normal)
        radius = np.linalg.norm(todo - centre[:, None], axis=2).max(axis=1)
        free = middle > radius
        buried = middle < -radius
        small = radius < FINEST * spacing
        done.append(todo[free])
        cut = small & ~free & ~buried
        done.append(_cut(todo[cut], corners[cut], normal[cut], clearance))
        todo = _halved(todo[~(free | buried | small)])
    return _joined(np.concatenate(done))


def _halved(own: FloatArray) -> FloatArray:
    """Each facet cut in two across its longest edge."""
    d = own.shape[1]
    if d == 2:
        middle = own.mean(axis=1)
        return np.concatenate(
            [np.stack([own[:, 0], middle], axis=1), np.stack([middle, own[:, 1]], axis=1)]
        )
    length = np.linalg.norm(own - np.roll(own, -1, axis=1), axis=2)
    turn = np.argmax(length, axis=1)
    rows = np.arange(len(own))
    a, b, c = (own[rows, (turn + k) % 3] for k in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def _cut(
    own: FloatArray,
    at: FloatArray,
    normal: FloatArray,
    clearance: Callable[[FloatArray, FloatArray], FloatArray],
) -> FloatArray:
    """The parts of facets (m, D, D) where ``clearance``, at their corners ``at`` (m, D), is
    positive: cut along the line between its zeros on their edges."""
    d = own.shape[1]
    keep = [own[(at > 0.0).all(axis=1)]]
    for n in range(1, d):
        some = (at > 0.0).sum(axis=1) == n
        x, free, normals = own[some], at[some] > 0.0, normal[some]
        rows = np.arange(len(x))
        # Turned so that the corner that stands alone comes first: the order, and the normal, stay.
        lone = np.argmax(free, axis=1) if n == 1 else np.argmin(free, axis=1)
        x = np.stack([x[rows, (lone + k) % d] for k in range(d)], axis=1)
        roots = []
        for k in range(1, d):
            inside, outside = (x[:, k], x[:, 0]) if n == 1 else (x[:, 0], x[:, k])
            for _ in range(BISECTIONS):
                middle = 0.5 * (inside + outside)
                out = (clearance(middle, normals) > 0.0)[:, None]
                inside, outside = np.where(out, inside, middle), np.where(out, middle, outside)
            roots.append(outside)
        if n == 1:
            part = np.stack([x[:, 0], *roots], axis=1)
            if d == 2:
                # Turning a segment reversed it.
                part[lone == 1] = part[lone == 1][:, ::-1]
            keep.append(part)
        else:
            keep.append(np.stack([roots[0], x[:, 1], x[:, 2]], axis=1))
            keep.append(np.stack([roots[0], x[:, 2], roots[1]], axis=1))
    return np.concatenate(keep)


def _joined(own: FloatArray) -> FloatArray:
    """In 2D, neighbouring segments on one line as one; triangles as they are."""
    if own.shape[1] != 2 or len(own) < 2:
        return own
    length = np.linalg.norm(own[:, 1] - own[:, 0], axis=1)
    own = own[length > 1e-12 * length.max()]
    scale = float(np.abs(own).max()) or 1.0

    def key(point: FloatArray) -> tuple[float, ...]:
        return tuple(np.round(point / scale, 12).tolist())

    normal = facets.normals(own)
    start = {key(p): i for i, p in enumerate(own[:, 0])}
    following = [start.get(key(p)) for p in own[:, 1]]
    straight = [
        k if k is not None and normal[i] @ normal[k] > 1.0 - 1e-12 else None
        for i, k in enumerate(following)
    ]
    has_before = {k for k in straight if k is not None}
    joined: list[FloatArray] = []
    for first in range(len(own)):
        if first in has_before:
            continue
        last = first
        while (k := straight[last]) is not None:
            last = k
        joined.append(np.stack([own[first, 0], own[last, 1]]))
    return np.array(joined)
