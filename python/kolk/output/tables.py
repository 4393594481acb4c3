"""Tables that grow by whole lines: probe records and the history of a run.

A row goes to the file in one `write`, so a kill leaves whole rows (a full disk may leave part of
one: readers drop a last line without its end). A checkpoint stores each table's length in
bytes; on resume the table is cut back to it, and the same rows follow again.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kolk.output.atomic import storage_error

if TYPE_CHECKING:
    import pandas as pd


class Table:
    """A CSV file open for appending rows of numbers under named columns.

    `length` bytes are kept of an existing file (None: a new, empty table). Raises `RunError` where
    the file cannot be written, or is shorter than `length`.
    """

    def __init__(self, path: Path, columns: Sequence[str], length: int | None = None) -> None:
        self.path = path
        self.columns = tuple(columns)
        self._descriptor = -1
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            flags = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0)
            self._descriptor = os.open(path, flags, 0o666)
            present = os.fstat(self._descriptor).st_size
            if length is not None and present < length:
                raise OSError(None, f"it holds {present} bytes where the checkpoint knows {length}")
            self.length = length or 0
            os.ftruncate(self._descriptor, self.length)
            os.lseek(self._descriptor, self.length, os.SEEK_SET)
            if self.length == 0:
                self._write(",".join(self.columns))
        except OSError as error:
            self.close()
            raise storage_error(path, error, "open the table") from error

    def append(self, row: Sequence[float]) -> None:
        """Adds one row; values are written so that they read back to the same bits."""
        try:
            self._write(",".join(repr(float(value)) for value in row))
        except OSError as error:
            raise storage_error(self.path, error, "add a row to the table") from error

    def cut(self, length: int) -> None:
        """Takes back the rows beyond `length` bytes."""
        if length == self.length:
            return
        try:
            os.ftruncate(self._descriptor, length)
            os.lseek(self._descriptor, length, os.SEEK_SET)
        except OSError as error:
            raise storage_error(self.path, error, "take back rows of the table") from error
        self.length = length

    def sync(self) -> None:
        """Makes the rows durable."""
        try:
            os.fsync(self._descriptor)
        except OSError as error:
            raise storage_error(self.path, error, "write the table") from error

    def close(self) -> None:
        """Closes the file; a closed table may be closed again."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def _write(self, line: str) -> None:
        data = line.encode() + b"\n"
        written = 0
        while written < len(data):
            written += os.write(self._descriptor, data[written:])
        self.length += len(data)


def read_columns(path: Path) -> dict[str, NDArray[np.float64]]:
    """The whole rows of a table, by column; a torn last line is dropped."""
    text = path.read_text(encoding="utf-8")
    header, *lines = text[: text.rfind("\n") + 1].splitlines()
    names = header.split(",")
    # NumPy reads numbers to the same bits; pandas's own reader does not in every version.
    rows = np.loadtxt(lines, delimiter=",", ndmin=2) if lines else np.zeros((0, len(names)))
    return dict(zip(names, rows.T, strict=True))


def read_table(path: Path) -> pd.DataFrame:
    """The whole rows of a table as a pandas frame with its columns."""
    import pandas as pd

    return pd.DataFrame(read_columns(path))
