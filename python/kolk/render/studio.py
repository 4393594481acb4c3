"""Everything that is drawn of one run, in order."""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kolk.compare import common_shift, records
from kolk.compare.records import RunLike

from . import curves, exact, flow, space
from .film import film_path, flow_film
from .quantity import FreeSurface, Quantity, Scales

if TYPE_CHECKING:
    from kolk.cases import Comparison

PATIENCE = 2.0
"""Seconds before a progress bar appears."""

_FIELDS = {"pressure": "pressure", "speed": "velocity"}
"""Pictures of fields, and the field of a frame that each needs."""


class Studio:
    """Draws one run; see :func:`kolk.render.render_run`."""

    def __init__(self, run: RunLike, *, quiet: bool = False) -> None:
        self.run = run
        self.quiet = quiet
        self.folder = Path(run.folder) / "pictures"
        scene = run.scene
        self.title = str(scene.title or scene.name)
        self.spacing = float(scene.spacing)
        self.flat = int(scene.dimension) == 2
        self.asked = records.comparisons(run)
        self.scales = _scales(run)
        start = scene.gravity_at_start
        gravity = None if start is None else np.asarray(start, float)
        moved = gravity is not None and np.any(gravity)
        self.vertical = int(np.argmax(np.abs(gravity))) if moved and gravity is not None else 2

    def draw(self, *, film: bool) -> list[Path]:
        """Draws all; returns the files in the order they were made."""
        self.folder.mkdir(parents=True, exist_ok=True)
        made: list[Path] = []
        jobs = [*self._sheets(), *self._exact(), *self._fields(), *self._probes()]
        frames = len(self.run.frames) if film else 0
        filmed = frames if self.flat else space.film_frames(frames)
        with Bar(len(jobs) + filmed, self.quiet, at_once=not self.flat) as bar:
            for job in jobs:
                made.append(job())
                bar.step()
            if film and frames > 1 and self._shown():
                made.append(self._film(bar.step))
        return made

    def _shown(self) -> list[str]:
        """Fields that the frames hold; a scene may leave some out."""
        held = getattr(self.run.frames[0], "fields", tuple(_FIELDS.values()))
        return [name for name, needed in _FIELDS.items() if needed in held]

    def _common(self) -> dict[str, Any]:
        return {"spacing": self.spacing, "title": self.title, "scales": self.scales}

    def _sheets(self) -> list[Callable[[], Path]]:
        jobs: list[Callable[[], Path]] = []
        frames, shown = self.run.frames, self._shown()
        if len(frames) and shown:
            path = self.folder / "flow.png"
            if self.flat:
                jobs.append(lambda: flow.flow_sheet(frames, path, fields=shown, **self._common()))
            else:
                jobs.append(
                    lambda: space.space_sheet(
                        frames, path, field=shown[-1], vertical=self.vertical, **self._common()
                    )
                )
        pressures = [c for c in self.asked if c.quantity == "pressure" and c.probe is not None]
        pressures.sort(key=lambda c: c.kind != "band")
        if pressures:
            jobs.append(
                lambda: curves.pressure_sheet(
                    self.run.probes,
                    pressures,
                    self.folder / "pressure.png",
                    f"{self.title}: pressure" if self.scales else self.title,
                    common_shift(self.run, self.asked),
                )
            )
        return jobs

    def _exact(self) -> list[Callable[[], Path]]:
        def job(asked: Comparison) -> Callable[[], Path]:
            name = asked.reference.replace("_", "-")
            path = self.folder / f"exact-{name}.png"
            return lambda: exact.exact_picture(self.run.frames, asked, path, self.title)

        wanted = [c for c in self.asked if c.reference in exact.DRAWN and c.kind == "analytic"]
        return [job(asked) for asked in wanted if len(self.run.frames) > 1]

    def _fields(self) -> list[Callable[[], Path]]:
        if not self.flat or not len(self.run.frames):
            return []

        def job(name: str, shown: str | Quantity) -> Callable[[], Path]:
            path = self.folder / f"field-{name}.png"
            return lambda: flow.frame_picture(self.run.frames[-1], path, shown, **self._common())

        jobs = [job(name, name) for name in self._shown()]
        scene = self.run.scene
        if scene.free_surface:
            surface = FreeSurface(
                "free surface",
                "free surface (1) and inside (0)",
                1.0,
                float(scene.smoothing_length),
                str(scene.kernel),
                self.spacing,
                tuple(scene.periodic_axes),
            )
            jobs.append(job("free-surface", surface))
        return jobs

    def _probes(self) -> list[Callable[[], Path]]:
        matches = {
            name: [c for c in self.asked if c.probe == name and c.kind != "analytic"]
            for name in self.run.probes
        }
        shift = common_shift(self.run, self.asked)
        about = getattr(self.run.probes, "about", {})

        def job(name: str) -> Callable[[], Path]:
            told = about.get(name, {})
            label = f"{told.get('quantity', '')} [{told.get('unit', '')}]" if told else ""
            path = self.folder / f"probe-{name}.png"
            table = self.run.probes[name]
            found = matches[name]
            match = found[0] if found else None
            return lambda: curves.probe_picture(name, table, path, match, label, shift, found[1:])

        return [job(name) for name in self.run.probes if len(self.run.probes[name]) > 1]

    def _film(self, tick: Callable[[], None]) -> Path:
        path = film_path(self.folder)
        field = self._shown()[-1]
        if self.flat:
            return flow_film(self.run.frames, path, field, tick=tick, **self._common())
        return space.space_film(
            self.run.frames, path, field=field, vertical=self.vertical, tick=tick, **self._common()
        )


def _scales(run: RunLike) -> Scales | None:
    """Scales of the case's experiment: from a pressure in rho g H against a time in sqrt(H/g)."""
    for each in records.comparisons(run):
        if each.kind == "analytic" or each.probe is None:
            continue
        units = records.reference_of(each).units
        if units["time"] == "sqrt(H/g)" and "rho g H" in units.values():
            gravity = float(np.linalg.norm(np.asarray(run.scene.gravity, float)))
            depth = gravity * each.scale_time**2
            return Scales(depth, gravity, each.scale_value / (gravity * depth))
    return None


class Bar:
    """A progress bar on standard error after PATIENCE; none where that is no terminal."""

    def __init__(self, total: int, quiet: bool, *, at_once: bool = False) -> None:
        """``at_once``: without patience, where the first picture alone takes long."""
        self._total = total
        self._patience = 0.0 if at_once else PATIENCE
        self._done = 0
        self._begun = clock.monotonic()
        self._wanted = not quiet and sys.stderr.isatty()
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> Bar:
        self._show()
        return self

    def __exit__(self, *error: object) -> None:
        if self._bar is not None:
            self._bar.stop()

    def step(self) -> None:
        """One picture or one frame of a film is done."""
        self._done += 1
        self._show()

    def _show(self) -> None:
        if not self._wanted or clock.monotonic() < self._begun + self._patience:
            return
        if self._bar is None:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

            self._bar = Progress(
                TextColumn("pictures"),
                BarColumn(),
                TextColumn("{task.completed} of {task.total}"),
                TimeRemainingColumn(),
                console=Console(stderr=True),
                transient=True,
            )
            self._task = self._bar.add_task("pictures", total=self._total)
            self._bar.start()
        self._bar.update(self._task, completed=self._done)
