"""A parallel view of a three-dimensional scene, shared by every way of drawing it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

EDGES = (
    (0, 1),
    (0, 2),
    (0, 4),
    (1, 3),
    (1, 5),
    (2, 3),
    (2, 6),
    (3, 7),
    (4, 5),
    (4, 6),
    (5, 7),
    (6, 7),
)
"""Edges of :func:`corners`, by index."""


def corners(low: FloatArray, high: FloatArray) -> FloatArray:
    """The eight corners (8, 3) of a box; bit k of the index says whether axis k is at ``high``."""
    pick = (np.arange(8)[:, None] >> np.arange(3)) & 1
    return np.asarray(np.where(pick == 1, high, low))


@dataclass(frozen=True)
class Camera:
    """Directions of the picture plane and the rectangle shown on it (m)."""

    right: FloatArray
    up: FloatArray
    toward: FloatArray
    """Unit vector from the scene to the eye."""
    left_edge: float
    right_edge: float
    bottom_edge: float
    top_edge: float

    @property
    def aspect(self) -> float:
        """Width over height."""
        return (self.right_edge - self.left_edge) / (self.top_edge - self.bottom_edge)

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Points (n, 3) to the picture plane (n, 2), and their nearness to the eye (n,), m."""
        return np.stack([points @ self.right, points @ self.up], -1), points @ self.toward


def look_at(
    low: Sequence[float] | FloatArray,
    high: Sequence[float] | FloatArray,
    vertical: int = 2,
    azimuth: float = 28.0,
    elevation: float = 24.0,
) -> Camera:
    """A view of the box from ``low`` to ``high`` (3,), m, from the front right and above.

    The longer horizontal axis runs to the right of the picture, turned by ``azimuth`` degrees;
    ``vertical`` is the axis that points up.
    """
    low, high = np.asarray(low, np.float64), np.asarray(high, np.float64)
    level = [axis for axis in range(3) if axis != vertical]
    along = max(level, key=lambda axis: high[axis] - low[axis])
    above = np.eye(3)[vertical]
    ahead = np.eye(3)[along]
    side = np.cross(above, ahead)
    turn, tilt = np.deg2rad(azimuth), np.deg2rad(elevation)
    right = np.cos(turn) * ahead + np.sin(turn) * side
    back = -np.cos(turn) * side + np.sin(turn) * ahead
    toward = np.cos(tilt) * back + np.sin(tilt) * above
    up = np.cross(toward, right)
    box = corners(low, high)
    x, y = box @ right, box @ up
    margin = 0.02 * float(np.ptp(x))
    return Camera(
        right=right,
        up=up,
        toward=toward,
        left_edge=float(x.min()) - margin,
        right_edge=float(x.max()) + margin,
        bottom_edge=float(y.min()) - margin,
        top_edge=float(y.max()) + margin,
    )
