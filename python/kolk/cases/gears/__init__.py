"""Spur gears with involute flanks, as outlines and as solids of triangles.

``python -m kolk.cases.gears`` writes the outlines beside this file, as a drawing would come.
Source: Litvin & Fuentes, Gear Geometry and Applied Theory (2004).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

FOLDER = Path(__file__).parent
MODULE = 0.008
"""Pitch diameter over teeth, m."""
TEETH = {"driver": 14, "wheel": 21}
ADDENDUM = 0.8 * MODULE
"""Of stub teeth, whose tips stay blunt in spite of the play, m."""
PRESSURE_ANGLE = math.radians(25.0)
PLAY = 0.0035
"""By how much teeth are thinner than the gaps that take them, m."""


def involute(radius: FloatArray | float, base: float) -> FloatArray:
    """Angle in rad by which an involute of the circle of radius ``base`` has turned at ``radius``:
    ``inv(phi) = tan(phi) - phi`` with ``cos(phi) = base / radius``."""
    angle = np.arccos(np.minimum(base / np.asarray(radius, np.float64), 1.0))
    return np.asarray(np.tan(angle) - angle)


def gear(teeth: int, *, points: int = 8) -> FloatArray:
    """Outline (k, 2) in m of a spur gear about the origin, a tooth pointing along x.

    Dedendum 1.25 modules; flanks end radially below the base circle.
    ``points``: along each flank.
    """
    pitch = 0.5 * MODULE * teeth
    base = pitch * math.cos(PRESSURE_ANGLE)
    tip, root = pitch + ADDENDUM, pitch - 1.25 * MODULE
    radii = np.linspace(max(base, root), tip, points)
    # Half the angle of a tooth on the pitch circle, less the play.
    half = 0.5 * (0.5 * math.pi * MODULE - PLAY) / pitch
    flank = half + float(involute(pitch, base)) - involute(radii, base)
    if root < base:
        radii, flank = np.append(root, radii), np.append(flank[0], flank)
    middle = np.arange(teeth)[:, None] * 2.0 * math.pi / teeth
    angle = np.concatenate([middle - flank, middle + flank[::-1]], axis=1)
    radius = np.tile(np.concatenate([radii, radii[::-1]]), (teeth, 1))
    # Root circles between teeth are arcs of few points, as short as those of a flank.
    ends = np.linspace(flank[0], 2.0 * math.pi / teeth - flank[0], 5)[1:-1]
    angle = np.concatenate([angle, middle + ends], axis=1).ravel()
    radius = np.concatenate([radius, np.full((teeth, 3), root)], axis=1).ravel()
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def turned(outline: FloatArray, angle: float) -> FloatArray:
    """The outline turned about the origin by ``angle`` in rad."""
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(outline @ np.array([[c, s], [-s, c]]))


def outlines() -> dict[str, FloatArray]:
    """Outline of either gear about its own axis, m, as they mesh at the start."""
    # A tooth of the driver points at the wheel, which has a gap there.
    wheel = turned(gear(TEETH["wheel"]), math.pi + math.pi / TEETH["wheel"])
    return {"driver": gear(TEETH["driver"]), "wheel": wheel}


def prism(outline: FloatArray, low: float, high: float) -> tuple[FloatArray, Any]:
    """Corners (n, 3) and triangles (m, 3) of the prism over an outline, normals outwards."""
    import shapely

    n = len(outline)
    corners = np.concatenate(
        [np.column_stack([outline, np.full(n, z)]) for z in (low, high)], axis=0
    )
    place = {tuple(x): i for i, x in enumerate(outline.tolist())}
    ring = np.arange(n)
    after = np.roll(ring, -1)
    faces = [np.stack([ring, after, after + n], axis=1), np.stack([ring, after + n, ring + n], 1)]
    flat = shapely.constrained_delaunay_triangles(shapely.Polygon(outline))
    caps = np.array(
        [
            [place[tuple(c)] for c in shapely.get_coordinates(part)[:3].tolist()]
            for part in flat.geoms
        ]
    )
    a, b, c = np.moveaxis(outline[caps], 1, 0)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    anticlockwise = ux * vy - uy * vx > 0.0
    caps[~anticlockwise] = caps[~anticlockwise][:, ::-1]
    return corners, np.concatenate([*faces, caps[:, ::-1], caps + n])


def write(folder: Path = FOLDER) -> None:
    """Write the outlines of the gears."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, outline in outlines().items():
        lines = [f"# {TEETH[name]} teeth, module {MODULE:g} m, about the axis", "x, y"]
        lines += [f"{x:.9f}, {y:.9f}" for x, y in outline]
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
