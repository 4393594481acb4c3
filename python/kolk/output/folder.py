"""The folder of a run: its file names, and how a new run finds or refuses one.

| asked for | what happens |
|---|---|
| no folder | `runs/NAME`, or the first free of `runs/NAME-2`, `-3`, ...: nothing is overwritten |
| a folder that is new or empty | it is used |
| a folder that holds a run | refused, unless `--resume` (go on) or `--force` (start over) |
| a folder with other files | refused, unless `--force`, which removes only kolk's own files |
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
from pathlib import Path

from kolk.errors import RunError
from kolk.output.atomic import TEMPORARY_SUFFIX, storage_error

RUNS = Path("runs")
"""Where runs go that were given no folder."""


class RunFolder:
    """Paths of a run's files. Making one touches nothing on the disk."""

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self.scene = self.path / "scene.toml"
        self.fields = self.path / "fields.vtkhdf"
        self.probes = self.path / "probes"
        self.history = self.path / "history.csv"
        self.checkpoint = self.path / "checkpoint.h5"
        self.summary = self.path / "summary.json"
        self.log = self.path / "log.txt"
        self.pictures = self.path / "pictures"
        self._lock: int | None = None

    def __str__(self) -> str:
        return str(self.path)

    @property
    def holds_run(self) -> bool:
        """Whether a run was started here."""
        return self.scene.is_file()

    def probe(self, name: str) -> Path:
        """The table of a probe; characters that file systems refuse become underscores."""
        return self.probes / f"{safe_name(name)}.csv"

    def claim(self, *, force: bool) -> None:
        """Makes the folder ready for a new run and locks it. Raises `RunError` where it may not."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            occupied = any(entry.name != _LOCK for entry in self.path.iterdir())
        except OSError as error:
            raise storage_error(self.path, error, "use the run's folder") from error
        if occupied and not force:
            if self.holds_run:
                raise RunError(
                    f"the folder {self.path} already holds a run: go on with it (--resume), "
                    "start over (--force), or choose another folder (--out)"
                )
            raise RunError(
                f"the folder {self.path} holds other files: choose a new or empty folder "
                "(--out), or --force to write among them"
            )
        self.lock()
        if occupied:
            self._clear()

    def lock(self) -> None:
        """Keeps other runs out until `unlock` or the end of the process. Raises `RunError`."""
        place = self.path / _LOCK
        try:
            descriptor = os.open(place, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError as error:
            raise storage_error(self.path, error, "write in the run's folder") from error
        if not _try_lock(descriptor):
            os.close(descriptor)
            raise RunError(
                f"another kolk is running in the folder {self.path}: "
                "wait for it, stop it, or choose another folder (--out)"
            )
        self._lock = descriptor

    def unlock(self) -> None:
        """Lets others in again."""
        if self._lock is not None:
            with contextlib.suppress(OSError):
                (self.path / _LOCK).unlink()
            os.close(self._lock)
            self._lock = None

    def discard(self) -> None:
        """Takes back what a run that could not begin has left; best effort."""
        with contextlib.suppress(OSError, RunError):
            self._clear()
            self.log.unlink(missing_ok=True)
            self.unlock()
            if self.probes.is_dir():
                self.probes.rmdir()
            self.path.rmdir()

    def _clear(self) -> None:
        """Removes a former run's files, and nothing else."""
        files = [
            self.summary,
            self.checkpoint,
            self.fields,
            self.history,
            self.scene,
            # Own particles, which lie beside the scene.
            *sorted(self.path.glob("*.npz")),
        ]
        files += sorted(self.probes.glob("*.csv")) if self.probes.is_dir() else []
        try:
            for file in files:
                file.unlink(missing_ok=True)
                file.with_name(file.name + TEMPORARY_SUFFIX).unlink(missing_ok=True)
            if self.pictures.is_dir():
                shutil.rmtree(self.pictures)
        except OSError as error:
            raise storage_error(self.path, error, "clear the run's folder") from error


_LOCK = ".lock"


def _try_lock(descriptor: int) -> bool:
    """Takes an exclusive lock that the system releases when the process ends, however it ends."""
    try:
        import fcntl
    except ImportError:
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        # Some network file systems know no locks; a run must work there all the same.
        return True
    return True


def safe_name(name: str) -> str:
    """`name` as a file name on every system."""
    return re.sub(r"[^\w.+-]+", "_", name).strip(".") or "_"


def free_folder(name: str, root: Path = RUNS) -> RunFolder:
    """The first of `root/NAME`, `root/NAME-2`, ... that holds nothing."""
    base = safe_name(name)
    number = 1
    while True:
        path = root / (base if number == 1 else f"{base}-{number}")
        if not path.exists() or (path.is_dir() and not any(path.iterdir())):
            return RunFolder(path)
        number += 1


def newest_folder(name: str, root: Path = RUNS) -> RunFolder | None:
    """The run among `root/NAME`, `root/NAME-2`, ... that was written last; None where none is."""
    base = re.compile(re.escape(safe_name(name)) + r"(-\d+)?")
    folders = [RunFolder(path) for path in root.glob("*")] if root.is_dir() else []
    runs = [f for f in folders if base.fullmatch(f.path.name) and f.holds_run]
    return max(runs, key=_last_written, default=None)


def _last_written(folder: RunFolder) -> float:
    present = [p for p in (folder.checkpoint, folder.summary, folder.scene) if p.is_file()]
    return max(path.stat().st_mtime for path in present)
