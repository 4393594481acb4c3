"""Carrying out a job: `perform`, or `python -m kolk.study.worker FOLDER` in a process of its own.

The folder holds the job's files and `job.json`; the record is written beside them.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time as clock
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kolk.errors import InstabilityError

from .job import SCENE, Job, machine_name
from .machine import busy_seconds, peak_memory
from .record import Costs, Record, Score, Track

if TYPE_CHECKING:
    from kolk.results import Run

HISTORY = "kinetic energy"
"""The record that every run has, for scenes without probes."""


def perform(job: Job, place: str | None = None, alone: bool = False) -> Record:
    """Runs a job here and measures it. place: where frames may lie meanwhile.

    Meant for the worker processes of an executor: the job is all that it needs.
    """
    from kolk.errors import SceneError
    from kolk.runner import run
    from kolk.scene import load

    with tempfile.TemporaryDirectory(prefix="kolk-run-", dir=place) as temporary:
        folder = Path(temporary)
        scene = load(job.unpack(folder / "job"))
        begun, processor, busy = clock.perf_counter(), clock.process_time(), busy_seconds()
        reason = ""
        try:
            finished = run(
                scene,
                folder / "run",
                precision=job.precision,
                threads=job.threads,
                quiet=True,
                pictures=False,
            )
        except InstabilityError as error:
            from kolk.results import Run

            reason, finished = str(error), Run(folder / "run")
        except SceneError:
            raise
        wall = clock.perf_counter() - begun
        # The start of the process is no part of `wall`, but its time was used all the same.
        used = clock.process_time() - (0.0 if alone else processor)
        own = clock.process_time() - processor
        others = (busy_seconds() - busy - own) / wall
        return _record(job, finished, reason, alone, wall, used, others)


def _record(
    job: Job, run: Run, reason: str, alone: bool, wall: float, cpu: float, others: float
) -> Record:
    summary = run.summary
    phases = {k: float(v["seconds"]) for k, v in summary["seconds"]["phases"].items()}
    steps = int(summary["steps"]["total"])
    total = int(summary["particles"]["total"])
    rate = float(summary["particle_steps_per_second"])
    return Record(
        key=job.key,
        name=job.name,
        spacing=job.spacing,
        precision=job.precision,
        threads=job.threads,
        alone=alone,
        outcome=run.outcome,
        reason=reason,
        particles={k: int(v) for k, v in summary["particles"].items()},
        steps=steps,
        limits=summary["steps"]["by_limit"],
        costs=Costs(
            wall=wall - phases.get("comparison", 0.0),
            cpu=cpu,
            stepping=steps * total / rate if rate else 0.0,
            peak_memory=peak_memory(),
            engine_memory=sum(summary["memory"].values()),
            others=others,
        ),
        phases=phases,
        scores=tuple(_scores(run)) if run.outcome == "done" else (),
        machine=machine_name(),
        version=str(summary["kolk"]),
        until=float(summary["time"]["until"]),
        compression=compression(run),
        tracks=tracks(run),
    )


def compression(run: Run) -> float:
    """How far the fluid is compressed: the largest density over the reference less one.

    The median over the frames, since an impact passes; 0 where fluids of several densities hide it.
    """
    densities = {fluid.density for fluid in run.scene.fluid}
    if len(densities) > 1 or not len(run.history):
        return 0.0
    largest = float(np.median(run.history["density_max"].to_numpy(np.float64)))
    return max(largest / densities.pop() - 1.0, 0.0)


def _scores(run: Run) -> list[Score]:
    from .scores import scores

    return scores(run)


def tracks(run: Run) -> dict[str, Track]:
    """The records of a run's probes; the kinetic energy of its history where it has none."""
    about: Mapping[str, Any] = run.summary["probes"]
    found = {}
    for name, table in run.probes.items():
        rows = table.to_numpy(np.float64)
        found[name] = Track(
            name, about[name]["quantity"], about[name]["unit"], tuple(table.columns[1:]), rows
        )
    if not found:
        rows = run.history[["time", "kinetic_energy"]].to_numpy(np.float64)
        found[HISTORY] = Track(HISTORY, "energy", "J", ("value",), rows)
    return found


def write_job(job: Job, folder: Path) -> None:
    """What `main` reads."""
    job.unpack(folder)
    about = {"name": job.name, "spacing": job.spacing}
    about |= {"precision": job.precision, "threads": job.threads, "files": sorted(job.files)}
    (folder / "job.json").write_text(json.dumps(about), encoding="utf-8")


def read_job(folder: Path) -> Job:
    """What `write_job` wrote."""
    about = json.loads((folder / "job.json").read_text(encoding="utf-8"))
    files = {name: (folder / name).read_bytes() for name in about.pop("files")}
    assert SCENE in files
    return Job(files=files, **about)


def main() -> None:
    folder = Path(sys.argv[1])
    perform(read_job(folder), place=str(folder), alone=True).save(folder)


if __name__ == "__main__":
    main()
