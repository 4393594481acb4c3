"""Progress of a run on the terminal: a bar, or plain lines where standard error is no terminal.

Nothing is shown for the first two seconds, so a short run stays silent; nothing ever is in quiet
mode. All of it goes to standard error, so that standard output holds the results alone.
"""

from __future__ import annotations

import contextlib
import sys
import time as clock
from collections.abc import Iterator
from contextvars import ContextVar
from types import TracebackType
from typing import Any

PATIENCE = 2.0
"""Seconds before anything is shown."""

PLAIN_INTERVAL = 10.0
"""Seconds between two lines where there is no terminal."""


_silent: ContextVar[bool] = ContextVar("silent", default=False)


@contextlib.contextmanager
def silence(wanted: bool = True) -> Iterator[None]:
    """No progress of work that a caller cannot tell to be quiet, such as filling a scene."""
    token = _silent.set(wanted or _silent.get())
    try:
        yield
    finally:
        _silent.reset(token)


def is_silent() -> bool:
    """Whether this happens within :func:`silence`."""
    return _silent.get()


class Progress:
    """Shows how far a run is. Use it as a context and call `update` as often as you like."""

    def __init__(self, until: float, *, start: float = 0.0, quiet: bool = False) -> None:
        self.until, self.start, self.quiet = until, start, quiet
        self._begun = clock.monotonic()
        self._next_line = self._begun + PATIENCE
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> Progress:
        self._begun = clock.monotonic()
        self._next_line = self._begun + PATIENCE
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def update(self, time: float, steps: int, time_step: float) -> None:
        """Time reached (s), steps taken, last time step (s)."""
        share = (time - self.start) / max(self.until - self.start, 1e-300)
        self.show(
            share, f"t = {time:.4g} of {self.until:g} s, step {steps:,}, Δt = {time_step:.3g} s"
        )

    def show(self, share: float, text: str) -> None:
        """Share of the work that is done, and in words where it stands."""
        if self.quiet:
            return
        now = clock.monotonic()
        if now < self._begun + PATIENCE:
            return
        left = (now - self._begun) * (1.0 - share) / share if share > 0.0 else float("inf")
        if sys.stderr.isatty():
            self._draw(share, f"{text}, {duration(left)} left")
        elif now >= self._next_line:
            self._next_line = now + PLAIN_INTERVAL
            print(f"{100.0 * share:5.1f} %  {text}, {duration(left)} left", file=sys.stderr)

    def _draw(self, share: float, text: str) -> None:
        if self._bar is None:
            from rich.console import Console
            from rich.progress import BarColumn, TaskProgressColumn, TextColumn
            from rich.progress import Progress as Bar

            self._bar = Bar(
                BarColumn(30),
                TaskProgressColumn(),
                TextColumn("{task.description}"),
                console=Console(stderr=True),
                transient=True,
                refresh_per_second=5,
            )
            self._task = self._bar.add_task("", total=1.0)
            self._bar.start()
        self._bar.update(self._task, completed=share, description=text)


def duration(seconds: float) -> str:
    """Seconds as a reader says them: 0.8 s, 42 s, 3 min 20 s, 2 h 05 min."""
    if not seconds < 1e9:
        return "unknown time"
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"
