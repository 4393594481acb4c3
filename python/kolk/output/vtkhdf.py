"""`fields.vtkhdf`: the frames of a run as a transient VTKHDF file of particles (PolyData vertices).

Opens in ParaView 5.12 and later and in VTK 9.3 and later. Points are padded to three components and
float32 where that resolves them (see `FieldsLayout.points`), fields float32, and arrays that never
change (mass, body, kind, id) are stored once: their `PointDataOffsets` are 0 at every step.

**Why a kill at any moment leaves every earlier frame readable.** The file is created as a whole,
under another name, with room for every planned frame: contiguous datasets, allocated but not
written (holes of a sparse file, so they take no space). From then on no HDF5 structure changes.
A frame is written in three strides:

1. its values go by `pwrite` to their places beyond the frames already counted;
2. `fsync`: they are on the disk before anything counts them;
3. the number of steps is raised in one write (see `commit`), and synced.

A kill, a crash or a full disk during 1 or 2 leaves bytes that nothing counts; 3 happens or not.
Resuming lowers the number of steps to the checkpoint's in the same way and writes on from there.
A file that needs more room than planned, or that ends with room to spare, is copied to a new file
of the right size, which then takes its name.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray

from kolk.output.atomic import replacing, storage_error
from kolk.output.commit import PAGE, StepCount, find_step_count
from kolk.output.image import hdf5_image, write_at

VERSION = (2, 0)
"""Version of the VTKHDF format: the first with transient PolyData."""

_CELLS = ("Vertices", "Lines", "Strips", "Polygons")


@dataclass(frozen=True)
class BodyRange:
    """A body's rows in every frame: `start` to `stop` (excluded). `kind`: "fluid" or "wall"."""

    name: str
    kind: str
    start: int
    stop: int


@dataclass(frozen=True)
class FieldsLayout:
    """What every frame holds.

    dimension: 2 or 3. bodies: in row order. changing: field -> components (1 or 3), float32.
    constant: field -> (n,) array, stored once. points: type of the positions, "f4" or "f8"; "f4" is
    half as large and right where its steps are far smaller than the particles' spacing.
    """

    dimension: int
    bodies: tuple[BodyRange, ...]
    changing: Mapping[str, int]
    constant: Mapping[str, NDArray[Any]]
    points: str = "f8"

    @property
    def count(self) -> int:
        """Particles in a frame."""
        return self.bodies[-1].stop if self.bodies else 0


class FieldsFile:
    """The open time series, made by `create` or `reopen`; it holds at least one frame."""

    def __init__(self, path: Path, layout: FieldsLayout, capacity: int, frames: int) -> None:
        self.path = path
        self.layout = layout
        self.capacity = capacity
        self.frames = frames
        self._descriptor = -1
        self._attach()

    @classmethod
    def create(
        cls,
        path: Path,
        layout: FieldsLayout,
        capacity: int,
        time: float,
        position: ArrayLike,
        fields: Mapping[str, ArrayLike],
    ) -> FieldsFile:
        """A new file with room for `capacity` frames that holds its first one (see `append`).

        HDF5 refuses a file of this kind without a frame, so the file appears with one. Raises
        `RunError`.
        """
        capacity = max(capacity, 1)
        try:
            with replacing(path) as temporary:
                _build(temporary, layout, capacity)
                first = cls(temporary, layout, capacity, 0)
                try:
                    first.append(time, position, fields)
                finally:
                    first._detach()
            return cls(path, layout, capacity, 1)
        except OSError as error:
            raise storage_error(path, error, "create the time series") from error

    @classmethod
    def reopen(cls, path: Path, frames: int) -> FieldsFile:
        """Opens an existing file to go on after its first `frames` frames; later ones are dropped.

        Raises `RunError` where the file is missing, foreign, or holds fewer frames.
        """
        try:
            layout, capacity, present = read_layout(path)
            if present < frames:
                raise OSError(
                    None, f"it holds {present} frames where the checkpoint knows {frames}"
                )
            file = cls(path, layout, capacity, frames)
            file._commit()
            return file
        except (OSError, KeyError, ValueError) as error:
            known = error if isinstance(error, OSError) else OSError(None, str(error))
            raise storage_error(path, known, "go on with the time series") from error

    def append(self, time: float, position: ArrayLike, fields: Mapping[str, ArrayLike]) -> None:
        """Adds one frame, durable when this returns.

        time: s. position: (n, D), m. fields: the changing ones, (n,) or (n, D). Raises `RunError`
        where the disk refuses; the earlier frames stay.
        """
        layout = self.layout
        try:
            if self.frames == self.capacity:
                self._resize(2 * self.capacity)
            self._put("Points", _three(position), 3)
            for name, components in layout.changing.items():
                value = np.asarray(fields[name])
                data = _three(value) if components == 3 else value
                self._put(f"PointData/{name}", data, components)
            moment = np.array([time], dtype=np.float64)
            write_at(self._descriptor, moment, self._places["Steps/Values"] + 8 * self.frames)
            os.fsync(self._descriptor)
            self.frames += 1
            try:
                self._commit()
            except OSError:
                self.frames -= 1
                raise
        except OSError as error:
            raise storage_error(self.path, error, f"write the frame at t = {time:g} s") from error

    def close(self, *, trim: bool = False) -> None:
        """Closes the file; with `trim` it first gives back the room of frames that never came."""
        if self._descriptor < 0:
            return
        if trim and 0 < self.frames < self.capacity:
            # A file with spare room is whole as well: a disk too full for the copy loses nothing.
            with contextlib.suppress(OSError):
                self._resize(self.frames)
        self._detach()

    def _attach(self) -> None:
        self._count: StepCount = find_step_count(self.path)
        with h5py.File(self.path, "r") as file:
            group = file["VTKHDF"]
            names = ["Points", "Steps/Values", *(f"PointData/{n}" for n in self.layout.changing)]
            self._places = {name: int(group[name].id.get_offset() or 0) for name in names}
            self._types = {name: group[name].dtype for name in names}
        self._descriptor = os.open(self.path, os.O_RDWR | getattr(os, "O_BINARY", 0))

    def _detach(self) -> None:
        os.close(self._descriptor)
        self._descriptor = -1

    def _put(self, name: str, value: NDArray[Any], components: int) -> None:
        rows = self.layout.count
        expected = (rows, components) if components > 1 else (rows,)
        if value.shape != expected:
            raise OSError(None, f"{name} has the shape {value.shape}, not {expected}")
        kind = self._types[name]
        data = np.ascontiguousarray(value, dtype=kind)
        write_at(self._descriptor, data, self._places[name] + self.frames * data.nbytes)

    def _commit(self) -> None:
        self._count.write(self._descriptor, self.frames)
        os.fsync(self._descriptor)

    def _resize(self, capacity: int) -> None:
        """Copies the frames to a new file with another capacity, which takes this one's name."""
        with replacing(self.path) as temporary:
            _build(temporary, self.layout, capacity)
            copy = FieldsFile(temporary, self.layout, capacity, self.frames)
            try:
                for name, place in self._places.items():
                    size = self._bytes_per_frame(name) * self.frames
                    _copy(self._descriptor, place, copy._descriptor, copy._places[name], size)
                copy._commit()
            finally:
                copy._detach()
        self._detach()
        self.capacity = capacity
        self._attach()

    def _bytes_per_frame(self, name: str) -> int:
        if name == "Steps/Values":
            return 8
        field = name.rpartition("/")[2]
        components = 3 if name == "Points" else self.layout.changing[field]
        return int(self._types[name].itemsize) * components * self.layout.count


def read_layout(path: Path) -> tuple[FieldsLayout, int, int]:
    """Layout, capacity and number of frames of a file that `kolk` wrote."""
    with h5py.File(path, "r") as file:
        about = json.loads(file["kolk"].attrs["about"])
        data = file["VTKHDF/PointData"]
        layout = FieldsLayout(
            dimension=int(about["dimension"]),
            bodies=tuple(BodyRange(**body) for body in about["bodies"]),
            changing={name: int(size) for name, size in about["changing"].items()},
            constant={name: data[name][...] for name in about["constant"]},
            points=str(about["points"]),
        )
        frames = int(file["VTKHDF/Steps"].attrs["NSteps"])
        return layout, int(about["capacity"]), frames


def _build(path: Path, layout: FieldsLayout, capacity: int) -> None:
    """Writes a file with room for `capacity` frames, all of them counted, none written."""
    for padding in range(0, PAGE, 256):
        _build_padded(path, layout, capacity, padding)
        if find_step_count(path).in_one_page:
            return
    raise OSError(None, "HDF5 does not keep its step counts together")


def _build_padded(path: Path, layout: FieldsLayout, capacity: int, padding: int) -> None:
    about = {
        "dimension": layout.dimension,
        "bodies": [asdict(body) for body in layout.bodies],
        "changing": dict(layout.changing),
        "constant": list(layout.constant),
        "points": layout.points,
        "capacity": capacity,
    }
    steps = np.arange(capacity, dtype=np.int64)
    rows = steps * layout.count
    nothing = np.zeros(capacity, dtype=np.int64)
    with hdf5_image(path) as file:
        own = file.create_group("kolk")
        own.attrs["about"] = json.dumps(about)
        if padding:
            own.attrs["padding"] = np.zeros(padding, dtype=np.uint8)
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array(VERSION, dtype=np.int64)
        root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
        step = root.create_group("Steps")
        step.attrs["NSteps"] = np.int64(capacity)
        _reserve(step, "Values", (capacity,), "f8")
        step["NumberOfParts"] = nothing + 1
        step["PartOffsets"] = steps
        step["PointOffsets"] = rows
        step["CellOffsets"] = np.zeros((capacity, 4), dtype=np.int64)
        step["ConnectivityIdOffsets"] = np.zeros((capacity, 4), dtype=np.int64)
        offsets = step.create_group("PointDataOffsets")

        root["NumberOfPoints"] = nothing + layout.count
        for name in _CELLS:
            size = layout.count if name == "Vertices" else 0
            cells = root.create_group(name)
            cells["NumberOfCells"] = nothing + size
            cells["NumberOfConnectivityIds"] = nothing + size
            cells["Connectivity"] = np.arange(size, dtype=np.int64)
            cells["Offsets"] = np.arange(size + 1, dtype=np.int64)

        data = root.create_group("PointData")
        for name, value in layout.constant.items():
            data[name] = value
            offsets[name] = nothing
        # Last, so that the holes lie together at the end of the file.
        for name, components in layout.changing.items():
            shape = (capacity * layout.count, *([components] if components > 1 else []))
            _reserve(data, name, shape, "f4")
            offsets[name] = rows
        _reserve(root, "Points", (capacity * layout.count, 3), layout.points)


def _reserve(group: Any, name: str, shape: tuple[int, ...], kind: str) -> None:
    """A contiguous dataset that has its place in the file and no contents."""
    plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plan.set_layout(h5py.h5d.CONTIGUOUS)
    plan.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    plan.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    # The same run shall make the same bytes, whenever it runs.
    plan.set_obj_track_times(False)
    space = h5py.h5s.create_simple(shape)
    kind_id = h5py.h5t.py_create(np.dtype(kind))
    h5py.h5d.create(group.id, name.encode(), kind_id, space, plan)


def _copy(source: int, start: int, target: int, place: int, size: int) -> None:
    """Copies `size` bytes between two open files, 16 MiB at a time."""
    done = 0
    while done < size:
        block = os.pread(source, min(size - done, 1 << 24), start + done)
        if not block:
            raise OSError(None, "the file is shorter than its frames")
        write_at(target, block, place + done)
        done += len(block)


def _three(value: ArrayLike) -> NDArray[Any]:
    """(n, D) as (n, 3), padded with zeros."""
    array = np.asarray(value)
    if array.ndim != 2 or array.shape[1] == 3:
        return array
    padded = np.zeros((len(array), 3), dtype=array.dtype)
    padded[:, : array.shape[1]] = array
    return padded


def body_ranges(names: Sequence[tuple[str, str, int]]) -> tuple[BodyRange, ...]:
    """Row ranges of bodies given as (name, kind, particles), one after the other."""
    ranges, start = [], 0
    for name, kind, size in names:
        ranges.append(BodyRange(name, kind, start, start + size))
        start += size
    return tuple(ranges)
