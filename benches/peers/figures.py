"""From what a worker left behind to the figures of the table: rates, pairs and errors."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scenes import COLUMN, GRAVITY, Array, Scene, vortex_velocity
from scipy.spatial import cKDTree

# Martin and Moyce 1952, column twice as high as wide, a = 2.25 in and 1.125 in:
# T = t sqrt(2 g / a), Z = x / a.
MARTIN_MOYCE = np.array(
    [
        (1.212, 1.443),
        (1.219, 1.474),
        (1.602, 1.884),
        (1.997, 2.292),
        (2.283, 2.689),
        (2.547, 2.995),
        (2.95, 3.728),
        (3.345, 4.134),
        (3.598, 4.528),
    ]
)
ALIGNED = 1.44  # Z at which the computed and the measured front are made to coincide
ALIGNED_TIME = 1.212


@dataclass(frozen=True)
class Figures:
    """One run's row. Rates per wall second; particles are the fluid's; pairs are directed."""

    particle_steps: float
    evaluations: float  # particles times force evaluations
    pairs: float
    physical: float  # physical seconds
    memory: float  # peak, bytes
    neighbours: float
    fluid: int
    wall: int
    steps: int
    error: float | None  # None where the run is too short to have one


def read(folder: Path, scene: Scene) -> Figures:
    """The figures of the run in ``folder``."""
    record = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    with np.load(folder / "final.npz") as final:
        position, velocity, wall = final["position"], final["velocity"], final["wall"]
    if not np.isfinite(position).all():
        raise ValueError("the run ended with positions that are not finite")
    neighbours = mean_neighbours(scene, position, wall)
    seconds, fluid = record["wall_seconds"], record["fluid"]
    evaluations = fluid * record["evaluations"] / seconds
    finished = record["end"] >= 0.99 * scene.until
    return Figures(
        particle_steps=fluid * record["steps"] / seconds,
        evaluations=evaluations,
        pairs=evaluations * neighbours,
        physical=record["physical_seconds"] / seconds,
        memory=record["peak_bytes"],
        neighbours=neighbours,
        fluid=fluid,
        wall=record["wall"],
        steps=record["steps"],
        error=error(scene, record, position, velocity) if finished else None,
    )


def mean_neighbours(scene: Scene, position: Array, wall: Array) -> float:
    """Mean number of neighbours of a fluid particle, fluid and wall, at the end of the run."""
    if scene.tank is None:
        tree = cKDTree(np.mod(position, 1.0), boxsize=1.0)
        return float(tree.count_neighbors(tree, scene.radius) / len(position) - 1.0)
    fluid = cKDTree(position)
    count = fluid.count_neighbors(fluid, scene.radius) / len(position) - 1.0
    if len(wall):
        count += fluid.count_neighbors(cKDTree(wall), scene.radius) / len(position)
    return float(count)


def error(
    scene: Scene, record: dict[str, object], position: Array, velocity: Array
) -> float | None:
    """Error of a finished run.

    Taylor-Green: relative L1 error of the velocity. Dam break: RMS error of the front.
    """
    if scene.tank is None:
        exact = vortex_velocity(position, float(str(record["end"])))
        wrong = np.linalg.norm(velocity - exact, axis=1).mean()
        return float(wrong / np.linalg.norm(exact, axis=1).mean())
    fronts = np.asarray(record["fronts"], dtype=np.float64)
    return front_error(fronts[:, 0], fronts[:, 1] + 0.5 * scene.spacing)


def front_error(time: Array, front: Array) -> float | None:
    """RMS distance in Z from Martin and Moyce's points, times aligned at Z = 1.44.

    The experiment's moment of release is unknown, hence the alignment.
    """
    scaled, reach = time * np.sqrt(2.0 * GRAVITY / COLUMN), front / COLUMN
    if reach.max() < ALIGNED or reach.min() > ALIGNED:
        return None
    shift = ALIGNED_TIME - scaled[np.argmax(reach >= ALIGNED)]
    measured = MARTIN_MOYCE[MARTIN_MOYCE[:, 0] <= scaled[-1] + shift]
    computed = np.interp(measured[:, 0], scaled + shift, reach)
    return float(np.sqrt(np.mean((computed - measured[:, 1]) ** 2)))
