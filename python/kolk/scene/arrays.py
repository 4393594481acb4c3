"""Particles that the user brings: checked arrays, and the file that keeps them beside a scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from kolk.errors import ArrayError, KolkError
from kolk.output.atomic import replacing, storage_error

FloatArray = npt.NDArray[np.float64]
COLUMNS = ("position", "velocity", "density", "mass")


class Particles:
    """Columns of particles given by the user: copies, checked, read-only.

    position (n, D) in m, velocity (n, D) in m/s, density (n,) in kg/m^3, mass (n,) in kg (per
    metre in 2D); all but the position may be None, which means: at rest, at the reference density
    under the body's pressure, of one cell of the spacing each. Raises ArrayError.
    """

    __slots__ = ("density", "mass", "position", "velocity")

    def __init__(
        self, position: Any, velocity: Any = None, density: Any = None, mass: Any = None
    ) -> None:
        self.position = _column("position", position, None)
        shape = self.position.shape
        self.velocity = None if velocity is None else _column("velocity", velocity, shape)
        self.density = None if density is None else _column("density", density, shape[:1])
        self.mass = None if mass is None else _column("mass", mass, shape[:1])
        for name, column in (("density", self.density), ("mass", self.mass)):
            if column is not None and not (column > 0.0).all():
                i = int(np.argmin(column))
                raise ArrayError(f"{name}[{i}]: found {column[i]:g}, must be greater than 0")

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return int(self.position.shape[1])

    def __len__(self) -> int:
        return len(self.position)

    def __repr__(self) -> str:
        return f"<{len(self)} particles in {self.dimension}D>"

    def save(self, path: Path) -> None:
        """Write the columns to ``path`` (npz), whole or not at all. Raises RunError."""
        columns = {c: getattr(self, c) for c in COLUMNS if getattr(self, c) is not None}
        try:
            with replacing(path) as part, part.open("wb") as file:
                np.savez_compressed(file, **columns)
        except OSError as error:
            raise storage_error(path, error, "write the particles") from error


def load_particles(path: Path) -> Particles:
    """The columns in ``path``. Raises ValueError with what is wrong with the file."""
    try:
        with np.load(path, allow_pickle=False) as file:
            columns = {name: file[name] for name in file.files}
    except FileNotFoundError:
        raise ValueError(f"found no file at {path}: give a path beside the scene file") from None
    except Exception as error:
        raise ValueError(f"{path} is no readable .npz file ({error})") from None
    if "position" not in columns or not set(columns) <= set(COLUMNS):
        raise ValueError(
            f"{path} holds {', '.join(columns) or 'nothing'}; it must hold 'position' (n, D), and "
            "may hold 'velocity' (n, D), 'density' (n,) and 'mass' (n,)"
        )
    try:
        return Particles(**columns)
    except KolkError as error:
        raise ValueError(f"{path}: {error}") from None


def _column(name: str, value: Any, shape: tuple[int, ...] | None) -> FloatArray:
    try:
        array = np.asarray(value)
    except ValueError:
        raise ArrayError(f"{name}: found rows of different lengths, must be one array") from None
    if array.dtype.kind not in "fiu":
        raise ArrayError(
            f"{name}: found an array of type {array.dtype}, must be real numbers: convert it with "
            ".astype(float)"
        )
    if shape is None:
        if array.ndim != 2 or array.shape[1] not in (2, 3):
            raise ArrayError(
                f"{name}: found an array of shape {array.shape}, must be (n, 2) or (n, 3)"
            )
        if len(array) == 0:
            raise ArrayError(f"{name}: found no particles, must be at least one")
    elif array.shape != shape:
        raise ArrayError(
            f"{name}: found an array of shape {array.shape}, must be {shape} as position has it"
        )
    column = np.array(array, np.float64, order="C")
    if not np.isfinite(column).all():
        i = int(np.argmin(np.isfinite(column).reshape(len(column), -1).all(axis=1)))
        raise ArrayError(f"{name}[{i}]: found {column[i]}, must be finite numbers")
    column.flags.writeable = False
    return column
