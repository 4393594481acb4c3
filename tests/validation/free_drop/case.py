"""Momentum of a free drop: what pairs exchange must cancel to round-off."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

import kolk

from ..running import FloatArray, counts, simulation
from ..suite import Case, Figure, Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

STEPS = 1000
BOUND = 1e-12


def scene(resolution: int, dimension: int) -> kolk.Scene:
    """A disc or ball of radius 1 m that flies, spins and stretches, its particles jittered."""
    flow = ["5 - 3*y - 2*x", "2 + 3*x + 2*y"]
    return kolk.Scene(
        name="free-drop",
        dimension=dimension,
        spacing=1.0 / resolution,
        until=1.0,
        fluid=[
            {
                "name": "drop",
                "shape": {"sphere": {"centre": [0.0] * dimension, "radius": 1.0}},
                "velocity": flow if dimension == 2 else [*flow, "1 + 2*x - y"],
                "sound_speed": 100.0,
                "viscosity": {"artificial": 0.05},
                "jitter": 0.1,
                "seed": 1,
            }
        ],
    )


def sums(sim: kolk.Simulation) -> tuple[FloatArray, FloatArray]:
    """Momentum (D,) in kg m/s and angular momentum (1,) or (3,) about the origin in kg m²/s."""
    drop = sim.bodies["drop"]
    momentum = drop.mass[:, None] * drop.velocity
    return momentum.sum(axis=0), np.atleast_1d(_cross(drop.position, momentum).sum(axis=0))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    if a.shape[1] == 2:
        return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return np.cross(a, b)


def drift(
    resolution: int,
    dimension: int,
    precision: Literal["f64", "mixed"] = "f64",
    shifting: str = "auto",
) -> tuple[float, float, kolk.Simulation]:
    """Change of momentum over Σ m|u|, of angular momentum over Σ m|x||u|, after `STEPS` steps."""
    chosen = scene(resolution, dimension).replace({"numerics.shifting": shifting})
    sim = simulation(chosen, precision)
    drop = sim.bodies["drop"]
    speed = np.linalg.norm(drop.velocity, axis=1)
    reach = np.linalg.norm(drop.position, axis=1)
    before = sums(sim)
    sim.advance_to(1e3, max_steps=STEPS)
    after = sums(sim)
    assert sim.step_count == STEPS
    linear = np.abs(after[0] - before[0]).max() / (drop.mass * speed).sum()
    angular = np.abs(after[1] - before[1]).max() / (drop.mass * speed * reach).sum()
    return float(linear), float(angular), sim


def run(resolution: int) -> Level:
    figures = []
    for dimension, cells in ((2, resolution), (3, resolution // 2)):
        linear, angular, sim = drift(cells, dimension)
        figures += [
            Figure(f"momentum, {dimension}D, share of Σ m|u|", linear, BOUND),
            Figure(f"angular momentum, {dimension}D, share of Σ m|x||u|", angular, BOUND),
        ]
    linear, angular, flat = drift(resolution, 2, "mixed")
    figures += [
        Figure("momentum, 2D, mixed precision", linear),
        Figure("angular momentum, 2D, mixed precision", angular),
    ]
    linear, angular, _ = drift(resolution, 2, shifting="none")
    figures += [
        Figure("momentum, 2D, without particle shifting", linear, BOUND),
        Figure("angular momentum, 2D, without particle shifting", angular, BOUND),
    ]
    return Level(
        resolution, tuple(figures), **counts(sim), curves={"drop": flat.bodies["drop"].arrays()}
    )


def draw(levels: Sequence[Level], canvas: Canvas) -> None:
    axes = canvas.subplots()
    drop = levels[-1].curves["drop"]
    speed = np.linalg.norm(drop["velocity"] - drop["velocity"].mean(axis=0), axis=1)
    points = axes.scatter(*drop["position"].T, c=speed, s=6.0)
    canvas.colorbar(points, label="speed relative to the drop's mean, m/s")
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m", title=f"The drop after {STEPS} steps")


case = Case(
    title="Free drop: momentum",
    setup="A disc and a ball of radius 1 m that fly, spin and stretch, from jittered particles, "
    f"with artificial viscosity, density diffusion and particle shifting, for {STEPS} steps in "
    "f64. A shift moves particles and leaves them their velocities: of a fluid that nothing holds, "
    "it is freed of what it would add to the angular momentum.",
    reference="Linear and angular momentum do not change: the largest component of their change.",
    unit="R/Δp in 2D (half of it in 3D)",
    short=(20,),
    full=(20,),
    run=run,
    draw=draw,
)
