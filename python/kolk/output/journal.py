"""`log.txt`: what a run did and when, one line an event, appended over resumes."""

from __future__ import annotations

import contextlib
from datetime import datetime
from pathlib import Path
from typing import TextIO

from kolk.output.atomic import storage_error


class Journal:
    """An open log file. A log that can no longer be written must not end a run: it falls silent."""

    def __init__(self, path: Path, *, fresh: bool) -> None:
        self.path = path
        try:
            self._file: TextIO | None = path.open("w" if fresh else "a", encoding="utf-8")
        except OSError as error:
            raise storage_error(path, error, "open the log") from error

    def write(self, event: str) -> None:
        """Adds an event with the local time; further lines of it are indented."""
        if self._file is None:
            return
        stamp = datetime.now().astimezone().isoformat(timespec="seconds")
        text = event.rstrip().replace("\n", "\n    ")
        with contextlib.suppress(OSError):
            self._file.write(f"{stamp}  {text}\n")
            self._file.flush()

    def close(self) -> None:
        """Closes the file; a closed journal ignores further events."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.close()
            self._file = None
