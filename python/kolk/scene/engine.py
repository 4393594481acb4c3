"""The scene in the engine's words: resolved numbers only, no "auto"."""

from __future__ import annotations

from typing import Any

from .model import Scene
from .motion import Gravity


def engine_config(scene: Scene) -> dict[str, Any]:
    """The engine's configuration as a JSON-ready dict."""
    fluid, numerics = scene.fluid[0], scene.numerics
    viscosity = fluid.viscosity
    artificial = laminar = None
    if viscosity is not None and viscosity.artificial is not None:
        artificial = {"alpha": viscosity.artificial, "beta": viscosity.beta}
    if viscosity is not None and viscosity.laminar is not None:
        # Morris' form loses half of the dissipation under a free surface, and is the better one
        # between walls (Colagrossi et al., Phys. Rev. E 84 (2011) 026705).
        # Morris' form does not keep angular momentum: on a wall that turns it would give the torque
        # of the gradient of the velocity, to which a rigid rotation contributes.
        turning = any(w.motion is not None and w.motion.turns for w in scene.wall)
        form = "monaghan-gingold" if scene.free_surface or turning else "morris"
        laminar = {"kinematic": viscosity.laminar, "form": form}
    diffusion = shifting = None
    wall: dict[str, Any] | None = None
    if numerics.density_diffusion != "none":
        diffusion = {"form": numerics.density_diffusion, "delta": numerics.delta}
    shift = numerics.shifting
    if shift == "auto":
        shift = "sun"
    if shift != "none":
        shifting = {"form": shift, "free_surface": scene.free_surface}
    damper = numerics.acoustic_damper
    if damper == "auto":
        damper = 0.3 if scene.free_surface else 0.0
    if scene.wall:
        wall = {"method": numerics.wall, "slip": scene.wall[0].slip}
        wall["suction"] = not scene.free_surface
    gravity: Any = scene.gravity
    varying: list[dict[str, Any]] = []
    if isinstance(gravity, Gravity):
        varying, gravity = gravity.engine(), gravity.base
    return {
        "dimension": scene.dimension,
        "spacing": scene.spacing,
        "smoothing_length": scene.smoothing_length,
        "kernel": scene.kernel,
        "gravity": None if gravity is None else list(gravity),
        "gravity_over_time": varying,
        "motion": [
            {"body": w.name, "parts": w.motion.engine(scene.dimension)}
            for w in scene.wall
            if w.motion is not None
        ],
        "periodic": [None if p is None else list(p) for p in scene.periodic_axes],
        "reference_density": fluid.density,
        "sound_speed": scene.sound_speed,
        "eos": fluid.eos,
        "gamma": fluid.gamma,
        "background_pressure": numerics.background_pressure,
        "artificial_viscosity": artificial,
        "laminar_viscosity": laminar,
        "density_diffusion": diffusion,
        "acoustic_damper": damper or None,
        "shifting": shifting,
        "wall": wall,
        "courant": numerics.courant,
        "time_step": numerics.time_step,
    }
