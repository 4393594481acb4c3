"""What a scene has and does not need, and what it lacks: rules, each with its reason.

A rule looks at the scene alone. What following it costs or saves is measured afterwards.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from kolk.scene import automatic

if TYPE_CHECKING:
    from kolk.scene import Scene


@dataclass(frozen=True)
class Advice:
    """One thing to change in a scene."""

    kind: Literal["drop", "add", "change"]
    effect: str
    """The effect that it is about, by its name in the catalogue."""
    text: str
    """What is the matter, and why."""
    changes: Mapping[str, Any]
    """Keys of the scene with their new values, None to take one out: for `Scene.replace`."""
    speed: float = 1.0
    """Factor by which the run gets faster by longer steps, as far as the scene alone tells."""

    @property
    def setting(self) -> str:
        """The changes as a user writes them."""
        return ", ".join(
            f"leave out {key}" if value is None else f"{key} = {_shown(value)}"
            for key, value in self.changes.items()
        )


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:.3g}"


def equivalent_viscosity(scene: Scene) -> float:
    """Kinematic viscosity in m^2/s of the artificial one, ``alpha h c0 / (2 (D + 2))``.

    Source: Monaghan, Rep. Prog. Phys. 68 (2005) 1703. 0 without artificial viscosity.
    """
    alpha = automatic.artificial(scene)
    if alpha is None:
        return 0.0
    length_speed = scene.smoothing_length * scene.sound_speed
    return float(alpha.value) * length_speed / (2.0 * (scene.dimension + 2.0))


def diffusion_length(viscosity: float, time: float) -> float:
    """How far in m momentum diffuses in ``time`` s: ``sqrt(4 nu t)`` (Stokes 1851)."""
    return math.sqrt(4.0 * viscosity * time)


def _all_fluids(scene: Scene, key: str, value: Any) -> dict[str, Any]:
    """All fluids of a scene share one material."""
    return {f"fluid.{fluid.name}.{key}": value for fluid in scene.fluid}


def _unresolved_laminar(scene: Scene) -> Advice | None:
    viscosity = scene.fluid[0].viscosity
    if viscosity is None or viscosity.laminar is None:
        return None
    nu, reach = viscosity.laminar, diffusion_length(viscosity.laminar, scene.until)
    swamped = equivalent_viscosity(scene)
    if reach >= scene.spacing and nu >= 0.05 * swamped:
        return None
    if reach < scene.spacing:
        text = (
            f"the laminar viscosity carries momentum {reach:.2g} m in the whole run, less than the "
            f"spacing of {scene.spacing:.2g} m: it cannot be seen"
        )
    else:
        text = (
            f"the laminar viscosity of {nu:.2g} m^2/s is swamped by the artificial one, which acts "
            f"like {swamped:.2g} m^2/s"
        )
    alone = viscosity.artificial is None and viscosity.turbulence is None
    key = "viscosity" if alone else "viscosity.laminar"
    return Advice("drop", "laminar viscosity", text, _all_fluids(scene, key, None))


def _swamping_artificial(scene: Scene) -> Advice | None:
    viscosity = scene.fluid[0].viscosity
    if viscosity is None or viscosity.laminar is None or viscosity.artificial is None:
        return None
    nu, extra = viscosity.laminar, equivalent_viscosity(scene)
    unresolved = _unresolved_laminar(scene) is not None
    if automatic.free_surface(scene).value or unresolved or extra < 0.05 * nu:
        return None
    return Advice(
        "drop",
        "artificial viscosity",
        f"between walls the laminar viscosity of {nu:.2g} m^2/s is the friction that you ask for; "
        f"the artificial one adds {100.0 * extra / nu:.0f} % to it",
        _all_fluids(scene, "viscosity.artificial", None),
    )


def _quadratic_term(scene: Scene) -> Advice | None:
    viscosity = scene.fluid[0].viscosity
    if viscosity is None or viscosity.artificial is None or viscosity.beta == 0.0:
        return None
    return Advice(
        "change",
        "artificial viscosity",
        f"beta = {viscosity.beta:g} is for shocks; in a flow at a tenth of the speed of sound it "
        "only blurs impacts",
        _all_fluids(scene, "viscosity.beta", 0.0),
    )


def _no_viscosity(scene: Scene) -> Advice | None:
    free = automatic.free_surface(scene).value
    viscous = scene.fluid[0].viscosity is not None or automatic.artificial(scene) is not None
    damped = viscous or automatic.scheme(scene).value == "riemann"
    if damped or not free:
        return None
    return Advice(
        "add",
        "artificial viscosity",
        "nothing damps what particles in disorder make of a violent flow",
        _all_fluids(scene, "viscosity.artificial", 0.02),
    )


def _no_diffusion(scene: Scene) -> Advice | None:
    if automatic.density_diffusion(scene).value != "none":
        return None
    free = automatic.free_surface(scene).value
    return Advice(
        "add",
        "density diffusion",
        "without it pressure is full of noise"
        + (", and grows noisier with every impact under the free surface" if free else ""),
        {"numerics.density_diffusion": "antuono"},
    )


def _lifting_diffusion(scene: Scene) -> Advice | None:
    form = automatic.density_diffusion(scene).value
    if form != "molteni" or not scene.weight.any():
        return None
    return Advice(
        "change",
        "density diffusion",
        "Molteni's form lifts fluid at rest at the free surface, where the weight of the water is "
        "a gradient of density to it",
        {"numerics.density_diffusion": "antuono"},
    )


def _needless_background(scene: Scene) -> Advice | None:
    given = scene.numerics.background_pressure
    if given == 0.0:
        return None
    if automatic.free_surface(scene).value:
        text = f"a background pressure of {given:.3g} Pa pushes the free surface outwards"
    elif automatic.shifting(scene).value != "none":
        text = (
            f"the background pressure of {given:.3g} Pa adds noise of its own; shifting already "
            "keeps particles together where pressure is negative"
        )
    else:
        return None
    return Advice("change", "pressure", text, {"numerics.background_pressure": None})


def _tension(scene: Scene) -> Advice | None:
    if automatic.shifting(scene).value != "none" or scene.numerics.background_pressure > 0.0:
        return None
    if automatic.free_surface(scene).value:
        text = "stretched tongues of fluid break up into pairs and strings of particles"
    else:
        text = "where pressure turns negative particles clump and voids open"
    return Advice(
        "add", "particle shifting", f"without shifting {text}", {"numerics.shifting": "auto"}
    )


def _sound(scene: Scene) -> Advice | None:
    free = automatic.free_surface(scene).value
    if not free or automatic.acoustic_damper(scene).value != 0.0:
        return None
    return Advice(
        "add",
        "acoustic damper",
        "the sound of an impact runs on through the water and into every pressure probe",
        {"numerics.acoustic_damper": "auto"},
    )


def _too_stiff(scene: Scene) -> Advice | None:
    from kolk.errors import SceneError

    if scene.fluid[0].sound_speed == "auto":
        return None
    changes = _all_fluids(scene, "sound_speed", "auto")
    try:
        enough = scene.replace(changes).sound_speed
    except SceneError:
        return None
    if scene.sound_speed < 1.5 * enough:
        return None
    return Advice(
        "change",
        "pressure",
        f"the sound speed of {scene.sound_speed:.3g} m/s is {scene.sound_speed / enough:.1f} times "
        f"what keeps the flow at Mach 0.1 ({enough:.3g} m/s): steps are that much shorter",
        changes,
        speed=scene.sound_speed / enough,
    )


def _sticky_without_friction(scene: Scene) -> Advice | None:
    viscosity = scene.fluid[0].viscosity
    friction = viscosity is not None and any(
        getattr(viscosity, name, None) is not None
        for name in ("laminar", "herschel_bulkley", "turbulence")
    )
    if friction or not any(wall.slip == "no" for wall in scene.wall):
        return None
    return Advice(
        "change",
        "walls",
        'slip = "no" does nothing without a laminar viscosity, and takes room: artificial '
        "viscosity has no part in the friction at a wall",
        {f"wall.{wall.name}.slip": "free" for wall in scene.wall},
    )


RULES: tuple[Callable[[Scene], Advice | None], ...] = (
    _unresolved_laminar,
    _swamping_artificial,
    _quadratic_term,
    _no_viscosity,
    _no_diffusion,
    _lifting_diffusion,
    _needless_background,
    _tension,
    _sound,
    _too_stiff,
    _sticky_without_friction,
)


def advise(scene: Scene) -> tuple[Advice, ...]:
    """What to change in ``scene``; empty where nothing is the matter."""
    found = (rule(scene) for rule in RULES)
    return tuple(advice for advice in found if advice is not None)
