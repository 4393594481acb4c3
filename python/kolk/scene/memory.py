"""How much memory a scene needs, and how much there is, before either is touched."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np

from kolk.errors import Problem, SceneError

from .model import Scene
from .parts import Fluid, Wall
from .shapes import Tank

BYTES_PER_PARTICLE = 300
"""Upper bound of the engine's memory for one particle, its neighbour search included."""

_STAGE_SETS = {"predictor-corrector": 1, "rk2": 1, "rk4": 2}
"""Sets of columns that an integrator of several stages keeps beside the state."""

_FILLING_BYTES = 64
"""Bytes per lattice point while a shape is being filled: coordinates and distances in f64."""


def available() -> int:
    """Bytes of memory that this process may still take; a container's limit counts."""
    free = math.inf
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                free = int(line.split()[1]) * 1024
    except (OSError, ValueError):
        free = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    try:
        group = Path("/sys/fs/cgroup")
        limit = (group / "memory.max").read_text(encoding="ascii").strip()
        used = (group / "memory.current").read_text(encoding="ascii").strip()
        free = min(free, int(limit) - int(used))
    except (OSError, ValueError):
        pass  # no control group, or one without a limit
    return int(max(free, 0))


def estimated_particles(scene: Scene, body: Fluid | Wall) -> float:
    """About how many particles ``body`` will have, without making one."""
    if body.particles is not None:
        return len(body.particles)
    assert body.shape is not None
    shape, cell = body.shape.shape, scene.spacing**scene.dimension
    if isinstance(body, Fluid):
        return shape.size() / cell
    thickness = scene.wall_layers * scene.spacing
    low, high = shape.bounds(thickness)
    if isinstance(shape, Tank):
        inner_low, inner_high = shape.bounds()
        return float(np.prod(high - low) - np.prod(inner_high - inner_low)) / cell
    inside = np.maximum(high - low - 2.0 * thickness, 0.0)
    return min(float(np.prod(high - low) - np.prod(inside)), shape.size()) / cell


def needed(scene: Scene) -> int:
    """Bytes that the scene's particles need in the engine, about."""
    bodies: list[Fluid | Wall] = [*scene.fluid, *scene.wall]
    stages = 8 * (2 * scene.dimension + 1) * _STAGE_SETS.get(scene.numerics.integrator, 0)
    return int((BYTES_PER_PARTICLE + stages) * sum(estimated_particles(scene, b) for b in bodies))


def check_memory(scene: Scene) -> None:
    """Raise SceneError where the particles would not fit into the memory that there is."""
    lattice = 0.0
    for body in (*scene.fluid, *scene.wall):
        if body.shape is not None:
            low, high = body.shape.shape.bounds(scene.wall_layers * scene.spacing)
            lattice = max(lattice, float(np.prod((high - low) / scene.spacing)))
    want, have = needed(scene) + int(_FILLING_BYTES * lattice), available()
    if want > have:
        # Particles, hence memory, go with spacing^-D.
        coarser = scene.spacing * (want / (0.9 * max(have, 1))) ** (1.0 / scene.dimension)
        raise SceneError(
            problems=[
                Problem(
                    ("spacing",),
                    f"found {scene.spacing:g} m, which makes about "
                    f"{needed(scene) / BYTES_PER_PARTICLE:.3g} particles that need "
                    f"{want / 1e9:.3g} GB, but {have / 1e9:.3g} GB are free: "
                    f"use a spacing of {coarser:.2g} m or more",
                )
            ]
        )
