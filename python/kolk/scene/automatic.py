"""What a scene leaves to kolk, and what kolk makes of it: value and reason of every choice.

The one place that resolves "auto" and keys that are absent: the engine's configuration takes the
values from here, and the summary, `kolk check` and `kolk explain` the reasons.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .model import Scene


@dataclass(frozen=True)
class Choice:
    """One key of the scene, resolved."""

    key: str
    value: str | float | bool
    automatic: bool
    """Whether kolk chose it; else the scene says so."""
    reason: str
    """Why this value; empty where the scene says so."""

    def __str__(self) -> str:
        value = f"{self.value:.4g}" if isinstance(self.value, float) else str(self.value).lower()
        return f"{self.key} = {value}" + (f": {self.reason}" if self.reason else "")


def _given(key: str, value: str | float | bool) -> Choice:
    return Choice(key, value, False, "")


def free_surface(scene: Scene) -> Choice:
    """Whether the fluid has a free surface: decides how shifting, walls and viscosity treat it."""
    key = "numerics.free_surface"
    if scene.numerics.free_surface is not None:
        return _given(key, scene.numerics.free_surface)
    if scene.weight.any():
        return Choice(key, True, True, "gravity acts across no period: fluid has a top")
    if any(interval is None for interval in scene.periodic_axes) and not scene.wall:
        return Choice(key, True, True, "there is no wall around the fluid")
    held = "walls" if scene.wall else "periods"
    return Choice(key, False, True, f"no gravity pulls it down, and {held} hold the fluid")


def kernel(scene: Scene) -> Choice:
    """The smoothing kernel."""
    key = "kernel"
    if key in scene.model_fields_set:
        return _given(key, scene.kernel)
    if free_surface(scene).value:
        return Choice(key, "wendland-c2", True, "the least error for its time at a free surface")
    if any(fluid.arrangement == "packed" for fluid in scene.fluid):
        return Choice(key, "wendland-c2", True, "the one for which particles are packed evenly")
    viscosity = scene.fluid[0].viscosity
    if viscosity is not None and viscosity.herschel_bulkley is not None:
        reason = "misses less of the shear between rows that slide along a plug"
        return Choice(key, "wendland-c2", True, reason)
    reason = "smooths less on the same neighbours: a quarter less error inside a fluid"
    return Choice(key, "wendland-c4", True, reason)


def scheme(scene: Scene) -> Choice:
    """The weakly compressible scheme."""
    key = "numerics.scheme"
    given = scene.numerics.scheme
    if given != "auto":
        return _given(key, given)
    return Choice(key, "delta-sph", True, "the least error for its time")


def diffusion_of_scheme(scene: Scene) -> tuple[str, float] | None:
    """Form and coefficient of the density diffusion that the scheme brings along, if it does."""
    chosen = scheme(scene).value
    if chosen == "edac":
        # Ramachandran & Puri, Comput. Fluids 179 (2019): nu = alpha h c / 8 with alpha = 0.5, which
        # is Molteni's form with delta = alpha / 8. Under weight that would smooth the hydrostatic
        # pressure away at the surface: there of what is beyond it.
        return ("fourtakas" if scene.weight.any() else "molteni"), 0.5 / 8.0
    if chosen == "riemann":
        # Zhang, Hu & Adams, J. Comput. Phys. 335 (2017): the whole difference of the states.
        return "riemann", 1.0
    return None


def density_diffusion(scene: Scene) -> Choice:
    """The form of density diffusion, or "none"."""
    key = "numerics.density_diffusion"
    if (own := diffusion_of_scheme(scene)) is not None:
        return Choice(key, own[0], True, f'that of numerics.scheme = "{scheme(scene).value}"')
    given = scene.numerics.density_diffusion
    if given != "auto":
        return _given(key, given)
    if not free_surface(scene).value and not scene.weight.any():
        reason = "without weight and surface no gradient is needed: less error and time"
        return Choice(key, "molteni", True, reason)
    return Choice(
        key,
        "antuono",
        True,
        "keeps pressure free of noise and leaves water at rest alone, up to the free surface",
    )


def shifting(scene: Scene) -> Choice:
    """The form of particle shifting, or "none"."""
    key = "numerics.shifting"
    given = scene.numerics.shifting
    if given != "auto":
        return _given(key, given)
    if scene.fluid[0].surface_tension is not None:
        reason = "a shift through the surface would work against its tension and drive the flow"
        return Choice(key, "gentle", True, reason)
    if free_surface(scene).value:
        reason = "keeps stretched tongues of fluid from breaking up, and leaves the surface alone"
    elif scene.wall and not any(scene.periodic_axes):
        reason = "takes velocity along: half the error where a flow turns round between walls"
        return Choice(key, "consistent", True, reason)
    else:
        reason = "keeps particles evenly spread where pressure turns negative"
    return Choice(key, "sun", True, reason)


def tensile_control(scene: Scene) -> Choice:
    """What keeps fluid under tension from clumping, or "none". Fills the scene with particles."""
    key = "numerics.tensile_control"
    given = scene.numerics.tensile_control
    if given != "auto":
        return _given(key, given)
    if free_surface(scene).value:
        reason = "fluid with a free surface gives way to tension"
        return Choice(key, "none", True, reason)
    if scene.numerics.wall in FACETS:
        return Choice(key, "none", True, "walls without particles leave nothing to take it off")
    from .material import pressure_at

    fluids = [b for b in scene.filling.bodies if b.kind == "fluid"]
    fastest = max(float(np.max(np.sum(b.velocity**2, axis=1), initial=0.0)) for b in fluids)
    expected = max(scene.filling.expected_speed, scene.numerics.expected_speed or 0.0) ** 2
    rest = scene.fluid[0].density
    # The second term is rounding of the density.
    bound = rest * max(fastest, expected) + 1e-6 * rest * scene.sound_speed**2
    least = float(
        pressure_at(
            np.array([min(float(b.density.min()) for b in fluids)]),
            reference_density=rest,
            sound_speed=scene.sound_speed,
            eos=scene.fluid[0].eos,
            gamma=scene.fluid[0].gamma,
            background_pressure=scene.numerics.background_pressure,
        )[0]
    )
    if least < -bound:
        return Choice(key, "sun", True, f"the fluid starts under a tension of {-least:.3g} Pa")
    reason = "no more tension at the start than motion makes, which shifting copes with"
    return Choice(key, "none", True, reason)


FACETS = ("semi-analytical", "penalty", "mirror")
"""Methods of walls that have no particles."""


def acoustic_damper(scene: Scene) -> Choice:
    """Bulk viscosity that takes up sound, over h c0; 0 for none."""
    key = "numerics.acoustic_damper"
    given = scene.numerics.acoustic_damper
    if given != "auto":
        return _given(key, float(given))
    if free_surface(scene).value:
        return Choice(key, 0.3, True, "impacts under a free surface make sound")
    return Choice(key, 0.0, True, "without a free surface nothing strikes and makes sound")


ORDERING = 0.05
"""Artificial viscosity of a liquid with surface tension where the scene names none."""


def artificial(scene: Scene) -> Choice | None:
    """The coefficient of the artificial viscosity; None without it."""
    fluid = scene.fluid[0]
    key = f"fluid.{fluid.name}.viscosity.artificial"
    if fluid.viscosity is not None and fluid.viscosity.artificial is not None:
        return _given(key, float(fluid.viscosity.artificial))
    if fluid.surface_tension is None or scheme(scene).value == "riemann":
        return None
    reason = "under surface tension nothing else takes up what disorders a surface; 0 turns it off"
    return Choice(key, ORDERING, True, reason)


def added_viscosity(scene: Scene) -> Choice | None:
    """The artificial viscosity that kolk adds; None where the scene names one or needs none."""
    choice = artificial(scene)
    return choice if choice is not None and choice.automatic else None


def laminar_form(scene: Scene) -> Choice | None:
    """The form of the laminar viscosity; None without it."""
    viscosity = scene.fluid[0].viscosity
    if viscosity is None or viscosity.laminar is None:
        return None
    key = f"fluid.{scene.fluid[0].name}.viscosity.laminar"
    # Colagrossi et al., Phys. Rev. E 84 (2011) 026705.
    if free_surface(scene).value:
        reason = "dissipates what it should under a free surface, where Morris' form loses half"
        return Choice(f"{key} (form)", "monaghan-gingold", True, reason)
    if any(wall.motion is not None and wall.motion.turns for wall in scene.wall):
        # Morris' form does not keep angular momentum: on a wall that turns it would give the torque
        # of the gradient of the velocity, to which a rigid rotation contributes.
        reason = "keeps angular momentum, hence gives the torque on a wall that turns"
        return Choice(f"{key} (form)", "monaghan-gingold", True, reason)
    reason = "the more exact one where no surface is free"
    return Choice(f"{key} (form)", "morris", True, reason)


def wall(scene: Scene) -> Choice | None:
    """The boundary method; None without walls."""
    if not scene.wall:
        return None
    key = "numerics.wall"
    given = scene.numerics.wall
    if given != "auto":
        return _given(key, given)
    reason = "pressure at the wall from the fluid before it: any shape, no penetration"
    return Choice(key, "adami", True, reason)


def suction(scene: Scene) -> Choice | None:
    """Whether walls may pull at the fluid; None without walls."""
    if not scene.wall:
        return None
    key = "walls may pull"
    if free_surface(scene).value:
        return Choice(key, False, True, "fluid under a free surface lets go of a wall")
    return Choice(key, True, True, "a fluid that fills its space cannot leave a wall")


def smoothing_ratio(scene: Scene) -> Choice:
    """Smoothing length over spacing."""
    key = "smoothing_ratio"
    assert scene.smoothing_ratio is not None, "resolved when the scene is made"
    if "smoothing_ratio" in scene.model_fields_set:
        return _given(key, scene.smoothing_ratio)
    reason = "smaller ones resist shear like a solid"
    if scene.dimension == 3:
        reason += "; larger ones cost more than they gain in 3D"
    return Choice(key, scene.smoothing_ratio, True, reason)


COURANT = {"symplectic": 0.5, "predictor-corrector": 0.4, "rk2": 0.2, "rk4": 0.7}
"""Courant number of each integrator where the scene names none: the engine's own."""


def integrator(scene: Scene) -> Choice:
    """The integrator in time."""
    key = "numerics.integrator"
    given = scene.numerics.integrator
    if given != "auto":
        return _given(key, given)
    reason = "one evaluation a step, and sound neither grows nor decays by it"
    return Choice(key, "symplectic", True, reason)


def courant(scene: Scene) -> Choice:
    """What sets the time step: a fixed one, a Courant number, or the integrator's own."""
    numerics = scene.numerics
    if numerics.time_step is not None:
        return _given("numerics.time_step", numerics.time_step)
    if numerics.courant is not None:
        return _given("numerics.courant", numerics.courant)
    reason = "what the integrator bears, less a margin"
    return Choice("numerics.courant", COURANT[str(integrator(scene).value)], True, reason)


def sound_speed(scene: Scene) -> Choice:
    """The speed of sound in m/s: what it was chosen from. Fills the scene with particles."""
    fluid = scene.fluid[0]
    key = f"fluid.{fluid.name}.sound_speed"
    if fluid.sound_speed != "auto":
        return _given(key, scene.sound_speed)
    from .fill import capillary_speed, fall_height

    filling = scene.filling
    speed = filling.expected_speed
    fall = 0.0
    positions = [b.position for b in filling.bodies if b.kind == "fluid"]
    strength = float(np.linalg.norm(scene.weight))
    if strength > 0.0:
        fall = fall_height(scene, positions)
    capillary = capillary_speed(scene, positions)
    if fall > 0.0 and abs(2.0 * np.sqrt(strength * fall) - speed) <= 1e-9 * speed:
        source = f"2 sqrt(g H) of a front that collapses through H = {fall:.4g} m"
    elif capillary > 0.0 and abs(capillary - speed) <= 1e-9 * speed:
        source = "sqrt(2 p/rho) of the capillary pressure in the thinnest fluid"
    elif scene.numerics.expected_speed == speed:
        source = "numerics.expected_speed"
    else:
        source = "the fastest that the scene starts or moves with"
    return Choice(key, scene.sound_speed, True, f"ten times {speed:.4g} m/s, {source}")


CHOICES: tuple[Callable[[Scene], Choice | None], ...] = (
    free_surface,
    kernel,
    smoothing_ratio,
    scheme,
    density_diffusion,
    shifting,
    tensile_control,
    acoustic_damper,
    added_viscosity,
    laminar_form,
    wall,
    suction,
    integrator,
    courant,
    sound_speed,
)
"""Everything that a scene may leave to kolk."""


def choices(scene: Scene) -> tuple[Choice, ...]:
    """All keys that a scene may leave to kolk, resolved. Raises SceneError as filling does."""
    found = (choose(scene) for choose in CHOICES)
    return tuple(choice for choice in found if choice is not None)
