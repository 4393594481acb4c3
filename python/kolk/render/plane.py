"""A two-dimensional frame as an image: coloured fluid between grey walls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.colors import Normalize, to_rgb

from kolk.compare.fields import FrameLike

from . import style
from .quantity import Quantity
from .raster import Image, View, over, paint

FloatArray = npt.NDArray[np.float64]

FLUID_RADIUS = 0.85
"""Disc radius in spacings: closes the gaps of a disordered fluid, shows single drops as drops."""

WALL_RADIUS = 0.75


@dataclass(frozen=True)
class Extent:
    """The rectangle that pictures of a run show, m."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def aspect(self) -> float:
        """Width over height."""
        return (self.right - self.left) / (self.top - self.bottom)

    def view(self, width: int) -> View:
        """The same on ``width`` pixels."""
        height = max(round(width / self.aspect), 2)
        return View(self.left, self.right, self.bottom, self.top, width, height)


def extent(frames: Sequence[FrameLike], spacing: float) -> Extent:
    """What to show: the walls, wherever they move, and the fluid as far as it stays near.

    Without walls the fluid of the frames given. With walls, fluid that has left them by more than
    a quarter of their size is cut off: a drop that flies away must not shrink the picture.
    """
    low, high = _box([f.position[f.rows("fluid")] for f in frames])
    walls = [f.position[f.rows("wall")] for f in frames]
    if any(len(w) for w in walls):
        wall_low, wall_high = _box(walls)
        slack = 0.25 * (wall_high - wall_low)
        low = np.minimum(np.maximum(low, wall_low - slack), wall_low)
        high = np.maximum(np.minimum(high, wall_high + slack), wall_high)
    margin = 1.5 * spacing
    return Extent(low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin)


def _box(clouds: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    whole = [c for c in clouds if len(c)]
    if not whole:
        return np.zeros(2), np.ones(2)
    return np.min([c.min(axis=0) for c in whole], 0), np.max([c.max(axis=0) for c in whole], 0)


class Painter:
    """Paints frames of one run on one view; walls that do not move are painted once."""

    def __init__(self, view: View, spacing: float) -> None:
        self.view = view
        self.spacing = spacing
        self._wall_position: FloatArray | None = None
        self._ground: Image = np.ones((view.height, view.width, 3), np.float32)

    def __call__(self, frame: FrameLike, shown: Quantity, scale: Normalize) -> Image:
        """Image (height, width, 3), float32 in 0..1."""
        x, value = shown.of(frame)
        rgb = np.asarray(style.colours(shown.name)(scale(value))[:, :3], np.float32)
        picture = paint(self.view, x[:, :2], rgb, FLUID_RADIUS * self.spacing)
        return over(picture, self._walls(frame))

    def _walls(self, frame: FrameLike) -> Image:
        walls = frame.position[frame.rows("wall")][:, :2]
        if self._wall_position is None or not np.array_equal(walls, self._wall_position):
            grey = np.broadcast_to(np.array(to_rgb(style.WALL), np.float32), (len(walls), 3))
            white = np.ones((self.view.height, self.view.width, 3), np.float32)
            self._ground = over(paint(self.view, walls, grey, WALL_RADIUS * self.spacing), white)
            self._wall_position = walls
        return self._ground
