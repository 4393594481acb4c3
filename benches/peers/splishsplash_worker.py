"""Runs a scene with SPlisHSPlasH through its Python bindings, whose wheel computes in f32.

Variants: `wcsph` (the equation of state, sound speed and acoustic time step of the other codes, the
step fixed) and `dfsph` (its incompressible solver with its own time step: what its users would
take). SPlisHSPlasH ties the support to the particle's volume: the radius is chosen so that the
volume is the lattice's, and the support follows (`narrow` in scenes.py). Walls: one layer of
samples (Akinci et al. 2012), about where the others have their first. There are no periodic
boundaries, so no Taylor-Green vortex.
"""

from __future__ import annotations

import importlib.metadata
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pysplishsplash as sph
from scenes import Array, Scene, make
from worker import FRONTS, WARM_UP, Clock, Job, Record, leave, parse_job, peak_bytes

GAP = 0.11  # at which the first layer beside a plane wall has the density of the lattice

CUBE = (
    "v -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 .5 -.5\nv -.5 .5 -.5\n"
    "v -.5 -.5 .5\nv .5 -.5 .5\nv .5 .5 .5\nv -.5 .5 .5\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
    "f 4 7 3\nf 4 8 7\nf 1 5 8\nf 1 8 4\nf 2 3 7\nf 2 7 6\n"
)


def upright(position: Array) -> Array:
    """Positions in SPlisHSPlasH's axes (n, 3): gravity along -y, z = 0 in 2D."""
    if position.shape[1] == 2:
        return np.column_stack([position, np.zeros(len(position))])
    return position[:, [0, 2, 1]]


def write_bgeo(path: Path, position: Array) -> None:
    """Points in Houdini's old big-endian format, which SPlisHSPlasH reads."""
    header = struct.pack(">4sc9i", b"Bgeo", b"V", 5, len(position), 0, 0, 0, 0, 0, 0, 0)
    points = np.ones((len(position), 4), dtype=">f4")
    points[:, :3] = position
    path.write_bytes(header + points.tobytes() + b"\x00\xff")


def set_back(wall: Array, tank: tuple[float, ...], spacing: float) -> Array:
    """Wall samples moved outwards by `GAP` spacings.

    A single layer stands for the whole wall, so its samples weigh about 1.5 lattice cells. A fluid
    lattice one spacing away would start compressed by several per cent and burst.
    """
    outwards = (wall > np.asarray(tank)).astype(np.float64) - (wall < 0.0)
    return wall + GAP * spacing * outwards


def artificial_as_kinematic(scene: Scene) -> float:
    """Kinematic viscosity (m²/s) that matches Monaghan's alpha: alpha c h / (2 (D + 2))."""
    return scene.alpha * scene.sound_speed * scene.h / (2 * (scene.dimension + 2))


def scene_file(scene: Scene, job: Job, wall: Array) -> Path:
    """Writes the scene in SPlisHSPlasH's format, and the particles beside it."""
    folder = job.folder
    write_bgeo(folder / "fluid.bgeo", upright(scene.fluid))
    write_bgeo(folder / "wall.bgeo", upright(wall))
    (folder / "cube.obj").write_text(CUBE, encoding="ascii")
    acoustic = 0.25 * scene.h / scene.sound_speed
    weakly = job.variant == "wcsph"
    configuration: dict[str, Any] = {
        "sim2D": scene.dimension == 2,
        "particleRadius": scene.radius / 4,
        "simulationMethod": 0 if weakly else 4,
        "gravitation": [0, -scene.gravity, 0],
        "timeStepSize": acoustic if weakly else 0.0005,
        "cflMethod": 0 if weakly else 1,
        "cflFactor": 1,
        "cflMaxTimeStepSize": 0.001,
        "boundaryHandlingMethod": 0,
        "enableZSort": True,
        "WCSPH": {
            "stiffness": scene.density * scene.sound_speed**2 / 7.0,
            "exponent": 7,
        },
    }
    content = {
        "Configuration": configuration,
        "Materials": [
            {
                "id": "Fluid",
                "density0": scene.density,
                "viscosityMethod": 1,
                "Standard viscosity": {
                    "viscosity": artificial_as_kinematic(scene),
                    "viscosityBoundary": 0.0,
                },
            }
        ],
        "FluidModels": [{"particleFile": str(folder / "fluid.bgeo"), "id": "Fluid"}],
        "RigidBodies": [
            {
                "geometryFile": str(folder / "cube.obj"),
                "particleFile": "wall.bgeo",  # always taken as relative to the scene
                "translation": [0, 0, 0],
                "scale": [1, 1, 1],
                "isDynamic": False,
                "isWall": True,
            }
        ],
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


class Run:
    """A SPlisHSPlasH simulation without its window."""

    def __init__(self, scene: Scene, job: Job, wall: Array) -> None:
        self.scene = scene
        self.job = job
        self.clock = Clock()
        self.evaluations = 0.0
        self.total = 0
        self.base = sph.Exec.SimulatorBase()
        self.base.init(
            sceneFile=str(scene_file(scene, job, wall)),
            useGui=False,
            useCache=False,
            initialPause=False,
            outputDir=str(job.folder / "splishsplash"),
        )
        self.base.initSimulation()
        self.base.setValueFloat(self.base.STOP_AT, scene.until)
        self.base.setTimeStepCB(self.after_step)
        self.simulation = sph.Simulation.getCurrent()
        self.model = self.simulation.getFluidModel(0)
        self.time = sph.TimeManager.getCurrent()

    def field(self, name: str) -> Array:
        """A vector field of the fluid (n, D) in the scene's axes."""
        raw = np.array(self.model.getFieldBuffer(name), dtype=np.float64).reshape(-1, 3)
        columns = [0, 1] if self.scene.dimension == 2 else [0, 2, 1]
        return raw[: self.model.numActiveParticles(), columns]  # the rest waits for emitters

    def iterations(self) -> float:
        """Sums over all pairs in the last step: one, and one an iteration of a pressure solver."""
        if self.job.variant == "wcsph":
            return 1.0
        step = self.simulation.getTimeStep()
        pressure = step.getValueUInt(step.SOLVER_ITERATIONS)
        divergence = step.getValueUInt(step.SOLVER_ITERATIONS_V)
        return 1.0 + float(pressure) + float(divergence)

    def after_step(self) -> None:
        """Counts a step; the first steps are not timed where the number of steps is given."""
        now = self.time.getTime()
        self.total += 1
        self.clock.steps += 1
        self.evaluations += self.iterations()
        if self.job.steps and self.total == WARM_UP:
            self.evaluations = 0.0
            self.clock.start(now)
        fronts = self.clock.fronts
        if now >= len(fronts) * self.scene.until / FRONTS:
            fronts.append((now, float(self.field("position")[:, 0].max())))
        if self.job.steps and self.total == WARM_UP + self.job.steps:
            self.base.setValueFloat(self.base.STOP_AT, now)  # the next step is the last

    def advance(self) -> None:
        self.clock.start(0.0)
        self.base.runSimulation()


def main() -> None:
    job = parse_job()
    scene = make(job.scene, job.cells, narrow=True)
    lattice = make(job.scene, job.cells, narrow=True, layers=1).wall
    assert scene.tank is not None, "SPlisHSPlasH has no periodic boundaries"
    wall = set_back(lattice, scene.tank, scene.spacing)
    run = Run(scene, job, wall)
    run.advance()
    seconds = run.clock.seconds()
    position, velocity = run.field("position"), run.field("velocity")
    record = Record(
        version=importlib.metadata.version("pysplishsplash"),
        fluid=len(position),
        wall=len(wall),
        steps=run.clock.steps,
        evaluations=run.evaluations,
        wall_seconds=seconds,
        physical_seconds=run.time.getTime() - run.clock.time_at_start,
        end=run.time.getTime(),
        peak_bytes=peak_bytes(),
        fronts=run.clock.fronts,
    )
    leave(job, record, position, velocity, wall)


if __name__ == "__main__":
    main()
