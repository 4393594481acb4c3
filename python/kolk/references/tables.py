"""Published figures as package data: a short table per record, its source in the file's head.

A file opens with ``# key: value`` lines (title, paper, kind, ``unit COLUMN``, ``peak COLUMN``,
note) and goes on as CSV with one header line. Records longer than 60 rows are thinned so that
straight lines between the rows follow the record.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from types import MappingProxyType

import numpy as np
import numpy.typing as npt
import pandas as pd

from kolk.errors import KolkError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Reference:
    """One record: its figures and where they come from."""

    name: str
    title: str
    paper: str
    kind: str
    """``experiment`` or ``simulation``."""
    units: Mapping[str, str]
    """Unit of each column, or its scale (``rho g H``, ``sqrt(H/g)``) where it is dimensionless."""
    peaks: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Peak value and its time of the full record, where thinning or averaging lowered it."""
    notes: tuple[str, ...] = ()
    _table: pd.DataFrame = field(default_factory=pd.DataFrame, repr=False, compare=False)

    @property
    def table(self) -> pd.DataFrame:
        """The figures: ``time`` and the value columns. A copy: edit it freely."""
        return self._table.copy()

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the value columns, ``time`` left out."""
        return tuple(str(c) for c in self._table.columns if c != "time")

    @property
    def time(self) -> FloatArray:
        """Times, in ``units["time"]``, ascending."""
        return np.array(self._table["time"], np.float64)

    def values(self, column: str | None = None) -> FloatArray:
        """One value column; without a name, the only one.

        Raises KolkError for an unknown column, or without a name where there are several.
        """
        if column is None and len(self.columns) == 1:
            column = self.columns[0]
        if column not in self.columns:
            raise KolkError(
                f"reference '{self.name}' has no column {column!r}; it has "
                f"{', '.join(self.columns)}: name one of them"
            )
        return np.array(self._table[column], np.float64)

    def peak(self, column: str | None = None) -> tuple[float, float]:
        """Largest value and its time: of the full record where it is known, else of the table."""
        values = self.values(column)
        key = column or self.columns[0]
        if key in self.peaks:
            return self.peaks[key]
        i = int(np.argmax(values))
        return float(values[i]), float(self.time[i])


def names() -> list[str]:
    """Names that :func:`load` takes, sorted."""
    folder = resources.files(__package__) / "data"
    return sorted(f.name[:-4] for f in folder.iterdir() if f.name.endswith(".csv"))


@cache
def load(name: str) -> Reference:
    """The record called ``name``; :func:`names` lists them.

    Raises KolkError for an unknown name.
    """
    if name not in names():
        raise KolkError(f"no reference is called {name!r}; there are {', '.join(names())}")
    text = (resources.files(__package__) / "data" / f"{name}.csv").read_text(encoding="utf-8")
    return _parse(name, text)


def _parse(name: str, text: str) -> Reference:
    head: dict[str, str] = {}
    units: dict[str, str] = {}
    peaks: dict[str, tuple[float, float]] = {}
    notes: list[str] = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        key, _, value = line[1:].strip().partition(": ")
        if key.startswith("unit "):
            units[key[5:]] = value
        elif key.startswith("peak "):
            peak, _, time = value.partition(" at ")
            peaks[key[5:]] = (float(peak), float(time))
        elif key == "note":
            notes.append(value)
        else:
            head[key] = value
    return Reference(
        name=name,
        title=head["title"],
        paper=head["paper"],
        kind=head["kind"],
        units=MappingProxyType(units),
        peaks=MappingProxyType(peaks),
        notes=tuple(notes),
        _table=pd.read_csv(io.StringIO(text), comment="#", dtype=np.float64),
    )
