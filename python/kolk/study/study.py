"""What accuracy costs in time: the runs of a study, and what may be concluded from them."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kolk.errors import RunError, SceneError
from kolk.output.atomic import storage_error, write_json, write_text
from kolk.output.folder import safe_name

from .curve import Curve, Ladder, ladder
from .job import Job, machine_name, make_job, package_digest
from .ladder import DEFAULT, Variant, check_spacings, default_spacings, variants
from .pareto import pareto_front
from .record import Record
from .store import STUDIES, Store
from .worker import perform

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from kolk.scene import Scene
    from kolk.simulation import Precision


class StudyInterrupted(KeyboardInterrupt):
    """A study ended by Ctrl-C; the runs that were finished are kept."""

    def __init__(self, finished: int, planned: int) -> None:
        super().__init__(
            f"interrupted with {finished} of {planned} runs finished; they are kept, and the same "
            "command goes on with the others"
        )
        self.finished, self.planned = finished, planned


@dataclass(frozen=True)
class Study:
    """Runs of a scene over spacings and settings, measured; made by `kolk.accuracy`."""

    scene: Scene
    variants: tuple[Variant, ...]
    """The first is the scene as it is."""
    records: Mapping[str, tuple[Record, ...]]
    """By the label of the variant."""
    folder: Path
    store: Path
    """Where its runs are kept."""
    quantity: str | None = None
    """The error that it speaks of; None for the leading one."""
    notes: tuple[str, ...] = field(default=())

    @cached_property
    def ladders(self) -> dict[str, Ladder]:
        """The ladder of every variant, by its label."""
        first = ladder(self.variants[0], self.records[self.variants[0].label])
        others = {v.label: ladder(v, self.records[v.label], first) for v in self.variants[1:]}
        return {first.variant.label: first, **others}

    @property
    def base(self) -> Ladder:
        """The ladder of the scene as it is."""
        return self.ladders[self.variants[0].label]

    @property
    def leading(self) -> str:
        """Name of the error that the study speaks of."""
        return self.quantity or self.base.leading

    def curve(self, name: str | None = None, variant: str = DEFAULT) -> Curve:
        """Error against spacing of a variant. Raises `RunError` for a name that there is not."""
        wanted = name or self.leading
        found = self.ladders[variant]
        try:
            return found.curve(wanted)
        except KeyError:
            raise RunError(
                f"quantity: {wanted!r} is not among what the study measured: "
                f"{', '.join(found.names) or 'nothing, since no run reached its end'}"
            ) from None

    @property
    def front(self) -> list[tuple[str, int]]:
        """The Pareto front of time and leading error: labels of variants, numbers of levels."""
        points: list[tuple[str, int, float, float]] = []
        for label, rungs in self.ladders.items():
            if not rungs.records:
                continue
            curve = self.curve(variant=label)
            walls = {record.spacing: record.costs.wall for record in rungs.records}
            for i, (h, error) in enumerate(zip(curve.spacing, curve.error, strict=True)):
                points.append((label, i, walls[float(h)], float(error)))
        best = pareto_front([p[2] for p in points], [p[3] for p in points])
        return [points[i][:2] for i in best]

    @property
    def sentences(self) -> list[str]:
        """What the study shows, in plain English."""
        from .words import sentences

        return sentences(self)

    @property
    def table(self) -> Any:
        """One row a run, as a pandas frame; see `kolk.study.tables`."""
        from .tables import table

        return table(self)

    @property
    def bars(self) -> Any:
        """Every probe's statistics with their error bars, as a pandas frame."""
        from .tables import bars

        return bars(self)

    def plot(self, path: str | Path | None = None) -> Figure:
        """The picture of error against time, as a Matplotlib figure; written to `path` if given."""
        from .picture import picture

        return picture(self, None if path is None else Path(path))

    def save(self) -> list[Path]:
        """Writes picture, tables, sentences and `study.json` into the folder; returns the paths."""
        from .tables import write_tables

        data = {
            "scene": self.scene.name,
            "store": os.path.relpath(self.store, self.folder),
            "quantity": self.quantity,
            "leading": self.leading if self.base.records else None,
            "variants": [
                {
                    "label": v.label,
                    "changes": dict(v.changes),
                    "runs": [record.key for record in self.records[v.label]],
                }
                for v in self.variants
            ],
            "sentences": self.sentences,
            "machine": machine_name(),
            "package": package_digest(),
            "notes": list(self.notes),
        }
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.scene.save(self.folder / "scene.toml")
            made = write_tables(self)
            if self.base.records:
                self.plot(self.folder / "accuracy.png")
                made.append(self.folder / "accuracy.png")
        except OSError as error:
            raise storage_error(self.folder, error, "write the study") from error
        write_text(
            self.folder / "sentences.txt", "\n".join(self.sentences) + "\n", "write the study"
        )
        write_json(self.folder / "study.json", data, "write the study")
        return made

    def __repr__(self) -> str:
        runs = sum(map(len, self.records.values()))
        return f"<kolk study of {self.scene.name!r}: {runs} runs, {len(self.variants)} variants>"


def accuracy(
    scene: Scene | str | Path,
    spacings: Sequence[float] | None = None,
    *,
    vary: Mapping[str, Sequence[Any]] | None = None,
    cross: bool = False,
    quantity: str | None = None,
    precision: Precision | None = None,
    threads: int = 0,
    executor: Executor | None = None,
    out: str | Path | None = None,
    store: str | Path | None = None,
    quiet: bool = False,
) -> Study:
    """Runs a scene over a ladder of spacings and says what accuracy costs in time.

    scene: a scene, the name of a built-in one, or a file. spacings: m, three or more for an order;
    four around the scene's own if absent. vary: keys of the scene (or `precision`) with the values
    to try, one key at a time, or in all combinations with `cross`. quantity: the error to speak of,
    a probe or a reference (see `Study.base.names`). Each run is measured alone, in a process of its
    own; with an `executor` (any of `concurrent.futures`, dask, mpi4py) the runs are spread over
    its workers, and their times are marked as not alone. out: the study's folder, `studies/NAME` if
    absent. store: where finished runs are kept, `studies/runs` if absent: none is ever repeated,
    so that an interrupted study goes on when it is called again.

    Raises `SceneError`; `RunError` where nothing can be kept or a process fails;
    `StudyInterrupted` (a `KeyboardInterrupt`).
    """
    if isinstance(scene, (str, Path)):
        from kolk.scene import load

        scene = load(scene)
    steps = check_spacings(spacings) if spacings is not None else default_spacings(scene)
    if not steps:
        raise SceneError(f"spacing: found {scene.spacing:g} m, too coarse to be studied: refine it")
    tried = variants(vary, cross=cross)
    kept = Store(None if store is None else Path(store))
    kept.check()
    plan = _plan(scene, steps, tried, precision, threads)
    teller = Teller(len(plan), quiet)
    measured = (
        _alone(plan, kept, teller) if executor is None else _spread(plan, kept, executor, teller)
    )
    records = {v.label: tuple(r for label, r in measured if label == v.label) for v in tried}
    folder = Path(out) if out is not None else STUDIES / safe_name(scene.name)
    study = Study(scene, tuple(tried), records, folder, kept.folder, quantity)
    if study.base.records:
        study.curve()  # a wrong `quantity` is said before anything is written
    study.save()
    return study


Plan = list[tuple[str, Job]]


def _plan(
    scene: Scene,
    spacings: Sequence[float],
    tried: Sequence[Variant],
    precision: Precision | None,
    threads: int,
) -> Plan:
    """All runs, the cheap ones first. Raises `SceneError` before any of them is begun."""
    return [
        (v.label, make_job(v.scene(scene, h), v.precision or precision, threads))
        for h in spacings
        for v in tried
    ]


def _alone(plan: Plan, store: Store, teller: Teller) -> list[tuple[str, Record]]:
    measured: list[tuple[str, Record]] = []
    try:
        for label, job in plan:
            teller.begin(label, job)
            measured.append((label, store.measure(job)))
            teller.end(measured[-1][1])
    except KeyboardInterrupt:
        raise StudyInterrupted(len(measured), len(plan)) from None
    return measured


def _spread(
    plan: Plan, store: Store, executor: Executor, teller: Teller
) -> list[tuple[str, Record]]:
    """The runs that are not there yet over an executor's workers, in whatever order they end."""
    measured: list[tuple[str, Record]] = []
    waiting = {}
    for label, job in plan:
        found = store.find(job)
        if found is not None:
            measured.append((label, found))
        else:
            waiting[executor.submit(perform, job)] = label
    try:
        for future in as_completed(waiting):
            record = future.result()
            store.keep(record)
            measured.append((waiting[future], record))
            teller.end(record)
    except KeyboardInterrupt:
        for future in waiting:
            future.cancel()
        raise StudyInterrupted(len(measured), len(plan)) from None
    return measured


def open_study(folder: str | Path) -> Study:
    """The study that was written into a folder. Raises `RunError` where there is none."""
    from kolk.scene import load

    place = Path(folder)
    try:
        data = json.loads((place / "study.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunError(
            f"{place} is not the folder of a study (its study.json cannot be read): "
            "make one with  kolk accuracy SCENE"
        ) from error
    records: dict[str, tuple[Record, ...]] = {}
    runs: Path | str = "its store"
    try:
        runs = Path(os.path.normpath(place / data["store"]))
        tried = tuple(Variant(v["label"], v["changes"]) for v in data["variants"])
        for entry in data["variants"]:
            found = [Record.load(runs / key) for key in entry["runs"]]
            records[entry["label"]] = tuple(found)
    except (OSError, ValueError, KeyError) as error:
        raise RunError(
            f"the runs of the study {place} are no longer in {runs}: "
            f"make it again with  kolk accuracy {data.get('scene', 'SCENE')}"
        ) from error
    return Study(load(place / "scene.toml"), tried, records, place, runs, data["quantity"])


class Teller:
    """Says on standard error how far a study is."""

    def __init__(self, planned: int, quiet: bool) -> None:
        self.planned, self.quiet, self.number = planned, quiet, 0

    def begin(self, label: str, job: Job) -> None:
        """A run is about to begin, or to be found."""
        if not self.quiet:
            what = "" if label == DEFAULT else f", {label}"
            text = f"{self.number + 1} of {self.planned}: spacing {job.spacing:.4g} m{what} ..."
            print(text, end="", file=sys.stderr, flush=True)

    def end(self, record: Record) -> None:
        """It is done."""
        from kolk.progress import duration

        self.number += 1
        if not self.quiet:
            first = record.scores[0] if record.scores else None
            error = f", {first.error:.2%} {first.name}" if first is not None else ""
            state = "" if record.done else f" {record.outcome}"
            print(f" {duration(record.costs.wall)}{error}{state}", file=sys.stderr, flush=True)
