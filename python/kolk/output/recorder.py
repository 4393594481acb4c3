"""The observer of a run: writes its frames, probe rows, history and checkpoints.

Everything that must survive a restart besides the engine's own state is in the `book` that goes
into each checkpoint: the number of frames, the length of each table, the next sample of each
probe. Frames and rows reach the disk before the checkpoint that counts them.
"""

from __future__ import annotations

import hashlib
import json
import math
import time as clock
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from kolk.output.checkpoint import Checkpoint, write_checkpoint
from kolk.output.folder import RunFolder
from kolk.output.stability import leaks, voids
from kolk.output.tables import Table
from kolk.output.vtkhdf import FieldsFile, FieldsLayout, body_ranges

if TYPE_CHECKING:
    from kolk.probes import Probe
    from kolk.simulation import Simulation

COMPONENTS = {"velocity": 3, "pressure": 1, "density": 1}
"""Fields of a frame that change, and the components that the file holds of each."""

MOST_PLANNED = 2000
"""Frames that a time series makes room for in advance; a longer one grows."""

ADJUSTABLE = ("courant", "time_step", "guard")
"""Engine settings that may change where a run is resumed."""

HISTORY = (
    "kinetic_energy",
    "potential_energy",
    "compression_energy",
    "dissipated",
    "density_min",
    "density_max",
    "speed_max",
    "mach",
    "pressure_min",
    "pressure_max",
    "closest_pair",
    "crowded",
)
"""Columns of `history.csv` after time, step and time_step, as the engine reports them; then come
`leaks` and `voids`, and the steps so far that each criterion has set."""


class Stopwatch:
    """Seconds and calls by phase, for what happens outside the engine."""

    def __init__(self) -> None:
        self.phases: dict[str, dict[str, float]] = {}
        self.begun = clock.perf_counter()

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Adds the time of the block to a phase."""
        begun = clock.perf_counter()
        try:
            yield
        finally:
            entry = self.phases.setdefault(name, {"seconds": 0.0, "calls": 0})
            entry["seconds"] += clock.perf_counter() - begun
            entry["calls"] += 1


class Sampler:
    """A probe with its table: a row at every multiple of `every` (s).

    A row is the mean of the probe's `readings`, spread evenly over the interval that it ends: a
    sample at one moment of a signal with sound in it would be a matter of chance.
    """

    def __init__(self, probe: Probe, every: float, folder: RunFolder, book: Any = None) -> None:
        self.probe, self.every = probe, every / probe.readings
        self.next = int(book["next"]) if book else 0
        length = int(book["length"]) if book else None
        self.sums = [float(value) for value in book["sums"]] if book else []
        self.count = int(book["count"]) if book else 0
        self._past: list[tuple[float, dict[str, Any]]] = [
            (float(time), dict(before)) for time, before in (book["past"] if book else ())
        ]
        """Time of each reading that the engine may still take back, and the book before it."""
        self.table = Table(folder.probe(probe.name), ("time", *probe.columns), length)

    def take(self, simulation: Simulation) -> None:
        """Takes a reading if one is due, and adds a row if it completes one."""
        now = simulation.time
        if now < self.next * self.every * (1.0 - 1e-12):
            return
        self._past.append((now, self._count()))
        reading = (now, *self.probe.evaluate(simulation))
        self.sums = (
            [a + b for a, b in zip(self.sums, reading, strict=True)] if self.sums else list(reading)
        )
        self.count += 1
        row = math.ceil(self.next / self.probe.readings) * self.probe.readings
        if now >= row * self.every * (1.0 - 1e-12):
            self.table.append(tuple(value / self.count for value in self.sums))
            self.sums, self.count = [], 0
        self.next = math.floor(now / self.every * (1.0 + 1e-12)) + 1

    def settle(self, kept: float) -> None:
        """Forgets how to take back the readings up to the time `kept`: the engine never will."""
        self._past = [entry for entry in self._past if entry[0] > kept]

    def take_back(self, kept: float) -> None:
        """Takes back the readings after the time `kept`, to which the engine has gone back."""
        undone = [book for time, book in self._past if time > kept]
        if undone:
            first = undone[0]
            self.next, self.sums, self.count = first["next"], first["sums"], first["count"]
            self.table.cut(first["length"])
        self._past = []

    def book(self) -> dict[str, Any]:
        """What a checkpoint keeps of it."""
        return {**self._count(), "past": self._past}

    def _count(self) -> dict[str, Any]:
        return {
            "next": self.next,
            "length": self.table.length,
            "sums": self.sums,
            "count": self.count,
        }


class Recorder:
    """Writes a run into its folder. `begin` a new one, or `resume` after a checkpoint's book."""

    def __init__(
        self,
        simulation: Simulation,
        folder: RunFolder,
        probes: Sequence[tuple[Probe, float]],
        fields: Sequence[str],
        capacity: int,
        watch: Stopwatch,
    ) -> None:
        self.simulation, self.folder, self.watch = simulation, folder, watch
        self.probes = list(probes)
        self._fields, self._capacity = tuple(fields), min(capacity, MOST_PLANNED)
        self._series: FieldsFile | None = None
        self._samplers: list[Sampler] = []
        self._history: Table | None = None
        self._undone = 0
        self.written = -math.inf
        """Time of the last frame, s."""

    @property
    def frames(self) -> int:
        """Frames written so far."""
        return self._series.frames if self._series is not None else 0

    @property
    def sampling(self) -> bool:
        """Whether there are probes."""
        return bool(self._samplers)

    @property
    def fingerprint(self) -> str:
        """What a checkpoint must belong to: engine settings, particles, precision, probes."""
        simulation = self.simulation
        digest = hashlib.sha256()
        config = json.loads(simulation.scene.engine_config())
        # What a run that became unstable may go on with is not part of it.
        settings = {key: value for key, value in config.items() if key not in ADJUSTABLE}
        digest.update(json.dumps(settings).encode())
        digest.update(simulation.precision.encode())
        described = [(p.name, p.quantity, p.columns, every) for p, every in self.probes]
        digest.update(json.dumps([described, self._fields]).encode())
        for body in simulation.initial.values():
            digest.update(f"{body.name} {body.kind} {len(body.mass)}".encode())
            for array in (body.position, body.velocity, body.density, body.mass):
                digest.update(np.ascontiguousarray(array, dtype=np.float64).tobytes())
        return digest.hexdigest()

    def begin(self) -> None:
        """Creates the files and writes the first frame and the first samples."""
        self._history = Table(self.folder.history, self._columns())
        self._samplers = [Sampler(p, every, self.folder) for p, every in self.probes]
        self.frame()
        self.sample()

    def resume(self, book: Mapping[str, Any]) -> None:
        """Cuts the files back to what a checkpoint counts, ready to go on."""
        self._history = Table(self.folder.history, self._columns(), int(book["history"]))
        kept = book["probes"]
        self._samplers = [Sampler(p, every, self.folder, kept[p.name]) for p, every in self.probes]
        self._undone, self.written = int(book["undone"]), float(book["written"])
        self._series = FieldsFile.reopen(self.folder.fields, int(book["frames"]))

    def sample(self) -> None:
        """Takes the probe samples that are due, and back those of steps that were taken back."""
        if self._samplers:
            with self.watch.phase("probes"):
                guard = self.simulation.retries
                kept = math.inf if guard["kept"] is None else guard["kept"]
                for sampler in self._samplers:
                    if guard["undone"] != self._undone:
                        sampler.take_back(kept)
                    sampler.take(self.simulation)
                    sampler.settle(kept)
                self._undone = guard["undone"]

    def frame(self) -> None:
        """Writes a frame and a row of the history."""
        with self.watch.phase("frames"):
            simulation = self.simulation
            bodies = [view.arrays() for view in simulation.bodies.values()]

            def joined(name: str) -> Any:
                return np.concatenate([np.asarray(body[name]) for body in bodies])

            values = {name: joined(name) for name in self._fields if name in COMPONENTS}
            position = joined("position")
            if self._series is None:
                self._series = FieldsFile.create(
                    self.folder.fields,
                    self._layout(),
                    self._capacity,
                    simulation.time,
                    position,
                    values,
                )
            else:
                self._series.append(simulation.time, position, values)
            self._add_history()
            self.written = simulation.time

    def checkpoint(self, extra: Mapping[str, Any]) -> None:
        """Replaces the checkpoint by the present state; `extra` joins the book."""
        with self.watch.phase("checkpoint"):
            for table in self._tables():
                table.sync()
            assert self._history is not None
            book = {
                "frames": self.frames,
                "history": self._history.length,
                "undone": self._undone,
                "written": self.written,
                "probes": {s.probe.name: s.book() for s in self._samplers},
                **extra,
            }
            state = self.simulation.state()
            write_checkpoint(self.folder.checkpoint, Checkpoint(state, book, self.fingerprint))

    def close(self, *, finished: bool) -> None:
        """Closes the files; a finished time series gives back the room it did not need."""
        if self._series is not None:
            self._series.close(trim=finished)
        for table in self._tables():
            table.close()

    def _tables(self) -> list[Table]:
        tables = [sampler.table for sampler in self._samplers]
        return [*tables, self._history] if self._history is not None else tables

    def _columns(self) -> tuple[str, ...]:
        limits = (f"steps_{name}" for name in self.simulation.steps_by_limit)
        return ("time", "step", "time_step", *HISTORY, "leaks", "voids", *limits)

    def _add_history(self) -> None:
        simulation = self.simulation
        now = simulation.diagnostics
        now["dissipated"] = math.fsum(dict(now["dissipated"]).values())
        head = (now["time"], simulation.step_count, simulation.time_step)
        tail = (leaks(simulation), voids(simulation))
        assert self._history is not None
        self._history.append(
            (*head, *(now[name] for name in HISTORY), *tail, *simulation.steps_by_limit.values())
        )

    def _layout(self) -> FieldsLayout:
        bodies = list(self.simulation.initial.values())
        sizes = [len(body.mass) for body in bodies]
        constant: dict[str, Any] = {
            "body": np.repeat(np.arange(len(bodies), dtype=np.int32), sizes),
            "kind": np.repeat([np.uint8(b.kind == "wall") for b in bodies], sizes),
        }
        if "mass" in self._fields:
            constant["mass"] = np.concatenate(
                [np.asarray(b.mass, dtype=np.float64) for b in bodies]
            )
        if "id" in self._fields:
            # Within each body, as `Simulation.bodies` counts.
            constant["id"] = np.concatenate([np.arange(size, dtype=np.int64) for size in sizes])
        return FieldsLayout(
            dimension=self.simulation.dimension,
            bodies=body_ranges([(b.name, b.kind, len(b.mass)) for b in bodies]),
            changing={name: COMPONENTS[name] for name in self._fields if name in COMPONENTS},
            constant=constant,
            points=_point_type(
                max(float(np.max(np.abs(b.position))) for b in bodies),
                self.simulation.scene.spacing,
            ),
        )


def _point_type(farthest: float, spacing: float) -> str:
    """Type of the positions in frames: float32 where it resolves 1e-4 of the spacing."""
    return "f4" if farthest * float(np.finfo(np.float32).eps) < 1e-4 * spacing else "f8"
