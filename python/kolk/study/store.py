"""Finished runs by their key: a run that is there is never repeated."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from kolk.output.atomic import storage_error

from .alone import run_alone
from .job import Job
from .record import Record
from .worker import write_job

STUDIES = Path("studies")
"""Where studies go, and the runs that they share."""


class Store:
    """A folder of records. Making one touches nothing on the disk."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or STUDIES / "runs"

    def find(self, job: Job) -> Record | None:
        """The record of a job, if it was run before; one measured among others counts too."""
        place = self.folder / job.key
        if not (place / "record.json").is_file():
            return None
        try:
            return Record.load(place)
        except (OSError, ValueError, KeyError, TypeError):
            # Of another version, or broken: as good as none.
            return None

    def keep(self, record: Record) -> None:
        """Keeps a record that was made elsewhere."""
        with self._fresh() as folder:
            record.save(folder)
            self._take(folder, record.key)

    def measure(self, job: Job) -> Record:
        """The record of a job: the kept one, or that of a run in a process of its own.

        Raises `RunError` where the process fails or the disk does; nothing is kept then.
        """
        found = self.find(job)
        if found is not None:
            return found
        with self._fresh() as folder:
            write_job(job, folder)
            run_alone("kolk.study.worker", str(folder))
            record = Record.load(folder)
            self._take(folder, record.key)
        return record

    def check(self) -> None:
        """Raises `RunError` where nothing could be kept, before the first run is spent."""
        with self._fresh():
            pass

    def _take(self, folder: Path, key: str) -> None:
        place = self.folder / key
        shutil.rmtree(place, ignore_errors=True)
        os.replace(folder, place)

    @contextlib.contextmanager
    def _fresh(self) -> Iterator[Path]:
        """A folder beside the records, gone after the block unless it was taken."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            folder = Path(tempfile.mkdtemp(prefix=".new-", dir=self.folder))
        except OSError as error:
            raise storage_error(self.folder, error, "keep the runs of the study") from error
        try:
            yield folder
        except OSError as error:
            raise storage_error(self.folder, error, "keep the runs of the study") from error
        finally:
            shutil.rmtree(folder, ignore_errors=True)
