"""`checkpoint.h5`: the newest whole state of a run, enough to go on to the same bits.

It holds the engine's state as it stands (every array in its own type, untouched) and the run's
bookkeeping: how many frames and how many bytes of each table belong to this state, which probe
sample comes next, the time spent so far. It is replaced as a whole (`atomic`), so a kill or a full
disk while it is written leaves the one before.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from kolk.errors import RunError
from kolk.output.atomic import replacing, storage_error
from kolk.output.image import hdf5_image

FORMAT = 1
"""Layout of the file; a reader refuses another one."""

State = Mapping[str, Any]
"""The engine's state: name -> array, integer, float, string or truth value."""


@dataclass(frozen=True)
class Checkpoint:
    """What a checkpoint holds.

    state: the engine's. book: the run's bookkeeping, JSON types only. scene: fingerprint of the
    scene that the state belongs to.
    """

    state: State
    book: Mapping[str, Any]
    scene: str


def write_checkpoint(path: Path, checkpoint: Checkpoint) -> None:
    """Replaces the checkpoint. Raises `RunError`; the earlier one then stays."""
    try:
        with replacing(path) as temporary, hdf5_image(temporary) as file:
            file.attrs["format"] = FORMAT
            file.attrs["scene"] = checkpoint.scene
            file.attrs["book"] = json.dumps(dict(checkpoint.book))
            group = file.create_group("state")
            # By number: a name may hold a slash, which HDF5 would take for a folder.
            for number, (name, value) in enumerate(checkpoint.state.items()):
                _put(group, str(number), value)
                group[str(number)].attrs["name"] = name
    except OSError as error:
        raise storage_error(path, error, "write the checkpoint") from error


def read_checkpoint(path: Path) -> Checkpoint:
    """Reads a checkpoint back. Raises `RunError` where it is missing, damaged or foreign."""
    if not path.is_file():
        raise RunError(
            f"there is no checkpoint {path}: nothing to resume from; run without --resume"
        )
    try:
        with h5py.File(path, "r") as file:
            if int(file.attrs["format"]) != FORMAT:
                raise RunError(
                    f"the checkpoint {path} has the format {int(file.attrs['format'])}, this kolk "
                    f"reads {FORMAT}: resume with the version that wrote it"
                )
            entries = sorted(file["state"].values(), key=lambda entry: int(entry.name[7:]))
            state = {str(entry.attrs["name"]): _get(entry) for entry in entries}
            book = json.loads(file.attrs["book"])
            return Checkpoint(state, book, str(file.attrs["scene"]))
    except (OSError, KeyError, ValueError) as error:
        raise RunError(
            f"the checkpoint {path} cannot be read ({error}): run again without --resume"
        ) from error


def _put(group: Any, name: str, value: Any) -> None:
    # An integer may use all 64 bits without a sign (random states, hashes).
    if isinstance(value, (str, bytes)):
        group[name] = np.void(value.encode() if isinstance(value, str) else value) if value else 0
        group[name].attrs["kind"] = "str" if isinstance(value, str) else "bytes"
    elif isinstance(value, (bool, int, float)):
        large = type(value) is int and value > np.iinfo(np.int64).max
        group[name] = np.uint64(value) if large else value
        group[name].attrs["kind"] = type(value).__name__
    else:
        array = np.asarray(value)
        group.create_dataset(name, data=array)
        group[name].attrs["kind"] = "array"


def _get(dataset: Any) -> Any:
    kind, value = str(dataset.attrs["kind"]), dataset[()]
    if kind in ("str", "bytes"):
        data = value.tobytes() if dataset.dtype.kind == "V" else b""
        return data.decode() if kind == "str" else data
    if kind == "array":
        return dataset[...]
    return {"bool": bool, "int": int, "float": float}[kind](value)
