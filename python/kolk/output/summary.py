"""`summary.json`: what a run was, what it cost, and how it ended, for people and for scripts."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kolk.output.stability import stability_report

if TYPE_CHECKING:
    from kolk.output.recorder import Recorder
    from kolk.simulation import Simulation

ENGINE_LIBRARIES = ("numpy", "h5py", "pydantic")
"""Packages whose versions may matter to a result."""


def version() -> str:
    """The version of kolk."""
    from importlib.metadata import PackageNotFoundError
    from importlib.metadata import version as installed

    try:
        return installed("kolk")
    except PackageNotFoundError:
        return "unknown"


def versions() -> dict[str, str]:
    """Versions of kolk, Python and the libraries that a result rests on."""
    from importlib.metadata import PackageNotFoundError
    from importlib.metadata import version as installed

    found = {"kolk": version(), "python": platform.python_version()}
    for name in ENGINE_LIBRARIES:
        try:
            found[name] = installed(name)
        except PackageNotFoundError:
            found[name] = "unknown"
    return found


def machine() -> dict[str, Any]:
    """The machine: processor, cores, memory (bytes), system."""
    try:
        memory: int | None = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        memory = None
    return {
        "processor": _processor(),
        "architecture": platform.machine(),
        "cores": os.cpu_count(),
        "memory": memory,
        "system": f"{platform.system()} {platform.release()}",
    }


def _processor() -> str:
    if sys.platform.startswith("linux"):
        try:
            for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
        except OSError:
            pass
    return platform.processor() or platform.machine()


def energy_record(diagnostics: Mapping[str, Any]) -> dict[str, float]:
    """The stored forms of energy in the engine's diagnostics, J."""
    names = ("kinetic", "potential", "compression")
    record = {name: float(diagnostics[f"{name}_energy"]) for name in names}
    return {**record, "total": sum(record.values())}


def energy_budget(initial: Mapping[str, float], diagnostics: Mapping[str, Any]) -> dict[str, Any]:
    """Energy at the start and now, what the effects dissipated, and what is unaccounted for, J.

    `unaccounted` is the total now plus what was dissipated minus the total at the start: the error
    of the scheme and of the sampling of powers. `walls` is negative where walls that move do work.
    """
    final = energy_record(diagnostics)
    dissipated = {str(k): float(v) for k, v in dict(diagnostics["dissipated"]).items()}
    gone = sum(dissipated.values())
    return {
        "initial": dict(initial),
        "final": final,
        "dissipated": dissipated,
        "unaccounted": final["total"] + gone - initial["total"],
    }


def summary_of(
    simulation: Simulation,
    recorder: Recorder,
    *,
    outcome: str,
    reason: str,
    initial_energy: Mapping[str, float],
    seconds: float,
    stepping: float,
    engine: Mapping[str, Mapping[str, float]],
    outside: Mapping[str, Mapping[str, float]],
    limits: Mapping[str, int],
) -> dict[str, Any]:
    """Everything that the summary says without looking at references.

    seconds, limits, the seconds of them spent on steps, and the time by phase in the engine and
    outside it: over all sittings of a resumed run.
    """
    from kolk.scene.automatic import choices

    scene = simulation.scene
    now = simulation.diagnostics
    steps, counts = simulation.step_count, simulation.particles
    total = sum(counts.values())
    return {
        "kolk": version(),
        "outcome": outcome,
        "reason": reason or None,
        "scene": {
            "name": scene.name,
            "title": scene.title,
            "dimension": simulation.dimension,
            "spacing": scene.spacing,
            "sound_speed": scene.sound_speed,
            "density": scene.fluid[0].density,
            "precision": simulation.precision,
            "threads": simulation.threads,
        },
        "time": {"reached": simulation.time, "until": scene.until},
        "particles": {**counts, "total": total},
        "frames": recorder.frames,
        "steps": {
            "total": steps,
            "by_limit": limits,
            "mean_time_step": simulation.time / steps if steps else None,
        },
        "seconds": {"total": seconds, "engine": stepping, "phases": {**engine, **outside}},
        # The calls that take steps as a user's clock sees them; what is measured and written
        # between them left out.
        "particle_steps_per_second": steps * total / max(stepping, 1e-9),
        "memory": simulation.memory,
        "energy": energy_budget(initial_energy, now),
        "momentum": now["momentum"],
        "stability": stability_report(recorder.folder.history, simulation, limits),
        "effects": simulation.effects,
        "choices": [asdict(choice) for choice in choices(scene)],
        "probes": {
            probe.name: {
                "quantity": probe.quantity,
                "unit": probe.unit,
                "columns": ["time", *probe.columns],
                "every": every,
            }
            for probe, every in recorder.probes
        },
        "versions": versions(),
        "machine": machine(),
    }
