"""The time series: its frames come back, VTK reads them, no moment is a bad one to be killed."""

import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from kolk.errors import RunError
from kolk.output.commit import find_step_count
from kolk.output.vtkhdf import FieldsFile, FieldsLayout, body_ranges, read_layout

COUNT = 30


def layout(dimension: int = 2, points: str = "f8") -> FieldsLayout:
    return FieldsLayout(
        dimension=dimension,
        bodies=body_ranges([("water", "fluid", COUNT - 10), ("tank", "wall", 10)]),
        changing={"velocity": 3, "pressure": 1},
        constant={"body": np.repeat([0, 1], [COUNT - 10, 10]).astype(np.int32)},
        points=points,
    )


def values(number: int, dimension: int = 2) -> tuple[float, Any, dict[str, Any]]:
    """Frame `number`, in which every value tells the number."""
    position = np.full((COUNT, dimension), float(number))
    fields = {"velocity": position * 10, "pressure": np.full(COUNT, number * 100.0)}
    return number * 0.1, position, fields


def create(path: Path, capacity: int, frames: int = 1, **more: Any) -> FieldsFile:
    file = FieldsFile.create(path, layout(**more), capacity, *values(0))
    for number in range(1, frames):
        file.append(*values(number))
    return file


def assert_whole(path: Path, frames: int) -> None:
    """The file opens, and its frames are 0 to `frames` - 1, whole."""
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        assert root["Steps"].attrs["NSteps"] == frames
        np.testing.assert_array_equal(root["Steps/Values"][:], 0.1 * np.arange(frames))
        for number in range(frames):
            rows = slice(number * COUNT, (number + 1) * COUNT)
            assert root["Steps/PointOffsets"][number] == rows.start
            assert (root["Points"][rows, :2] == number).all()
            assert (root["Points"][rows, 2] == 0).all()
            assert (root["PointData/velocity"][rows, :2] == number * 10).all()
            assert (root["PointData/pressure"][rows] == number * 100).all()


@pytest.mark.parametrize("points", ["f4", "f8"])
def test_frames_come_back(tmp_path: Path, points: str) -> None:
    path = tmp_path / "fields.vtkhdf"
    create(path, 4, frames=4, points=points).close()
    assert_whole(path, 4)
    found, capacity, frames = read_layout(path)
    assert (capacity, frames) == (4, 4)
    assert found.bodies == layout().bodies
    assert found.points == points


def test_vtk_reads_every_step(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    path = tmp_path / "fields.vtkhdf"
    create(path, 9, frames=3).close()
    reader = pyvista.get_reader(path).reader
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 3
    information = reader.GetOutputInformation(0)
    times = information.Get(reader.GetExecutive().TIME_STEPS())
    np.testing.assert_allclose(times, [0.0, 0.1, 0.2])
    for number, when in enumerate(times):
        reader.UpdateTimeStep(when)
        cloud = pyvista.wrap(reader.GetOutput())
        assert (cloud.n_points, cloud.n_verts) == (COUNT, COUNT)
        assert (cloud.points[:, :2] == number).all()
        assert (cloud["pressure"] == number * 100).all()
        assert cloud["velocity"].shape == (COUNT, 3)
        assert cloud["body"].tolist() == [0] * (COUNT - 10) + [1] * 10


def test_a_file_grows_beyond_its_plan_and_gives_back_spare_room(tmp_path: Path) -> None:
    path = tmp_path / "fields.vtkhdf"
    file = create(path, 2, frames=5)
    assert file.capacity == 8
    file.close(trim=True)
    assert_whole(path, 5)
    assert read_layout(path)[1:] == (5, 5)


def test_reopening_drops_later_frames_and_goes_on(tmp_path: Path) -> None:
    path, straight = tmp_path / "fields.vtkhdf", tmp_path / "straight.vtkhdf"
    create(path, 6, frames=5).close()
    file = FieldsFile.reopen(path, 2)
    assert_whole(path, 2)
    for number in range(2, 6):
        file.append(*values(number))
    file.close()
    assert_whole(path, 6)
    create(straight, 6, frames=6).close()
    assert path.read_bytes() == straight.read_bytes()


def test_reopening_refuses_what_it_cannot_go_on_with(tmp_path: Path) -> None:
    path = tmp_path / "fields.vtkhdf"
    with pytest.raises(RunError, match=r"fields\.vtkhdf"):
        FieldsFile.reopen(path, 1)
    create(path, 3, frames=2).close()
    with pytest.raises(RunError, match="2 frames where the checkpoint knows 3"):
        FieldsFile.reopen(path, 3)
    path.write_bytes(b"not HDF5 at all")
    with pytest.raises(RunError, match="go on with the time series"):
        FieldsFile.reopen(path, 1)


def test_the_step_count_lies_in_one_page(tmp_path: Path) -> None:
    for particles in (1, 17, 400):
        path = tmp_path / f"{particles}.vtkhdf"
        plan = FieldsLayout(2, body_ranges([("a", "fluid", particles)]), {}, {})
        FieldsFile.create(path, plan, 50, 0.0, np.zeros((particles, 2)), {}).close()
        assert find_step_count(path).in_one_page


class Killed(BaseException):
    """Stands for the process's end at a system call."""


def dying(call: Callable[..., int], after: int, partly: bool) -> Callable[..., int]:
    """`os.pwrite` that ends the process at its call number `after`, some of it written or not."""
    left = [after]

    def pwrite(descriptor: int, data: bytes, offset: int) -> int:
        if left[0] == 0:
            # A write within a page is all or nothing; a longer one may stop at a page's end.
            if partly and len(data) > 64:
                call(descriptor, bytes(data)[: len(data) // 2], offset)
            raise Killed
        left[0] -= 1
        return call(descriptor, data, offset)

    return pwrite


@pytest.mark.parametrize("partly", [False, True])
@pytest.mark.parametrize("capacity", [8, 3])
def test_death_at_any_write_keeps_every_earlier_frame(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, partly: bool, capacity: int
) -> None:
    whole = os.pwrite
    for after in range(40):
        path = tmp_path / f"{after}.vtkhdf"
        file = create(path, capacity, frames=3)
        monkeypatch.setattr(os, "pwrite", dying(whole, after, partly))
        try:
            file.append(*values(3))
        except Killed:
            monkeypatch.setattr(os, "pwrite", whole)
            assert_whole(path, 3)
            again = FieldsFile.reopen(path, 3)
            again.append(*values(3))
            again.close()
            assert_whole(path, 4)
        else:
            monkeypatch.setattr(os, "pwrite", whole)
            assert_whole(path, 4)
            assert after >= 4, "the test must have died at several writes before it got through"
            return
    pytest.fail("appending a frame takes more writes than expected")


def test_a_full_disk_is_an_error_and_loses_no_frame(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "fields.vtkhdf"
    file = create(path, 8, frames=2)
    whole, left = os.pwrite, [1]

    def full(descriptor: int, data: bytes, offset: int) -> int:
        if left[0] == 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        left[0] -= 1
        return whole(descriptor, data, offset)

    monkeypatch.setattr(os, "pwrite", full)
    with pytest.raises(RunError, match=r"t = 0\.2 s.*No space left.*free some space"):
        file.append(*values(2))
    monkeypatch.setattr(os, "pwrite", whole)
    assert_whole(path, 2)
    file.append(*values(2))
    assert_whole(path, 3)


WRITER = """
import sys
sys.path.insert(0, {here!r})
from pathlib import Path
import test_output_vtkhdf as t
file = t.create(Path({path!r}), 4)
print("ready", flush=True)
number = 1
while True:
    file.append(*t.values(number))
    number += 1
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
@pytest.mark.parametrize("delay", [0.0, 0.013, 0.05, 0.11])
def test_a_killed_writer_leaves_whole_frames(tmp_path: Path, delay: float) -> None:
    path = tmp_path / "fields.vtkhdf"
    code = WRITER.format(here=str(Path(__file__).parent), path=str(path))
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as writer:
        assert writer.stdout is not None
        assert writer.stdout.readline() == b"ready\n"
        time.sleep(delay)
        os.kill(writer.pid, signal.SIGKILL)
    frames = read_layout(path)[2]
    assert frames >= 1
    assert_whole(path, frames)
