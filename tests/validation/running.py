"""Running a scene for a case: the way a user does, into a folder that is thrown away."""

from __future__ import annotations

import dataclasses
import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

import kolk

from .suite import Case, Level

FloatArray = npt.NDArray[np.float64]

THREADS = int(os.environ.get("KOLK_VALIDATION_THREADS", "1"))
"""The figures do not depend on it: a run has the same bits for every number of threads."""


PRECISION: Literal["f64", "mixed"] = "mixed"
"""Of the runs of a case that does not choose its own: the default of a user."""


@contextmanager
def finished_run(
    scene: kolk.Scene, precision: Literal["f64", "mixed"] | None = None
) -> Iterator[kolk.Run]:
    """The finished run of ``scene``; its folder lasts as long as the context."""
    with tempfile.TemporaryDirectory(prefix="kolk-validation-") as folder:
        yield kolk.run(
            scene,
            Path(folder) / "run",
            precision=precision or PRECISION,
            threads=THREADS,
            quiet=True,
            pictures=False,
        )


def simulation(
    scene: kolk.Scene, precision: Literal["f64", "mixed"] | None = None
) -> kolk.Simulation:
    """A simulation of ``scene`` on the suite's threads."""
    return kolk.Simulation(scene, precision=precision or PRECISION, threads=THREADS)


def probe(run: kolk.Run, name: str, column: str = "value") -> tuple[FloatArray, FloatArray]:
    """Time (n,) s and value (n,) SI of a probe of ``run``."""
    table = run.probes[name]
    return table["time"].to_numpy(np.float64), table[column].to_numpy(np.float64)


def counts(run: kolk.Run | kolk.Simulation) -> dict[str, int]:
    """Particles and steps of a run, as a `Level` takes them."""
    if isinstance(run, kolk.Simulation):
        return {"particles": sum(run.particles.values()), "steps": run.step_count}
    particles: dict[str, Any] = run.summary["particles"]
    wanted = (particles.get("fluid", 0), particles.get("wall", 0))
    return {"particles": sum(map(int, wanted)), "steps": int(run.summary["steps"]["total"])}


def run_level(case: Case, resolution: int) -> Level:
    """The case at one resolution, with the time it took."""
    start = time.perf_counter()
    level = case.run(resolution)
    return dataclasses.replace(level, seconds=time.perf_counter() - start)
