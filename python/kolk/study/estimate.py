"""What a run will cost, before it: particles, memory, steps and time, each with its interval.

Two pilots (`pilot`): one of the whole scene on a coarse spacing, which shows how the time step and
the time per step change on the way; one of a few seconds at the wanted spacing, or the nearest that
can be afforded, which shows what a step costs there. Time steps go with the spacing as their limits
do: with h where sound sets them, with h² where viscosity does, with √h where acceleration does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kolk.errors import KolkError, RunError, SceneError
from kolk.execution import CHECKPOINT_SHARE

from .job import make_job
from .ladder import snapped
from .pilot import Pilot, fly

if TYPE_CHECKING:
    from kolk.scene import Fluid, Scene, Wall
    from kolk.simulation import Precision

Floats = NDArray[np.float64]

SECONDS = 3.0
"""Of steps in each pilot, unless it is over before."""

AFFORDABLE = 1_500_000
"""Particles up to which a pilot runs at the wanted spacing itself: filling takes seconds."""

PATIENCE = 2.0
"""Times the seconds that the coarse pilot may take, since all of it is needed."""

COARSE = 600
"""Particles that the coarse pilot has at least, where the scene has so many at all."""

COARSEST_ACROSS = 8
"""Particles across the thinnest extent of the fluid below which a flow is another one."""

POWER = {"acoustic": 1.0, "viscous": 2.0, "force": 0.5, "fixed": 0.0}
"""Power of the spacing that each limit of the time step goes with."""

MODEL = 0.15
"""Relative half-width of the wall time's interval that the model adds, at about 95 %. Over five
scenes, on a machine whose speed wanders, it was wrong by up to 18 %, its pilots' noise included."""

STEPS = 0.04
"""The same of the steps: what a finer run resolves in speed that a coarse one does not."""

MEMORY = 0.08
"""The same of the memory."""

PER_DOUBLING = 0.06
"""Further half-width of the wall time for each doubling of the particles beyond the pilot's."""


@dataclass(frozen=True)
class Interval:
    """A figure with the interval in which it will be found, at about 95 %."""

    value: float
    low: float
    high: float

    @classmethod
    def around(cls, value: float, half: float) -> Interval:
        """With a relative half-width, as far down as up by the same factor."""
        return cls(value, value / (1.0 + half), value * (1.0 + half))

    def holds(self, truth: float) -> bool:
        """Whether the truth lies inside."""
        return self.low <= truth <= self.high

    def as_dict(self) -> dict[str, float]:
        """JSON-ready."""
        return {"value": self.value, "low": self.low, "high": self.high}


@dataclass(frozen=True)
class Estimate:
    """What a run will cost; times in seconds, memory in bytes."""

    name: str
    spacing: float
    particles: Interval
    steps: Interval
    memory: Interval
    """Largest resident size of the process."""
    wall: Interval
    """Until everything is written; pictures and film come on top where the scene wants them."""
    parts: dict[str, float]
    """Seconds of the wall time by what they go to."""
    error: Interval | None
    """Share; None where no study of the scene says anything."""
    error_of: str
    pilots: tuple[Pilot, ...]
    """The coarse one and the fine one."""

    def __str__(self) -> str:
        from .words_of_estimate import describe

        return describe(self)

    def as_dict(self) -> dict[str, Any]:
        """JSON-ready, without the pilots."""
        return {
            "name": self.name,
            "spacing": self.spacing,
            "particles": self.particles.as_dict(),
            "steps": self.steps.as_dict(),
            "memory": self.memory.as_dict(),
            "wall": self.wall.as_dict(),
            "parts": self.parts,
            "error": self.error.as_dict() if self.error is not None else None,
            "error_of": self.error_of,
        }


def estimate(
    scene: Scene | str | Path,
    *,
    precision: Precision | None = None,
    threads: int = 0,
    seconds: float = SECONDS,
) -> Estimate:
    """Particles, memory, steps and wall time of a run, and its error where a study exists.

    Takes two pilot runs of at most `seconds` of steps each. Raises `SceneError` for a scene that
    cannot run, `RunError` where a pilot fails.
    """
    if isinstance(scene, (str, Path)):
        from kolk.scene import load

        scene = load(scene)
    if not seconds > 0.0:
        raise KolkError(f"seconds: found {seconds!r}, must be above 0")
    model = calibrate(scene, precision=precision, threads=threads, seconds=seconds)
    return model.at(scene.spacing)


@dataclass(frozen=True)
class CostModel:
    """Costs of a scene at any spacing, from a coarse and a fine pilot on this machine."""

    scene: Scene
    coarse: Pilot
    fine: Pilot

    def at(self, spacing: float) -> Estimate:
        """The estimate for a run of the scene at a spacing (m)."""
        from .known import expected_error

        particles, sure = self._particles(spacing)
        growth = particles / self.fine.total
        steps, resolved = self._steps(spacing)
        parts = self._parts(spacing, growth)
        wall = sum(parts.values())
        spread = 0.5 * self._noise()
        half = math.hypot(MODEL, spread, 2.0 * resolved)
        half = math.hypot(half, PER_DOUBLING * abs(math.log2(growth)))
        beyond = 0.05 * abs(math.log2(growth))
        error, name = expected_error(self.scene, spacing)
        return Estimate(
            name=self.scene.name,
            spacing=spacing,
            particles=Interval.around(particles, 0.0 if sure else 0.05),
            steps=Interval.around(steps, STEPS + 2.0 * resolved),
            memory=Interval.around(self._memory(particles), MEMORY + beyond),
            wall=Interval.around(wall, half),
            parts=parts,
            error=error,
            error_of=name,
            pilots=(self.coarse, self.fine),
        )

    def wall(self, spacing: float) -> float:
        """Seconds of a run at a spacing (m), its particles not counted but estimated: quick."""
        growth = self._about(spacing) / self.fine.total
        return sum(self._parts(spacing, growth).values())

    def _about(self, spacing: float) -> float:
        """Particles by their number at the fine pilot: a rough count is as wrong at both."""
        near = _estimated(self.scene.replace(spacing=self.fine.spacing))
        return self.fine.total * _estimated(self.scene.replace(spacing=spacing)) / near

    def _particles(self, spacing: float) -> tuple[float, bool]:
        """Particles, and whether they were counted."""
        if abs(spacing / self.fine.spacing - 1.0) < 1e-12:
            return float(self.fine.total), True
        scene = self.scene.replace(spacing=spacing)
        if _estimated(scene) <= AFFORDABLE:
            return float(sum(len(body) for body in scene.bodies())), True
        return self._about(spacing), False

    def _profile(self) -> Pilot:
        """The pilot that went farther."""
        return max(self.fine, self.coarse, key=lambda pilot: pilot.table[-1, 0])

    def _natural_steps(self, spacing: float) -> tuple[Floats, Floats, float]:
        """(k,) natural steps between the stations of the profile, (k,) their share of its own
        time per step, and the share of the scene's time that no pilot has seen."""
        profile = self._profile()
        table = profile.table
        gained, taken = np.diff(table[:, 1]), np.diff(table[:, 2])
        ratio = profile.spacing / spacing
        limits = profile.limits[1:]
        powers = np.array([ratio ** POWER[limit] for limit in limits])
        if profile is not self.fine:
            # What the fine pilot saw of the time step corrects the law of its limit.
            powers *= self._step_correction()
        seen = table[-1, 0] / profile.until
        unseen = max(1.0 - seen, 0.0) / seen if seen < 1.0 - 1e-9 else 0.0
        steps = gained * powers
        if unseen:
            # The last third goes on as it was.
            start = int(2 * len(steps) / 3)
            span = table[-1, 0] - table[start, 0]
            steps = np.append(steps, steps[start:].sum() * (profile.until - table[-1, 0]) / span)
            gained = np.append(gained, gained[start:].sum())
            taken = np.append(taken, taken[start:].sum())
        mean = max(float(np.sum(taken)), 1e-12) / max(float(np.sum(gained)), 1e-12)
        each = np.divide(taken, gained, out=np.full_like(taken, mean), where=gained > 0.0)
        return steps, each, min(unseen, 1.0)

    def _step_correction(self) -> float:
        """Coarse time step over the fine one in the same stretch of time, over the law's ratio."""
        fine, coarse = self.fine.table, self.coarse.table
        end = fine[-1, 0]
        mine = fine[-1, 1]
        theirs = float(np.interp(end, coarse[:, 0], coarse[:, 1]))
        if mine < 20.0 or theirs < 4.0:
            return 1.0
        power = POWER[self.fine.limits[-1]]
        law = (self.coarse.spacing / self.fine.spacing) ** power
        same = self.fine.limits[-1] == self.coarse.limits[min(1, len(self.coarse.limits) - 1)]
        correction = mine / theirs / law
        return float(correction) if same and 0.5 < correction < 2.0 else 1.0

    def _steps(self, spacing: float) -> tuple[float, float]:
        """Steps, and the share of the time that had to be guessed."""
        steps, _, unseen = self._natural_steps(spacing)
        return float(steps.sum()) + 0.5 * self.fine.frames, 0.25 * unseen

    def _parts(self, spacing: float, growth: float) -> dict[str, float]:
        """Seconds by what they go to."""
        steps, each, _ = self._natural_steps(spacing)
        fine, profile = self.fine, self._profile()
        table = fine.table
        per_step = table[-1, 2] / max(table[-1, 1], 1.0)
        shape = np.ones_like(each)
        if profile is not fine and len(each) > 1:
            # Time per step over that at the same early stretch, in eighths: single stations are
            # noise.
            early = self._early(profile, table[-1, 0])
            shape = _smoothed(each, steps) / max(early, 1e-12)
        # What each step costs beside its particles does not grow with them.
        stepping = float(np.sum(steps * shape)) * float(per_step) * growth
        probing = float(table[-1, 3] / max(table[-1, 0], 1e-300)) * fine.until
        frames = fine.frame * (fine.frames - 1) * growth
        before = fine.set_up * growth + fine.begin + stepping + probing + frames
        checkpoint = fine.checkpoint * growth
        most = CHECKPOINT_SHARE * before
        rest = min(most, fine.frames * checkpoint) + checkpoint
        return {
            "set-up": fine.set_up * growth + fine.begin,
            "steps": stepping,
            "probes": probing,
            "frames": frames,
            "checkpoints": rest,
        }

    def _early(self, profile: Pilot, end: float) -> float:
        """Seconds per step of the profile up to a time (s), at least a twentieth of it."""
        table = profile.table
        i = int(np.searchsorted(table[:, 0], max(end, 0.05 * table[-1, 0])))
        i = min(max(i, 1), len(table) - 1)
        return float(table[i, 2] / max(table[i, 1], 1.0))

    def _memory(self, particles: float) -> float:
        """Linear in the particles through both pilots; through the fine one alone if they agree."""
        slope = (self.fine.peak_memory - self.coarse.peak_memory) / max(
            self.fine.total - self.coarse.total, 1
        )
        per_particle = self.fine.engine_memory / self.fine.total
        if self.fine.total < 2 * self.coarse.total or slope < per_particle:
            slope = 2.0 * per_particle
        return self.fine.peak_memory + slope * (particles - self.fine.total)

    def _noise(self) -> float:
        """Relative spread of the time per step over eighths of the fine pilot."""
        table = self.fine.table
        edges = np.unique(np.linspace(0, len(table) - 1, 9).astype(int))
        gained, taken = np.diff(table[edges, 1]), np.diff(table[edges, 2])
        each = taken[gained > 0.0] / gained[gained > 0.0]
        if len(each) < 3:
            return 0.2
        return float(np.std(each) / np.mean(each))


def calibrate(
    scene: Scene,
    *,
    precision: Precision | None = None,
    threads: int = 0,
    seconds: float = SECONDS,
    coarse: Pilot | None = None,
) -> CostModel:
    """The cost model of a scene around its spacing. coarse: a pilot that is there already."""
    wanted = scene if _estimated(scene) <= AFFORDABLE else _affordable(scene)
    fine = fly(make_job(wanted, precision, threads), seconds)
    if coarse is None and not fine.whole:
        coarse = fly(make_job(coarse_scene(wanted), precision, threads), PATIENCE * seconds)
    return CostModel(scene, coarse or fine, fine)


def coarse_scene(scene: Scene) -> Scene:
    """The scene at the spacing of the coarse pilot: about COARSE particles, if that is resolved."""
    factor = (_estimated(scene) / COARSE) ** (1.0 / scene.dimension)
    thinnest = min((_thinnest(body) for body in scene.fluid), default=0.0)
    if not thinnest:
        return scene
    factor = min(factor, thinnest / COARSEST_ACROSS / scene.spacing)
    while factor > 1.25:
        try:
            coarser = scene.replace(spacing=snapped(scene, scene.spacing * factor))
            coarser.bodies()
        except SceneError:
            factor /= 1.3
            continue
        return coarser
    return scene


def _affordable(scene: Scene) -> Scene:
    """The scene at the finest spacing that a pilot can run at."""
    factor = (_estimated(scene) / AFFORDABLE) ** (1.0 / scene.dimension)
    if any(body.shape is None for body in (*scene.fluid, *scene.wall)):
        raise RunError(
            "a scene of so many own particles cannot be made coarser for a pilot: run it for a few "
            "steps instead"
        )
    return scene.replace(spacing=scene.spacing * factor)


def _thinnest(body: Fluid) -> float:
    """Least extent of a fluid, m; 0 for own particles, which have no other spacing."""
    if body.shape is None:
        return 0.0
    low, high = body.shape.shape.bounds()
    return float(np.min(high - low))


def _estimated(scene: Scene) -> float:
    from kolk.scene.memory import estimated_particles

    bodies: list[Fluid | Wall] = [*scene.fluid, *scene.wall]
    return sum(estimated_particles(scene, body) for body in bodies)


def _smoothed(each: Floats, weight: Floats) -> Floats:
    """Mean of each eighth, weighted, in place of its items."""
    found = np.empty_like(each)
    for part in np.array_split(np.arange(len(each)), min(8, len(each))):
        total = float(weight[part].sum())
        found[part] = (
            float(each[part] @ weight[part]) / total if total else float(each[part].mean())
        )
    return found
