"""Replacing a file as a whole: readers see the old contents or the new ones, never a mixture.

The new contents go to a temporary file beside the target, reach the disk (`fsync`), and only then
take the target's name (`os.replace`, atomic within a file system). A crash, a kill or a full disk
leaves the old file as it was; the temporary file is removed, or overwritten by the next attempt.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from kolk.errors import RunError

TEMPORARY_SUFFIX = ".part"


def storage_error(path: Path, error: OSError, doing: str) -> RunError:
    """The error for a file that cannot be written: what failed, why, and what to do.

    `doing` completes "cannot ...", for example "write the checkpoint".
    """
    # HDF5 reports the system's error inside its own message only.
    nested = re.search(r"errno = (\d+)", str(error))
    number = int(nested.group(1)) if nested else error.errno or 0
    reason = os.strerror(number) if number else str(error)
    remedies = {
        errno.ENOSPC: "free some space on this disk, or choose another folder with --out",
        errno.EDQUOT: "free some of your disk quota, or choose another folder with --out",
        errno.EFBIG: "this file system or your limits refuse so large a file: "
        "write fewer frames (output.every) or choose another folder with --out",
        errno.EROFS: "choose a folder on a writable disk with --out",
        errno.EACCES: "choose a folder that you may write to with --out",
        errno.EPERM: "choose a folder that you may write to with --out",
        errno.ENOTDIR: "a part of this path is a file: choose another folder with --out",
        errno.EEXIST: "a file has this name: choose another folder with --out",
        errno.ENAMETOOLONG: "choose a shorter name with --out",
    }
    remedy = remedies.get(number, "check the disk and the folder, or choose another with --out")
    return RunError(f"cannot {doing} ({path}): {reason}; {remedy}")


def sync_folder(folder: Path) -> None:
    """Makes the names in a folder durable; a no-op where folders cannot be synced."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Gives a temporary path to write to; when the block ends well it becomes `path`.

    An exception inside the block leaves `path` untouched and removes the temporary file.
    """
    temporary = path.with_name(path.name + TEMPORARY_SUFFIX)
    try:
        yield temporary
        descriptor = os.open(temporary, os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
        os.replace(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise
    sync_folder(path.parent)


def write_text(path: Path, text: str, doing: str) -> None:
    """Writes `text` to `path` as a whole; `RunError` ("cannot `doing` ...") where it cannot."""
    try:
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    except OSError as error:
        raise storage_error(path, error, doing) from error


def write_bytes(path: Path, data: bytes, doing: str) -> None:
    """Writes `data` to `path` as a whole; `RunError` ("cannot `doing` ...") where it cannot."""
    try:
        with replacing(path) as temporary:
            temporary.write_bytes(data)
    except OSError as error:
        raise storage_error(path, error, doing) from error


def write_json(path: Path, value: Mapping[str, Any], doing: str) -> None:
    """Writes `value` as indented JSON, as a whole. Numbers that are not finite become null."""
    text = json.dumps(_plain(value), indent=2, ensure_ascii=False, allow_nan=False)
    write_text(path, text + "\n", doing)


def _plain(value: Any) -> Any:
    """`value` in JSON's own types; NumPy scalars and arrays become numbers and lists."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return value if value == value and abs(value) != float("inf") else None
    if value is None or isinstance(value, (str, int, bool)):
        return value
    return str(value)
