"""Particles to pixels without a drawing library: fast enough for films.

Each particle is a disc; where discs overlap the nearest centre wins, so that the inside of a fluid
is filled without gaps and no value is smoothed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Image = npt.NDArray[np.float32]

EMPTY = -1
"""Pixel that no particle covers."""


@dataclass(frozen=True)
class View:
    """A rectangle of the plane (m) and the pixels it is drawn on."""

    left: float
    right: float
    bottom: float
    top: float
    width: int
    height: int

    @property
    def scale(self) -> float:
        """Pixels per metre."""
        return self.width / (self.right - self.left)

    def pixels(self, position: FloatArray) -> FloatArray:
        """Positions (n, 2) in m to pixel coordinates (n, 2): column from the left, row from top."""
        scale_y = self.height / (self.top - self.bottom)
        return np.stack(
            [(position[:, 0] - self.left) * self.scale, (self.top - position[:, 1]) * scale_y], -1
        )


def disc_offsets(radius: float) -> npt.NDArray[np.int64]:
    """Pixel offsets (k, 2) of a disc of ``radius`` pixels, the farthest first."""
    reach = math.ceil(radius)
    dx, dy = np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1))
    distance = np.hypot(dx, dy).ravel()
    inside = np.flatnonzero(distance <= max(radius, 0.5))
    order = inside[np.argsort(-distance[inside], kind="stable")]
    return np.stack([dx.ravel()[order], dy.ravel()[order]], axis=-1)


def owners(pixel: FloatArray, radius: float, width: int, height: int) -> npt.NDArray[np.int32]:
    """Which particle each pixel shows: (height, width), EMPTY where none.

    pixel (n, 2): centres in pixels; radius in pixels. The offsets run from the rim inwards, so a
    nearer centre overwrites a farther one.
    """
    offsets = disc_offsets(radius)
    reach = int(np.abs(offsets).max())
    column = np.floor(pixel[:, 0]).astype(np.int64)
    row = np.floor(pixel[:, 1]).astype(np.int64)
    near = np.flatnonzero(
        (column >= -reach) & (column < width + reach) & (row >= -reach) & (row < height + reach)
    )
    # A disc whose centre is out of the picture by its reach extends as far again beyond that.
    pad = 2 * reach + 1
    stride = width + 2 * pad
    canvas = np.full((height + 2 * pad) * stride, EMPTY, np.int32)
    label = near.astype(np.int32)
    start = (row[near] + pad) * stride + column[near] + pad
    for dx, dy in offsets:
        canvas[start + dy * stride + dx] = label
    return canvas.reshape(height + 2 * pad, stride)[pad:-pad, pad:-pad]


def paint(
    view: View,
    position: FloatArray,
    rgb: npt.NDArray[np.float32],
    radius: float,
    oversample: int = 2,
) -> Image:
    """Picture (height, width, 4), float32 in 0..1, premultiplied by its alpha, of coloured discs.

    position (n, 2) m; rgb (n, 3) in 0..1; radius in m. Drawn ``oversample`` times finer and
    averaged, which smooths the rims.
    """
    fine = oversample
    shown = owners(
        view.pixels(position) * fine,
        radius * view.scale * fine,
        view.width * fine,
        view.height * fine,
    )
    # one 32-bit word per colour: a fourth of the look-ups; the last entry is the transparent
    # pixel that EMPTY picks
    table = np.zeros((len(rgb) + 1, 4), np.uint8)
    table[:-1, :3] = np.clip(rgb * 255.0 + 0.5, 0.0, 255.0)
    table[:-1, 3] = 255
    picture = table.view(np.uint32)[:, 0][shown].view(np.uint8)
    picture = picture.reshape(view.height * fine, view.width * fine, 4)
    total = np.zeros((view.height, view.width, 4), np.uint16)
    for i in range(fine):
        for j in range(fine):
            total += picture[i::fine, j::fine]
    return total.astype(np.float32) * np.float32(1.0 / (255.0 * fine * fine))


def over(picture: Image, ground: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """A painted picture laid on ``ground`` (height, width, 3)."""
    return np.asarray(picture[..., :3] + ground * (1.0 - picture[..., 3:]), np.float32)
