"""What a run costs at any spacing, by what two pilots (`pilot`) have shown of it.

The profile has flown the whole scene at a coarse spacing: how the time step and the time per step
change on the way, from a quiet start to a splash. The other has flown seconds of it where the run
will be: what a step costs there, of so many particles on so many threads. Of the profile only
ratios count, those of each stretch to the one that both have seen. Time steps go with the spacing
as their limits do: with h where sound sets them, with h² where viscosity does, with √h where
acceleration does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kolk.execution import CHECKPOINT_SHARE

from .pilot import Pilot

if TYPE_CHECKING:
    from kolk.scene import Scene

Floats = NDArray[np.float64]

AFFORDABLE = 1_500_000
"""Particles up to which a run is filled to count them: more take seconds."""

POWER = {"acoustic": 1.0, "viscous": 2.0, "force": 0.5, "capillary": 1.5, "fixed": 0.0}
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

OF_WALL = 0.1
"""Time of a wall particle's step over one of the fluid: walls cost only where there is fluid. In
the tank of dam-break-column, 90 % walls, it is 0.04; in a flat one with few particles 0.5."""

POWER_OF_WORK = 0.88
"""Of the particles that the time of a step grows with: threads have more to share among many. From
0.75 to 0.95 over five scenes in 2D and 3D, from a thousand particles to a hundred thousand."""

POWER_SPREAD = 0.06
"""Standard deviation of that power from scene to scene."""

NOISE = 0.08
"""Standard deviation of the logarithm of the speed that the machine has during a pilot."""

WARM = 1.0 / 3.0
"""Share of a pilot's steps that its time per step leaves out: memory is touched for the first
time, the energy is audited more often, and what hardly moves yet is slow to compute with."""

STRETCHES = 8
"""Parts of a profile, even in time, of which each has one time per step: single stations are
noise."""


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
        half = math.hypot(MODEL, 0.5 * self._noise(), 2.0 * resolved)
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
        return sum(self._parts(spacing, self._about(spacing) / self.fine.total).values())

    def spacing_for(self, seconds: float, coarsest: float) -> float:
        """The spacing (m) up to the coarsest whose run takes so long."""
        high = math.log(coarsest)
        low = high - math.log(64.0)
        while high - low > 0.001:
            middle = 0.5 * (low + high)
            if self.wall(math.exp(middle)) > seconds:
                low = middle
            else:
                high = middle
        return math.exp(high)

    def _about(self, spacing: float) -> float:
        """Particles by their number at the fine pilot: a rough count is as wrong at both."""
        near = estimated(self.scene.replace(spacing=self.fine.spacing))
        return self.fine.total * estimated(self.scene.replace(spacing=spacing)) / near

    def _particles(self, spacing: float) -> tuple[float, bool]:
        """Particles, and whether they were counted."""
        if abs(spacing / self.fine.spacing - 1.0) < 1e-12:
            return float(self.fine.total), True
        scene = self.scene.replace(spacing=spacing)
        if estimated(scene) <= AFFORDABLE:
            return float(sum(len(body) for body in scene.bodies())), True
        return self._about(spacing), False

    @cached_property
    def _seen_slower(self) -> float:
        """Logarithm of the time of a step of the fine pilot over one of the profile's, where both
        have flown."""
        fine, profile = self.fine.table, self._profile().table
        begin = float(np.interp(WARM * fine[-1, 1], fine[:, 1], fine[:, 0]))
        warm_up = float(np.interp(begin, fine[:, 0], fine[:, 2]))
        per_step = (fine[-1, 2] - warm_up) / ((1.0 - WARM) * fine[-1, 1])
        shared = np.minimum(profile[1:, 0], fine[-1, 0]) - np.maximum(profile[:-1, 0], begin)
        theirs = np.average(_paces(profile), weights=np.maximum(shared, 0.0))
        return math.log(per_step / theirs)

    @cached_property
    def _scale(self) -> float:
        """Logarithm of the work of a step of the fine pilot over that of one of the profile's."""
        there = self._profile().spacing
        return math.log(_work(self._there(self.fine.spacing)) / _work(self._there(there)))

    @property
    def hindrance(self) -> float:
        """By how many standard deviations the fine pilot was slower than the profile leads to:
        beyond 2 something else had the machine meanwhile."""
        spread = math.hypot(POWER_SPREAD * self._scale, math.sqrt(2.0) * NOISE)
        return (self._seen_slower - POWER_OF_WORK * self._scale) / spread

    @cached_property
    def _slower(self) -> float:
        """The same as `_seen_slower`, with what the profile leads to: the mean of both, weighted
        by the inverse of their variances."""
        of_law = (POWER_SPREAD * self._scale) ** 2 + NOISE**2
        trust = of_law / (of_law + NOISE**2)
        return trust * self._seen_slower + (1.0 - trust) * POWER_OF_WORK * self._scale

    def _burden(self, spacing: float) -> float:
        """Time of a step over that at the fine pilot, where both are in the same state."""
        far = self._scale > math.log(2.0)
        power = self._slower / self._scale if far else POWER_OF_WORK
        growth = _work(self._there(spacing)) / _work(self._there(self.fine.spacing))
        return float(growth ** min(max(power, 0.5), 1.0))

    def _there(self, spacing: float) -> Scene:
        return self.scene.replace(spacing=spacing)

    def _profile(self) -> Pilot:
        """The pilot that went farther."""
        return max(self.fine, self.coarse, key=lambda pilot: pilot.table[-1, 0])

    def _course(self, spacing: float) -> tuple[Floats, Floats, float]:
        """(k,) natural steps of a run between the stations of the profile, (k,) the seconds that
        the profile took for each of its own, and the share of the time that no pilot has seen."""
        profile = self._profile()
        table = profile.table
        ratio = profile.spacing / spacing
        steps = np.diff(table[:, 1]) * [ratio ** POWER[limit] for limit in profile.limits[1:]]
        if profile is not self.fine:
            # What the fine pilot saw of the time step corrects the law of its limit.
            steps *= self._step_correction()
        each = _paces(table)
        seen, end = float(table[-1, 0]), profile.until
        if seen >= end * (1.0 - 1e-9):
            return steps, each, 0.0
        # The last third goes on as it was.
        start = int(2 * len(steps) / 3)
        rest = steps[start:].sum() * (end - seen) / (seen - table[start, 0])
        slow = float(steps[start:] @ each[start:] / steps[start:].sum())
        return np.append(steps, rest), np.append(each, slow), min(end / seen - 1.0, 1.0)

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
        steps, _, unseen = self._course(spacing)
        return float(steps.sum()) + 0.5 * self.fine.frames, 0.25 * unseen

    def _stepping(self, spacing: float) -> float:
        """Seconds of all steps at a spacing (m)."""
        steps, each, _ = self._course(spacing)
        return float(steps @ each) * math.exp(self._slower) * self._burden(spacing)

    def _parts(self, spacing: float, growth: float) -> dict[str, float]:
        """Seconds by what they go to."""
        fine = self.fine
        stepping = self._stepping(spacing)
        probing = float(fine.table[-1, 3] / fine.table[-1, 0]) * fine.until
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


def estimated(scene: Scene) -> float:
    """About how many particles a scene has, without making one."""
    fluid, wall = _counts(scene)
    return fluid + wall


def _work(scene: Scene) -> float:
    """What a step goes with, in particles of the fluid."""
    fluid, wall = _counts(scene)
    return fluid + OF_WALL * wall


def _counts(scene: Scene) -> tuple[float, float]:
    """About how many particles the fluids and the walls of a scene have."""
    from kolk.scene.memory import estimated_particles

    fluid = sum(estimated_particles(scene, body) for body in scene.fluid)
    return fluid, sum(estimated_particles(scene, body) for body in scene.wall)


def _paces(table: Floats) -> Floats:
    """(k,) seconds per natural step between the stations of a pilot, as they are in most of the
    stretch that each lies in: something else may have had the machine for a moment."""
    each = np.diff(table[:, 2]) / np.maximum(np.diff(table[:, 1]), 1e-12)
    middle = 0.5 * (table[1:, 0] + table[:-1, 0])
    stretch = (STRETCHES * middle / table[-1, 0]).astype(int)
    for i in np.unique(stretch):
        each[stretch == i] = np.median(each[stretch == i])
    return np.maximum(each, 1e-12)
