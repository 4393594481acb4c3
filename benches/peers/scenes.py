"""The scenes of the comparison: the same particles for every code, from NumPy alone.

A scene is a lattice of fluid particles, layers of wall particles behind the tank's faces, and the
physical parameters that all codes share. The workers of the peers run in environments that have
little but NumPy, so this module imports nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRAVITY = 9.81  # m/s²
COLUMN = 0.05715  # m: the width a of Martin and Moyce's column, 2.25 in
RUN = 5.0  # length of the tank in column widths
TALL = 2.2  # height of the tank's walls in column widths
SMOOTHING = 1.3  # h / spacing of the dam breaks with Wendland C2
NARROW = 1.0  # the same with SPlisHSPlasH's cubic spline: four particle radii are the support
REYNOLDS = 100.0
JITTER = 0.1  # of the spacing: a perfect lattice makes the vortex a matter of luck


@dataclass(frozen=True)
class Scene:
    """One scene at one resolution. Lengths in m, time in s, masses per metre in 2D."""

    name: str
    dimension: int
    spacing: float
    smoothing_ratio: float  # h / spacing
    kernel: str  # kolk's name
    support: float  # of the kernel, in h
    density: float
    sound_speed: float
    alpha: float  # Monaghan's artificial viscosity
    viscosity: float  # kinematic, m²/s
    gravity: float  # along minus the second axis (2D) or the third (3D)
    box: tuple[float, ...]  # upper corner of the fluid's box, lower corner at the origin
    tank: tuple[float, ...] | None  # the same of the tank; None: a periodic box
    fluid: Array
    velocity: Array
    wall: Array
    until: float

    @property
    def h(self) -> float:
        return self.smoothing_ratio * self.spacing

    @property
    def radius(self) -> float:
        """Support radius, m."""
        return self.support * self.h

    @property
    def mass(self) -> float:
        return float(self.density * self.spacing**self.dimension)


def lattice(upper: tuple[float, ...], spacing: float) -> Array:
    """Cell-centred lattice (n, D) that fills the box from the origin to ``upper``."""
    axes = [(np.arange(round(top / spacing)) + 0.5) * spacing for top in upper]
    mesh = np.meshgrid(*axes, indexing="ij")
    return np.stack([axis.ravel() for axis in mesh], axis=1)


def tank_walls(upper: tuple[float, ...], spacing: float, layers: int) -> Array:
    """Wall particles (n, D): ``layers`` outside every face but the top, corners included."""
    last = len(upper) - 1
    axes = []
    for axis, top in enumerate(upper):
        above = 0 if axis == last else layers
        axes.append((np.arange(-layers, round(top / spacing) + above) + 0.5) * spacing)
    grid = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    inside = np.all((grid > 0.0) & (grid < np.asarray(upper)), axis=1)
    walls: Array = grid[~inside]
    return walls


def dam_break(
    dimension: int, cells: int, *, narrow: bool = False, layers: int | None = None
) -> Scene:
    """Martin and Moyce's collapse of a column a by 2a (by a in 3D), ``cells`` particles along a.

    ``narrow``: SPlisHSPlasH's cubic spline and support. Without ``layers``, as many wall layers as
    the support needs.
    """
    spacing = COLUMN / cells
    ratio, support = (NARROW if narrow else SMOOTHING), 2.0
    deep = (COLUMN,) if dimension == 3 else ()
    box = (COLUMN, *deep, 2 * COLUMN)
    tank = (RUN * COLUMN, *deep, round(TALL * cells) * spacing)
    count = int(np.ceil(ratio * support)) if layers is None else layers
    fluid = lattice(box, spacing)
    return Scene(
        name=f"dam break {dimension}D",
        dimension=dimension,
        spacing=spacing,
        smoothing_ratio=ratio,
        kernel="cubic" if narrow else "wendland-c2",
        support=support,
        density=1000.0,
        sound_speed=10.0 * float(np.sqrt(2.0 * GRAVITY * 2.0 * COLUMN)),
        alpha=0.1,
        viscosity=0.0,
        gravity=GRAVITY,
        box=box,
        tank=tank,
        fluid=fluid,
        velocity=np.zeros_like(fluid),
        wall=tank_walls(tank, spacing, count),
        # The front has run through most of the record, and has not reached the far wall.
        until=2.4 / float(np.sqrt(2.0 * GRAVITY / COLUMN)),
    )


def taylor_green(cells: int) -> Scene:
    """The periodic vortex of unit size and speed at Re 100, ``cells`` particles along a side."""
    spacing = 1.0 / cells
    jitter = np.random.default_rng(1).uniform(-JITTER, JITTER, (cells * cells, 2))
    fluid = lattice((1.0, 1.0), spacing) + spacing * jitter
    return Scene(
        name="Taylor-Green",
        dimension=2,
        spacing=spacing,
        smoothing_ratio=1.0,
        kernel="quintic",
        support=3.0,
        density=1.0,
        sound_speed=10.0,
        alpha=0.0,
        viscosity=1.0 / REYNOLDS,
        gravity=0.0,
        box=(1.0, 1.0),
        tank=None,
        fluid=fluid,
        velocity=vortex_velocity(fluid, 0.0),
        wall=np.empty((0, 2)),
        until=1.0,
    )


def vortex_velocity(position: Array, time: float) -> Array:
    """Velocity (n, 2) of the Taylor-Green vortex at ``position`` (n, 2): Taylor and Green 1937."""
    decay = np.exp(-8.0 * np.pi**2 / REYNOLDS * time)
    x, y = 2.0 * np.pi * position[:, 0], 2.0 * np.pi * position[:, 1]
    velocity: Array = decay * np.stack([-np.cos(x) * np.sin(y), np.sin(x) * np.cos(y)], axis=1)
    return velocity


def vortex_pressure(position: Array) -> Array:
    """Pressure (n,) of the vortex at time 0 and unit density."""
    x, y = 4.0 * np.pi * position[:, 0], 4.0 * np.pi * position[:, 1]
    return -0.25 * (np.cos(x) + np.cos(y))


def make(name: str, cells: int, *, narrow: bool = False, layers: int | None = None) -> Scene:
    """The scene called ``name``: dam-break-2d, dam-break-3d or taylor-green."""
    if name == "taylor-green":
        return taylor_green(cells)
    return dam_break(3 if name.endswith("3d") else 2, cells, narrow=narrow, layers=layers)
