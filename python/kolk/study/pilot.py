"""A run of a few seconds that shows what the whole one will cost: `python -m kolk.study.pilot`.

It does what a run does, with its probes, a few frames and checkpoints, and stops the clock on each.
"""

from __future__ import annotations

import contextlib
import json
import sys
import tempfile
import time as clock
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kolk.output.atomic import write_json

from .alone import run_alone
from .job import Job
from .machine import peak_memory
from .worker import read_job, write_job

if TYPE_CHECKING:
    from kolk.output.folder import RunFolder
    from kolk.scene import Scene

Floats = NDArray[np.float64]

STATIONS = 200
"""Most moments at which the clocks are kept."""

FRAMES = 4
"""Frames that a pilot writes on the way: the first with all that it loads, and others whose time
counts."""


@dataclass(frozen=True)
class Pilot:
    """What a pilot run showed. Times in seconds, memory in bytes."""

    spacing: float
    particles: dict[str, int]
    threads: int
    until: float
    frames: int
    """Of the whole run."""
    set_up: float
    begin: float
    """First frame and first checkpoint, and the libraries that they load."""
    frame: float
    """Of a further frame: the median, since a disk lets one wait now and then."""
    checkpoint: float
    wall: float
    peak_memory: int
    engine_memory: int
    stations: list[list[float]]
    """Time reached (s), natural steps, seconds stepping, seconds on probes: since the start."""
    limits: list[str]
    """What set the step at each station."""

    @property
    def total(self) -> int:
        """Particles of all bodies."""
        return self.particles["total"]

    @property
    def whole(self) -> bool:
        """Whether it reached the end of the scene."""
        return self.stations[-1][0] >= self.until * (1.0 - 1e-9)

    @property
    def table(self) -> Floats:
        """(n, 4) the stations."""
        return np.asarray(self.stations, np.float64)


def fly(job: Job, seconds: float, place: Path | None = None) -> Pilot:
    """A pilot of at most so many seconds of steps, in a process of its own.

    Raises `RunError` where the process fails, with its reason.
    """
    with tempfile.TemporaryDirectory(prefix="kolk-pilot-", dir=place) as temporary:
        folder = Path(temporary)
        write_job(job, folder)
        run_alone("kolk.study.pilot", str(folder), repr(seconds))
        data: dict[str, Any] = json.loads((folder / "pilot.json").read_text(encoding="utf-8"))
    return Pilot(**data)


def perform(job: Job, seconds: float, folder: Path) -> Pilot:
    """The pilot, here; its files go into `folder`."""
    from kolk.execution import BREATH, MOST_STEPS, Schedule
    from kolk.output.folder import RunFolder
    from kolk.output.recorder import Recorder, Stopwatch
    from kolk.probes import build_probes
    from kolk.scene import load
    from kolk.simulation import Simulation

    started = clock.perf_counter()
    scene = load(job.unpack(folder / "job"))
    simulation = Simulation(scene, precision=job.precision, threads=job.threads)
    probes = build_probes(scene, simulation)
    set_up = clock.perf_counter() - started
    schedule = Schedule(scene.until, float(scene.output.every or scene.until))
    place = RunFolder(folder / "run")
    place.claim(force=False)
    watch = Stopwatch()
    recorder = Recorder(simulation, place, probes, scene.output.fields, schedule.frames, watch)
    begun = clock.perf_counter()
    recorder.begin()
    recorder.checkpoint({})
    begin = clock.perf_counter() - begun
    stepping = 0.0
    steps, passed = 1, 0
    framing: list[float] = []
    rows: list[list[float]] = [[0.0, 0.0, 0.0, 0.0]]
    limits = [simulation.limit]
    probing = watch.phases.get("probes", {"seconds": 0.0})["seconds"]
    since = clock.perf_counter()
    while simulation.time < scene.until and clock.perf_counter() - since < seconds:
        target = schedule.after(simulation.time)
        while simulation.time < target and clock.perf_counter() - since < seconds:
            before = clock.perf_counter()
            simulation.advance_to(target, steps)
            spent = clock.perf_counter() - before
            stepping += spent
            if not recorder.sampling:
                steps = max(1, min(2 * steps, int(steps * BREATH / max(spent, 1e-6)), MOST_STEPS))
            recorder.sample()
            passed += simulation.time >= target
            if simulation.time <= rows[-1][0]:
                continue  # the guard has gone back: what it costs counts with what follows
            looked = watch.phases.get("probes", {"seconds": 0.0})["seconds"] - probing
            # A step cut short by a frame counts half of one.
            natural = simulation.step_count - 0.5 * passed
            rows.append([simulation.time, natural, stepping, looked])
            limits.append(simulation.limit)
        if len(framing) < FRAMES and simulation.time >= target:
            framing.append(timed(recorder.frame))
    framing.append(timed(recorder.frame))
    checkpoint = timed(lambda: recorder.checkpoint({}))
    recorder.close(finished=True)
    _look_back(scene, place)
    kept = np.unique(np.linspace(0, len(rows) - 1, STATIONS).astype(int))
    return Pilot(
        spacing=job.spacing,
        particles={**simulation.particles, "total": sum(simulation.particles.values())},
        threads=simulation.threads,
        until=scene.until,
        frames=schedule.frames,
        set_up=set_up,
        begin=begin,
        frame=median(framing),
        checkpoint=checkpoint,
        wall=clock.perf_counter() - started,
        peak_memory=peak_memory(),
        engine_memory=sum(simulation.memory.values()),
        stations=[rows[i] for i in kept],
        limits=_natural([limits[i] for i in kept]),
    )


def timed(action: Callable[[], None]) -> float:
    """Seconds that an action takes."""
    begun = clock.perf_counter()
    action()
    return clock.perf_counter() - begun


def _look_back(scene: Scene, place: RunFolder) -> None:
    """What a run does at its end, for the memory that it takes; what it finds does not matter."""
    from kolk.compare import compare
    from kolk.execution import write_scene
    from kolk.results import Run

    write_scene(scene, place)
    run = Run(place.path)
    # So short a record may hold nothing to compare.
    with contextlib.suppress(Exception):
        compare(run)
    for name in run.probes:
        run.probes[name]


def _natural(limits: list[str]) -> list[str]:
    """The limits without those of frames, in whose place the next other one stands."""
    others = [limit for limit in limits if limit != "output"]
    found, last = [], others[0] if others else "acoustic"
    for limit in limits:
        last = limit if limit != "output" else last
        found.append(last)
    return found


def main() -> None:
    folder = Path(sys.argv[1])
    pilot = perform(read_job(folder), float(sys.argv[2]), folder)
    write_json(folder / "pilot.json", asdict(pilot), "write the pilot")


if __name__ == "__main__":
    main()
