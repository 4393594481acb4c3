"""Surfaces of simple solids as facets: segments in 2D, triangles in 3D.

An array (m, D, D) of m facets with D corners each, in metres. Corners are ordered so that the
normal points out of the solid: to the right of a segment from its first corner to its second, and
by the right-hand rule around a triangle. Planes are exact; curved surfaces are inscribed polyhedra
whose edges lie ``SAG`` spacings off at most.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

SAG = 0.01
"""Largest distance in spacings of a facet from the curve that it stands for."""


def box(low: FloatArray, high: FloatArray, faces: set[tuple[int, int]] | None = None) -> FloatArray:
    """The ``faces`` (axis, 0 low | 1 high; all if None) of a box, normals outwards."""
    d = len(low)
    found: list[FloatArray] = []
    for axis in range(d):
        for end in (0, 1):
            if faces is not None and (axis, end) not in faces:
                continue
            others = [a for a in range(d) if a != axis]
            spans = [np.array([low[a], high[a]]) for a in others]
            corners = np.stack(np.meshgrid(*spans, indexing="ij"), axis=-1).reshape(-1, d - 1)
            face = np.insert(corners, axis, (low, high)[end][axis], axis=1)
            outward = np.zeros(d)
            outward[axis] = 2.0 * end - 1.0
            parts = face[None, :, :] if d == 2 else face[[[0, 1, 2], [2, 1, 3]]]
            found.append(turned(parts, outward))
    return np.concatenate(found) if found else np.zeros((0, d, d))


def turned(facets: FloatArray, outward: FloatArray) -> FloatArray:
    """The facets with their normals on the side of ``outward`` (D,) or (m, D)."""
    wrong = np.sum(normals(facets) * outward, axis=1) < 0.0
    result = facets.copy()
    result[wrong] = facets[wrong][:, [1, 0, *range(2, facets.shape[1])]]
    return result


def normals(facets: FloatArray) -> FloatArray:
    """Unit normals (m, D), by the order of the corners; zero for a facet without extent."""
    edge = facets[:, 1] - facets[:, 0]
    if facets.shape[1] == 2:
        normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1)
    else:
        normal = np.cross(edge, facets[:, 2] - facets[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(normal / np.where(length > 0.0, length, 1.0))


def polygon(corners: FloatArray) -> FloatArray:
    """The edges of the polygon through ``corners`` (k, 2), normals outwards."""
    x, y = corners.T
    if np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) < 0.0:
        corners = corners[::-1]
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


def prism(corners: FloatArray, low: float, high: float) -> FloatArray:
    """A polygon (k, 2) from z = ``low`` to ``high``, normals outwards."""
    import shapely

    edges = polygon(corners)
    a, b = edges[:, 0], edges[:, 1]

    def at(points: FloatArray, z: float) -> FloatArray:
        return np.concatenate([points, np.full((*points.shape[:-1], 1), z)], axis=-1)

    sides = np.concatenate(
        [
            np.stack([at(a, low), at(b, low), at(b, high)], axis=1),
            np.stack([at(a, low), at(b, high), at(a, high)], axis=1),
        ]
    )
    outline = shapely.Polygon(corners)
    pieces = [
        np.array(t.exterior.coords)[:3]
        for t in shapely.constrained_delaunay_triangles(outline).geoms
    ]
    flat = np.array(pieces)
    up = np.array([0.0, 0.0, 1.0])
    return np.concatenate([sides, turned(at(flat, high), up), turned(at(flat, low), -up)])


def _pieces(radius: float, spacing: float, turn: float = 2.0 * math.pi) -> int:
    """How many chords keep within ``SAG`` of an arc."""
    sag = min(SAG * spacing / radius, 0.2)
    return max(8, math.ceil(turn / (2.0 * math.acos(1.0 - sag)) - 1e-9))


def disc(centre: FloatArray, radius: float, spacing: float) -> FloatArray:
    """A circle in 2D, normals outwards."""
    angle = 2.0 * math.pi * np.arange(_pieces(radius, spacing)) / _pieces(radius, spacing)
    return polygon(centre + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def sphere(centre: FloatArray, radius: float, spacing: float) -> FloatArray:
    """A sphere from the faces of a cube, normals outwards."""
    n = max(2, _pieces(radius, spacing, 0.5 * math.pi) // 2)
    # Nodes at equal angles along the edges of the cube: triangles of nearly equal size.
    node = np.tan(0.25 * math.pi * np.linspace(-1.0, 1.0, n + 1))
    u, v = np.meshgrid(node, node, indexing="ij")
    found: list[FloatArray] = []
    for axis in range(3):
        for end in (-1.0, 1.0):
            face = np.insert(np.stack([u, v], axis=-1), axis, end, axis=-1)
            face = radius * face / np.linalg.norm(face, axis=-1, keepdims=True)
            a, b, c, d = face[:-1, :-1], face[1:, :-1], face[1:, 1:], face[:-1, 1:]
            for three in ((a, b, c), (a, c, d)):
                part = np.stack([p.reshape(-1, 3) for p in three], axis=1)
                found.append(turned(part, part.mean(axis=1)) + centre)
    return np.concatenate(found)


def cylinder(start: FloatArray, end: FloatArray, radius: float, spacing: float) -> FloatArray:
    """A flat-ended cylinder, normals outwards."""
    axis = end - start
    along = axis / np.linalg.norm(axis)
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    n = _pieces(radius, spacing)
    angle = 2.0 * math.pi * np.arange(n)[:, None] / n
    ring = radius * (np.cos(angle) * first + np.sin(angle) * second)
    a, b = ring, np.roll(ring, -1, axis=0)
    sides = np.concatenate(
        [
            np.stack([start + a, start + b, end + b], axis=1),
            np.stack([start + a, end + b, end + a], axis=1),
        ]
    )
    radial = np.concatenate([a + b, a + b])
    caps = [
        turned(np.stack([np.broadcast_to(o, a.shape), o + a, o + b], axis=1), s * along)
        for o, s in ((start, -1.0), (end, 1.0))
    ]
    return np.concatenate([turned(sides, radial), *caps])


def level_set(
    value: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray, step: float
) -> FloatArray:
    """The surface of the solid where ``value`` is negative, within a box.

    Cells of ``step`` are cut into simplices, and each simplex by the zero of the linear function
    through its corners (Doi & Koide 1991): exact for planes, off by step² for the rest.
    """
    d = len(low)
    counts = np.ceil((high - low) / step - 1e-6).astype(int) + 3
    nodes = np.stack(
        np.meshgrid(
            *(a + step * (np.arange(n) - 1.0) for a, n in zip(low, counts, strict=True)),
            indexing="ij",
        ),
        axis=-1,
    )
    at = value(nodes.reshape(-1, d)).reshape(nodes.shape[:-1])
    # A node on the surface itself would make facets without extent.
    at = np.where(np.abs(at) < 1e-9 * step, 1e-9 * step, at)
    found: list[FloatArray] = []
    for simplex in _simplices(d):

        def corner(offset: tuple[int, ...], of: FloatArray) -> FloatArray:
            window = tuple(slice(o, n - 1 + o) for o, n in zip(offset, counts, strict=True))
            return np.asarray(of[window].reshape(-1, *of.shape[d:]))

        x = np.stack([corner(o, nodes) for o in simplex], axis=1)
        f = np.stack([corner(o, at) for o in simplex], axis=1)
        crossed = (f < 0.0).any(axis=1) & (f > 0.0).any(axis=1)
        found += _cut(x[crossed], f[crossed])
    facets = np.concatenate(found) if found else np.zeros((0, d, d))
    return np.asarray(facets[np.linalg.norm(normals(facets), axis=1) > 0.5])


def _simplices(d: int) -> list[list[tuple[int, ...]]]:
    """The corners of the d! simplices of a cell (Kuhn's triangulation)."""
    from itertools import permutations

    found = []
    for order in permutations(range(d)):
        at = [0] * d
        corners = [tuple(at)]
        for axis in order:
            at[axis] = 1
            corners.append(tuple(at))
        found.append(corners)
    return found


def _cut(x: FloatArray, f: FloatArray) -> list[FloatArray]:
    """Facets (m, D, D) where the linear function of values f (m, D + 1) at the corners of simplices
    x (m, D + 1, D) vanishes."""
    order = np.argsort(f, axis=1)
    x = np.take_along_axis(x, order[:, :, None], axis=1)
    f = np.take_along_axis(f, order, axis=1)
    d = x.shape[2]
    inside = (f < 0.0).sum(axis=1)
    found: list[FloatArray] = []
    for n in range(1, d + 1):
        some = inside == n
        xs, fs = x[some], f[some]

        def root(i: int, j: int, xs: FloatArray = xs, fs: FloatArray = fs) -> FloatArray:
            t = (fs[:, i] / (fs[:, i] - fs[:, j]))[:, None]
            return np.asarray(xs[:, i] + t * (xs[:, j] - xs[:, i]))

        edges = [(i, j) for i in range(n) for j in range(n, d + 1)]
        # The crossing is a simplex, or in 3D between two and two corners a quadrilateral.
        fans = (
            [edges[:d]]
            if len(edges) == d
            else [[edges[0], edges[1], edges[3]], [edges[0], edges[3], edges[2]]]
        )
        outward = xs[:, n:].mean(axis=1) - xs[:, :n].mean(axis=1)
        for fan in fans:
            found.append(turned(np.stack([root(i, j) for i, j in fan], axis=1), outward))
    return found
