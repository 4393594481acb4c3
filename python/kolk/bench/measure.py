"""Measuring: settle each flow, then time whole steps in both precisions, turn by turn."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from kolk.simulation import PRECISIONS, Precision, Simulation

from . import flops
from .settled import FLOWS, SETTLE, Flow, scene

PILOT = 8_000
"""Particles of the pilot that tells how large a flow fits into the time."""

SWEEPS = ("forces", "continuity")
"""Phases that visit every pair."""

TURNS = 5
"""Timed windows of each precision: odd, so that the median is one of them."""


@dataclass(frozen=True)
class Rate:
    """A speed: the median of the timed windows, and the slowest and the fastest of them."""

    median: float
    low: float
    high: float


@dataclass(frozen=True)
class Figures:
    """One flow in one precision. Particles are the fluid's, pairs directed neighbour pairs."""

    flow: str
    dimension: int
    precision: Precision
    particles: int
    wall_particles: int
    neighbours: float
    """Neighbours of a fluid particle, fluid and wall, on average."""
    steps: int
    particle_steps: Rate
    """Per second."""
    phases: dict[str, float]
    """Nanoseconds per particle-step by phase of the step."""
    pairs: float
    """Per second, over whole steps: each pair once a step."""
    pairs_in_sweeps: float
    """Per second, over the time of the two sweeps that visit pairs."""
    flops_per_pair: int
    """Of both sweeps together, for one neighbour of a particle."""
    share_of_peak: float
    """Of the machine's peak in this precision, while it sweeps."""
    bytes_per_particle: float


@dataclass(frozen=True)
class Bench:
    """What `kolk bench` found."""

    threads: int
    vector_unit: str
    peak: dict[str, float]
    """Floating-point operations per second by precision: "mixed" computes pairs in f32."""
    flows: list[Figures]
    seconds: float
    """That all of it took."""
    machine: dict[str, object] = field(default_factory=dict)


def measure(
    *, threads: int = 0, seconds: float = 45.0, say: Callable[[str], None] = lambda text: None
) -> Bench:
    """Measure all flows within about ``seconds`` (s); ``say`` hears what is being done.

    ``threads``: 0 for every core. Flows are as large as fits into the time, up to the sizes of
    `settled.FLOWS`. Raises KolkError for a negative number of threads.
    """
    from kolk import _core
    from kolk.output.summary import machine

    begun = time.perf_counter()
    say("peak of the vector units")
    peak: dict[str, float] = {p: _core.peak_flops(p, threads) for p in PRECISIONS}
    found: list[Figures] = []
    used = threads
    for i, flow in enumerate(FLOWS):
        share = (seconds - (time.perf_counter() - begun)) / (len(FLOWS) - i)
        pair = _settled(flow, max(share, 1.0), threads, say)
        used = pair["mixed"].threads
        found += _timed(flow, pair, peak, say)
    return Bench(
        threads=used,
        vector_unit=_core.simd_level(),
        peak=peak,
        flows=found,
        seconds=time.perf_counter() - begun,
        machine=machine(),
    )


def _step(simulation: Simulation, steps: int) -> float:
    """Seconds of ``steps`` steps."""
    start = time.perf_counter()
    simulation.advance(1e6, max_steps=steps)
    return time.perf_counter() - start


def _settled(
    flow: Flow, seconds: float, threads: int, say: Callable[[str], None]
) -> dict[Precision, Simulation]:
    """The flow after its first steps in both precisions, as large as fits into ``seconds``."""
    say(f"{flow.name}: how fast it is")
    pilot = Simulation(scene(flow, PILOT), precision="mixed", threads=threads)
    _step(pilot, 4)
    each = min(_step(pilot, 4) for _ in range(2)) / (4 * pilot.particles["fluid"])
    # Settling in mixed precision, then windows of about a twentieth of it in both; doubles take
    # twice as long. A third is left for filling and counting.
    steps = SETTLE + TURNS * _window() * 3
    particles = int(min(flow.most, 0.6 * seconds / (steps * each)))
    full = scene(flow, max(particles, PILOT))
    mixed = Simulation(full, precision="mixed", threads=threads)
    say(f"{flow.name}: {mixed.particles['fluid']:,} particles settle")
    _step(mixed, SETTLE)
    double = Simulation(full, precision="f64", threads=threads)
    double.restore(mixed.state())
    return {"mixed": mixed, "f64": double}


def _window() -> int:
    """Steps of a timed window: enough for the sort, which not every step needs, to average out."""
    return 6


def _timed(
    flow: Flow,
    pair: dict[Precision, Simulation],
    peak: dict[str, float],
    say: Callable[[str], None],
) -> list[Figures]:
    say(f"{flow.name}: whole steps")
    for simulation in pair.values():
        _step(simulation, 2)
    before = {p: _spent(s) for p, s in pair.items()}
    windows: dict[Precision, list[float]] = {p: [] for p in pair}
    # Turn by turn, so that what else the machine does meets both precisions alike.
    for _ in range(TURNS):
        for precision, simulation in pair.items():
            windows[precision].append(_step(simulation, _window()))
    found = []
    neighbours = mean_neighbours(pair["mixed"])
    for precision, simulation in pair.items():
        particles, steps = simulation.particles["fluid"], TURNS * _window()
        work = particles * _window()
        after = _spent(simulation)
        phases = {
            name: 1e9 * (after[name] - before[precision].get(name, 0.0)) / (particles * steps)
            for name in after
        }
        median = statistics.median(windows[precision])
        in_sweeps = 1e9 * neighbours / sum(phases[name] for name in SWEEPS)
        operations = flops.of_a_pair(flow.dimension)
        found.append(
            Figures(
                flow=flow.name,
                dimension=flow.dimension,
                precision=precision,
                particles=particles,
                wall_particles=simulation.particles["wall"],
                neighbours=neighbours,
                steps=steps,
                particle_steps=Rate(
                    work / median, work / max(windows[precision]), work / min(windows[precision])
                ),
                phases=phases,
                pairs=work * neighbours / median,
                pairs_in_sweeps=in_sweeps,
                flops_per_pair=operations,
                share_of_peak=in_sweeps * operations / peak[precision],
                bytes_per_particle=sum(simulation.memory.values()) / particles,
            )
        )
    return found


def _spent(simulation: Simulation) -> dict[str, float]:
    return {name: entry["seconds"] for name, entry in simulation.timings.items()}


def mean_neighbours(simulation: Simulation) -> float:
    """Neighbours of a fluid particle within the support, fluid and wall, on average."""
    import kolk

    bodies = simulation.bodies.values()
    fluid = np.concatenate([b.position for b in bodies if b.kind == "fluid"])
    wall = [b.position for b in bodies if b.kind == "wall"]
    scene = simulation.scene
    offsets, _ = kolk.neighbours(
        np.concatenate([fluid, *wall]), scene.support, periodic=scene.periodic_axes
    )
    return float(offsets[len(fluid)] / len(fluid))
