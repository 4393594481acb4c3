"""`docs/validation.md` from the results that the cases have left in their folders."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .suite import FOLDER, Case, Figure, Level, get, names, observed_order

PAGE = FOLDER.parents[1] / "docs" / "validation.md"

HEAD = """# Validation

What kolk computes, set beside exact solutions, experiments and fine runs of others. Written by
`python -m tests.validation`, which runs every case (`python -m tests.validation CASE ...` runs some
and keeps the others' figures). Every figure is an error: the smaller the better.

- **bound**: beyond it the test fails. The short versions run with `pytest`, the full ones with
  `pytest -m validation`.
- **goal**: what the project aims at, shown as met or not met; it fails no test.
- **order**: observed between the two finest resolutions, of the case's first figure.
- Times are seconds on one thread of the machine named with each case. Scenes run with kolk's
  defaults, in mixed precision unless a case says otherwise.
"""


def keep(name: str, case: Case, levels: Sequence[Level], machine: str) -> None:
    """Writes a case's figures and its picture into its folder."""
    folder = FOLDER / name
    data = {
        "machine": machine,
        "levels": [
            {
                "resolution": level.resolution,
                "particles": level.particles,
                "steps": level.steps,
                "seconds": round(level.seconds, 1),
                "figures": [
                    {"name": f.name, "value": f.value if math.isfinite(f.value) else None}
                    | {"bound": f.bound, "goal": f.goal, "unit": f.unit}
                    for f in level.figures
                ],
            }
            for level in levels
        ],
    }
    text = json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    (folder / "result.json").write_text(text, encoding="utf-8")
    draw(case, levels, folder / "picture.png")


def draw(case: Case, levels: Sequence[Level], path: Path) -> None:
    """The case's picture."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Canvas

    canvas = Canvas(figsize=(9.0, 4.5), dpi=90, layout="constrained")
    FigureCanvasAgg(canvas)
    case.draw(levels, canvas)
    canvas.savefig(path)


def read(name: str) -> tuple[str, list[Level]] | None:
    """Machine and levels that a case has left, or None."""
    path = FOLDER / name / "result.json"
    if not path.exists():
        return None
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    levels = [
        Level(
            resolution=level["resolution"],
            figures=tuple(
                Figure(**(f | {"value": math.nan if f["value"] is None else f["value"]}))
                for f in level["figures"]
            ),
            particles=level["particles"],
            steps=level["steps"],
            seconds=level["seconds"],
        )
        for level in data["levels"]
    ]
    return data["machine"], levels


def verdict(figure: Figure) -> str:
    """What a figure's limits say about it."""
    words = []
    if figure.bound is not None:
        words.append("passed" if figure.passed else "**beyond the bound**")
    if figure.goal is not None:
        words.append("goal met" if figure.within(figure.goal) else "goal not met")
    return ", ".join(words)


def page() -> str:
    """The whole page."""
    parts = [HEAD, summary()]
    for name in names():
        kept = read(name)
        if kept is not None:
            parts.append(section(name, get(name), *kept))
    return "\n".join(parts)


def summary() -> str:
    """One row a case, at its finest resolution."""
    rows = [
        "| case | finest | leading error | order | bounds | goals | time, s |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in names():
        case, kept = get(name), read(name)
        if kept is None:
            rows.append(f"| {case.title} | not run yet | | | | | |")
            continue
        levels = kept[1]
        finest = max(levels, key=lambda level: level.resolution)
        first = finest.figures[0]
        bounds = [f.passed for f in finest.figures if f.bound is not None]
        goals = [f.within(f.goal) for f in finest.figures if f.goal is not None]
        cells = [
            f"[{case.title}](#{anchor(case.title)})",
            f"{case.unit} = {finest.resolution}",
            f"{cell(first.name)}: {first.shown(first.value)}",
            order(levels),
            f"{sum(bounds)} of {len(bounds)} kept" if bounds else "",
            f"{sum(goals)} of {len(goals)} met" if goals else "",
            f"{finest.seconds:.0f}",
        ]
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def section(name: str, case: Case, machine: str, levels: Sequence[Level]) -> str:
    """One case: set-up, reference, picture, every figure at every resolution."""
    lines = [f"## {case.title}", "", f"{case.setup}", "", f"Reference: {case.reference}", ""]
    if case.remarks:
        lines += [case.remarks, ""]
    lines += [f"![{case.title}](../tests/validation/{name}/picture.png)", ""]
    heads = [f"{case.unit} = {level.resolution}" for level in levels]
    lines.append("| figure | " + " | ".join(heads) + " | bound | goal | verdict at the finest |")
    lines.append("|---|" + "---|" * (len(heads) + 3))
    finest = max(levels, key=lambda level: level.resolution)
    for row, figure in enumerate(finest.figures):
        values = [level.figures[row].shown(level.figures[row].value) for level in levels]
        limits = [figure.shown(figure.bound), figure.shown(figure.goal), verdict(figure)]
        lines.append("| " + " | ".join([cell(figure.name), *values, *limits]) + " |")
    for label, values in (
        ("particles", [f"{level.particles:,}" for level in levels]),
        ("steps", [f"{level.steps:,}" for level in levels]),
        ("time, s", [f"{level.seconds:.1f}" for level in levels]),
    ):
        lines.append(f"| {label} | " + " | ".join(values) + " | | | |")
    observed = order(levels)
    lines += ["", f"Observed order: {observed}. " * bool(observed) + f"Machine: {machine}.", ""]
    return "\n".join(lines)


def cell(text: str) -> str:
    """``text`` for a cell of a table, where a bar would end it."""
    return text.replace("|", "\\|")


def order(levels: Sequence[Level]) -> str:
    """The observed order in words; empty where there is none."""
    value = observed_order(levels)
    return f"{value:.1f}" if math.isfinite(value) else ""


def anchor(title: str) -> str:
    """The link target that a heading gets on the usual hosts of Markdown."""
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -")
    return kept.replace(" ", "-")
