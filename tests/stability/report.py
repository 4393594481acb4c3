"""`docs/stability.md` from the results that are kept in `results.json`."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from kolk.output.atomic import replacing

from .suite import FOLDER, Figure, Result, get, names

PAGE = FOLDER.parents[1] / "docs" / "stability.md"
RESULTS = FOLDER / "results.json"

WITHOUT = "without its remedy"
"""The variant of a case that must fail."""

HEAD = """# Stability

Cases in which SPH codes blow up, leak, clump or lose energy, and what kolk shows on each. All run
with the defaults that a user gets. Written by `python -m tests.stability --full`, which runs every
variant that has no figures of this engine yet (`--full CASE ...` some cases, `--again` also those
that have); a run that is cut goes on from where it was. `pytest` runs the short versions and
`pytest -m stability` the full ones.

A figure has a limit, beyond which the test fails, or a goal, which is shown as met or not. Retries
are how often the guard went back to an earlier state and on with a shorter step. Times are those of
the clock, and include that of other work where a run was paused for it: water at rest with EDAC
(about 0.8 of 3.9 thousand seconds are its own) and the cell of 100,000 particles.
"""

TAIL = """## Kills, full disks and chance

Runs killed with `kill -9` once or twice at random moments, fifty of them, each resumed to the same
bytes as an undisturbed run with no file half written: 48 of fifty at the first go; the other two
met the test's own time limit on a busy machine (since raised), and were right when repeated. Disks
in memory that fill up after 60, 150 and 400 kB: the run ends with a sentence, what was written can
be read, and with room again it goes on to the same bytes: three of three
(`tests/stability/test_durability.py`).

Fuzzing, each on one core beside other work: scene files and array functions under hypothesis
(`tests/python/test_fuzz.py`) for half an hour each, array functions and whole simulations under
cargo-fuzz (`fuzz/`) for 14 and 30. Nothing panicked or hung in the end; what was found on
the way, and tests now hold: neighbours that were missed across a period by points 1e15 periods
away; radii so small that their squares are zero, now refused; an overflow in the number of cells
where particles are 1e300 m apart, which only builds with checks stop at.
"""


def keep(name: str, result: Result, where: dict[str, str]) -> None:
    """Keeps the result of a variant, in place of its earlier one; ``where``: machine, engine."""
    # Read just before it is written: another process may have kept others meanwhile.
    everything = read()
    variants = {*get(name).full, WITHOUT}
    everything[name] = {v: of for v, of in everything.get(name, {}).items() if v in variants}
    everything[name][result.variant] = _plain(result) | where
    text = json.dumps(everything, indent=1, ensure_ascii=False, sort_keys=True, allow_nan=False)
    with replacing(RESULTS) as temporary:
        temporary.write_text(text + "\n", encoding="utf-8")


def kept(name: str, variant: str, engine: str) -> bool:
    """Whether there is a result of a variant, and of this engine."""
    return bool(read().get(name, {}).get(variant, {}).get("engine") == engine)


def _plain(result: Result) -> dict[str, Any]:
    figures = [{**vars(f), "value": f.value if math.isfinite(f.value) else str(f.value)}
               for f in result.figures]  # fmt: skip
    return {**vars(result), "figures": figures, "seconds": round(result.seconds, 1)}


def _result(plain: dict[str, Any]) -> Result:
    figures = tuple(Figure(**(f | {"value": float(f["value"])})) for f in plain["figures"])
    known = {key: value for key, value in plain.items() if key not in ("machine", "engine")}
    return Result(**(known | {"figures": figures}))


def read() -> dict[str, Any]:
    """All results that are kept, by case."""
    if not RESULTS.exists():
        return {}
    found: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8"))
    return found


def page() -> str:
    """The whole page."""
    found = read()
    return "\n".join([HEAD, *(_section(name, found.get(name, {})) for name in names()), TAIL])


def _section(name: str, found: dict[str, Any]) -> str:
    case = get(name)
    lines = [f"## {case.title}", "", f"{case.setup} Typical failure: {case.failure}.", ""]
    if case.remarks:
        lines += [case.remarks, ""]
    there = [variant for variant in case.full if variant in found]
    if there:
        lines += ["| variant | quantity | value | limit | |", "|---|---|---|---|---|"]
    for variant in there:
        result = _result(found[variant])
        rows = [_row(variant if k == 0 else "", f) for k, f in enumerate(result.figures)]
        if result.stopped:
            rows = [f"| {variant} | stopped by the guard | | | **not met** |"]
        cost = f"{result.particles:,} particles, {result.steps:,} steps, {result.seconds:,.0f} s"
        lines += [*rows, f"| | *{cost}* | {result.retries} retries | | |"]
    for variant in there:
        if stopped := found[variant]["stopped"]:
            lines += ["", f"{variant} was stopped: {stopped}"]
    if missing := [variant for variant in case.full if variant not in found]:
        lines += ["", f"Not run yet: {'; '.join(missing)}."]
    if WITHOUT in found:
        without = _result(found[WITHOUT])
        missed = ", ".join(f"{f} (limit {f.limit})" for f in without.missed)
        stopped = (without.stopped or "").partition(". Probable cause")[0]
        end = f"the guard stops it, {stopped}" if stopped else missed
        lines += ["", f"Without {case.remedy}: {end or 'no limit is missed'}."]
    lines += ["", *_where(found, [*there, *([WITHOUT] if WITHOUT in found else [])])]
    return "\n".join(lines)


def _where(found: dict[str, Any], variants: Sequence[str]) -> list[str]:
    """Which machines and engines the figures are of."""
    engines: dict[str, list[str]] = {}
    for variant in variants:
        of = f"engine {found[variant]['engine']}, {found[variant]['machine']}"
        engines.setdefault(of, []).append(variant)
    if len(engines) == 1:
        return [f"By {next(iter(engines))}.", ""]
    parts = [f"{of}: {'; '.join(found)}" for of, found in engines.items()]
    return [f"By {', by '.join(parts)}.", ""] if parts else []


def _row(variant: str, figure: Figure) -> str:
    met = "met" if figure.passed else "**not met**"
    if figure.goal is not None:
        met += ", goal met" if figure.value <= figure.goal else ", goal not met"
    elif not figure.limit:
        met = ""
    value = str(figure).partition(": ")[2]
    return f"| {variant} | {figure.name} | {value} | {figure.limit} | {met} |"
