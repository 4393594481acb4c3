"""What each effect costs, measured: short runs of the scene with and without it, turn by turn.

Two terms of one sweep share work, so that what an effect adds to a bare step and what a full step
saves without it differ. Its cost here is the mean of the two, which shares out fairly what two
effects have in common (Shapley 1953, exact where no three effects interact), and adds up.

Pilots run on one thread, and what they take is processor time: neither other threads nor other
programs that the machine runs count as costs of an effect. All variants take steps of the same
length from the same state, so that they order particles as often. Every round makes every variant
anew: where its columns happen to lie in memory changes its speed by up to a quarter.
"""

from __future__ import annotations

import math
import random
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from kolk.errors import InstabilityError, SceneError
from kolk.scene.engine import engine_config
from kolk.simulation import Precision, Simulation, make_engine

from .catalogue import BY_NAME, Entry

if TYPE_CHECKING:
    from kolk import _core
    from kolk.scene import Body, Scene

MOST = 20_000
"""Particles of a pilot; a larger scene is piloted at a coarser spacing."""

SHORT = 4_000
"""The same where no time is given."""

SETTLE = 30
"""Steps after which the first lattice is forgotten."""

FEWEST = 3
"""Rounds where no time is given."""

MOST_ROUNDS = 45
"""Rounds where there is time for more."""

STEPS = 16
"""Timed steps of a round: the order in memory lasts for some of them."""

FOR_EVER = 1e9
"""s: no pilot gets there."""


@dataclass(frozen=True)
class Interval:
    """A measured value: the median, and an interval that holds it with 95 % probability."""

    value: float
    low: float
    high: float

    @staticmethod
    def of(values: Sequence[float]) -> Interval:
        """Of the median of ``values``, whatever their distribution (Thompson 1936): the order
        statistics ``n/2 -+ 0.98 sqrt(n)``; all of a few values."""
        ordered = sorted(values)
        n = len(ordered)
        cut = max(0, math.floor(0.5 * n - 0.98 * math.sqrt(n))) if n >= 6 else 0
        return Interval(statistics.median(ordered), ordered[cut], ordered[-1 - cut])


@dataclass(frozen=True)
class Pilot:
    """What the pilots found; costs in ns of one processor per particle-step, of the
    fluid's particles."""

    spacing: float
    """Of the pilots, m: the scene's own, or coarser."""
    particles: int
    steps: int
    """Timed steps of each variant."""
    whole: Interval
    """A step with everything that the scene calls for."""
    base: Interval
    """A step with nothing that can be taken away."""
    costs: Mapping[str, Interval]
    """Of each effect that runs and can be taken away."""
    longer_steps: Mapping[str, float]
    """By what factor steps would be longer without the effect, where it shortens them."""
    bytes_per_particle: float
    unmeasured: Mapping[str, str] = field(default_factory=dict)
    """Effects without which the pilot did not run, and why."""

    @property
    def sum_over_whole(self) -> float:
        """Base and costs together over the whole step: 1 if nothing is missing or counted twice."""
        return (self.base.value + sum(c.value for c in self.costs.values())) / self.whole.value


@dataclass
class _Variant:
    """A scene with some effects."""

    make: Callable[[], _core.Simulation]
    times: list[float] = field(default_factory=list)
    """Processor seconds per step, one value a round."""
    plan: list[tuple[bool, int]] = field(default_factory=list)
    """Whether steps are timed, and how many of them follow each other: the same in every round."""

    def prepare(self, steps: int) -> float:
        """Find out which steps are audited, until ``steps`` are not; gives the time taken in s."""
        start = time.process_time()
        engine = self.make()
        audits = _audits(engine)
        while sum(count for timed, count in self.plan if timed) < steps:
            engine.advance_to(FOR_EVER, 1)
            before, audits = audits, _audits(engine)
            timed = audits == before
            alike = self.plan.pop()[1] if self.plan and self.plan[-1][0] == timed else 0
            self.plan.append((timed, alike + 1))
        return time.process_time() - start

    def run(self) -> None:
        """One round: made anew, warm, and timed."""
        engine = self.make()
        taken, steps = 0.0, 0
        for timed, count in self.plan:
            start = time.process_time()
            engine.advance_to(FOR_EVER, count)
            if timed:
                taken += time.process_time() - start
                steps += count
        self.times.append(taken / steps)


def _audits(engine: _core.Simulation) -> float:
    """How often powers have been summed so far."""
    return engine.timings().get("budget", {"calls": 0})["calls"]


def measure(
    simulation: Simulation, *, seconds: float, say: Callable[[str], None] = lambda text: None
) -> Pilot:
    """Pilot the scene of a settled ``simulation`` for about ``seconds``; at the least three rounds
    of two steps each.

    Raises InstabilityError where the scene itself does not go on.
    """
    bodies = _bodies_now(simulation)
    running = [
        BY_NAME[e["name"]]
        for e in simulation.effects
        if e["on"] and e["name"] in BY_NAME and BY_NAME[e["name"]].without is not None
    ]
    variants, longer, unmeasured = _variants(simulation, bodies, running)
    rounds, steps = _take_turns(list(variants.values()), seconds, say)
    return _evaluated(simulation, variants, running, longer, unmeasured, rounds * steps)


def added(simulation: Simulation, changes: Mapping[str, Any], *, seconds: float) -> Interval:
    """What ``changes`` of its keys add to the step of a settled scene, ns per particle-step."""
    bodies = _bodies_now(simulation)
    pair = [
        _Variant(partial(_made, simulation, bodies, engine_config(scene)))
        for scene in (simulation.scene, simulation.scene.replace(changes))
    ]
    _take_turns(pair, seconds)
    scale = 1e9 / simulation.particles["fluid"]
    before, after = pair
    return Interval.of([scale * (b - a) for a, b in zip(before.times, after.times, strict=True)])


def _take_turns(
    variants: Sequence[_Variant], seconds: float, say: Callable[[str], None] = lambda text: None
) -> tuple[int, int]:
    """Time all variants, turn by turn; gives the rounds and the steps of each."""
    steps = STEPS if seconds > 0.0 else 2
    each = sum(variant.prepare(steps) for variant in variants)
    rounds = max(FEWEST, min(MOST_ROUNDS, int(seconds / each)))
    say(f"{len(variants)} variants, {rounds} rounds of {steps} steps")
    # Another order every time: what a variant leaves behind in caches and in memory must not always
    # fall on the same next one.
    turns = random.Random(1)
    for _ in range(rounds):
        for variant in turns.sample(variants, len(variants)):
            variant.run()
    return rounds, steps


def coarsened(scene: Scene, most: int = MOST) -> Scene:
    """``scene`` at a spacing that leaves about ``most`` particles, if it has more and bears it."""
    particles = sum(len(b) for b in scene.bodies())
    if particles <= most or any(b.particles is not None for b in (*scene.fluid, *scene.wall)):
        return scene
    factor = (particles / most) ** (1.0 / scene.dimension)
    # Thin parts may not bear so coarse a spacing.
    for share in (1.0, 0.75, 0.5):
        try:
            coarse = scene.replace(spacing=factor**share * scene.spacing)
            coarse.bodies()
        except SceneError:
            continue
        return coarse
    return scene


def _bodies_now(simulation: Simulation) -> list[Body]:
    """The scene's bodies as they are now."""
    found = []
    for body in simulation.scene.bodies():
        now = simulation.bodies[body.name].arrays()
        found.append(
            replace(
                body,
                position=now["position"],
                velocity=now["velocity"],
                density=now["density"],
                mass=now["mass"],
            )
        )
    return found


def _made(
    simulation: Simulation,
    bodies: Sequence[Body],
    config: dict[str, Any],
    without: Sequence[Entry] = (),
) -> _core.Simulation:
    """A scene without some effects after its first steps. Raises InstabilityError."""
    reduced = dict(config)
    for entry in without:
        reduced.update({k: v for k, v in (entry.without or {}).items() if k in config})
    bare = any(entry.walls for entry in without)
    kept = [b for b in bodies if b.kind == "fluid" or not bare]
    precision: Precision = "f64" if simulation.precision == "f64" else "mixed"
    engine = make_engine(reduced, kept, precision, 1)
    engine.advance_to(FOR_EVER, 2)
    return engine


def _variants(
    simulation: Simulation, bodies: Sequence[Body], running: Sequence[Entry]
) -> tuple[dict[str, _Variant], dict[str, float], dict[str, str]]:
    """The whole, the base, and for each effect the whole without and the base with it.

    By what factor steps would be longer without an effect. And the effects without which the scene
    does not go on for some steps, with the reason.
    """
    free = engine_config(simulation.scene)
    step = _made(simulation, bodies, free).time_step
    config = {**free, "time_step": step}

    def variant(*without: Entry) -> _Variant:
        return _Variant(partial(_made, simulation, bodies, config, without))

    variants = {"whole": variant()}
    longer: dict[str, float] = {}
    unmeasured: dict[str, str] = {}
    for entry in running:
        try:
            longer[entry.name] = _made(simulation, bodies, free, [entry]).time_step / step
        except InstabilityError as error:
            unmeasured[entry.name] = str(error)
    measured = [entry for entry in running if entry.name not in unmeasured]
    variants["base"] = variant(*measured)
    for entry in measured:
        variants[f"whole less {entry.name}"] = variant(entry)
        others = [
            other
            for other in measured
            if other is not entry and not (other.walls and entry.name == "moving walls")
        ]
        variants[f"base and {entry.name}"] = variant(*others)
    return variants, longer, unmeasured


def _evaluated(
    simulation: Simulation,
    variants: Mapping[str, _Variant],
    running: Sequence[Entry],
    longer: Mapping[str, float],
    unmeasured: Mapping[str, str],
    steps: int,
) -> Pilot:
    particles = simulation.particles["fluid"]
    scale = 1e9 / particles
    times = {name: [scale * t for t in v.times] for name, v in variants.items()}
    measured = [entry.name for entry in running if entry.name not in unmeasured]
    costs: dict[str, Interval] = {}
    # Walls that move cannot stay when walls go: they are what goes first and comes last.
    both = {"walls", "moving walls"} <= set(measured)
    for name in measured:
        rounds = zip(
            times["whole less moving walls" if both and name == "walls" else "whole"],
            times[f"whole less {name}"],
            times[f"base and {name}"],
            times["base and walls" if both and name == "moving walls" else "base"],
            strict=True,
        )
        costs[name] = Interval.of(
            [0.5 * ((whole - less) + (more - base)) for whole, less, more, base in rounds]
        )
    return Pilot(
        spacing=simulation.scene.spacing,
        particles=particles,
        steps=steps,
        whole=Interval.of(times["whole"]),
        base=Interval.of(times["base"]),
        costs=costs,
        longer_steps={name: factor for name, factor in longer.items() if factor > 1.02},
        bytes_per_particle=sum(simulation.memory.values()) / particles,
        unmeasured=unmeasured,
    )
