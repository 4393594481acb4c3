"""Pictures of three-dimensional frames: the free surface where it can be drawn, else particles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure

from kolk.compare.fields import FrameLike

from . import style
from .camera import EDGES, Camera, corners, look_at
from .film import Picture, Stage, Tick, write_film
from .flow import colour_bar
from .quantity import Quantity, Scales, colour_range, quantity, spread, time_label
from .raster import Image
from .splat import spheres
from .surface import Cloud, surfaces

FloatArray = npt.NDArray[np.float64]

MOST_FRAMES = 60
"""Frames of a film: surfaces of large runs take seconds each."""


@dataclass(frozen=True)
class Room:
    """What stands still in the picture."""

    camera: Camera
    low: FloatArray
    """Lower corner of the tank's inside, m."""
    high: FloatArray
    solids: list[FloatArray]
    """Boxes (2, 3) that enclose the bodies standing in the tank."""
    walls: FloatArray
    """Particles (n, 3) of those bodies, for the pictures of particles."""

    @property
    def edges(self) -> FloatArray:
        """Edges of the tank, (12, 2, 3)."""
        box = corners(self.low, self.high)
        return np.array([[box[a], box[b]] for a, b in EDGES])


def room(frames: Sequence[FrameLike], spacing: float, vertical: int = 2) -> Room:
    """Tank, obstacles and camera from the walls of the first frame and the fluid of some.

    A wall body that encloses the fluid's start is the tank and is shown by its edges; every other
    one is an obstacle. Without a tank the edges enclose the fluid.
    """
    first = frames[0]
    water = [f.position[f.rows("fluid")] for f in frames]
    low = np.min([w.min(axis=0) for w in water], axis=0).astype(float)
    high = np.max([w.max(axis=0) for w in water], axis=0).astype(float)
    solids: list[FloatArray] = []
    standing = [np.zeros((0, 3))]
    start_low, start_high = water[0].min(axis=0), water[0].max(axis=0)
    tank: FloatArray | None = None
    for cloud in _wall_bodies(first):
        bottom, top = cloud.min(axis=0), cloud.max(axis=0)
        level = [axis for axis in range(3) if axis != vertical]
        if all(bottom[a] <= start_low[a] and top[a] >= start_high[a] for a in level):
            tank = cloud
        else:
            standing.append(cloud)
            solids.append(np.stack([bottom - 0.5 * spacing, top + 0.5 * spacing]))
    if tank is not None:
        low, high = inside(tank, spacing)
    return Room(look_at(low, high, vertical), low, high, solids, np.concatenate(standing))


def _wall_bodies(frame: FrameLike) -> list[FloatArray]:
    """Positions of each wall body; all walls as one where the frame does not tell them apart."""
    bodies = getattr(frame, "bodies", None)
    if bodies is None:
        walls = np.asarray(frame.position[frame.rows("wall")], np.float64)
        return [walls] if len(walls) else []
    return [
        np.asarray(b.position, np.float64) for b in bodies.values() if b.kind == "wall" and len(b)
    ]


def inside(tank: FloatArray, spacing: float) -> tuple[FloatArray, FloatArray]:
    """Lower and upper corner (3,) of the space that a tank's wall particles (n, 3) enclose, m.

    Along each axis the walls are read on the line through the tank's middle; an open side ends
    where the other walls end.
    """
    outer_low, outer_high = tank.min(axis=0), tank.max(axis=0)
    middle = 0.5 * (outer_low + outer_high)
    low, high = outer_low - 0.5 * spacing, outer_high + 0.5 * spacing
    for axis in range(3):
        others = [a for a in range(3) if a != axis]
        near = np.all(np.abs(tank[:, others] - middle[others]) < 1.01 * spacing, axis=1)
        along = tank[near, axis]
        below, above = along[along < middle[axis]], along[along > middle[axis]]
        if len(below):
            low[axis] = below.max() + 0.5 * spacing
        if len(above):
            high[axis] = above.min() - 0.5 * spacing
    return low, high


def images(
    frames: Sequence[FrameLike],
    scene: Room,
    shown: Quantity,
    scale: Normalize,
    width: int,
    spacing: float,
    *,
    surface: bool = True,
) -> list[Image]:
    """Pictures (height, ``width``, 4), premultiplied, one per frame."""
    clouds = []
    for frame in frames:
        x, value = shown.of(frame)
        rgb = np.asarray(style.colours(shown.name)(scale(value))[:, :3], np.float32)
        clouds.append(Cloud(x, rgb))
    if surface:
        made = surfaces(clouds, scene.camera, width, spacing, scene.solids, scene.edges)
        if made is not None:
            return made
    grey = np.broadcast_to(np.array(to_rgb(style.WALL), np.float32), (len(scene.walls), 3))
    return [
        spheres(
            scene.camera,
            width,
            np.concatenate([cloud.position, scene.walls]),
            np.concatenate([cloud.rgb, grey]),
            0.6 * spacing,
        )
        for cloud in clouds
    ]


def space_sheet(
    frames: Sequence[FrameLike],
    path: Path,
    *,
    spacing: float,
    title: str = "",
    scales: Scales | None = None,
    field: str = "speed",
    vertical: int = 2,
    count: int = 4,
    surface: bool = True,
) -> Path:
    """The flow at ``count`` times, two in a row. ``surface`` False draws particles at once."""
    chosen = [frames[i] for i in spread(frames, count)]
    scene = room([frames[0], *chosen], spacing, vertical)
    shown = quantity(field, scales, chosen)
    scale = colour_range(shown, chosen)
    columns = 2 if len(chosen) > 1 else 1
    rows = -(-len(chosen) // columns)
    inner = 5.2
    tall = inner / scene.camera.aspect
    left, top, bottom, gap = 0.25, 0.85, 0.2, 0.35
    width = 2 * left + columns * inner + (columns - 1) * gap
    height = top + rows * tall + (rows - 1) * gap + bottom
    pixels = round(inner * style.DPI)
    drawn = images(chosen, scene, shown, scale, pixels, spacing, surface=surface)
    with style.look():
        made = style.figure(width, height)
        made.text(left / width, 1 - 0.3 / height, title, weight="bold", fontsize=12, va="center")
        for k, frame in enumerate(chosen):
            row, column = divmod(k, columns)
            x = left + column * (inner + gap)
            y = bottom + (rows - 1 - row) * (tall + gap)
            axes = made.add_axes((x / width, y / height, inner / width, tall / height))
            _dress(axes, scene)
            _show(axes, drawn[k], scene.camera)
            axes.set_title(time_label(frame.time, scales), fontsize=9)
        bar = made.add_axes(
            ((width - left - 2.6) / width, 1 - 0.3 / height, 2.4 / width, 0.1 / height)
        )
        colour_bar(made, bar, shown, scale)
        return style.save(made, path)


def space_film(
    frames: Sequence[FrameLike],
    path: Path,
    *,
    spacing: float,
    title: str = "",
    scales: Scales | None = None,
    field: str = "speed",
    vertical: int = 2,
    tick: Tick = lambda: None,
) -> Path:
    """Film of shaded particles, at most MOST_FRAMES spread over the run."""
    chosen = [frames[i] for i in spread(frames, MOST_FRAMES)]
    sample = [frames[i] for i in spread(frames, 4)]
    scene = room([frames[0], *sample], spacing, vertical)
    shown = quantity(field, scales, sample)
    scale = colour_range(shown, sample)
    with style.look():
        made, axes = _film_figure(scene, shown, scale, title)
    pictures = _film_pictures(chosen, scene, shown, scale, spacing, scales, made, axes)
    return write_film(path, pictures, len(chosen), tick)


def film_frames(count: int) -> int:
    """How many frames :func:`space_film` shows of ``count``."""
    return min(count, MOST_FRAMES)


def _film_figure(scene: Room, shown: Quantity, scale: Normalize, title: str) -> tuple[Figure, Axes]:
    inner = 7.2
    tall = inner / scene.camera.aspect
    width, height = (2 * round(size * style.DPI / 2) / style.DPI for size in (7.6, tall + 1.1))
    made = style.figure(width, height)
    axes = made.add_axes((0.2 / width, 0.6 / height, inner / width, tall / height))
    _dress(axes, scene)
    axes.set_title(title)
    bar = made.add_axes((0.2 / width, 0.42 / height, 2.6 / width, 0.1 / height))
    colour_bar(made, bar, shown, scale)
    return made, axes


def _film_pictures(
    frames: Sequence[FrameLike],
    scene: Room,
    shown: Quantity,
    scale: Normalize,
    spacing: float,
    scales: Scales | None,
    made: Figure,
    axes: Axes,
) -> Iterator[Picture]:
    with style.look():
        stage = Stage(made, axes)
        for frame in frames:
            image = images([frame], scene, shown, scale, stage.width, spacing, surface=False)[0]
            yield stage.picture(image, time_label(frame.time, scales))


def _dress(axes: Axes, scene: Room) -> None:
    """No axes, the tank's edges behind the water, and the tank's sizes in metres."""
    camera = scene.camera
    axes.set_axis_off()
    axes.set_xlim(camera.left_edge, camera.right_edge)
    axes.set_ylim(camera.bottom_edge, camera.top_edge)
    ends, _ = camera.project(scene.edges.reshape(-1, 3))
    axes.add_collection(
        LineCollection(list(ends.reshape(-1, 2, 2)), colors=style.QUIET, linewidths=0.6, zorder=1)
    )
    box = corners(scene.low, scene.high)
    plane, _ = camera.project(box)
    size = scene.high - scene.low
    # level sizes stand at the edges that meet in the lowest corner of the picture, the height
    # at its leftmost upright edge
    lowest, leftmost = int(np.argmin(plane[:, 1])), int(np.argmin(plane[:, 0]))
    upright = int(np.argmax(np.abs(camera.up)))
    for axis in range(3):
        start = leftmost if axis == upright else lowest
        middle = 0.5 * (plane[start] + plane[start ^ (1 << axis)])
        outward = np.array([-1.0, 0.0]) if axis == upright else middle - plane.mean(axis=0)
        outward = outward / np.linalg.norm(outward)
        axes.annotate(
            f"{size[axis]:.3g} m",
            middle,
            textcoords="offset points",
            xytext=tuple(11 * outward),
            ha="center",
            va="center",
            rotation=90.0 if axis == upright else 0.0,
            fontsize=7.5,
            color=style.QUIET,
        )


def _show(axes: Axes, image: Image, camera: Camera) -> None:
    picture = image.copy()
    shown = picture[..., 3] > 0
    picture[shown, :3] /= picture[shown, 3:]
    axes.imshow(
        np.clip(picture, 0.0, 1.0),
        extent=(camera.left_edge, camera.right_edge, camera.bottom_edge, camera.top_edge),
        interpolation="nearest",
        aspect="auto",
        zorder=2,
    )
