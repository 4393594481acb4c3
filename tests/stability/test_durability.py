"""What has been written survives: runs killed at any moment, and disks that fill up."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import kolk

SCENE = """\
name = "tank"
dimension = 2
spacing = 0.03
gravity = [0.0, -9.81]
until = 0.4

[[fluid]]
name = "water"
shape = { box = { from = [0.0, 0.0], to = [0.4, 0.3] } }
viscosity = { artificial = 0.02 }

[[wall]]
name = "tank"
shape = { tank = { from = [0.0, 0.0], to = [1.0, 0.6], open = ["top"] } }

[[probe]]
name = "P"
pressure = { at = [0.0, 0.1] }

[output]
every = 0.01
checkpoint_every = 0.02
pictures = false
"""

WHOLE = 900.0
"""Seconds after which a run of the scene, which takes some, counts as hanging on a busy machine."""


def files(folder: Path) -> dict[str, bytes]:
    """The files whose bytes a resumed run must repeat."""
    names = ["fields.vtkhdf", "history.csv", "scene.toml"]
    names += [f"probes/{path.name}" for path in sorted((folder / "probes").glob("*.csv"))]
    return {name: (folder / name).read_bytes() for name in names}


def command(scene: Path, folder: Path, *more: str) -> list[str]:
    """The command that runs the scene into a folder."""
    words = ["run", str(scene), "--out", str(folder), "--quiet", "--threads", "1", *more]
    return [sys.executable, "-m", "kolk.cli", *words]


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("durability") / "tank.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def undisturbed(scene: Path) -> tuple[dict[str, bytes], float]:
    """The files of a run that nothing disturbed, and the seconds that it took."""
    folder, begun = scene.with_name("undisturbed"), time.monotonic()
    subprocess.run(command(scene, folder), check=True)
    return files(folder), time.monotonic() - begun


def readable(folder: Path) -> None:
    """Everything that a killed run has left can be read, or is not there yet."""
    if not (folder / "checkpoint.h5").exists():
        return
    run = kolk.open_run(folder)
    for frame in run.frames:
        assert len(frame["water"].position) == len(frame["water"].pressure)
    assert len(run.history) >= 1
    assert all(len(table) >= 0 for table in run.probes.values())


def kill_and_resume(scene: Path, whole: dict[str, bytes], seconds: float, seed: int) -> None:
    """Kills a run once or twice at random moments and resumes it to the same bytes."""
    chance = random.Random(seed)
    folder = scene.with_name(f"killed-{seed}")
    resume: list[str] = []
    for _ in range(chance.choice([1, 1, 2])):
        run = subprocess.Popen(command(scene, folder, *resume), stderr=subprocess.DEVNULL)
        try:
            run.wait(chance.uniform(0.2, 1.0) * seconds)
        except subprocess.TimeoutExpired:
            os.kill(run.pid, signal.SIGKILL)
            run.wait()
        readable(folder)
        # Before its first checkpoint there is nothing to go on with.
        resume = ["--resume"] if (folder / "checkpoint.h5").exists() else ["--force"]
    subprocess.run(command(scene, folder, *resume), check=True, timeout=WHOLE + 10 * seconds)
    assert files(folder) == whole
    shutil.rmtree(folder)


@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL on Windows")
@pytest.mark.parametrize("seed", range(5))
def test_a_killed_run_resumes_to_the_same_bits(
    scene: Path, undisturbed: tuple[dict[str, bytes], float], seed: int
) -> None:
    kill_and_resume(scene, *undisturbed, seed)


@pytest.mark.stability
@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL on Windows")
@pytest.mark.parametrize("seed", range(100, 150))
def test_fifty_killed_runs_resume_to_the_same_bits(
    scene: Path, undisturbed: tuple[dict[str, bytes], float], seed: int
) -> None:
    kill_and_resume(scene, *undisturbed, seed)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of some megabytes in memory."""
    folder = tmp_path / "disk"
    folder.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(folder)]
    if sys.platform != "linux" or subprocess.run(words, capture_output=True).returncode:
        pytest.skip("a disk in memory cannot be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("room", [60_000, 150_000, 400_000])
def test_a_full_disk_loses_nothing_that_was_written(
    scene: Path, undisturbed: tuple[dict[str, bytes], float], small_disk: Path, room: int
) -> None:
    whole, _ = undisturbed
    state = os.statvfs(small_disk)
    filler = small_disk / "filler"
    filler.write_bytes(bytes(state.f_bavail * state.f_bsize - room))
    folder = small_disk / "run"
    ended = subprocess.run(command(scene, folder), capture_output=True, text=True)
    assert ended.returncode in (1, 2), ended.stderr
    assert "Traceback" not in ended.stderr and "No space left" in ended.stderr
    readable(folder)
    filler.unlink()
    begun = (folder / "checkpoint.h5").exists()
    subprocess.run(command(scene, folder, "--resume" if begun else "--force"), check=True)
    assert files(folder) == whole
