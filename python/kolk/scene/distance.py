"""Signed distances of simple solids: negative inside, zero on the face, in metres.

Exact for a box, a ball and a polygon; for the cylinder too. Sources: the closed forms follow from
the nearest point of each face; for a polygon the sign is the even-odd rule.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def box(points: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Distance (m,) of ``points`` (m, D) from an axis-parallel box; faces may lie at infinity."""
    beyond = np.maximum(low - points, points - high)
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return np.asarray(outside + np.minimum(beyond.max(axis=1), 0.0))


def ball(points: FloatArray, centre: FloatArray, radius: float) -> FloatArray:
    """Distance (m,) of ``points`` (m, D) from a disc (D = 2) or a sphere (D = 3)."""
    return np.asarray(np.linalg.norm(points - centre, axis=1) - radius)


def cylinder(points: FloatArray, start: FloatArray, end: FloatArray, radius: float) -> FloatArray:
    """Distance (m,) of ``points`` (m, 3) from a flat-ended cylinder between two axis points."""
    axis = end - start
    length = float(np.linalg.norm(axis))
    axis = axis / length
    offset = points - start
    along = offset @ axis
    radial = np.linalg.norm(offset - along[:, None] * axis, axis=1) - radius
    # In the half plane (along, radial) the cylinder is a box.
    beyond = np.stack([np.abs(along - 0.5 * length) - 0.5 * length, radial], axis=1)
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return np.asarray(outside + np.minimum(beyond.max(axis=1), 0.0))


def polygon(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Distance (m,) of ``points`` (m, 2) from the closed polygon through ``corners`` (k, 2)."""
    nearest = np.full(len(points), np.inf)
    inside = np.zeros(len(points), bool)
    x, y = points[:, 0], points[:, 1]
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, offset = b - a, points - a
        t = np.clip(offset @ edge / (edge @ edge), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(offset - t[:, None] * edge, axis=1))
        crosses = (a[1] > y) != (b[1] > y)
        if a[1] != b[1]:
            inside ^= crosses & (x < a[0] + (y - a[1]) * edge[0] / edge[1])
    return np.where(inside, -nearest, nearest)


def polygon_area(corners: FloatArray) -> float:
    """Signed area of the polygon through ``corners`` (k, 2), m^2: positive anticlockwise."""
    x, y = corners.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
