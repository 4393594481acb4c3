"""`--tolerance` and `--budget` of `kolk run`: what is promised before it, and kept or not after."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING, Any

from kolk.errors import SceneError
from kolk.output.atomic import write_json

if TYPE_CHECKING:
    from kolk.results import Run
    from kolk.scene import Scene
    from kolk.simulation import Precision
    from kolk.study.promise import Promise

SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}
"""Seconds of each unit of a budget."""


def promised(
    scene: Scene,
    tolerance: str | None,
    budget: str | None,
    quantity: str | None,
    *,
    fixed: bool,
    precision: Precision | None,
    threads: int,
    quiet: bool,
) -> Promise:
    """The promise that the options ask for, said on the terminal. fixed: whether the spacing is."""
    from kolk.study.promise import choose

    if fixed:
        raise SceneError(
            "--tolerance and --budget choose the spacing: leave out --spacing and --resume"
        )
    found = choose(
        scene,
        tolerance=None if tolerance is None else share(tolerance),
        budget=None if budget is None else time(budget),
        quantity=quantity,
        precision=precision,
        threads=threads,
        quiet=quiet,
    )
    if not quiet:
        print(f"{found}\n", file=sys.stderr, flush=True)
    return found


def settled(promise: Promise, run: Run) -> None:
    """Says what became of the promise, and keeps it beside the run."""
    from kolk.study.promise import outcome

    lines = outcome(promise, run)
    print("\n".join(["", "The promise:", *(f"  {line}" for line in lines)]))
    data: dict[str, Any] = {
        "promise": list(promise.reasons),
        "outcome": lines,
        "tolerance": promise.tolerance,
    }
    data |= {"budget": promise.budget, "error": promise.error, "wall": promise.wall.as_dict()}
    write_json(run.folder / "promise.json", data, "write what was promised")


def share(text: str) -> float:
    """`2%` or `0.02` as a share. Raises `SceneError`."""
    match = re.fullmatch(r"([\d.]+(?:e-?\d+)?)\s*(%?)", text.strip())
    try:
        if match:
            return float(match[1]) * (0.01 if match[2] else 1.0)
    except ValueError:
        pass
    raise SceneError(f"--tolerance {text}: must be a share such as 2% or 0.02")


def time(text: str) -> float:
    """`10min`, `90s`, `1.5h` or seconds, as seconds. Raises `SceneError`."""
    match = re.fullmatch(r"([\d.]+)\s*(s|min|h|d)?", text.strip())
    try:
        if match:
            return float(match[1]) * SECONDS[match[2] or "s"]
    except ValueError:
        pass
    raise SceneError(f"--budget {text}: must be a time such as 90s, 10min or 2h")
