"""HDF5 files made in memory and then written by plain system calls.

HDF5 does not survive a full disk: a failed write leaves objects that cannot be closed, and the
process ends in a crash. So HDF5 never writes to a disk here. It writes into a `MemoryFile`, which
holds only what was really written (datasets that are merely reserved take no memory), and
`save_image` puts that into a file, where an error is an ordinary `OSError`.
"""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py

_BLOCK = 1 << 16


class MemoryFile:
    """A sparse file in memory, as `h5py.File` takes it: blocks never written read as zeros."""

    def __init__(self) -> None:
        self._blocks: dict[int, bytearray] = {}
        self._size = 0
        self._at = 0

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Moves to an offset from the start, from here, or from the end; returns the place."""
        start = {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: self._size}[whence]
        self._at = start + offset
        return self._at

    def tell(self) -> int:
        """The present place."""
        return self._at

    def read(self, size: int = -1) -> bytes:
        """The next `size` bytes, or all that follow."""
        rest = max(self._size - self._at, 0)
        data = bytearray(rest if size < 0 else min(size, rest))
        self.readinto(data)
        return bytes(data)

    def readinto(self, buffer: Any) -> int:
        """Fills a buffer from the present place; returns the bytes read."""
        target = memoryview(buffer).cast("B")
        length = max(min(len(target), self._size - self._at), 0)
        for number, within, begin, end in self._pieces(length):
            block = self._blocks.get(number)
            size = end - begin
            target[begin:end] = block[within : within + size] if block else bytes(size)
        self._at += length
        return length

    def write(self, data: Any) -> int:
        """Writes at the present place; returns the bytes written."""
        source = memoryview(data).cast("B")
        for number, within, begin, end in self._pieces(len(source)):
            block = self._blocks.setdefault(number, bytearray(_BLOCK))
            block[within : within + end - begin] = source[begin:end]
        self._at += len(source)
        self._size = max(self._size, self._at)
        return len(source)

    def truncate(self, size: int | None = None) -> int:
        """Sets the length of the file."""
        self._size = self._at if size is None else size
        return self._size

    def flush(self) -> None:
        """Nothing to do: there is no disk."""

    def save(self, path: Path) -> None:
        """Writes the file to a disk; blocks never written stay holes. Raises `OSError`."""
        flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
        descriptor = os.open(path, flags, 0o666)
        try:
            os.ftruncate(descriptor, self._size)
            for number, block in sorted(self._blocks.items()):
                offset = number * _BLOCK
                write_at(descriptor, block[: max(self._size - offset, 0)], offset)
        finally:
            os.close(descriptor)

    def _pieces(self, length: int) -> Iterator[tuple[int, int, int, int]]:
        """Block, place in it, begin and end in the caller's buffer, of the next `length` bytes."""
        begin = 0
        while begin < length:
            number, within = divmod(self._at + begin, _BLOCK)
            end = min(begin + _BLOCK - within, length)
            yield number, within, begin, end
            begin = end


def write_at(descriptor: int, data: Any, offset: int) -> None:
    """Writes all of `data` at an offset of an open file. Raises `OSError`."""
    view = memoryview(data).cast("B")
    while view:
        written = os.pwrite(descriptor, view, offset)
        view, offset = view[written:], offset + written


@contextmanager
def hdf5_image(path: Path) -> Iterator[Any]:
    """Gives an open, empty `h5py.File` in memory; when the block ends well it becomes `path`.

    In HDF5's original file format. Not atomic: write to a temporary path (see `atomic.replacing`).
    """
    memory = MemoryFile()
    with h5py.File(memory, "w", libver="earliest") as file:
        yield file
    memory.save(path)
