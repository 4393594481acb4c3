"""Walls that are too thin for the kernel, that overlap, or that leave gaps."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from kolk.scene import Body, Scene
from kolk.scene.automatic import FACETS
from kolk.scene.fill import lattice
from kolk.scene.parts import Wall
from kolk.scene.shapes import Box, Tank

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

MOST_CELLS = 4_000_000
"""Cells of the grid in which a way out is looked for; more are made coarser."""

LEVELS = 7
"""Halvings of the width of a gap while it is looked for."""

NARROWEST = 0.75
"""Width of a gap in spacings from which on it is told: bodies that meet may leave less."""


def warnings(scene: Scene, bodies: list[Body]) -> list[str]:
    """What is doubtful about the walls of ``scene``."""
    return [*_thin(scene), *_unfitted(scene), *_double(scene, bodies), *_gaps(scene, bodies)]


def layers(scene: Scene, wall: Wall) -> int:
    """How many layers deep the wall is filled: fewer than the kernel reaches if it is thin."""
    assert wall.shape is not None
    shape = wall.shape.shape
    if isinstance(shape, Tank):
        return scene.wall_layers
    points, steps = lattice(shape, scene.spacing, scene.wall_layers)
    # In the middle of a plate lies a particle, or the middle of a cell of the lattice.
    middles = points + 0.5 * steps
    deepest = max(float(-shape.distance(at).min()) for at in (points, middles))
    return min(scene.wall_layers, max(1, round(2.0 * deepest / float(steps.min()))))


def _thin(scene: Scene) -> list[str]:
    found: list[str] = []
    for wall in scene.wall:
        if wall.shape is not None and (deep := layers(scene, wall)) < scene.wall_layers:
            thick = "1 layer" if deep == 1 else f"{deep} layers"
            found.append(
                f"wall '{wall.name}' is {thick} thick, the kernel reaches "
                f"{scene.wall_layers}: fluid on its two sides would feel each other. Thicken it, "
                "or refine spacing"
            )
    return found


def _unfitted(scene: Scene) -> list[str]:
    """Walls of facets need the first layer half a spacing away, where no lattice has it."""
    if scene.numerics.wall not in FACETS or all(f.arrangement == "packed" for f in scene.fluid):
        return []
    return [
        f"wall '{wall.name}' may be slanted or curved, and numerics.wall = "
        f'"{scene.numerics.wall}" needs particles half a spacing from it: give the fluid '
        'arrangement = "packed", or use a wall of particles such as "adami"'
        for wall in scene.wall
        if wall.shape is not None and not isinstance(wall.shape.shape, (Box, Tank))
    ]


def _double(scene: Scene, bodies: list[Body]) -> list[str]:
    found: list[str] = []
    by_name = {b.name: b for b in bodies}
    for i, wall in enumerate(scene.wall):
        if wall.shape is None or isinstance(wall.shape.shape, Tank):
            continue
        for other in scene.wall[:i]:
            position = by_name[other.name].position
            double = wall.shape.shape.distance(position) < -0.01 * scene.spacing
            if double.any():
                found.append(
                    f"walls '{wall.name}' and '{other.name}' overlap in {int(double.sum()):,} "
                    "particles: fluid near them feels both. Make one wall of them with 'union', or "
                    "move one"
                )
    return found


def _gaps(scene: Scene, bodies: list[Body]) -> list[str]:
    """A way from the fluid, below its own level, past the walls."""
    walls = [b.position for b in bodies if b.kind == "wall"]
    if not walls or not scene.weight.any():
        return []
    gap = find_gap(scene, np.concatenate(walls), [b for b in bodies if b.kind == "fluid"])
    if gap is None:
        return []
    where, width = gap
    return [
        "the fluid can flow out below its own level, past the walls near ["
        + ", ".join(f"{x:.3g}" for x in where)
        + f"], through a gap of about {width:.2g} m ({width / scene.spacing:.1f} spacings): close "
        "it, unless it is meant"
    ]


def find_gap(scene: Scene, wall: FloatArray, fluids: list[Body]) -> tuple[FloatArray, float] | None:
    """The narrowest place (D,) on the widest way out of the walls, and its width, in m."""
    from scipy import ndimage
    from scipy.spatial import cKDTree

    spacing, d = scene.spacing, scene.dimension
    fluid = np.concatenate([b.position for b in fluids])
    everything = np.concatenate([wall, fluid])
    low, high = everything.min(axis=0), everything.max(axis=0)
    for axis, interval in enumerate(scene.periodic_axes):
        if interval is not None:
            low[axis], high[axis] = interval
    margin = np.array([0.0 if p is not None else 3.0 * spacing for p in scene.periodic_axes])
    low, high = low - margin, high + margin
    cell = max(0.25 * spacing, float(np.prod(high - low) / MOST_CELLS) ** (1.0 / d))
    if cell > spacing:
        return None  # too large to see a gap of a spacing
    counts = np.maximum(np.ceil((high - low) / cell - 1e-9).astype(int), 1)
    axes = [a + cell * (np.arange(n) + 0.5) for a, n in zip(low, counts, strict=True)]
    points = np.stack([g.ravel() for g in np.meshgrid(*axes, indexing="ij")], axis=1)
    distance, _ = cKDTree(wall).query(points, distance_upper_bound=4.0 * spacing)
    # The holes of a lattice of wall particles are half its diagonal away from them.
    reach = (0.5 * math.sqrt(d) + 0.05) * spacing
    free = (distance > reach).reshape(counts)
    up = -scene.weight / np.linalg.norm(scene.weight)
    level = float(np.max(fluid @ up)) + 0.5 * spacing
    free &= (points @ up < level).reshape(counts)
    index = np.clip(((fluid - low) / cell).astype(int), 0, counts - 1)
    start = np.zeros(counts, bool)
    start[tuple(index.T)] = True
    rim = np.zeros(counts, bool)
    for axis, interval in enumerate(scene.periodic_axes):
        if interval is None:
            ends: list[slice | int] = [slice(None)] * d
            for end in (0, -1):
                ends[axis] = end
                rim[tuple(ends)] = True
    # Half the width of the free space, where the wall's own particles are half a spacing behind it.
    room = np.where(free, np.minimum(distance.reshape(counts) - 0.5 * spacing, 3 * spacing), 0.0)

    def leads_out(width: float) -> Mask | None:
        parts, _ = ndimage.label(free & (room >= width))
        common = np.intersect1d(parts[start & (parts > 0)], parts[rim & (parts > 0)])
        return np.isin(parts, common) if len(common) else None

    if leads_out(0.0) is None:
        return None
    narrow, wide = 0.0, float(room.max()) + cell
    for _ in range(LEVELS):
        middle = 0.5 * (narrow + wide)
        if leads_out(middle) is None:
            wide = middle
        else:
            narrow = middle
    width = 2.0 * narrow + 0.5 * cell
    if width < NARROWEST * spacing:
        return None
    way = leads_out(narrow)
    assert way is not None
    # Without its tight places the way falls apart; they are where the parts grow together again.
    parts, _ = ndimage.label(way & (room > narrow + 0.25 * cell))
    inner = np.isin(parts, np.unique(parts[start & way])) & (parts > 0) | (start & way)
    outer = np.isin(parts, np.unique(parts[rim & way])) & (parts > 0) | (rim & way)
    while not (inner & outer).any():
        grown = ndimage.binary_dilation(inner, mask=way), ndimage.binary_dilation(outer, mask=way)
        inner, outer = np.asarray(grown[0]), np.asarray(grown[1])
    return points[(inner & outer).ravel()].mean(axis=0), width
