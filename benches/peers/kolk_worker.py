"""Runs a scene with kolk through its public Python interface.

Variants: `mixed` and `f64`, the precision; `narrow-` in front of it takes SPlisHSPlasH's kernel
and support. Dam breaks: artificial viscosity and Fourtakas's density diffusion alone, as the peers
compute them. Taylor-Green: laminar viscosity, density diffusion and particle shifting.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scenes import Scene, make, vortex_pressure
from worker import FRONTS, WARM_UP, Clock, Job, Record, leave, parse_job, peak_bytes

import kolk


def as_kolk(scene: Scene) -> kolk.Scene:
    """The same scene in kolk's terms."""
    shared: dict[str, Any] = {
        "name": scene.name.replace(" ", "-").lower(),
        "dimension": scene.dimension,
        "spacing": scene.spacing,
        "smoothing_ratio": scene.smoothing_ratio,
        "kernel": scene.kernel,
        "until": scene.until,
    }
    return vortex(scene, shared) if scene.tank is None else dam_break(scene, scene.tank, shared)


def vortex(scene: Scene, shared: dict[str, Any]) -> kolk.Scene:
    water = kolk.Fluid.from_arrays(
        scene.fluid,
        scene.velocity,
        name="water",
        reference_density=scene.density,
        sound_speed=scene.sound_speed,
        viscosity={"laminar": scene.viscosity},
        pressure=vortex_pressure,
    )
    return kolk.Scene(
        **shared,
        periodic={"x": [0.0, 1.0], "y": [0.0, 1.0]},
        fluid=[water],
        numerics={"density_diffusion": "antuono", "shifting": "sun"},
    )


def dam_break(scene: Scene, tank: tuple[float, ...], shared: dict[str, Any]) -> kolk.Scene:
    """kolk fills the shapes with the lattice of `scenes`."""
    origin = [0.0] * scene.dimension
    water = {
        "name": "water",
        "shape": {"box": {"from": origin, "to": list(scene.box)}},
        "density": scene.density,
        "sound_speed": scene.sound_speed,
        "viscosity": {"artificial": scene.alpha},
    }
    walls = {"from": origin, "to": list(tank), "open": ["top"]}
    return kolk.Scene(
        **shared,
        gravity=[*origin[1:], -scene.gravity],
        fluid=[water],
        wall=[{"name": "tank", "shape": {"tank": walls}}],
        # What kolk would add by itself, and the peers do not have.
        numerics={"density_diffusion": "fourtakas", "shifting": "none", "acoustic_damper": 0.0},
    )


def evaluations(sim: kolk.Simulation) -> int:
    """Force evaluations so far: calls of the sweep that sums the forces."""
    return int(sim.timings["forces"]["calls"])


def run_steps(sim: kolk.Simulation, scene: Scene, job: Job, clock: Clock) -> float:
    """Takes the job's steps; returns the force evaluations in the timed ones."""
    sim.advance_to(scene.until, max_steps=WARM_UP)
    before = evaluations(sim)
    clock.start(sim.time)
    clock.steps = sim.advance_to(scene.until, max_steps=job.steps)
    return evaluations(sim) - before


def run_to_end(sim: kolk.Simulation, scene: Scene, clock: Clock) -> float:
    """Runs to the scene's end, sampling the front; returns the force evaluations."""
    clock.start(0.0)
    for sample in range(1, FRONTS + 1):
        sim.advance_to(scene.until * sample / FRONTS)
        if scene.tank is not None:
            clock.fronts.append((sim.time, float(sim.bodies["water"].position[:, 0].max())))
    clock.steps = sim.step_count
    return evaluations(sim)


def main() -> None:
    job = parse_job()
    narrow, _, precision = job.variant.rpartition("-")
    scene = make(job.scene, job.cells, narrow=bool(narrow))
    sim = kolk.Simulation(as_kolk(scene), precision=precision, threads=job.threads)
    clock = Clock()
    done = run_steps(sim, scene, job, clock) if job.steps else run_to_end(sim, scene, clock)
    seconds = clock.seconds()
    water = sim.bodies["water"]
    walls = [sim.bodies[name].position for name in sim.bodies if name != "water"]
    wall = np.concatenate(walls) if walls else scene.wall
    record = Record(
        version=kolk.__version__,
        fluid=len(water.position),
        wall=len(wall),
        steps=clock.steps,
        evaluations=done,
        wall_seconds=seconds,
        physical_seconds=sim.time - clock.time_at_start,
        end=sim.time,
        peak_bytes=peak_bytes(),
        fronts=clock.fronts,
    )
    leave(job, record, water.position, water.velocity, wall)


if __name__ == "__main__":
    main()
