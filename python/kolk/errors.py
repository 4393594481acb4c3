"""All exceptions that kolk raises on purpose, in one place; the Rust engine raises them from here.

Each message names the key or the array, what was found, what is allowed, and what to do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace


class KolkError(Exception):
    """Base of every error that kolk raises on purpose."""


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong with a scene."""

    path: tuple[str | int, ...]
    """Keys from the root of the scene, list items by position or by name."""
    message: str

    def under(self, prefix: Sequence[str | int]) -> Problem:
        """The same problem, seen from further up."""
        return replace(self, path=(*prefix, *self.path))

    def __str__(self) -> str:
        key = ""
        for part in self.path:
            key += f"[{part}]" if isinstance(part, int) else f".{part}"
        return f"{key[1:]}: {self.message}" if key else self.message


class SceneError(KolkError, ValueError):
    """A scene that cannot be run as it stands."""

    def __init__(self, message: str = "", problems: Sequence[Problem] = ()) -> None:
        self.problems: tuple[Problem, ...] = tuple(problems)
        if self.problems and not message:
            lines = [str(p) for p in self.problems]
            message = (
                lines[0]
                if len(lines) == 1
                else "\n".join(
                    [f"{len(lines)} problems in the scene:", *(f"  {line}" for line in lines)]
                )
            )
        super().__init__(message)


class ArrayError(KolkError, ValueError):
    """An array of the wrong shape, type or content."""


class RunError(KolkError):
    """A run that cannot start or go on for a reason outside the physics, such as a full disk."""


class InstabilityError(KolkError):
    """A run that stopped for a numerical or physical reason.

    Attributes say where and why; those that do not apply are None.
    """

    def __init__(
        self,
        message: str = "",
        *,
        time: float | None = None,
        step: int | None = None,
        particle: int | None = None,
        position: Sequence[float] | None = None,
        quantity: str | None = None,
        value: float | None = None,
        cause: str | None = None,
        remedy: str | None = None,
    ) -> None:
        super().__init__(message)
        self.time = time
        self.step = step
        self.particle = particle
        self.position = tuple(position) if position is not None else None
        self.quantity = quantity
        self.value = value
        self.cause = cause
        self.remedy = remedy
