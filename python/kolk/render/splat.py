"""Three-dimensional particles as shaded spheres, without any graphics library.

The way out where no surface can be reconstructed or no GL stack works, and fast enough for films.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .camera import Camera
from .raster import Image, View, disc_offsets

FloatArray = npt.NDArray[np.float64]

LIGHT = np.array([-0.4, 0.65, 0.65])
"""Direction to the light: right, up, toward the eye."""


def spheres(
    camera: Camera,
    width: int,
    position: FloatArray,
    rgb: npt.NDArray[np.float32],
    radius: float,
    oversample: int = 2,
) -> Image:
    """Picture (height, ``width``, 4), premultiplied, of spheres at ``position`` (n, 3), m.

    rgb (n, 3) in 0..1; radius in m. Nearer spheres hide farther ones.
    """
    height = max(round(width / camera.aspect), 2)
    fine_width, fine_height = width * oversample, height * oversample
    view = View(
        camera.left_edge,
        camera.right_edge,
        camera.bottom_edge,
        camera.top_edge,
        fine_width,
        fine_height,
    )
    plane, nearness = camera.project(position)
    pixel = np.floor(view.pixels(plane)).astype(np.int64)
    inside = (
        (pixel[:, 0] >= 0)
        & (pixel[:, 0] < fine_width)
        & (pixel[:, 1] >= 0)
        & (pixel[:, 1] < fine_height)
    )
    # far to near: of particles on the same pixel the assignment keeps the last
    order = np.flatnonzero(inside)[np.argsort(nearness[inside], kind="stable")]
    size = max(radius * view.scale, 1.0)
    offsets = disc_offsets(size)
    pad = int(np.abs(offsets).max()) + 1
    stride = fine_width + 2 * pad
    start = (pixel[order, 1] + pad) * stride + pixel[order, 0] + pad
    depth = np.full((fine_height + 2 * pad) * stride, -np.inf, np.float32)
    owner = np.full(depth.shape, -1, np.int32)
    shade = np.zeros(depth.shape, np.float32)
    light = LIGHT / np.linalg.norm(LIGHT)
    near = nearness[order].astype(np.float32)
    for dx, dy in offsets:
        across, upward = dx / size, -dy / size
        out = np.sqrt(max(1.0 - across**2 - upward**2, 0.0))
        lit = max(float(np.dot(light, (across, upward, out))), 0.0)
        target = start + dy * stride + dx
        surface = near + np.float32(out * radius)
        wins = np.flatnonzero(surface > depth[target])
        hit = target[wins]
        depth[hit] = surface[wins]
        owner[hit] = order[wins]
        shade[hit] = 0.5 + 0.5 * lit
    table = np.zeros((len(rgb) + 1, 4), np.float32)
    table[:-1, :3], table[:-1, 3] = rgb, 1.0
    picture = table[owner]
    picture[:, :3] *= shade[:, None]
    grid = picture.reshape(fine_height + 2 * pad, stride, 4)[pad:-pad, pad:-pad]
    blocks = grid.reshape(height, oversample, width, oversample, 4)
    return np.asarray(blocks.mean(axis=(1, 3)), np.float32)
