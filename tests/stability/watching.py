"""What every hard case is judged by, measured while it runs."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

import kolk
from kolk.output.stability import leaks, voids

from .suite import Figure, Result

THREADS = int(os.environ.get("KOLK_STABILITY_THREADS", "1"))
"""The figures do not depend on it: a run has the same bits for every number of threads."""


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
        first = self.sim.time
        self.look()
        for k in range(1, looks + 1):
            self.sim.advance_to(first + (until - first) * k / looks)
            self.look()
        return self

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
