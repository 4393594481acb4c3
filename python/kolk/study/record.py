"""What one measured run left behind: costs, errors, and the records of its probes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from kolk.output.atomic import replacing, write_json

Floats = NDArray[np.float64]
Basis = Literal["analytic", "experiment"]

DISTURBED = 0.15
"""Cores taken by other programs, above which a run's times are marked."""


@dataclass(frozen=True)
class Score:
    """One relative error of a run against a reference."""

    name: str
    error: float
    """Share of the reference's size, such as 0.012."""
    basis: Basis
    sentence: str = ""


@dataclass(frozen=True)
class Track:
    """The record of a probe, or a column of the history."""

    name: str
    quantity: str
    unit: str
    columns: tuple[str, ...]
    """After the time."""
    rows: Floats
    """(n, 1 + k): time (s), then the columns."""


@dataclass(frozen=True)
class Costs:
    """What a run took. Times in seconds, memory in bytes."""

    wall: float
    """From the filling of the scene to the end of its output; pictures and comparison left out."""
    cpu: float
    """Of all threads, the process's start included."""
    stepping: float
    """Inside the calls that take steps."""
    peak_memory: int
    """Largest resident size of the process."""
    engine_memory: int
    """Held by the engine."""
    others: float = 0.0
    """Cores that other programs took meanwhile, on average; NaN where the system does not say."""


@dataclass(frozen=True)
class Record:
    """A measured run."""

    key: str
    name: str
    spacing: float
    precision: str
    threads: int
    alone: bool
    """Measured in a process of its own with nothing else of the study beside it."""
    outcome: str
    """As in a run's summary; "done" is the only good one."""
    reason: str
    particles: dict[str, int]
    steps: int
    limits: dict[str, int]
    costs: Costs
    phases: dict[str, float]
    """Seconds by phase."""
    scores: tuple[Score, ...]
    machine: str
    version: str
    until: float
    compression: float = 0.0
    """Largest density over the reference less one, in the median of its frames."""
    tracks: dict[str, Track] = field(default_factory=dict, repr=False)

    @property
    def done(self) -> bool:
        """Whether the run reached its end."""
        return self.outcome == "done"

    @property
    def particle_steps(self) -> int:
        """Particles times steps."""
        return self.particles["total"] * self.steps

    @property
    def disturbed(self) -> bool:
        """Whether other programs took a share of the machine that the times show."""
        return not self.alone or self.costs.others > DISTURBED

    def save(self, folder: Path) -> None:
        """Writes `record.json`, last, and `tracks.npz`."""
        arrays = {f"{i}": track.rows for i, track in enumerate(self.tracks.values())}
        with replacing(folder / "tracks.npz") as part, open(part, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        data = {k: v for k, v in asdict_shallow(self).items() if k != "tracks"}
        data["costs"] = asdict(self.costs)
        data["scores"] = [asdict(score) for score in self.scores]
        data["tracks"] = [
            {"name": t.name, "quantity": t.quantity, "unit": t.unit, "columns": list(t.columns)}
            for t in self.tracks.values()
        ]
        write_json(folder / "record.json", data, "write the record of a run")

    @classmethod
    def load(cls, folder: Path) -> Record:
        """Reads what `save` wrote. Raises OSError, ValueError or KeyError for anything else."""
        data: dict[str, Any] = json.loads((folder / "record.json").read_text(encoding="utf-8"))
        with np.load(folder / "tracks.npz") as arrays:
            tracks = [
                Track(**{**about, "columns": tuple(about["columns"])}, rows=arrays[str(i)])
                for i, about in enumerate(data.pop("tracks"))
            ]
        scores = tuple(
            Score(**{**s, "error": float("nan") if s["error"] is None else s["error"]})
            for s in data.pop("scores")
        )
        costs = Costs(**_numbers(data.pop("costs")))
        return cls(**data, costs=costs, scores=scores, tracks={t.name: t for t in tracks})


def asdict_shallow(record: Record) -> dict[str, Any]:
    """Fields by name, as they are."""
    return {name: getattr(record, name) for name in record.__dataclass_fields__}


def _numbers(costs: Mapping[str, Any]) -> dict[str, Any]:
    return {k: float("nan") if v is None else v for k, v in costs.items()}
