"""The reconstructed free surface, drawn in a process of its own.

A GL stack that is missing or broken can end the process that touches it, so the drawing happens in
a child with a time limit: whatever befalls it, the run and its other pictures go on.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .camera import Camera
from .raster import Image

FloatArray = npt.NDArray[np.float64]

START_LIMIT = 30.0
"""Seconds that the child may take to begin; a broken driver hangs for ever."""

PICTURE_LIMIT = 10.0
"""Seconds that each picture may take besides its particles."""

SLOWEST = 4000.0
"""Particles a second below which a picture is given up: a tenth of what one core does."""


def time_limit(counts: Sequence[int]) -> float:
    """Seconds allowed for pictures of so many particles each."""
    return START_LIMIT + sum(PICTURE_LIMIT + count / SLOWEST for count in counts)


@dataclass(frozen=True)
class Cloud:
    """The fluid of one frame: positions (n, 3) in m and a colour (n, 3) in 0..1 each."""

    position: FloatArray
    rgb: npt.NDArray[np.float32]


def available() -> bool:
    """True where the libraries are installed; whether the GL stack works shows only in use."""
    return all(find_spec(name) is not None for name in ("pyvista", "pysplashsurf"))


def surfaces(
    clouds: Sequence[Cloud],
    camera: Camera,
    width: int,
    spacing: float,
    solids: Sequence[FloatArray] = (),
    edges: FloatArray | None = None,
) -> list[Image] | None:
    """Pictures (height, ``width``, 4), premultiplied, one per cloud; None where it cannot be done.

    spacing: particle spacing, m. solids: boxes (2, 3), low and high corner, drawn in grey.
    edges: line segments (k, 2, 3) of the tank.
    """
    if not available():
        return None
    with tempfile.TemporaryDirectory(prefix="kolk-surface-") as name:
        folder = Path(name)
        np.savez(
            folder / "scene.npz",
            right=camera.right,
            up=camera.up,
            toward=camera.toward,
            window=[camera.left_edge, camera.right_edge, camera.bottom_edge, camera.top_edge],
            width=width,
            spacing=spacing,
            solids=np.reshape(np.asarray(solids, np.float64), (-1, 2, 3)),
            edges=np.zeros((0, 2, 3)) if edges is None else edges,
            count=len(clouds),
        )
        for i, cloud in enumerate(clouds):
            np.savez(folder / f"cloud{i}.npz", position=cloud.position, rgb=cloud.rgb)
        try:
            done = subprocess.run(
                [sys.executable, "-m", "kolk.render.surface_worker", str(folder)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=time_limit([len(cloud.position) for cloud in clouds]),
                check=False,
            )
        except (subprocess.TimeoutExpired, OSError):
            return None
        if done.returncode != 0:
            return None
        made = [folder / f"picture{i}.npy" for i in range(len(clouds))]
        if not all(path.is_file() for path in made):
            return None
        return [_premultiplied(np.load(path)) for path in made]


def _premultiplied(rgba: npt.NDArray[np.uint8]) -> Image:
    picture = rgba.astype(np.float32) / np.float32(255.0)
    picture[..., :3] *= picture[..., 3:]
    return picture
