"""What every hard case is judged by, measured while it runs."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import kolk
from kolk.output.checkpoint import Checkpoint, read_checkpoint, write_checkpoint
from kolk.output.stability import leaks, voids

from .suite import FOLDER, Figure, Result

THREADS = int(os.environ.get("KOLK_STABILITY_THREADS", "1"))
"""The figures do not depend on it: a run has the same bits for every number of threads."""


STATES = FOLDER / ".states"
"""Where long runs keep their states, to go on from when they were cut."""

_engine = ""


def keep_states(engine: str) -> None:
    """Lets runs keep their states at every look, and go on from those that ``engine`` left."""
    global _engine
    _engine = engine


def simulation(
    scene: kolk.Scene, precision: kolk.simulation.Precision = "mixed"
) -> kolk.Simulation:
    """A simulation of ``scene`` on the suite's threads."""
    return kolk.Simulation(scene, precision=precision, threads=THREADS)


@dataclass
class Watch:
    """The extremes of a simulation over all looks at it."""

    sim: kolk.Simulation
    leaks: int = 0
    voids: int = 0
    crowded: int = 0
    closest: float = np.inf
    low: float = np.inf
    high: float = 0.0
    speed: float = 0.0
    growth: float = 0.0
    _least: float = np.inf

    def look(self) -> None:
        """Looks at the present state."""
        sim, now = self.sim, self.sim.diagnostics
        rest = sim.scene.fluid[0].density
        self.leaks = max(self.leaks, leaks(sim))
        self.voids = max(self.voids, voids(sim))
        self.crowded = max(self.crowded, int(now["crowded"]))
        self.closest = min(self.closest, float(now["closest_pair"]))
        self.low = min(self.low, float(now["density_min"]) / rest)
        self.high = max(self.high, float(now["density_max"]) / rest)
        self.speed = max(self.speed, float(now["speed_max"]))
        energy = sim.energy.total
        self._least = min(self._least, energy)
        self.growth = max(self.growth, energy - self._least)

    def run(self, until: float, looks: int = 20) -> Watch:
        """Runs to ``until`` (s), looking evenly; gives itself."""
        kept = self._kept(until, looks)
        first, done = self.sim.time, 0
        if kept is not None and kept.exists():
            first, done = self._go_on(read_checkpoint(kept))
        else:
            self.look()
        for k in range(done + 1, looks + 1):
            self.sim.advance_to(first + (until - first) * k / looks)
            self.look()
            if kept is not None and self.sim.step_count > 2000:
                self._keep(kept, first, k)
        if kept is not None:
            kept.unlink(missing_ok=True)
        return self

    def _kept(self, until: float, looks: int) -> Path | None:
        """The file that keeps the state of a run to ``until``; None: states are not kept."""
        if not _engine:
            return None
        scene, begun = self.sim.scene, f"{self.sim.step_count} {until!r} {looks}"
        what = hashlib.sha256(f"{_engine} {begun} {scene.engine_config()}".encode()).hexdigest()[
            :16
        ]
        return STATES / f"{scene.name}-{sum(self.sim.particles.values())}-{what}.h5"

    def _keep(self, path: Path, first: float, done: int) -> None:
        seen = {key: value for key, value in vars(self).items() if key != "sim"}
        path.parent.mkdir(exist_ok=True)
        book = {"seen": seen, "first": first, "done": done}
        write_checkpoint(path, Checkpoint(self.sim.state(), book, self.sim.scene.name))

    def _go_on(self, kept: Checkpoint) -> tuple[float, int]:
        """Takes over a state and what was seen until then; when it began, and looks since."""
        self.sim.restore(kept.state)
        for key, value in kept.book["seen"].items():
            setattr(self, key, value)
        return kept.book["first"], kept.book["done"]

    def steps(self, count: int, looks: int = 20) -> Watch:
        """Runs ``count`` steps; gives itself."""
        self.look()
        for k in range(looks):
            part = count * (k + 1) // looks - count * k // looks
            self.sim.advance_to(1e9, part)
            self.look()
        return self

    def figures(self, closest: float = 0.3, speed: float | None = None) -> tuple[Figure, ...]:
        """The figures of every case: leaks, closest pair, density, voids, speed (m/s)."""
        return (
            Figure("leaks", self.leaks, most=0),
            Figure("closest pair", self.closest, least=closest, unit="Δp"),
            Figure("smallest density", self.low, least=0.5, unit="ρ0"),
            Figure("largest density", self.high, most=1.5, unit="ρ0"),
            Figure("largest speed", self.speed, most=speed, unit="m/s"),
        )

    def result(self, variant: str, *figures: Figure) -> Result:
        """A result with these figures."""
        guard = self.sim.retries
        return Result(
            variant,
            figures,
            particles=sum(self.sim.particles.values()),
            steps=self.sim.step_count,
            retries=sum(guard["retries"].values()),
        )


def number(variant: str) -> float:
    """The last number in the name of a variant."""
    return float(variant.split()[-1])
