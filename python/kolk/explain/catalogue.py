"""Every effect that kolk knows: what it is, why a scene has it or not, and the scene without it.

The engine says which effects run and what they need (`kolk.Simulation.effects`); this file adds
what only the scene knows. An effect of the engine without an entry here fails a test.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from kolk.scene import automatic

if TYPE_CHECKING:
    from kolk.scene import Scene

BASE = "pressure"
"""The entry of what every scene has."""


@dataclass(frozen=True)
class Entry:
    """An effect as scenes see it."""

    name: str
    """As the engine calls it."""
    what: str
    """What it does, in a few words."""
    where: str
    """Its place in the step."""
    why: Callable[[Scene], str]
    """The key that asks for it, what calls for it, or why it is left out."""
    without: Mapping[str, Any] | None
    """Keys of the engine's configuration that take it away; None where nothing does."""
    walls: bool = False
    """Whether the wall particles go with it."""


def _key(scene: Scene, name: str) -> str:
    return f"fluid.{scene.fluid[0].name}.{name}"


def _asked(key: str, value: Any) -> str:
    shown = f"{value:g}" if isinstance(value, float) else str(value)
    return f"asked for: {key} = {shown}"


def _always(scene: Scene) -> str:
    return "every fluid has it"


def _gravity(scene: Scene) -> str:
    if scene.gravity is None:
        return "left out: the scene has no gravity"
    if isinstance(scene.gravity, tuple):
        return f"asked for: gravity = {[float(g) for g in scene.gravity]}"
    return "asked for: gravity, which changes with time"


def _viscosity(name: str) -> Callable[[Scene], str]:
    def why(scene: Scene) -> str:
        viscosity = scene.fluid[0].viscosity
        value = None if viscosity is None else getattr(viscosity, name, None)
        key = _key(scene, f"viscosity.{name}")
        if value is None:
            return f"left out: no {key}"
        if isinstance(value, (int, float)):
            return _asked(key, float(value))
        return f"asked for: {key}"

    return why


def _artificial(scene: Scene) -> str:
    choice = automatic.artificial(scene)
    if choice is None:
        return _viscosity("artificial")(scene)
    return _chosen(automatic.artificial)(scene)


def _of_fluid(name: str) -> Callable[[Scene], str]:
    def why(scene: Scene) -> str:
        value = getattr(scene.fluid[0], name)
        key = _key(scene, name)
        return f"left out: no {key}" if value is None else _asked(key, value)

    return why


def _chosen(choose: Callable[[Scene], automatic.Choice | None]) -> Callable[[Scene], str]:
    def why(scene: Scene) -> str:
        choice = choose(scene)
        if choice is None:
            return "left out: the scene has no wall"
        if choice.automatic:
            verdict = f"chosen ({choice.value})" if choice.value else "left out"
            return f"{verdict}: {choice.reason}"
        if choice.value in ("none", 0.0):
            return f"left out: {choice.key} = {choice.value}"
        return _asked(choice.key, choice.value)

    return why


def _riemann(scene: Scene) -> str:
    choice = automatic.scheme(scene)
    if choice.value == "riemann":
        return _asked(choice.key, choice.value)
    return f"left out: {choice.key} = {choice.value}"


def _remedy(form: str) -> Callable[[Scene], str]:
    def why(scene: Scene) -> str:
        choice = automatic.tensile_control(scene)
        if choice.value == form:
            return _chosen(automatic.tensile_control)(scene)
        if choice.automatic:
            return f"left out: {choice.reason}"
        return f"left out: {choice.key} = {choice.value}"

    return why


def _contact(scene: Scene) -> str:
    if free_of_core(scene):
        return "walls only: where pressure is everywhere, particles keep apart by themselves"
    return "keeps single particles apart where pressure vanishes, and out of walls"


def free_of_core(scene: Scene) -> bool:
    """Whether fluid particles go without the soft core: laminar flow that fills its space."""
    form = automatic.laminar_form(scene)
    artificial = automatic.artificial(scene)
    return form is not None and form.value == "morris" and artificial is None


def _walls(scene: Scene) -> str:
    if not scene.wall:
        return "left out: the scene has no wall"
    return "; ".join(
        [f"wall {', '.join(w.name for w in scene.wall)}", _chosen(automatic.wall)(scene)]
    )


def _moving(scene: Scene) -> str:
    moving = [w.name for w in scene.wall if w.motion is not None]
    if not moving:
        return "left out: every wall is at rest"
    return f"asked for: motion of wall {', '.join(moving)}"


def _no(*keys: str, **values: Any) -> Mapping[str, Any]:
    return MappingProxyType({**dict.fromkeys(keys), **values})


CATALOGUE: tuple[Entry, ...] = (
    Entry(
        BASE,
        "pressure and continuity: the equations of a weakly compressible fluid",
        "terms of both sweeps, equation of state, motion, order in memory",
        _always,
        None,
    ),
    Entry(
        "gravity",
        "the same acceleration for all particles",
        "a stage that there is anyway",
        _gravity,
        _no("gravity", gravity_over_time=[]),
    ),
    Entry(
        "artificial viscosity",
        "takes up noise and shocks between approaching particles",
        "term of the sweep of forces",
        _artificial,
        _no("artificial_viscosity"),
    ),
    Entry(
        "laminar viscosity",
        "friction of a Newtonian liquid",
        "term of the sweep of forces",
        _viscosity("laminar"),
        _no("laminar_viscosity"),
    ),
    Entry(
        "Herschel-Bulkley",
        "friction of a liquid with yield stress",
        "sweeps of its own",
        _viscosity("herschel_bulkley"),
        _no("herschel_bulkley"),
    ),
    Entry(
        "turbulence",
        "friction by eddies smaller than the spacing",
        "sweeps of its own",
        _viscosity("turbulence"),
        _no("turbulence"),
    ),
    Entry(
        "surface tension",
        "pulls a free surface together",
        "sweeps of its own",
        _of_fluid("surface_tension"),
        _no("surface_tension"),
    ),
    Entry(
        "linear drag",
        "slows fluid in proportion to its velocity, as a porous bed does",
        "a pass over the particles",
        _of_fluid("drag"),
        _no("linear_drag"),
    ),
    Entry(
        "density diffusion",
        "keeps pressure free of checkerboard noise",
        "term of the sweep of continuity; the gradient that some forms need is a term of the other",
        _chosen(automatic.density_diffusion),
        _no("density_diffusion"),
    ),
    Entry(
        "acoustic damper",
        "a bulk viscosity that takes up sound",
        "part of the pressure, in a stage that there is anyway",
        _chosen(automatic.acoustic_damper),
        _no("acoustic_damper"),
    ),
    Entry(
        "particle shifting",
        "keeps particles evenly spread",
        "term of the sweep of continuity, and a stage",
        _chosen(automatic.shifting),
        _no("shifting"),
    ),
    Entry(
        "Riemann dissipation",
        "takes up the speed at which particles meet",
        "a sweep of its own",
        _riemann,
        _no(riemann_viscosity=False),
    ),
    Entry(
        "tensile control",
        "keeps fluid under tension from clumping: differences of pressure",
        "a sweep of its own",
        _remedy("sun"),
        _no("tensile_control"),
    ),
    Entry(
        "artificial stress",
        "keeps fluid under tension from clumping: a repulsion of near pairs",
        "a sweep of its own, and one at walls",
        _remedy("monaghan"),
        _no("tensile_control"),
    ),
    Entry(
        "contact",
        "a soft core that keeps particles apart and out of walls",
        "term of the sweep of forces",
        _contact,
        None,
    ),
    Entry(
        "walls",
        "solids that the fluid does not enter",
        "a sweep over wall particles in reach of fluid, and terms of both sweeps",
        _walls,
        _no("wall", motion=[]),
        walls=True,
    ),
    Entry(
        "moving walls",
        "walls in prescribed motion",
        "a stage, and an order in memory that is kept up",
        _moving,
        _no(motion=[]),
    ),
)

BY_NAME: Mapping[str, Entry] = MappingProxyType({entry.name: entry for entry in CATALOGUE})


def described(scene: Scene, effect: Mapping[str, Any]) -> dict[str, Any]:
    """What the engine says of an effect, with what the scene knows: what, where and why."""
    entry = BY_NAME.get(str(effect["name"]))
    if entry is None:
        return {**effect, "what": "", "where": "", "why": ""}
    return {**effect, "what": entry.what, "where": entry.where, "why": entry.why(scene)}
