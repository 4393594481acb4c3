"""How well a run holds together: leaks and voids at a moment, and the report over the whole run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kolk.output.tables import read_columns

if TYPE_CHECKING:
    from kolk.scene.shapes import Shape
    from kolk.simulation import Simulation

Floats = NDArray[np.float64]

LEAK_DEPTH = 0.1
"""Depth behind the surface of a wall, in spacings, from which on a particle has leaked."""

VOID = 0.7
"""Kernel sum inside the fluid below which there is a hole in it."""

_FARTHEST = 1 << 19
"""Cells on either side of the fluid's middle that are looked at for voids."""


def leaks(simulation: Simulation) -> int:
    """Fluid particles that are deeper than a tenth of a spacing in a wall, or not finite.

    The solid of a tank has no end: what has left it over an open side and fallen past it counts.
    Walls of own particles have no surface to be behind.
    """
    bodies, scene = simulation.bodies.values(), simulation.scene
    position = np.concatenate([body.position for body in bodies if body.kind == "fluid"])
    leaked: NDArray[np.bool_] = ~np.isfinite(position).all(axis=1)
    sound = np.where(leaked[:, None], 0.0, position)
    for wall in scene.wall:
        if wall.shape is not None:
            first, now = simulation.initial[wall.name].position, simulation.bodies[wall.name]
            seen = _as_at_start(sound, first, now.position, 1e-6 * scene.spacing)
            if seen is not None:
                depth = _depth(wall.shape.shape, seen, scene.spacing)
                leaked |= depth > LEAK_DEPTH * scene.spacing
    return int(leaked.sum())


def _as_at_start(points: Floats, first: Floats, now: Floats, rounding: float) -> Floats | None:
    """Points (m, D) as seen from a rigid body that has moved since the start, by the best rotation
    between its particles (n, D) then and now (Kabsch 1976); None if it is not rigid, as seen
    where a period cuts it."""
    if float(np.max(np.abs(now - first))) <= rounding:
        return points
    a, b = first.mean(axis=0), now.mean(axis=0)
    u, _, v = np.linalg.svd((now - b).T @ (first - a))
    flip = np.ones(first.shape[1])
    flip[-1] = np.sign(np.linalg.det(u @ v))
    turn = (u * flip) @ v
    if float(np.max(np.abs((now - b) @ turn + a - first))) > max(rounding, 1e-9 * np.ptp(first)):
        return None
    return np.asarray((points - b) @ turn + a)


def _depth(shape: Shape, position: Floats, spacing: float) -> Floats:
    """Depth (n,) in m inside a shape, from a function that need not be a distance."""
    depth = -shape.distance(position)
    inside = np.flatnonzero(depth > 0.0)
    if len(inside):
        at, step = position[inside], 1e-3 * spacing
        slope = np.zeros(len(inside))
        for axis in range(position.shape[1]):
            ahead, behind = at.copy(), at.copy()
            ahead[:, axis] += step
            behind[:, axis] -= step
            slope += ((shape.distance(ahead) - shape.distance(behind)) / (2.0 * step)) ** 2
        # A distance has slope 1, less in a corner, where it stays a distance.
        steep = np.sqrt(slope)
        depth[inside] /= np.where(steep > 1.5, steep, 1.0)
    return np.asarray(depth)


def voids(simulation: Simulation) -> int:
    """Holes inside the fluid: cells two spacings wide, among cells that all hold particles, at
    whose middle the kernel sum over fluid and walls is below 0.7."""
    scene = simulation.scene
    d, edge = simulation.dimension, 2.0 * scene.spacing
    bodies = simulation.bodies.values()
    position = np.concatenate([body.position for body in bodies])
    fluid = np.concatenate([np.full(len(body), body.kind == "fluid") for body in bodies])
    middle = np.median(position, axis=0)
    cell = np.floor((position - middle) / edge)
    near = (np.abs(cell) < _FARTHEST - 2).all(axis=1)
    cell, fluid = cell[near].astype(np.int64) + _FARTHEST, fluid[near]
    weight = (2 * _FARTHEST) ** np.arange(d, dtype=np.int64)
    held, count = np.unique(cell @ weight, return_counts=True)
    wet = np.unique(cell[fluid] @ weight)
    # An empty cell among full ones has a wet one beside it.
    steps = np.stack([g.ravel() for g in np.meshgrid(*[[-1, 0, 1]] * d)], axis=1) @ weight
    wanted = np.unique(np.concatenate([wet - 1, wet, wet + 1]))
    there = np.minimum(np.searchsorted(held, wanted), len(held) - 1)
    number = np.where(held[there] == wanted, count[there], 0)
    wanted = wanted[number < 0.75 * 2**d]
    for step in steps[steps != 0]:
        wanted = wanted[np.isin(wanted + step, held, assume_unique=True)]
    if not len(wanted):
        return 0
    index = np.stack([wanted // w % (2 * _FARTHEST) for w in weight], axis=1) - _FARTHEST
    found = simulation.sample((index + 0.5) * edge + middle, ["fill", "wall_fill"])
    return int(np.sum(found["fill"] + found["wall_fill"] < VOID))


def stability_report(
    history: Path, simulation: Simulation, limits: Mapping[str, int]
) -> dict[str, Any]:
    """How far the run stayed inside the range that its method is made for.

    history: the run's `history.csv`; the report holds the extremes over its rows. Largest and
    smallest density, pressure, speed, Mach number and closest pair (spacings); `leaks`, `crowded`
    (particles with another nearer than half a spacing) and `voids`: the most at one time;
    `energy_growth`: the most by which the energy ever grew, as a share of what it had in motion,
    compression and height above its last (moving walls and open ends may do so);
    `time_step`: its range (s); `limits`: what set it how often; the guard's `retries`,
    `passed` and `undone` steps; `wall_impulse`: momentum that the walls gave, kg m/s.
    """
    table = read_columns(history)
    largest = ("mach", "speed_max", "density_max", "pressure_max")
    smallest = ("density_min", "pressure_min", "closest_pair")
    counts = ("leaks", "crowded", "voids")
    guard = simulation.retries
    # The first row is written before there is a step.
    steps = table["time_step"][1:] if len(table["time_step"]) > 1 else table["time_step"]
    return {
        "mach_left_range": simulation.mach_warning,
        **{name: float(np.max(table[name])) for name in largest},
        **{name: float(np.min(table[name])) for name in smallest},
        **{name: int(np.max(table[name])) for name in counts},
        "energy_growth": _energy_growth(table),
        "time_step": {"smallest": float(np.min(steps)), "largest": float(np.max(steps))},
        "limits": dict(limits),
        "retries": sum(guard["retries"].values()),
        "retries_by_trouble": {k: v for k, v in guard["retries"].items() if v},
        "passed_by_trouble": {k: v for k, v in guard["passed"].items() if v},
        "undone": guard["undone"],
        "wall_impulse": _wall_impulse(simulation),
    }


def _energy_growth(table: Mapping[str, Floats]) -> float:
    """The most by which the energy grew from any row to a later one, as a share of its range."""
    names = ("kinetic_energy", "potential_energy", "compression_energy")
    total = np.sum([table[name] for name in names], axis=0)
    growth = float(np.max(total - np.minimum.accumulate(total)))
    # The zero of potential energy is arbitrary: counted from its lowest.
    least = np.min(table["potential_energy"])
    scale = float(np.max(total - least))
    return growth / scale if scale > 0.0 else 0.0


def _wall_impulse(simulation: Simulation) -> list[float] | None:
    """What changed the fluid's momentum besides gravity, kg m/s (in 2D per metre of depth); None
    where gravity changes in time."""
    from kolk.scene.motion import Gravity

    if isinstance(simulation.scene.gravity, Gravity):
        return None
    fluids = [body for body in simulation.initial.values() if body.kind == "fluid"]
    given = sum(body.mass @ body.velocity for body in fluids)
    mass = sum(float(body.mass.sum()) for body in fluids)
    gravity = np.array(simulation.scene.gravity_at_start or np.zeros(simulation.dimension))
    change = simulation.momentum - given - mass * simulation.time * gravity
    return [float(part) for part in change]
