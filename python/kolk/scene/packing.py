"""Particles of equal mass, relaxed inside a shape that no lattice fits.

Particles move down the gradient of their concentration until it is even (Colagrossi, Bouscasse,
Antuono and Marrone, Comput. Phys. Commun. 183 (2012) 1641-1653), by the steps of Lind et al. (J.
Comput. Phys. 231 (2012) 1499-1523) with momentum. What lies outside of the shape is filled and at
rest: a point of its own volume in each cell, at its centroid where the surface cuts the cell, so
that the kernel's sum over it is of second order whatever the surface. It holds the particles in.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from kolk import _core
from kolk.progress import Progress, is_silent

FloatArray = npt.NDArray[np.float64]
Distance = Callable[[FloatArray], FloatArray]

KERNEL = "wendland-c2"
"""Its Fourier transform is positive: particles do not pair, whatever the scene's own kernel is."""

SMOOTHING_RATIO = {2: 2.0, 3: 1.7}
"""Smoothing length over spacing while particles settle."""

MOMENTUM = 0.9
"""Share of its last step that a particle keeps: needs a fifth of the steps that none needs."""

LONGEST = 0.2
"""Longest step of a particle in spacings."""

SETTLED = 1e-3
"""Root mean square of the steps that the concentration asks for, in spacings, at rest."""

MOST_STEPS = 1000
"""Steps after which particles that have not settled never will: 60 are usual in 2D, 90 in 3D."""

UNEVEN = 0.1
"""Largest error of a particle's concentration that passes: a hundredth is usual, at corners."""

SUBCELLS = {2: 8, 3: 5}
"""Parts along each axis of a cell that the surface cuts, to measure what is inside."""

CHUNK = 1 << 20
"""Parts of cut cells measured at a time."""


class Unsettled(Exception):
    """The particles found no even distribution; the message says how far they were from it."""


class Packing(NamedTuple):
    """Particles inside a shape."""

    position: FloatArray
    """(n, D) in m."""
    volume: float
    """Of each particle, m^D: n of them are the shape's volume."""


class Placed(NamedTuple):
    """A body whose particles stay where they are."""

    distance: Distance
    position: FloatArray
    """(n, D) in m."""
    volume: float
    """Of each particle, m^D."""


class Cells(NamedTuple):
    """A shape on a lattice around it."""

    centre: FloatArray
    """Of each cell (n, D) in m."""
    depth: FloatArray
    """(n,): the shape's distance at the centre."""
    inside: FloatArray
    """(n,): share of the cell that lies inside the shape."""
    outer: FloatArray
    """Centroid (n, D) in m of the part outside; the centre where there is none."""
    near: npt.NDArray[np.bool_]
    """(n,): whether particles inside the shape may feel the cell."""


def cells(
    distance: Distance, low: FloatArray, high: FloatArray, spacing: float, reach: float
) -> Cells:
    """Cells of ``spacing`` (m) around the box ``low`` to ``high`` (D,), ``reach`` (m) beyond it.

    ``distance`` need be none: a function that is negative inside will do.
    """
    from scipy import ndimage

    d = len(low)
    counts = np.ceil((high - low) / spacing - 1e-6).astype(int) + 2 * math.ceil(reach / spacing + 1)
    start = 0.5 * (low + high) - 0.5 * spacing * counts
    axes = [a + spacing * (np.arange(n) + 0.5) for a, n in zip(start, counts, strict=True)]
    centre = np.stack([g.ravel() for g in np.meshgrid(*axes, indexing="ij")], axis=1)
    depth = distance(centre)
    inside = (depth < 0.0).astype(np.float64)
    outer = centre.copy()
    # A level set that is no distance shows by its signs which cells its surface cuts.
    full = inside.reshape(counts)
    cut = np.zeros(counts, bool)
    for axis in range(d):
        change = np.diff(full, axis=axis) != 0.0
        ends = [(0, 0)] * d
        cut |= np.pad(change, [*ends[:axis], (0, 1), *ends[axis + 1 :]])
        cut |= np.pad(change, [*ends[:axis], (1, 0), *ends[axis + 1 :]])
    edge = np.flatnonzero(cut.ravel() | (np.abs(depth) <= 0.5 * math.sqrt(d) * spacing))
    for part in np.array_split(edge, 1 + len(edge) * SUBCELLS[d] ** d // CHUNK):
        inside[part], outer[part] = _measured(distance, centre[part], spacing)
    gap = ndimage.distance_transform_edt((inside == 0.0).reshape(counts), sampling=spacing)
    return Cells(centre, depth, inside, outer, gap.ravel() <= reach + spacing)


def _measured(
    distance: Distance, centre: FloatArray, spacing: float
) -> tuple[FloatArray, FloatArray]:
    """Share (n,) of cells inside a shape, and centroid (n, D) of what is outside."""
    d = centre.shape[1]
    number = SUBCELLS[d]
    fine = spacing / number
    along = fine * (np.arange(number) + 0.5) - 0.5 * spacing
    offset = np.stack([g.ravel() for g in np.meshgrid(*[along] * d, indexing="ij")], axis=1)
    value = distance((centre[:, None] + offset).reshape(-1, d)).reshape(-1, *[number] * d)
    # To first order a level set lies value / |gradient| away: exact for a distance.
    slope = np.gradient(value, fine, axis=tuple(range(1, d + 1)))
    steep = np.sqrt(np.sum(np.square(slope), axis=0))
    share = np.clip(0.5 - value / np.maximum(fine * steep, 1e-300), 0.0, 1.0)
    left = (1.0 - share).reshape(len(centre), -1)
    total = left.sum(axis=1)
    centroid = (left @ offset) / np.maximum(total, 1e-300)[:, None]
    return 1.0 - total / left.shape[1], centre + centroid


def pack(
    distance: Distance,
    low: FloatArray,
    high: FloatArray,
    spacing: float,
    *,
    volume: float | None = None,
    others: Sequence[Placed] = (),
    name: str = "particles",
) -> Packing:
    """Particles at rest in what ``distance`` says is inside, within the box ``low`` to ``high``.

    distance: signed, of points (m, D), in m; low, high (D,) in m; spacing in m. volume: of the
    shape in m^D where it is known exactly, else it is measured on parts of cells. others:
    bodies around it, which stand for the filled space that they take. name: what the progress calls
    them. Gives the same bits each time; the cost is proportional to their number.
    Empty where not one particle fits. Raises Unsettled.
    """
    d = len(low)
    h = SMOOTHING_RATIO[d] * spacing
    reach = _core.kernel(KERNEL, d).support * h
    around = cells(distance, low, high, spacing, reach)
    if volume is None:
        volume = float(around.inside.sum()) * spacing**d
    count = round(volume / spacing**d)
    if count == 0:
        return Packing(np.empty((0, d)), spacing**d)
    first = around.centre[np.argsort(around.depth, kind="stable")[:count]]
    outer, outer_volume = _held(distance, low, high, spacing, reach, around, others)
    position = _settle(first, volume / count, outer, outer_volume, h, spacing, name)
    outside = distance(position) > 0.0
    if outside.any():
        where = position[outside][0].tolist()
        raise Unsettled(f"{int(outside.sum()):,} of {count:,} do not fit, such as at {where}")
    return Packing(position, volume / count)


def _held(
    distance: Distance,
    low: FloatArray,
    high: FloatArray,
    spacing: float,
    reach: float,
    around: Cells,
    others: Sequence[Placed],
) -> tuple[FloatArray, FloatArray]:
    """Points (m, D) that hold the particles in, and the volume (m,) of each: the cells ``around``
    the shape, and the particles of ``others`` in place of the cells that these take."""
    from scipy.spatial import cKDTree

    cell = spacing ** len(low)
    space, near = around, around.near
    # Bodies that overlap are no fault of packing: they are named where places are checked.
    others = [o for o in others if not np.any(distance(o.position) < 0.0)]
    if others:

        def taken(points: FloatArray) -> FloatArray:
            each = [distance(points), *(other.distance(points) for other in others)]
            return np.asarray(np.minimum.reduce(each))

        space = cells(taken, low, high, spacing, reach)
    held = near & (space.inside < 1.0 - 1e-9)
    points, volumes = [space.outer[held]], [(1.0 - space.inside[held]) * cell]
    tree = cKDTree(around.centre[near])
    for other in others:
        gap, _ = tree.query(other.position, distance_upper_bound=spacing)
        close = np.isfinite(gap)
        points.append(other.position[close])
        volumes.append(np.full(int(close.sum()), other.volume))
    return np.concatenate(points), np.concatenate(volumes)


def _settle(
    first: FloatArray,
    own: float,
    outer: FloatArray,
    outer_volume: FloatArray,
    h: float,
    spacing: float,
    name: str,
) -> FloatArray:
    """Positions (n, D) at rest of particles of the volume ``own`` each, from ``first`` (n, D),
    among points ``outer`` that do not move."""
    n = len(first)
    position, step = first.copy(), np.zeros_like(first)
    volume = np.concatenate([np.full(n, own), outer_volume])
    one = np.ones(len(volume))
    begun = 0.0
    with Progress(1.0, quiet=is_silent()) as progress:
        for number in range(MOST_STEPS):
            asked = _core.particle_shift(
                np.concatenate([position, outer]),
                volume,
                one,
                h,
                spacing,
                KERNEL,
                form="lind",
                free_surface=False,
            )[:n]
            rest = float(np.sqrt(np.mean(np.sum(asked**2, axis=1)))) / spacing
            if rest < SETTLED:
                break
            begun = max(begun, rest)
            share = math.log(begun / rest) / math.log(begun / SETTLED)
            progress.show(share, f"packing '{name}', {n:,} particles, step {number}")
            step = MOMENTUM * step + asked
            length = np.linalg.norm(step, axis=1, keepdims=True)
            step *= np.minimum(1.0, LONGEST * spacing / np.maximum(length, 1e-300))
            position += step
        else:
            raise Unsettled(
                f"after {MOST_STEPS} steps they still ask for {rest:.2g} spacings a step, and at "
                f"rest for {SETTLED:g}"
            )
    sum_of = _core.interpolate(
        position, np.concatenate([position, outer]), one, volume, one, h, KERNEL, normalise=False
    )
    worst = int(np.argmax(np.abs(sum_of - 1.0)))
    if abs(sum_of[worst] - 1.0) > UNEVEN:
        raise Unsettled(
            f"their concentration is {sum_of[worst]:.3g} at {position[worst].tolist()}, must be "
            f"within {UNEVEN:.0%} of 1"
        )
    return position
