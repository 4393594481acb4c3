"""The whole explanation of a scene: effects, choices, costs, advice."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kolk.scene import automatic
from kolk.simulation import DEFAULT_PRECISION, Precision, Simulation

from . import pilot
from .advice import Advice, advise
from .pilot import Interval, Pilot

if TYPE_CHECKING:
    from kolk.scene import Scene

SECONDS = 10.0
"""About how long the pilots of a scene take, s."""


@dataclass(frozen=True)
class Cost:
    """What an effect costs."""

    nanoseconds: Interval
    """Of one processor per particle-step (fluid particles), with the noise of the measurement."""
    share: float
    """Of the whole step."""
    longer_steps: float
    """By what factor steps would be longer without it; 1 where it does not shorten them."""


@dataclass(frozen=True)
class EffectReport:
    """One effect of a scene."""

    name: str
    what: str
    on: bool
    why: str
    where: str
    """Its place in the step."""
    columns: tuple[str, ...]
    """That particles carry for it alone."""
    bytes_per_particle: int
    sweeps: int
    """Sweeps over pairs of its own in each step."""
    limit: str | None
    """The time-step criterion that it brings."""
    dissipates: str
    source: str
    cost: Cost | None
    """None where it is off, or was not measured."""


@dataclass(frozen=True)
class Suggestion:
    """An advice with what following it gains or costs, measured."""

    advice: Advice
    figure: str


@dataclass(frozen=True)
class Explanation:
    """What :func:`explain` found."""

    scene: str
    precision: Precision
    particles: dict[str, int]
    limit: str
    """What sets the time step in the pilot."""
    time_step: float
    """s, in the pilot."""
    choices: tuple[automatic.Choice, ...]
    effects: tuple[EffectReport, ...]
    pilot: Pilot | None
    """None where nothing was measured."""
    suggestions: tuple[Suggestion, ...]

    def plain(self) -> dict[str, Any]:
        """Everything as dicts and lists, for JSON."""
        made = dataclasses.asdict(self)
        for suggestion, entry in zip(self.suggestions, made["suggestions"], strict=True):
            entry["advice"]["changes"] = dict(suggestion.advice.changes)
        if self.pilot is not None:
            made["pilot"]["sum_over_whole"] = self.pilot.sum_over_whole
        return made


def explain(
    scene: Scene,
    *,
    precision: Precision = DEFAULT_PRECISION,
    seconds: float = SECONDS,
    measured: bool = True,
    say: Callable[[str], None] = lambda text: None,
) -> Explanation:
    """Which effects ``scene`` runs, why, and what each costs.

    ``seconds``: about how long the pilots may take; 0 for the shortest ones that say anything.
    ``measured``: False to leave them out. ``say`` hears what is being done. Raises SceneError, and
    InstabilityError where the scene does not run.
    """
    piloted = scene
    if measured:
        piloted = pilot.coarsened(scene, pilot.MOST if seconds > 0.0 else pilot.SHORT)
    simulation = Simulation(piloted, precision=precision)
    found: Pilot | None = None
    if measured:
        simulation.advance(pilot.FOR_EVER, max_steps=pilot.SETTLE)
        found = pilot.measure(simulation, seconds=seconds, say=say)
    kinds = {"fluid": 0, "wall": 0}
    for body in scene.bodies():
        kinds[body.kind] += len(body)
    suggestions = tuple(
        Suggestion(advice, _figure(advice, found, simulation, seconds)) for advice in advise(scene)
    )
    return Explanation(
        scene=scene.name,
        precision=precision,
        particles=kinds,
        limit=simulation.limit if measured else "",
        time_step=simulation.time_step if measured else 0.0,
        choices=automatic.choices(scene),
        effects=tuple(_report(effect, found) for effect in simulation.effects),
        pilot=found,
        suggestions=suggestions,
    )


def _report(effect: dict[str, Any], found: Pilot | None) -> EffectReport:
    name = str(effect["name"])
    cost = None
    if found is not None and effect["on"]:
        measured = found.base if effect["what"] and name == "pressure" else found.costs.get(name)
        if measured is not None:
            share = measured.value / found.whole.value
            cost = Cost(measured, share, found.longer_steps.get(name, 1.0))
    return EffectReport(
        name=name,
        what=str(effect["what"]),
        on=bool(effect["on"]),
        why=str(effect["why"]),
        where=str(effect["where"]),
        columns=tuple(effect["columns"]),
        bytes_per_particle=int(effect["bytes_per_particle"]),
        sweeps=int(effect.get("sweeps", 0)),
        limit=effect["dt_limit"],
        dissipates=str(effect.get("dissipates", "")),
        source=str(effect.get("source", "")),
        cost=cost,
    )


def _figure(advice: Advice, found: Pilot | None, simulation: Simulation, seconds: float) -> str:
    """What following an advice gains or costs."""
    if advice.speed > 1.0:
        return f"saves {100.0 * (1.0 - 1.0 / advice.speed):.0f} % of the time: longer steps"
    if found is None:
        return ""
    if advice.kind == "drop" and advice.effect in found.costs:
        cost = found.costs[advice.effect]
        factor = found.longer_steps.get(advice.effect, 1.0)
        kept = (1.0 - cost.value / found.whole.value) / factor
        words = f"saves {cost.value:.0f} ns per particle-step"
        if factor > 1.0:
            words += f", steps become {factor:.2g} times as long"
        return f"{words}: {100.0 * (1.0 - kept):.0f} % of the time"
    if advice.kind == "add":
        cost = pilot.added(simulation, advice.changes, seconds=0.2 * seconds)
        return (
            f"costs {cost.value:.0f} ns per particle-step "
            f"({100.0 * cost.value / found.whole.value:.0f} % of the step)"
        )
    return ""
