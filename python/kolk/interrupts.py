"""Ctrl-C and SIGTERM during a run: heard at once by the engine, and never inside a file."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any


class Interrupts:
    """Turns Ctrl-C and SIGTERM into KeyboardInterrupt, but only where the state is whole.

    While the engine works it hears of it at once and stops between two steps; while a frame or a
    checkpoint is written it waits until that is done. A second Ctrl-C does not wait. Outside the
    main thread signals are left as they are.
    """

    def __init__(self) -> None:
        self._asked = 0
        self._open = False
        self._former: dict[int, Any] = {}

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._former[number] = signal.signal(number, self._hear)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, handler in self._former.items():
            signal.signal(number, handler)

    @property
    def hurried(self) -> bool:
        """Whether the signal came again before it was heeded."""
        return self._asked > 1

    def during(self) -> _Window:
        """The block in which a KeyboardInterrupt may come."""
        return _Window(self)

    def check(self) -> None:
        """Raises KeyboardInterrupt if it was asked for in the meantime."""
        if self._asked:
            raise KeyboardInterrupt

    def _hear(self, number: int, frame: FrameType | None) -> None:
        self._asked += 1
        if self._open or self._asked > 1:
            raise KeyboardInterrupt


class _Window:
    def __init__(self, interrupts: Interrupts) -> None:
        self._interrupts = interrupts

    def __enter__(self) -> None:
        self._interrupts._open = True
        self._interrupts.check()

    def __exit__(self, *_: object) -> None:
        self._interrupts._open = False
