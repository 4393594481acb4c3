"""Running a scene into a folder: what `kolk run` does, as a function.

The order of things: the scene is filled and handed to the engine (a scene that cannot run leaves
no folder behind), the folder is claimed, then the engine is asked for one output time after the
other. Frames, rows and checkpoints leave through the recorder. Nothing of that changes the steps:
the same scene gives the same bits with and without probes, interrupted and resumed or not.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, cast

from kolk.errors import RunError
from kolk.execution import Execution, RunInterrupted, RunStopped, Schedule
from kolk.output.checkpoint import read_checkpoint
from kolk.output.folder import RunFolder, free_folder, newest_folder
from kolk.output.recorder import Recorder, Stopwatch
from kolk.probes import build_probes
from kolk.progress import silence
from kolk.results import Run
from kolk.simulation import DEFAULT_PRECISION, Precision, Simulation

if TYPE_CHECKING:
    from kolk.scene import Scene

__all__ = ["RunInterrupted", "RunStopped", "run"]


def run(
    scene: Scene | str | Path,
    out: str | Path | None = None,
    *,
    precision: Precision | None = None,
    threads: int = 0,
    resume: bool = False,
    force: bool = False,
    quiet: bool = False,
    pictures: bool | None = None,
) -> Run:
    """Runs a scene and returns what it left behind.

    scene: a scene, the name of a built-in one, or a file. out: the run's folder; without it
    `runs/NAME`, or the first free of `runs/NAME-2`, ... (with `resume` the newest of them). A
    folder that holds a run is refused unless `resume` goes on with it, to the same bits as if it
    had never stopped, or `force` starts over. precision, threads: see `Simulation`; a resumed run
    keeps its precision. quiet: no progress. pictures: overrides the scene's `output.pictures`.

    Raises `SceneError`; `RunError` where it cannot begin; `RunStopped` (a `RunError`) for a full
    disk and the like on the way; `InstabilityError`; `RunInterrupted` (a `KeyboardInterrupt`). In
    the last three cases the folder holds a summary and everything written before.
    """
    if isinstance(scene, (str, Path)):
        from kolk.scene import load

        scene = load(scene)
    if resume and force:
        raise RunError("resume and force exclude each other: go on with a run, or start it over")
    folder = _folder_to_resume(scene, out) if resume else None
    checkpoint = read_checkpoint(folder.checkpoint) if folder is not None else None
    if precision is None:
        kept = checkpoint.book["precision"] if checkpoint is not None else DEFAULT_PRECISION
        precision = cast("Precision", kept)
    watch = Stopwatch()
    with watch.phase("set-up"), silence(quiet):
        simulation = Simulation(scene, precision=precision, threads=threads)
        probes = build_probes(scene, simulation)
    if folder is not None:
        folder.lock()
    else:
        folder = RunFolder(out) if out is not None else free_folder(scene.name)
        folder.claim(force=force)
    schedule = Schedule(scene.until, float(scene.output.every or scene.until))
    try:
        recorder = Recorder(simulation, folder, probes, scene.output.fields, schedule.frames, watch)
        execution = Execution(scene, simulation, folder, recorder, schedule, watch, quiet)
        execution.carry_out(checkpoint)
        wanted = scene.output.pictures if pictures is None else pictures
        execution.look_back(pictures=wanted)
    finally:
        folder.unlock()
    return Run(folder.path)


def _folder_to_resume(scene: Scene, out: str | Path | None) -> RunFolder:
    folder = RunFolder(out) if out is not None else newest_folder(scene.name)
    if folder is None:
        raise RunError(
            f"there is no run of {scene.name!r} in the folder runs to go on with: "
            "name its folder (--out), or run without --resume"
        )
    if not folder.holds_run:
        raise RunError(
            f"the folder {folder} holds no run to go on with: name another (--out), "
            "or run without --resume"
        )
    return folder
