"""Pictures of two-dimensional frames: one field, and the sheet of the flow at four times."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from kolk.compare.fields import FrameLike

from . import style
from .plane import Extent, Painter, extent
from .quantity import Quantity, Scales, colour_range, quantity, spread, time_label

LETTERS = 11.5
"""Of a title, per inch."""

LEFT, RIGHT, BOTTOM, TOP, GAP = 0.65, 0.2, 0.5, 1.2, 0.36
"""Margins of a sheet and the gap between its panels, inches."""


def frame_picture(
    frame: FrameLike,
    path: Path,
    field: str | Quantity = "speed",
    *,
    spacing: float,
    title: str = "",
    scales: Scales | None = None,
    shown_range: Normalize | None = None,
    area: Extent | None = None,
    width: float = 8.0,
) -> Path:
    """One field of one frame as a PNG. ``spacing`` in m, ``width`` in inches."""
    shown = field if isinstance(field, Quantity) else quantity(field, scales, [frame])
    area = area or extent([frame], spacing)
    with style.look():
        scale = shown_range or colour_range(shown, [frame])
        made, axes = panel(area, shown, scale, title, width)
        view = area.view(round(axes.get_position().width * made.bbox.width))
        _show(axes, Painter(view, spacing)(frame, shown, scale), area)
        axes.set_title(time_label(frame.time, scales), loc="right", weight="normal", fontsize=9)
        return style.save(made, path)


def panel(
    area: Extent, shown: Quantity, shown_range: Normalize, title: str, width: float
) -> tuple[Figure, Axes]:
    """A figure (``width`` inches) with one picture's axes and a colour bar below it."""
    inner = width - LEFT - RIGHT
    tall = inner / area.aspect
    if tall > 7.0:
        inner, tall = 7.0 * area.aspect, 7.0
        width = max(inner + LEFT + RIGHT, 4.0)
    # even pixel counts, as films want them
    # The time stands to the right below the title, which has lines of its own.
    lines = textwrap.wrap(title, int(LETTERS * width))
    height = tall + 1.45 + 0.18 * len(lines)
    width, height = (2 * round(size * style.DPI / 2) / style.DPI for size in (width, height))
    made = style.figure(width, height)
    axes = made.add_axes((LEFT / width, 1.0 / height, inner / width, tall / height))
    _dress(axes, area)
    axes.annotate(
        "\n".join(lines),
        (0.0, 1.0),
        (0.0, 18.0),
        xycoords="axes fraction",
        textcoords="offset points",
        va="bottom",
        fontsize=10.0,
        weight="bold",
    )
    bar = made.add_axes((LEFT / width, 0.42 / height, min(3.2, inner) / width, 0.1 / height))
    colour_bar(made, bar, shown, shown_range)
    return made, axes


def flow_sheet(
    frames: Sequence[FrameLike],
    path: Path,
    *,
    spacing: float,
    title: str = "",
    scales: Scales | None = None,
    fields: Sequence[str] = ("pressure", "speed"),
    count: int = 4,
) -> Path:
    """The flow at ``count`` times: a row per time and a column per field, or the other way round.

    Wide scenes get their times one below the other, tall ones side by side.
    """
    chosen = [frames[i] for i in spread(frames, count)]
    area = extent(chosen, spacing)
    shown = [quantity(name, scales, chosen) for name in fields]
    ranges = [colour_range(each, chosen) for each in shown]
    wide = area.aspect >= 1.8
    columns, rows = (len(fields), len(chosen)) if wide else (len(chosen), len(fields))
    inner = 5.2 if wide else min(2.9, 4.4 * area.aspect)
    tall = inner / area.aspect
    # in tall sheets each row has its own colour bar to the right
    right = RIGHT if wide else 1.1
    width = LEFT + right + columns * inner + (columns - 1) * GAP
    top = TOP if wide else 0.75
    height = BOTTOM + top + rows * tall + (rows - 1) * GAP
    with style.look():
        made = style.figure(width, height)
        made.text(LEFT / width, 1 - 0.26 / height, title, weight="bold", fontsize=12, va="center")
        painter = Painter(area.view(round(inner * made.dpi)), spacing)
        for row in range(rows):
            for column in range(columns):
                which, when = (column, row) if wide else (row, column)
                x = LEFT + column * (inner + GAP)
                y = BOTTOM + (rows - 1 - row) * (tall + GAP)
                axes = made.add_axes((x / width, y / height, inner / width, tall / height))
                _dress(axes, area, left=column == 0, bottom=row == rows - 1)
                _show(axes, painter(chosen[when], shown[which], ranges[which]), area)
                if column == 0 or not wide:
                    axes.set_title(time_label(chosen[when].time, scales), fontsize=9)
        for k, each in enumerate(shown):
            if wide:
                x, y = LEFT + k * (inner + GAP) + inner - 2.4, height - 0.6
                bar = made.add_axes((x / width, y / height, 2.4 / width, 0.1 / height))
            else:
                y = BOTTOM + (rows - 1 - k) * (tall + GAP)
                bar = made.add_axes(
                    ((width - right + 0.2) / width, y / height, 0.1 / width, tall / height)
                )
            colour_bar(made, bar, each, ranges[k], horizontal=wide)
        return style.save(made, path)


def _show(axes: Axes, image: object, area: Extent) -> None:
    axes.imshow(
        image,  # type: ignore[arg-type]
        extent=(area.left, area.right, area.bottom, area.top),
        interpolation="nearest",
        aspect="auto",
        zorder=0,
    )


def _dress(axes: Axes, area: Extent, *, left: bool = True, bottom: bool = True) -> None:
    style.bare(axes)
    axes.set_xlim(area.left, area.right)
    axes.set_ylim(area.bottom, area.top)
    across = axes.get_position().width * axes.figure.bbox.width / axes.figure.dpi
    axes.locator_params(axis="x", nbins=max(min(round(across / 0.55), 6), 2))
    axes.locator_params(axis="y", nbins=6)
    # a channel of a millimetre: 10^-3 once at the axis, not in every tick
    axes.ticklabel_format(style="sci", scilimits=(-2, 4), useMathText=True)
    for axis in (axes.xaxis, axes.yaxis):
        axis.get_offset_text().set(fontsize=7.5, color=style.QUIET)
    axes.xaxis.get_offset_text().set_visible(bottom)
    axes.yaxis.get_offset_text().set_visible(left)
    axes.tick_params(labelleft=left, labelbottom=bottom)
    if left:
        axes.set_ylabel("y [m]")
    if bottom:
        axes.set_xlabel("x [m]")


def colour_bar(
    made: Figure, axes: Axes, shown: Quantity, shown_range: Normalize, *, horizontal: bool = True
) -> None:
    """A colour bar without a frame, labelled with the quantity."""
    bar: Any = made.colorbar(
        ScalarMappable(shown_range, style.colours(shown.name)),
        cax=axes,
        orientation="horizontal" if horizontal else "vertical",
        extend="max",
    )
    bar.outline.set_visible(False)
    bar.ax.tick_params(length=0, pad=2)
    bar.ax.locator_params(nbins=5)
    bar.set_label(shown.label, labelpad=2)
