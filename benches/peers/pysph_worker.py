"""Runs a scene with PySPH, set as PySPH's own examples set it.

Dam breaks: `WCSPHScheme` with the Hughes-Graham correction and an adaptive time step; the PEC
integrator (one evaluation a step) in 2D and EPEC (two) in 3D, as in `dam_break_2d` and
`dam_break_3d`. Taylor-Green: of the schemes of `taylor_green`, `EDACScheme` with a
background pressure, which reaches the smallest error. All in f64, with OpenMP.
"""

from __future__ import annotations

import importlib.metadata
import sys
from typing import Any

import numpy as np
from pysph.base.kernels import QuinticSpline, WendlandQuintic
from pysph.base.nnps import DomainManager
from pysph.base.utils import get_particle_array
from pysph.solver.application import Application
from pysph.sph.integrator import EPECIntegrator, PECIntegrator
from pysph.sph.scheme import WCSPHScheme
from pysph.sph.wc.edac import EDACScheme
from scenes import Array, Scene, make, vortex_pressure
from worker import FRONTS, WARM_UP, Clock, Job, Record, leave, parse_job, peak_bytes


class Run(Application):
    """The scene as a PySPH application."""

    def __init__(self, scene: Scene, job: Job) -> None:
        self.scene = scene
        self.job = job
        self.clock = Clock()
        self.evaluations = 0
        super().__init__(output_dir=str(job.folder / "pysph"))

    def create_scheme(self) -> Any:
        s = self.scene
        if s.tank is None:
            return EDACScheme(
                ["fluid"],
                [],
                dim=2,
                rho0=s.density,
                c0=s.sound_speed,
                nu=s.viscosity,
                pb=s.density * s.sound_speed**2,
                h=s.h,
            )
        pull = {"gz" if s.dimension == 3 else "gy": -s.gravity}
        return WCSPHScheme(
            ["fluid"],
            ["wall"],
            dim=s.dimension,
            rho0=s.density,
            c0=s.sound_speed,
            h0=s.h,
            hdx=s.smoothing_ratio,
            alpha=s.alpha,
            beta=0.0,
            gamma=7.0,
            hg_correction=True,
            **pull,
        )

    def configure_scheme(self) -> None:
        s = self.scene
        if s.tank is None:
            step = min(0.25 * s.h / (s.sound_speed + 1.0), 0.125 * s.h**2 / s.viscosity)
            settings: dict[str, Any] = {"kernel": QuinticSpline(dim=2), "dt": step}
        elif s.dimension == 2:
            settings = {
                "kernel": WendlandQuintic(dim=2),
                "integrator_cls": PECIntegrator,
                "dt": 0.125 * s.h / s.sound_speed,
                "adaptive_timestep": True,
                "n_damp": self.damped_steps(),
            }
        else:
            settings = {
                "kernel": WendlandQuintic(dim=3),
                "integrator_cls": EPECIntegrator,
                "dt": 0.25 * s.h / (1.1 * s.sound_speed),
                "adaptive_timestep": True,
                "n_damp": self.damped_steps(),
            }
        self.scheme.configure_solver(tf=s.until, **settings)

    def damped_steps(self) -> int:
        """The examples ramp the time step up over 50 steps; a short run for speed does not."""
        return 0 if self.job.steps else 50

    def create_domain(self) -> DomainManager | None:
        if self.scene.tank is not None:
            return None
        return DomainManager(xmin=0, xmax=1, ymin=0, ymax=1, periodic_in_x=True, periodic_in_y=True)

    def create_particles(self) -> list[Any]:
        s = self.scene
        arrays = [self.array("fluid", s.fluid, s.velocity)]
        if len(s.wall):
            arrays.append(self.array("wall", s.wall, np.zeros_like(s.wall)))
        self.scheme.setup_properties(arrays)
        if s.tank is None:
            arrays[0].p[:] = vortex_pressure(s.fluid)
        return arrays

    def array(self, name: str, position: Array, velocity: Array) -> Any:
        s = self.scene
        axes = {axis: position[:, i].copy() for i, axis in enumerate("xyz"[: s.dimension])}
        speeds = {axis: velocity[:, i].copy() for i, axis in enumerate("uvw"[: s.dimension])}
        return get_particle_array(name=name, m=s.mass, h=s.h, rho=s.density, **axes, **speeds)

    def count_evaluations(self) -> None:
        """Counts the calls of the integrator's force evaluation."""
        integrator = self.solver.integrator
        original = integrator.compute_accelerations

        def counted(*args: Any, **kwargs: Any) -> None:
            self.evaluations += 1
            original(*args, **kwargs)

        integrator.compute_accelerations = counted

    def pre_step(self, solver: Any) -> None:
        if solver.count == (WARM_UP if self.job.steps else 0):
            self.evaluations = 0
            self.clock.start(solver.t)

    def post_step(self, solver: Any) -> None:
        self.clock.steps += 1
        front = self.clock.fronts
        now = solver.t + solver.dt
        if self.scene.tank is not None and now >= len(front) * self.scene.until / FRONTS:
            front.append((now, float(solver.particles[0].x.max())))


def main() -> None:
    job = parse_job()
    scene = make(job.scene, job.cells)
    arguments = ["--openmp", "--disable-output"]
    if job.steps:
        arguments += ["--max-steps", str(job.steps + WARM_UP)]
    sys.argv = ["pysph", *arguments]  # PySPH reads it when the application is made
    app = Run(scene, job)
    app.setup()
    app.count_evaluations()
    app.solver.solve(show_progress=False)
    seconds = app.clock.seconds()
    fluid = app.solver.particles[0]
    real = fluid.num_real_particles
    axes = "xyz"[: scene.dimension]
    position = np.stack([getattr(fluid, axis)[:real] for axis in axes], axis=1)
    speeds = "uvw"[: scene.dimension]
    velocity = np.stack([getattr(fluid, axis)[:real] for axis in speeds], axis=1)
    record = Record(
        version=importlib.metadata.version("pysph"),
        fluid=real,
        wall=len(scene.wall),
        steps=app.clock.steps,
        evaluations=app.evaluations,
        wall_seconds=seconds,
        physical_seconds=float(app.solver.t - app.clock.time_at_start),
        end=float(app.solver.t),
        peak_bytes=peak_bytes(),
        fronts=app.clock.fronts,
    )
    leave(job, record, position, velocity, scene.wall)


if __name__ == "__main__":
    main()
