"""What the three workers share: their command line, the clock, and the record they leave.

A worker runs one scene with one code in its own process and environment, and writes ``record.json``
and the final positions and velocities (``final.npz``) into the folder it is given.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
from scenes import Array

WARM_UP = 3  # steps before the clock starts: page faults, thread start, first sorts
FRONTS = 60  # samples of the front in a run to the end


@dataclass(frozen=True)
class Job:
    """One run: to the scene's end when ``steps`` is 0, else that many steps after the warm-up."""

    scene: str
    cells: int
    steps: int
    threads: int
    variant: str
    folder: Path


def parse_job() -> Job:
    parser = argparse.ArgumentParser()
    parser.add_argument("--scene", required=True)
    parser.add_argument("--cells", type=int, required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("--variant", required=True)
    parser.add_argument("--folder", type=Path, required=True)
    return Job(**vars(parser.parse_args()))


@dataclass
class Clock:
    """Counts the steps and the wall time after the warm-up, and keeps the front's path."""

    steps: int = 0
    started: float = 0.0
    time_at_start: float = 0.0
    fronts: list[tuple[float, float]] = field(default_factory=list)

    def start(self, physical: float) -> None:
        self.steps = 0
        self.time_at_start = physical
        self.started = time.perf_counter()

    def seconds(self) -> float:
        return time.perf_counter() - self.started


@dataclass(frozen=True)
class Record:
    """The figures of one run. ``evaluations``: force evaluations in the ``steps`` timed ones."""

    version: str
    fluid: int
    wall: int
    steps: int
    evaluations: float
    wall_seconds: float
    physical_seconds: float
    end: float
    peak_bytes: int
    fronts: list[tuple[float, float]]


def peak_bytes() -> int:
    """Peak resident memory of this process.

    On Linux `getrusage` also counts what the parent had when it started this process.
    """
    status = Path("/proc/self/status")
    if status.is_file():
        lines = status.read_text(encoding="ascii", errors="replace").splitlines()
        peaks = [line.split()[1] for line in lines if line.startswith("VmHWM:")]
        if peaks:
            return int(peaks[0]) * 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024


def leave(job: Job, record: Record, position: Array, velocity: Array, wall: Array) -> None:
    np.savez(job.folder / "final.npz", position=position, velocity=velocity, wall=wall)
    (job.folder / "record.json").write_text(json.dumps(asdict(record)), encoding="utf-8")
