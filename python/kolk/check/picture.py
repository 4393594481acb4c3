"""A picture of the set-up: every particle in 2D, views of the outline in 3D."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from kolk.scene import Body, Scene
from kolk.scene.shapes import Tank

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = npt.NDArray[np.float64]


def picture(scene: Scene, path: str | Path) -> Path:
    """Draw the set-up as PNG: every particle in 2D, three views of the outline in 3D.

    Returns the path. Raises SceneError for the scene, RunError where the file cannot be written.
    """
    from matplotlib.collections import PathCollection

    from kolk.output.atomic import storage_error
    from kolk.render.style import figure, look, save

    path = Path(path)
    bodies = scene.bodies()
    low = np.min([b.position.min(axis=0) for b in bodies], axis=0)
    high = np.max([b.position.max(axis=0) for b in bodies], axis=0)
    size = high - low + scene.spacing
    views = [(0, 1)] if scene.dimension == 2 else [(0, 2), (0, 1)]
    width = 9.0 * min(1.0, *(0.8 * float(size[a] / size[b]) for a, b in views))
    heights = [width * float(size[b] / size[a]) for a, b in views]
    with look():
        made = figure(max(width, 4.0), sum(heights) + 0.6 * len(views) + 0.8)
        made.set_layout_engine("constrained")
        grid = made.add_gridspec(len(views), 1, height_ratios=heights)
        for i, (a, b) in enumerate(views):
            _view(made.add_subplot(grid[i, 0]), scene, bodies, a, b, width)
        handles, labels = made.axes[0].get_legend_handles_labels()
        made.suptitle(scene.title or scene.name, x=0.01, ha="left", fontweight="bold")
        legend = made.legend(handles, labels, loc="outside lower left", ncols=4)
        for handle in legend.legend_handles:
            if isinstance(handle, PathCollection):
                handle.set_sizes([24.0])
        try:
            return save(made, path)
        except OSError as error:
            raise storage_error(path, error, "write the picture") from error


def _view(axes: Axes, scene: Scene, bodies: list[Body], a: int, b: int, width: float) -> None:
    """One view along the axis that is neither ``a`` nor ``b``."""
    from matplotlib.patheffects import withStroke

    from kolk.render.style import REFERENCE, RUN, WALL, bare

    wet = ["#2f7fc1", "#66b3a6", "#8a7fc7", "#c9a24b"]
    bare(axes)
    lows = np.min([x.position.min(axis=0) for x in bodies], axis=0) - scene.spacing
    highs = np.max([x.position.max(axis=0) for x in bodies], axis=0) + scene.spacing
    axes.set_xlim(lows[a], highs[a])
    axes.set_ylim(lows[b], highs[b])
    fluids = 0
    # Side of a square marker in points, so that neighbours just touch.
    pitch = 72.0 * width * scene.spacing / float(highs[a] - lows[a])
    for body in bodies:
        shown = body.position if scene.dimension == 2 else _seen(scene, body, a, b)
        if not len(shown):
            continue
        colour = WALL if body.kind == "wall" else wet[fluids % len(wet)]
        fluids += body.kind == "fluid"
        axes.scatter(
            shown[:, a],
            shown[:, b],
            s=max((0.92 * pitch) ** 2, 0.1),
            c=colour,
            marker="s",
            linewidths=0,
            label=f"{body.name} ({len(body):,})",
            rasterized=True,
        )
    for probe in scene.probe:
        at = getattr(probe.what, "at", None)
        if at is not None:
            axes.plot(at[a], at[b], marker="o", ms=4, mfc="white", mec=REFERENCE, ls="none")
            axes.annotate(
                probe.name,
                (at[a], at[b]),
                xytext=(4, 3),
                textcoords="offset points",
                fontsize=7,
                color=REFERENCE,
                path_effects=[withStroke(linewidth=2.0, foreground="white")],
            )
    for axis, spot in ((a, axes.axvline), (b, axes.axhline)):
        interval = scene.periodic_axes[axis]
        for edge in interval or ():
            spot(edge, color=RUN, lw=0.8, ls="--")
    axes.set_xlabel(f"{'xyz'[a]} [m]")
    axes.set_ylabel(f"{'xyz'[b]} [m]")


def _seen(scene: Scene, body: Body, a: int, b: int) -> FloatArray:
    """What a view along the third axis shows of a body in 3D: of a tank a cut through its middle,
    of anything else its shadow."""
    wall = next((w for w in scene.wall if w.name == body.name), None)
    if wall is not None and wall.shape is not None and isinstance(wall.shape.shape, Tank):
        depth = body.position[:, 3 - a - b]
        middle = 0.5 * (depth.min() + depth.max())
        return np.asarray(body.position[np.abs(depth - middle) < 0.75 * scene.spacing])
    cells = np.round(body.position[:, [a, b]] / (0.05 * scene.spacing)).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return np.asarray(body.position[first])
