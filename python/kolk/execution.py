"""One run on its way: from the first frame to the summary, past interruptions and full disks."""

from __future__ import annotations

import math
import time as clock
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kolk.errors import InstabilityError, RunError
from kolk.interrupts import Interrupts
from kolk.output.atomic import storage_error, write_json
from kolk.output.checkpoint import Checkpoint
from kolk.output.folder import RunFolder
from kolk.output.journal import Journal
from kolk.output.recorder import Recorder, Stopwatch
from kolk.output.summary import energy_record, summary_of, version
from kolk.progress import Progress
from kolk.results import Run
from kolk.simulation import Simulation

if TYPE_CHECKING:
    from kolk.scene import Scene

CHECKPOINT_SHARE = 0.05
"""Largest share of the running time that checkpoints take where the scene names no interval."""

BREATH = 0.1
"""Seconds of work between two looks at the clock and at the keyboard."""

MOST_STEPS = 10_000
"""Steps that the engine is asked for at once."""


class RunStopped(RunError):
    """A run ended by something outside the physics after it had begun; what it wrote is kept."""

    def __init__(self, message: str, folder: Path) -> None:
        super().__init__(message)
        self.folder = folder


class RunInterrupted(KeyboardInterrupt):
    """A run ended by Ctrl-C (or SIGTERM); nothing is lost.

    finished: whether the run itself was done, and only its pictures were on their way; otherwise
    its state is saved and `run(..., resume=True)` goes on. time: reached, s.
    """

    def __init__(self, folder: Path, time: float, steps: int, *, finished: bool = False) -> None:
        if finished:
            message = f"the run is done and in {folder}; its pictures were interrupted"
        else:
            message = (
                f"interrupted at t = {time:g} s after {steps:,} steps; "
                f"the state is saved in {folder}"
            )
        super().__init__(message)
        self.folder, self.time, self.steps, self.finished = folder, time, steps, finished


@dataclass(frozen=True)
class Schedule:
    """The times of the frames: 0, every, 2 every, ..., and the end (s)."""

    until: float
    every: float

    @property
    def frames(self) -> int:
        """How many frames a whole run has, the first and the last among them."""
        return int(self.until / self.every * (1.0 - 1e-9)) + 2

    def after(self, time: float) -> float:
        """The next frame after a time; multiples, so that no rounding adds up."""
        target = (int(time / self.every * (1.0 + 1e-12) + 1e-9) + 1) * self.every
        return self.until if target > self.until * (1.0 - 1e-9) else target


@dataclass
class Execution:
    """One run on its way."""

    scene: Scene
    simulation: Simulation
    folder: RunFolder
    recorder: Recorder
    schedule: Schedule
    watch: Stopwatch
    quiet: bool
    outcome: str = "unfinished"
    reason: str = ""
    notes: list[str] = field(default_factory=list)
    references: list[dict[str, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._former_seconds = 0.0
        self._stepping = 0.0
        """Seconds inside the calls that take steps, over all sittings."""
        self._former_timings: Timings = {}
        self._former_limits: dict[str, int] = {}
        self._initial_energy: dict[str, float] = {}
        self._last_checkpoint = clock.perf_counter()
        self._next_checkpoint = 0.0
        self._interrupts = Interrupts()
        self._target = math.inf
        """The frame that the engine is on its way to, s; infinite when it is written."""

    def carry_out(self, checkpoint: Checkpoint | None) -> None:
        """Runs to the end of the scene, from a checkpoint or from the start.

        What ends it early is raised again after everything is saved; a run that could not even
        begin leaves nothing behind.
        """
        begun = False
        self._log = Journal(self.folder.log, fresh=checkpoint is None)
        try:
            if checkpoint is not None:
                self._go_on(checkpoint)
            else:
                self._start()
            begun = True
            self._advance()
            self.outcome = "done"
        except InstabilityError as error:
            self._end("unstable", str(error))
            self._keep_last_state(error)
            raise
        except KeyboardInterrupt:
            if not begun:
                raise
            raise self._interrupted() from None
        except (RunError, MemoryError) as error:
            if not begun:
                raise
            self._end("failed", str(error))
            kept = f"everything up to t = {self.simulation.time:g} s at the latest is kept"
            again = "once that is put right, --resume goes on from the last checkpoint"
            message = f"{error}; {kept} in {self.folder}, and {again}"
            raise RunStopped(message, self.folder.path) from error
        finally:
            with self.watch.phase("frames"):
                self.recorder.close(finished=self.outcome in ("done", "unstable"))
            if begun:
                self._write_summary(strict=self.outcome == "done")
            self._log.write(f"{self.outcome} at t = {self.simulation.time:g} s. {self.reason}")
            self._log.close()
            if not begun and checkpoint is None:
                self.folder.discard()

    def look_back(self, *, pictures: bool) -> None:
        """Sets the finished run beside its references and draws it; neither can fail it."""
        self._log = Journal(self.folder.log, fresh=False)
        try:
            self._look_back(pictures)
        except KeyboardInterrupt:
            self.notes.append("the pictures were interrupted")
            self._write_summary(strict=False)
            steps, now = self.simulation.step_count, self.simulation.time
            raise RunInterrupted(self.folder.path, now, steps, finished=True) from None
        finally:
            self._log.close()

    def _look_back(self, pictures: bool) -> None:
        result = Run(self.folder.path)
        with self.watch.phase("comparison"):
            self._attempt("comparison with the reference", lambda: self._compare(result))
        # The pictures show the figures, so that they must be in the summary before.
        self._write_summary(strict=True)
        if pictures:
            result.refresh()
            with self.watch.phase("pictures"):
                self._attempt("pictures", lambda: self._draw(result))
        self._write_summary(strict=True)

    def _start(self) -> None:
        write_scene(self.scene, self.folder)
        simulation = self.simulation
        counts = ", ".join(f"{n} {kind}" for kind, n in simulation.particles.items())
        self._log.write(
            f"kolk {version()}: {self.scene.name} to {self.schedule.until:g} s, {counts} "
            f"particles, {simulation.precision}, {simulation.threads} threads"
        )
        self._initial_energy = energy_record(simulation.diagnostics)
        self.recorder.begin()
        self._checkpoint()

    def _go_on(self, checkpoint: Checkpoint) -> None:
        if checkpoint.scene != self.recorder.fingerprint:
            raise RunError(
                f"the run in {self.folder} is of another scene, precision or set of probes than "
                "this one (only until, the frames' interval, the pictures, and numerics' courant, "
                "time_step and guard may change): resume it with the same settings, or run into "
                "another folder (--out)"
            )
        book = checkpoint.book
        simulation = self.simulation
        simulation.restore(checkpoint.state)
        self.recorder.resume(book)
        self.watch.phases = _sum_timings(self.watch.phases, book["watch"])
        self._former_seconds = float(book["seconds"])
        self._stepping = float(book["stepping"])
        self._initial_energy = dict(book["initial_energy"])
        # The engine may or may not carry its counters along; what it shows now is not new.
        self._former_timings = _sum_timings(book["timings"], simulation.timings, -1)
        limits = simulation.steps_by_limit
        former = {str(k): int(v) for k, v in book["limits"].items()}
        self._former_limits = {k: former.get(k, 0) - limits.get(k, 0) for k in former | limits}
        write_scene(self.scene, self.folder)
        self._log.write(f"resumed at t = {simulation.time:g} s, step {simulation.step_count}")

    def _advance(self) -> None:
        simulation, until = self.simulation, self.schedule.until
        with (
            Progress(until, start=simulation.time, quiet=self.quiet) as progress,
            self._interrupts as interrupts,
        ):
            # Probes look at every step; without them the engine works for a breath at a time.
            steps = 1
            while simulation.time < until:
                self._target = target = self.schedule.after(simulation.time)
                while simulation.time < target:
                    begun = clock.perf_counter()
                    try:
                        with interrupts.during():
                            simulation.advance_to(target, steps)
                    finally:
                        spent = clock.perf_counter() - begun
                        self._stepping += spent
                    if not self.recorder.sampling:
                        fitting = int(steps * BREATH / max(spent, 1e-6))
                        steps = max(1, min(2 * steps, fitting, MOST_STEPS))
                    self.recorder.sample()
                    progress.update(simulation.time, simulation.step_count, simulation.time_step)
                    interrupts.check()
                self.recorder.frame()
                self._target = math.inf
                if self._checkpoint_is_due():
                    self._checkpoint()
                interrupts.check()
            self._checkpoint()

    def _checkpoint_is_due(self) -> bool:
        every = self.scene.output.checkpoint_every
        if every is not None:
            return self.simulation.time >= self._next_checkpoint * (1.0 - 1e-12)
        cost = self.watch.phases.get("checkpoint", {"seconds": 0.0, "calls": 1})
        mean = cost["seconds"] / max(cost["calls"], 1)
        return clock.perf_counter() - self._last_checkpoint > mean / CHECKPOINT_SHARE

    def _checkpoint(self) -> None:
        self.recorder.checkpoint(
            {
                "precision": self.simulation.precision,
                "seconds": self._seconds(),
                "stepping": self._stepping,
                "watch": self.watch.phases,
                "timings": self._timings(),
                "limits": self._limits(),
                "initial_energy": self._initial_energy,
            }
        )
        self._last_checkpoint = clock.perf_counter()
        every = self.scene.output.checkpoint_every
        if every is not None:
            self._next_checkpoint = (int(self.simulation.time / every + 1e-9) + 1) * every

    def _interrupted(self) -> KeyboardInterrupt | RunStopped:
        simulation = self.simulation
        if self._interrupts.hurried:
            # A second Ctrl-C may have come in the middle of a frame: the last checkpoint stands.
            self._end("interrupted", "the last checkpoint stands; resume with --resume")
            return RunInterrupted(self.folder.path, simulation.time, simulation.step_count)
        try:
            # The engine may have ended a step, or reached a frame, before it heard of it.
            self.recorder.sample()
            if simulation.time >= self._target:
                self.recorder.frame()
            self._checkpoint()
        except RunError as error:
            self._end("failed", str(error))
            return RunStopped(f"interrupted, and {error}", self.folder.path)
        self._end("interrupted", "resume with --resume")
        return RunInterrupted(self.folder.path, simulation.time, simulation.step_count)

    def _end(self, outcome: str, reason: str) -> None:
        self.outcome, self.reason = outcome, reason

    def _keep_last_state(self, error: InstabilityError) -> None:
        """Saves the state to which the guard went back when the run became unstable."""
        if self.simulation.retries["kept"] is None:
            kept = "The guard is off: --resume goes on from the last checkpoint"
        else:
            try:
                self.recorder.sample()
                if self.simulation.time > self.recorder.written:
                    self.recorder.frame()
                self._checkpoint()
                kept = f"The last good state, at t = {self.simulation.time:g} s, is saved: --resume"
                kept += " goes on from it"
            except RunError as failure:
                kept = f"The last good state could not be saved ({failure}): --resume goes on from"
                kept += " the last checkpoint"
        also = "courant, time_step and guard of numerics may be changed for it"
        error.args = (f"{error} {kept} in {self.folder}; {also}.",)

    def _seconds(self) -> float:
        return self._former_seconds + clock.perf_counter() - self.watch.begun

    def _timings(self) -> Timings:
        return _sum_timings(self._former_timings, self.simulation.timings)

    def _limits(self) -> dict[str, int]:
        now, former = self.simulation.steps_by_limit, self._former_limits
        return {name: now.get(name, 0) + former.get(name, 0) for name in now | former}

    def _write_summary(self, *, strict: bool) -> None:
        try:
            write_json(self.folder.summary, self._summary(), "write the summary")
        except RunError as error:
            if strict:
                raise RunStopped(str(error), self.folder.path) from error
            self._log.write(str(error))

    def _summary(self) -> dict[str, Any]:
        return {
            **summary_of(
                self.simulation,
                self.recorder,
                outcome=self.outcome,
                reason=self.reason,
                initial_energy=self._initial_energy,
                seconds=self._seconds(),
                stepping=self._stepping,
                engine=self._timings(),
                outside=self.watch.phases,
                limits=self._limits(),
            ),
            "references": self.references,
            "notes": self.notes,
        }

    def _compare(self, result: Run) -> None:
        from kolk.compare import compare

        self.references = [
            {"sentence": item.sentence, **item.as_dict()} for item in compare(result)
        ]

    def _draw(self, result: Run) -> None:
        from kolk.render import missing, render_run

        made = render_run(result, film=True, quiet=self.quiet)
        self.notes += missing(self.simulation.dimension)
        self._log.write(f"{len(made)} pictures in {self.folder.pictures}")

    def _attempt(self, what: str, action: Callable[[], None]) -> None:
        """What adds to a finished run must not fail it: the error becomes a note."""
        try:
            action()
        except Exception as error:
            self.notes.append(f"{what}: {error}")
            self._log.write(f"{what} failed\n{traceback.format_exc()}")


def write_scene(scene: Scene, folder: RunFolder) -> None:
    """Writes the complete scene, and own particles beside it. Raises `RunError`."""
    try:
        scene.save(folder.scene)
    except OSError as error:
        raise storage_error(folder.scene, error, "write the scene") from error


Timings = dict[str, dict[str, float]]


def _sum_timings(first: Timings, second: Timings, sign: int = 1) -> Timings:
    """Seconds and calls of two records by phase, added (or the second taken away)."""
    nothing: dict[str, float] = {"seconds": 0.0, "calls": 0}
    return {
        name: {
            key: first.get(name, nothing)[key] + sign * second.get(name, nothing)[key]
            for key in ("seconds", "calls")
        }
        for name in {**first, **second}
    }
