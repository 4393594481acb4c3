"""What a run left behind, read back: probes, frames, history, summary. Never needs the engine.

```python
run = kolk.open_run("runs/dam-break")
run.probes["P2"]                     # pandas: time, value
run.frames[-1].to_pyvista()          # all particles of the last frame
run.frames[-1]["water"].pressure     # NumPy, one body
run.summary["steps"]["total"]
```
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from kolk.errors import RunError
from kolk.output.folder import RunFolder, safe_name
from kolk.output.tables import read_table
from kolk.output.vtkhdf import BodyRange, FieldsLayout, read_layout

if TYPE_CHECKING:
    import pandas as pd

    from kolk.scene import Scene

Array = NDArray[Any]


class BodyFrame:
    """One body in one frame: NumPy arrays in the stable order of its particles.

    position (n, D), m, float32 where that resolves a ten-thousandth of the spacing, else float64;
    velocity (n, D), density, pressure (n,) float32, SI; mass (n,) float64, kg. A field that the
    scene's `output.fields` left out raises `KeyError`.
    """

    def __init__(self, frame: Frame, body: BodyRange) -> None:
        self._frame, self._body = frame, body
        self.name, self.kind = body.name, body.kind

    def __getitem__(self, field: str) -> Array:
        return self._frame.field(field)[self._body.start : self._body.stop]

    def __len__(self) -> int:
        return self._body.stop - self._body.start

    @property
    def position(self) -> Array:
        """(n, D), m."""
        return self["position"]

    @property
    def velocity(self) -> Array:
        """(n, D), m/s."""
        return self["velocity"]

    @property
    def density(self) -> Array:
        """(n,), kg/m³."""
        return self["density"]

    @property
    def pressure(self) -> Array:
        """(n,), Pa."""
        return self["pressure"]

    @property
    def mass(self) -> Array:
        """(n,), kg (in 2D per metre of depth)."""
        return self["mass"]


class Frame:
    """The particles of a run at one time; arrays are read when asked for and then kept."""

    def __init__(self, path: Path, layout: FieldsLayout, index: int, time: float) -> None:
        self._path, self._layout = path, layout
        self.index = index
        self.time = time
        """s"""
        self._arrays: dict[str, Array] = {}

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._layout.dimension

    @property
    def fields(self) -> tuple[str, ...]:
        """Names that `field` knows."""
        return ("position", *self._layout.changing, *self._layout.constant)

    @property
    def bodies(self) -> dict[str, BodyFrame]:
        """The bodies by name, in the scene's order."""
        return {body.name: BodyFrame(self, body) for body in self._layout.bodies}

    @property
    def position(self) -> Array:
        """(n, D) of all particles, m."""
        return self.field("position")

    def __getitem__(self, body: str) -> BodyFrame:
        bodies = self.bodies
        if body not in bodies:
            raise KeyError(f"there is no body {body!r}; the run has {', '.join(bodies)}")
        return bodies[body]

    def rows(self, kind: str) -> NDArray[np.bool_]:
        """(n,) True for the particles of a kind: "fluid" or "wall"."""
        mask = np.zeros(self._layout.count, dtype=np.bool_)
        for body in self._layout.bodies:
            mask[body.start : body.stop] = body.kind == kind
        return mask

    def field(self, name: str) -> Array:
        """(n,) or (n, D): a field of all particles, bodies one after the other."""
        if name in self._layout.constant:
            return self._layout.constant[name]
        if name != "position" and name not in self._layout.changing:
            raise KeyError(f"frames hold no {name!r}, only {', '.join(self.fields)}")
        if name not in self._arrays:
            import h5py

            start = self.index * self._layout.count
            place = "Points" if name == "position" else f"PointData/{name}"
            with h5py.File(self._path, "r") as file:
                data = file[f"VTKHDF/{place}"][start : start + self._layout.count]
            flat = data.ndim == 2 and data.shape[1] == 3
            self._arrays[name] = data[:, : self.dimension] if flat else data
        return self._arrays[name]

    def to_pyvista(self) -> Any:
        """All particles as `pyvista.PolyData` with every field (needs `kolk[pictures]`)."""
        try:
            import pyvista
        except ImportError as error:
            raise RunError(
                "PyVista is not installed: install it with  pip install 'kolk[pictures]'"
            ) from error
        points = np.zeros((self._layout.count, 3))
        points[:, : self.dimension] = self.position
        cloud = pyvista.PolyData(points)
        for name in self.fields[1:]:
            value = self.field(name)
            if value.ndim == 2:
                padded = np.zeros((len(value), 3), dtype=value.dtype)
                padded[:, : self.dimension] = value
                value = padded
            cloud[name] = value
        cloud.field_data["time"] = np.array([self.time])
        return cloud

    def __repr__(self) -> str:
        return f"<frame {self.index}: t = {self.time:g} s, {self._layout.count} particles>"


class Frames(Sequence[Frame]):
    """The frames of a run, in order of time; indexed and sliced as a list."""

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.is_file():
            raise RunError(f"the run has no frames: {path} is missing")
        try:
            import h5py

            self._layout, _, count = read_layout(path)
            with h5py.File(path, "r") as file:
                self.times = np.asarray(file["VTKHDF/Steps/Values"][:count], dtype=np.float64)
        except (OSError, KeyError, ValueError) as error:
            raise RunError(f"the time series {path} cannot be read: {error}") from error

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        number = range(len(self))[index]
        return Frame(self.path, self._layout, number, float(self.times[number]))

    def __len__(self) -> int:
        return len(self.times)

    def at(self, time: float) -> Frame:
        """The frame nearest to a time (s)."""
        return self[int(np.argmin(np.abs(self.times - time)))]

    def __repr__(self) -> str:
        return f"<{len(self)} frames, t = {self.times[0]:g} to {self.times[-1]:g} s>"


class Probes(Mapping[str, "pd.DataFrame"]):
    """Probe records by name: pandas frames with `time` (s) and the probe's columns (SI)."""

    def __init__(self, folder: RunFolder, about: Mapping[str, Any]) -> None:
        self._folder = folder
        self.about = about
        """What each probe is: quantity, unit, columns."""
        self._read: dict[str, pd.DataFrame] = {}

    def __getitem__(self, name: str) -> pd.DataFrame:
        path = self._folder.probe(name)
        if name not in self._read:
            if not path.is_file():
                known = ", ".join(map(repr, self)) or "none"
                raise KeyError(f"there is no probe {name!r}; the run has {known}")
            self._read[name] = read_table(path)
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        present = {path.stem for path in self._folder.probes.glob("*.csv")}
        known = [name for name in self.about if safe_name(name) in present]
        return iter(known or sorted(present))

    def __len__(self) -> int:
        return sum(1 for _ in self)


class Run:
    """A run's folder, opened for reading."""

    def __init__(self, folder: Path | str) -> None:
        self._files = RunFolder(folder)
        if not self._files.holds_run:
            raise RunError(
                f"{folder} is not the folder of a kolk run (it has no scene.toml): give the folder "
                "that a run was written to, such as runs/dam-break"
            )

    @property
    def folder(self) -> Path:
        """Where the run's files are."""
        return self._files.path

    @property
    def files(self) -> RunFolder:
        """Paths of the run's files."""
        return self._files

    @cached_property
    def scene(self) -> Scene:
        """The scene as it was run."""
        from kolk.scene import load

        return load(self._files.scene)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """`summary.json`; empty for a run that was killed before it could write one."""
        if not self._files.summary.is_file():
            return {}
        try:
            found: dict[str, Any] = json.loads(self._files.summary.read_text(encoding="utf-8"))
        except ValueError as error:
            raise RunError(f"{self._files.summary} is not valid JSON: {error}") from error
        return found

    @property
    def outcome(self) -> str:
        """ "done", "unstable", "interrupted", "failed", or "unfinished" for a killed run."""
        return str(self.summary.get("outcome", "unfinished"))

    @cached_property
    def frames(self) -> Frames:
        """The frames of `fields.vtkhdf`."""
        return Frames(self._files.fields)

    @cached_property
    def probes(self) -> Probes:
        """The probe records."""
        return Probes(self._files, self.summary.get("probes", {}))

    @cached_property
    def history(self) -> pd.DataFrame:
        """Energy, extremes and time step at each frame; see `kolk.output.recorder`."""
        return read_table(self._files.history)

    @property
    def pictures(self) -> list[Path]:
        """The pictures and films that were made of the run."""
        return sorted(p for p in self._files.pictures.glob("*") if p.is_file())

    def refresh(self) -> None:
        """Forgets what was read, so that a run in progress is read again."""
        for name in ("summary", "frames", "probes", "history"):
            self.__dict__.pop(name, None)

    def __repr__(self) -> str:
        return f"<kolk run {str(self.folder)!r}: {self.outcome}>"


def open_run(folder: Path | str) -> Run:
    """Opens the folder of a run. Raises `RunError` where it holds none."""
    return Run(folder)
