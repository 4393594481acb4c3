"""Running a scene: what is left behind, and that going on equals never having stopped."""

import errno
import json
import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kolk
from kolk.errors import InstabilityError, RunError
from kolk.execution import Schedule
from kolk.output.vtkhdf import FieldsFile
from kolk.probes import SurgeFront
from kolk.simulation import DEFAULT_PRECISION, Precision, Simulation


def result_files(folder: Path) -> dict[str, bytes]:
    """Contents of everything in a run's folder that must not depend on the clock."""
    names = ["fields.vtkhdf", "history.csv", "scene.toml"]
    paths = [folder / name for name in names] + sorted((folder / "probes").glob("*.csv"))
    return {path.name: path.read_bytes() for path in paths}


def test_a_run_leaves_its_folder(tank: Path) -> None:
    run = kolk.run("tank.toml", quiet=True)
    assert run.folder == Path("runs/tank")
    assert run.outcome == "done"
    present = {path.name for path in run.folder.iterdir()}
    assert present == {
        "scene.toml",
        "fields.vtkhdf",
        "probes",
        "history.csv",
        "checkpoint.h5",
        "summary.json",
        "log.txt",
    }
    np.testing.assert_allclose(run.frames.times, [0, 0.02, 0.04, 0.06, 0.08, 0.1], atol=1e-12)
    assert list(run.probes) == ["P", "level", "front", "load", "speed"]
    assert list(run.probes["P"].columns) == ["time", "value"]
    assert list(run.probes["load"].columns) == ["time", "x", "y", "moment"]
    assert list(run.probes["speed"].columns) == ["time", "x", "y"]
    assert run.probes["P"]["time"].is_monotonic_increasing
    assert run.probes["P"]["time"].iloc[0] == 0.0
    assert len(run.history) == len(run.frames)
    with pytest.raises(KeyError, match="'P', 'level'"):
        run.probes["missing"]


def test_the_speed_is_that_of_the_steps(tank: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    slow = SurgeFront.evaluate

    def evaluate(self: SurgeFront, simulation: Simulation) -> tuple[float, ...]:
        time.sleep(0.01)
        return slow(self, simulation)

    monkeypatch.setattr(SurgeFront, "evaluate", evaluate)
    run = kolk.run("tank.toml", quiet=True)
    summary, seconds = run.summary, run.summary["seconds"]
    probes = seconds["phases"]["probes"]["seconds"]
    assert probes > 0.01 * len(run.probes["front"])
    assert 0.0 < seconds["engine"] < seconds["total"] - probes
    work = summary["steps"]["total"] * summary["particles"]["total"]
    assert summary["particle_steps_per_second"] == pytest.approx(work / seconds["engine"])

    spent = seconds["engine"]
    more = kolk.run(kolk.load("tank.toml").replace(until=0.12), run.folder, resume=True, quiet=True)
    assert more.summary["seconds"]["engine"] > spent


def test_frames_hold_the_bodies(tank: Path) -> None:
    run = kolk.run("tank.toml", quiet=True)
    first, last = run.frames[0], run.frames[-1]
    filled = {body.name: body for body in kolk.load("tank.toml").bodies()}
    assert list(first.bodies) == ["water", "tank"]
    np.testing.assert_allclose(first["water"].position, filled["water"].position, rtol=1e-6)
    np.testing.assert_array_equal(first["tank"].mass, filled["tank"].mass)
    assert last["water"].velocity.shape == filled["water"].velocity.shape
    assert last.rows("fluid").sum() == len(filled["water"].mass)
    assert run.frames.at(0.041).time == pytest.approx(0.04)
    assert [frame.index for frame in run.frames[1:3]] == [1, 2]
    with pytest.raises(KeyError, match="no body 'oil'"):
        last["oil"]


def test_a_frame_goes_to_pyvista(tank: Path) -> None:
    pytest.importorskip("pyvista")
    run = kolk.run("tank.toml", quiet=True)
    frame = run.frames[-1]
    cloud = frame.to_pyvista()
    np.testing.assert_allclose(cloud.points[:, :2], frame.position, rtol=1e-6)
    np.testing.assert_array_equal(cloud["pressure"], frame.field("pressure"))
    assert cloud["velocity"].shape == (len(frame.position), 3)


def test_the_summary_tells_the_run(tank: Path) -> None:
    run = kolk.run("tank.toml", quiet=True)
    summary = json.loads((run.folder / "summary.json").read_text(encoding="utf-8"))
    assert summary == run.summary
    assert summary["outcome"] == "done"
    assert summary["time"] == {"reached": 0.1, "until": 0.1}
    assert summary["particles"]["total"] == len(run.frames[0].position)
    assert summary["steps"]["total"] == sum(summary["steps"]["by_limit"].values())
    spent = sum(phase["seconds"] for phase in summary["seconds"]["phases"].values())
    assert 0.0 < spent <= 1.1 * summary["seconds"]["total"]
    assert {"initial", "final", "dissipated", "unaccounted"} <= set(summary["energy"])
    assert summary["versions"]["python"]
    assert summary["machine"]["cores"]
    assert summary["probes"]["P"]["unit"] == "Pa"


def test_the_scene_in_the_folder_reproduces_the_run(tank: Path) -> None:
    first = kolk.run(kolk.load("tank.toml").replace(spacing=0.06), quiet=True)
    second = kolk.run(first.folder / "scene.toml", out="again", quiet=True)
    assert result_files(first.folder) == result_files(second.folder)


def test_probes_do_not_change_the_flow(tank: Path) -> None:
    scene = kolk.load("tank.toml")
    with_probes = kolk.run(scene, quiet=True)
    without = kolk.run(scene.replace(probe=[]), quiet=True)
    assert (with_probes.folder / "fields.vtkhdf").read_bytes() == (
        without.folder / "fields.vtkhdf"
    ).read_bytes()


@pytest.fixture
def straight(tank: Path) -> dict[str, bytes]:
    """The files of a run that nothing disturbed."""
    return result_files(kolk.run("tank.toml", out="straight", quiet=True).folder)


@pytest.fixture
def interrupt_after(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Presses Ctrl-C when the engine has taken a number of steps."""
    assert threading.current_thread() is threading.main_thread()
    advance = Simulation.advance_to
    left = [0]

    def watched(self: Simulation, time: float, max_steps: int | None = None) -> int:
        taken = advance(self, time, max_steps)
        if left[0] > 0:
            left[0] -= taken
            if left[0] <= 0:
                os.kill(os.getpid(), signal.SIGINT)
        return taken

    def arm(steps: int) -> None:
        left[0] = steps

    monkeypatch.setattr(Simulation, "advance_to", watched)
    yield arm


def frame_steps(folder: str) -> list[int]:
    """Number of the step that ended at each frame of a run."""
    return [int(step) for step in kolk.open_run(folder).history["step"]]


@pytest.mark.skipif(os.name == "nt", reason="signals differ on Windows")
@pytest.mark.parametrize("where", ["first step", "before a frame", "at a frame", "later"])
def test_an_interrupted_run_goes_on_to_the_same_bits(
    straight: dict[str, bytes], interrupt_after: Any, where: str
) -> None:
    second = frame_steps("straight")[1]
    steps = {"first step": 1, "before a frame": second - 1, "at a frame": second}
    interrupt_after(steps.get(where, second + 7))
    with pytest.raises(kolk.RunInterrupted, match="the state is saved in runs/tank") as caught:
        kolk.run("tank.toml", quiet=True)
    assert caught.value.steps == steps.get(where, second + 7)
    halted = kolk.open_run("runs/tank")
    assert halted.outcome == "interrupted"
    resumed = kolk.run("tank.toml", resume=True, quiet=True)
    assert resumed.folder == halted.folder
    assert resumed.outcome == "done"
    assert result_files(resumed.folder) == straight
    assert resumed.summary["steps"] == kolk.open_run("straight").summary["steps"]


@pytest.mark.skipif(os.name == "nt", reason="signals differ on Windows")
def test_a_run_interrupted_twice_goes_on_to_the_same_bits(
    straight: dict[str, bytes], interrupt_after: Any
) -> None:
    for resume in (False, True):
        interrupt_after(9)
        with pytest.raises(KeyboardInterrupt):
            kolk.run("tank.toml", out="twice", resume=resume, quiet=True)
    resumed = kolk.run("tank.toml", out="twice", resume=True, quiet=True)
    assert result_files(resumed.folder) == straight


def test_a_killed_run_goes_on_from_its_last_checkpoint(
    straight: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Frames and rows after the checkpoint are there when the process dies; they come again."""

    class Killed(BaseException):
        pass

    append, frames = FieldsFile.append, [0]

    def dying(self: FieldsFile, *args: Any) -> None:
        append(self, *args)
        frames[0] += 1
        if frames[0] == 4:
            raise Killed

    monkeypatch.setattr(FieldsFile, "append", dying)
    monkeypatch.setattr("kolk.execution.CHECKPOINT_SHARE", 1e-9)
    with pytest.raises(Killed):
        kolk.run("tank.toml", out="killed", quiet=True)
    monkeypatch.setattr(FieldsFile, "append", append)
    assert len(kolk.open_run("killed").frames) == 4
    resumed = kolk.run("tank.toml", out="killed", resume=True, quiet=True)
    assert result_files(resumed.folder) == straight


def test_a_finished_run_is_extended(tank: Path) -> None:
    scene = kolk.load("tank.toml")
    long = kolk.run(scene.replace(until=0.16), out="long", quiet=True)
    kolk.run(scene, out="short", quiet=True)
    extended = kolk.run(scene.replace(until=0.16), out="short", resume=True, quiet=True)
    assert result_files(extended.folder) == result_files(long.folder)
    again = kolk.run(scene.replace(until=0.16), out="short", resume=True, quiet=True)
    assert again.outcome == "done"
    assert result_files(again.folder) == result_files(long.folder)


def test_another_scene_is_not_resumed(tank: Path) -> None:
    scene = kolk.load("tank.toml")
    kolk.run(scene, quiet=True)
    for other in (scene.replace(spacing=0.06), scene.replace({"probe.P.every": 0.005})):
        with pytest.raises(RunError, match="another scene, precision or set of probes"):
            kolk.run(other, resume=True, quiet=True)
    other_precision: Precision = "f64" if DEFAULT_PRECISION == "mixed" else "mixed"
    with pytest.raises(RunError, match="another scene, precision"):
        kolk.run(scene, resume=True, precision=other_precision, quiet=True)
    assert kolk.open_run("runs/tank").outcome == "done"


def test_a_second_run_takes_a_folder_of_its_own(tank: Path) -> None:
    assert kolk.run("tank.toml", quiet=True).folder == Path("runs/tank")
    assert kolk.run("tank.toml", quiet=True).folder == Path("runs/tank-2")
    with pytest.raises(RunError, match=r"already holds a run.*--resume.*--force"):
        kolk.run("tank.toml", out="runs/tank", quiet=True)
    assert kolk.run("tank.toml", out="runs/tank", force=True, quiet=True).outcome == "done"


def test_a_full_disk_ends_the_run_and_loses_no_frame(
    straight: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, left = os.pwrite, [16]

    def full(descriptor: int, data: bytes, offset: int) -> int:
        left[0] -= 1
        if left[0] < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return whole(descriptor, data, offset)

    monkeypatch.setattr(os, "pwrite", full)
    with pytest.raises(kolk.RunStopped, match=r"No space left.*free some space.*--resume"):
        kolk.run("tank.toml", quiet=True)
    monkeypatch.setattr(os, "pwrite", whole)
    halted = kolk.open_run("runs/tank")
    assert halted.outcome == "failed"
    assert len(halted.frames) >= 2
    resumed = kolk.run("tank.toml", resume=True, quiet=True)
    assert result_files(resumed.folder) == straight


def test_a_full_disk_at_the_start_is_found_before_anything_runs(
    tank: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "pwrite", full)
    with pytest.raises(RunError, match="No space left") as caught:
        kolk.run("tank.toml", quiet=True)
    assert not isinstance(caught.value, kolk.RunStopped)
    assert not Path("runs/tank").exists()


def test_an_unstable_run_says_so_and_keeps_its_frames(
    tank: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    advance = Simulation.advance_to

    def unstable(self: Simulation, time: float, max_steps: int | None = None) -> int:
        if self.time > 0.05:
            raise InstabilityError("it blew up", time=self.time)
        return advance(self, time, max_steps)

    monkeypatch.setattr(Simulation, "advance_to", unstable)
    with pytest.raises(InstabilityError, match="it blew up"):
        kolk.run("tank.toml", quiet=True)
    run = kolk.open_run("runs/tank")
    assert run.outcome == "unstable"
    assert run.summary["reason"] == "it blew up"
    np.testing.assert_allclose(run.frames.times[:3], [0.0, 0.02, 0.04], atol=1e-12)
    assert run.frames.times[-1] > 0.05


def test_pictures_and_comparison_cannot_fail_a_run(
    tank: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import kolk.compare
    import kolk.render

    def broken(*_: Any, **__: Any) -> None:
        raise ValueError("no display")

    monkeypatch.setattr(kolk.render, "render_run", broken)
    monkeypatch.setattr(kolk.compare, "compare", broken)
    run = kolk.run("tank.toml", pictures=True, quiet=True)
    assert run.outcome == "done"
    notes = ["comparison with the reference: no display", "pictures: no display"]
    assert run.summary["notes"] == notes


def test_missing_picture_libraries_are_named(tank: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import kolk.render

    monkeypatch.setattr(kolk.render, "render_run", lambda *_, **__: [])
    monkeypatch.setattr(
        kolk.render, "missing", lambda dimension: ["imageio-ffmpeg: pip install kolk[x]"]
    )
    run = kolk.run("tank.toml", pictures=True, quiet=True)
    assert run.summary["notes"] == ["imageio-ffmpeg: pip install kolk[x]"]


@pytest.mark.parametrize(
    ("until", "every", "times"),
    [
        (0.1, 0.02, [0.02, 0.04, 0.06, 0.08, 0.1]),
        (0.1, 0.03, [0.03, 0.06, 0.09, 0.1]),
        (0.1, 0.1, [0.1]),
        (0.3, 0.1, [0.1, 0.2, 0.3]),
    ],
)
def test_the_schedule_ends_on_time(until: float, every: float, times: list[float]) -> None:
    schedule = Schedule(until, every)
    found, now = [], 0.0
    while now < until:
        now = schedule.after(now)
        found.append(now)
    np.testing.assert_allclose(found, times, rtol=1e-12)
    assert found[-1] == until
    assert schedule.frames >= len(times) + 1


def test_folders_that_are_no_runs_are_refused(tmp_path: Path) -> None:
    with pytest.raises(RunError, match=r"no scene\.toml"):
        kolk.open_run(tmp_path)


def test_a_run_that_was_killed_early_opens(tank: Path) -> None:
    folder = kolk.run("tank.toml", quiet=True).folder
    (folder / "summary.json").unlink()
    with (folder / "probes" / "P.csv").open("a", encoding="utf-8") as table:
        table.write("0.123,4")
    run = kolk.open_run(folder)
    assert run.outcome == "unfinished"
    assert run.summary == {}
    assert sorted(run.probes) == ["P", "front", "level", "load", "speed"]
    assert run.probes["P"]["time"].iloc[-1] <= 0.1
    (folder / "fields.vtkhdf").unlink()
    with pytest.raises(RunError, match="no frames"):
        _ = kolk.open_run(folder).frames


def test_a_run_outside_the_main_thread_leaves_signals_alone(tank: Path) -> None:
    before = signal.getsignal(signal.SIGINT)
    outcome: list[str] = []
    thread = threading.Thread(
        target=lambda: outcome.append(kolk.run("tank.toml", quiet=True).outcome)
    )
    thread.start()
    thread.join()
    assert outcome == ["done"]
    assert signal.getsignal(signal.SIGINT) is before


def test_the_loop_belongs_to_the_user(tank: Path) -> None:
    simulation = kolk.Simulation(kolk.load("tank.toml"), threads=1)
    water = simulation.bodies["water"]
    before = water.position
    water.position[:] = 0.0
    assert water.position.tobytes() == before.tobytes()
    simulation.advance(0.01)
    assert simulation.time == pytest.approx(0.01, abs=1e-15)
    assert (water.position != before).any()
    assert simulation.energy.kinetic > 0.0
    assert simulation.energy.total == pytest.approx(
        sum((simulation.energy.kinetic, simulation.energy.potential, simulation.energy.compression))
    )
    assert simulation.momentum.shape == (2,)
    assert simulation.step_count == sum(simulation.steps_by_limit.values())
    state = simulation.state()
    simulation.advance(0.01)
    after = water.position.tobytes()
    simulation.restore(state)
    assert simulation.time == pytest.approx(0.01, abs=1e-15)
    simulation.advance(0.01)
    assert water.position.tobytes() == after
    with pytest.raises(KeyError, match="no body 'oil'"):
        simulation.bodies["oil"]
    with pytest.raises(kolk.KolkError, match="not a time"):
        simulation.advance(float("nan"))
