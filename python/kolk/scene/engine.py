"""The scene in the engine's words: resolved numbers only, no "auto"."""

from __future__ import annotations

from typing import Any

from . import automatic
from .model import Scene
from .motion import Gravity


def engine_config(scene: Scene) -> dict[str, Any]:
    """The engine's configuration as a JSON-ready dict."""
    fluid, numerics = scene.fluid[0], scene.numerics
    viscosity = fluid.viscosity
    artificial = laminar = yielding = turbulence = None
    alpha = automatic.artificial(scene)
    if alpha is not None:
        beta = 0.0 if viscosity is None else viscosity.beta
        artificial = {"alpha": alpha.value, "beta": beta}
    if viscosity is not None and viscosity.laminar is not None:
        form = automatic.laminar_form(scene)
        assert form is not None, "there is a laminar viscosity"
        laminar = {"kinematic": viscosity.laminar, "form": form.value}
    if viscosity is not None and viscosity.herschel_bulkley is not None:
        yielding = viscosity.herschel_bulkley.model_dump()
    if viscosity is not None and viscosity.turbulence is not None:
        turbulence = {"smagorinsky": viscosity.turbulence}
    diffusion = shifting = None
    wall: dict[str, Any] | None = None
    form_of_diffusion = automatic.density_diffusion(scene).value
    if form_of_diffusion != "none":
        diffusion = {"form": form_of_diffusion, "delta": numerics.delta}
    if (own := automatic.diffusion_of_scheme(scene)) is not None:
        diffusion = {"form": own[0], "delta": own[1]}
    tensile: dict[str, Any] | None = None
    form_of_remedy = automatic.tensile_control(scene).value
    if form_of_remedy != "none":
        tensile = {"form": form_of_remedy, "free_surface": scene.free_surface}
    form_of_shift = automatic.shifting(scene).value
    if form_of_shift != "none":
        shifting = {
            "form": form_of_shift,
            "free_surface": scene.free_surface,
            "every": numerics.shifting_interval,
        }
    method, suction = automatic.wall(scene), automatic.suction(scene)
    if method is not None and suction is not None:
        wall = {"method": method.value, "slip": scene.wall[0].slip, "suction": suction.value}
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
        "turbulence": turbulence,
        "herschel_bulkley": yielding,
        "surface_tension": fluid.surface_tension,
        "linear_drag": fluid.drag,
        "density_diffusion": diffusion,
        "acoustic_damper": automatic.acoustic_damper(scene).value or None,
        "shifting": shifting,
        "riemann_viscosity": automatic.scheme(scene).value == "riemann",
        "tensile_control": tensile,
        "wall": wall,
        "integrator": automatic.integrator(scene).value,
        "courant": numerics.courant,
        "time_step": numerics.time_step,
        "guard": numerics.guard == "on",
    }
