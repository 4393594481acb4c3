"""The two numbers that say how many steps a VTKHDF file holds, changed in one write.

A transient VTKHDF file says its number of steps twice: the attribute `NSteps` of the group
`/VTKHDF/Steps`, and the length of the dataset `/VTKHDF/Steps/Values`. VTK reads the whole of
`Values` into room for `NSteps` numbers, so a file in which the two differ is not just inconsistent:
it crashes its reader. Changing them through HDF5 takes several writes, and a kill may come between.

With HDF5's original file format (`libver="earliest"`) both are plain 8-byte integers in object
headers without checksums, and HDF5 places the two headers next to each other. This module finds
their places by walking the headers (HDF5 file format specification 3.0, IV.A.1.a "Version 1 data
object header prefix", IV.A.2.b "Dataspace message", IV.A.2.m "Attribute message") and rewrites the
few bytes that span both in a single `pwrite` inside one page of the file. A process can be killed
before or after such a write, not within it, and a disk writes the block that it lies in as a whole.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import h5py

PAGE = 4096
"""Bytes that the operating system and the disk handle as one (the smallest page in use)."""

_DATASPACE, _ATTRIBUTE, _CONTINUATION = 0x0001, 0x000C, 0x0010


@dataclass(frozen=True)
class StepCount:
    """Where a file keeps its number of steps: the offsets of the two integers, in bytes."""

    attribute: int
    length: int

    @property
    def in_one_page(self) -> bool:
        """Whether one write inside a page covers both."""
        first, last = sorted((self.attribute, self.length))
        return first // PAGE == (last + 7) // PAGE

    def write(self, descriptor: int, steps: int) -> None:
        """Sets both numbers to `steps` in one write. Raises `OSError`."""
        first = min(self.attribute, self.length)
        span = bytearray(os.pread(descriptor, abs(self.attribute - self.length) + 8, first))
        struct.pack_into("<q", span, self.attribute - first, steps)
        struct.pack_into("<q", span, self.length - first, steps)
        if os.pwrite(descriptor, span, first) != len(span):
            raise OSError(None, "the number of steps was not written")

    def read(self, descriptor: int) -> tuple[int, int]:
        """The attribute and the length as they stand in the file."""
        values = (os.pread(descriptor, 8, place) for place in (self.attribute, self.length))
        attribute, length = (struct.unpack("<q", value)[0] for value in values)
        return attribute, length


def find_step_count(path: Path) -> StepCount:
    """Finds the two numbers in a file that `kolk` made. Raises `OSError` where they are not."""
    with h5py.File(path, "r") as file:
        group = h5py.h5o.get_info(file["VTKHDF/Steps"].id).addr
        values = h5py.h5o.get_info(file["VTKHDF/Steps/Values"].id).addr
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
    try:
        attributes = [
            value
            for kind, place, data in _messages(descriptor, group)
            if kind == _ATTRIBUTE and (value := _attribute_value(place, data, b"NSteps")) >= 0
        ]
        # A simple dataspace, version 1: four single bytes, four reserved, then the lengths.
        lengths = [
            place + 8
            for kind, place, data in _messages(descriptor, values)
            if kind == _DATASPACE and data[:2] == b"\x01\x01"
        ]
        if len(attributes) != 1 or len(lengths) != 1:
            raise OSError(None, "its step count does not lie where kolk's files keep it")
        found = StepCount(attributes[0], lengths[0])
        attribute, length = found.read(descriptor)
        if not 0 <= attribute == length:
            raise OSError(None, f"its step counts disagree ({attribute} and {length})")
        return found
    finally:
        os.close(descriptor)


def _messages(descriptor: int, address: int) -> Iterator[tuple[int, int, bytes]]:
    """The messages of a version 1 object header: kind, offset of the data in the file, data."""
    prefix = os.pread(descriptor, 16, address)
    if len(prefix) < 16 or prefix[0] != 1:
        raise OSError(None, "it is not in HDF5's original file format")
    blocks = [(address + 16, struct.unpack_from("<I", prefix, 8)[0])]
    while blocks:
        start, size = blocks.pop(0)
        block = os.pread(descriptor, size, start)
        at = 0
        while at + 8 <= len(block):
            kind, length = struct.unpack_from("<HH", block, at)
            data = block[at + 8 : at + 8 + length]
            if kind == _CONTINUATION:
                blocks.append(struct.unpack_from("<QQ", data))
            else:
                yield kind, start + at + 8, data
            at += 8 + length


def _attribute_value(place: int, data: bytes, name: bytes) -> int:
    """Offset in the file of the value of a version 1 attribute `name`; -1 for another one."""
    version, _, name_size, type_size, space_size = struct.unpack_from("<BBHHH", data)
    if version != 1 or data[8 : 8 + name_size].rstrip(b"\0") != name:
        return -1
    padded: int = sum(-(-size // 8) * 8 for size in (name_size, type_size, space_size))
    return place + 8 + padded
