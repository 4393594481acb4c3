"""`docs/stability.md` from the results that are kept in `results.json`."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from .suite import FOLDER, Figure, Result, get, names

PAGE = FOLDER.parents[1] / "docs" / "stability.md"
RESULTS = FOLDER / "results.json"

HEAD = """# Stability

Cases in which SPH codes blow up, leak, clump or lose energy, and what kolk shows on each. All run
with the defaults that a user gets. Written by `python -m tests.stability --full`, which runs every
case (`... --full CASE ...` some, keeping the others' figures); `pytest` runs the short versions and
`pytest -m stability` the full ones.

A figure has a limit, beyond which the test fails, or a goal, which is shown as met or not. Retries
are how often the guard went back to an earlier state and on with a shorter step.
"""


def keep(name: str, results: Sequence[Result], without: Result | None, machine: str) -> None:
    """Keeps the results of a case, in place of its earlier ones."""
    everything = read()
    everything[name] = {
        "machine": machine,
        "results": [_plain(result) for result in results],
        "without": None if without is None else _plain(without),
    }
    text = json.dumps(everything, indent=1, ensure_ascii=False, sort_keys=True, allow_nan=False)
    RESULTS.write_text(text + "\n", encoding="utf-8")


def _plain(result: Result) -> dict[str, Any]:
    figures = [{**vars(f), "value": f.value if math.isfinite(f.value) else str(f.value)}
               for f in result.figures]  # fmt: skip
    return {**vars(result), "figures": figures, "seconds": round(result.seconds, 1)}


def _result(plain: dict[str, Any]) -> Result:
    figures = tuple(Figure(**(f | {"value": float(f["value"])})) for f in plain["figures"])
    return Result(**(plain | {"figures": figures}))


def read() -> dict[str, Any]:
    """All results that are kept, by case."""
    if not RESULTS.exists():
        return {}
    found: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8"))
    return found


def page() -> str:
    """The whole page."""
    kept = read()
    return "\n".join([HEAD, *(_section(name, kept.get(name)) for name in names())])


def _section(name: str, kept: dict[str, Any] | None) -> str:
    case = get(name)
    lines = [f"## {case.title}", "", f"{case.setup} Typical failure: {case.failure}.", ""]
    if case.remarks:
        lines += [case.remarks, ""]
    if kept is None:
        return "\n".join([*lines, "Not run yet.", ""])
    lines += ["| variant | quantity | value | limit | |", "|---|---|---|---|---|"]
    for plain in kept["results"]:
        result = _result(plain)
        lines += [_row(result.variant if k == 0 else "", f) for k, f in enumerate(result.figures)]
        cost = f"{result.particles:,} particles, {result.steps:,} steps, {result.seconds:,.0f} s"
        lines.append(f"| | *{cost}* | {result.retries} retries | | |")
    if kept["without"] is not None:
        missed = ", ".join(f"{f} (limit {f.limit})" for f in _result(kept["without"]).missed)
        lines += ["", f"Without {case.remedy}: {missed or 'no limit is missed'}."]
    return "\n".join([*lines, "", f"On {kept['machine']}.", ""])


def _row(variant: str, figure: Figure) -> str:
    met = "met" if figure.passed else "**not met**"
    if figure.goal is not None:
        met += ", goal met" if figure.value <= figure.goal else ", goal not met"
    elif not figure.limit:
        met = ""
    value = str(figure).partition(": ")[2]
    return f"| {variant} | {figure.name} | {value} | {figure.limit} | {met} |"
