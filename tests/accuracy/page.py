"""`docs/accuracy` from the results that the studies have left: pictures, tables, sentences."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from kolk.study.study import Study
from kolk.study.tables import runs_markdown
from kolk.study.words import saving

FOLDER = Path(__file__).parents[2] / "docs" / "accuracy"

HEAD = """# What accuracy costs

kolk's own choices, each tried against the default: what it buys in error and costs in time. Written
by `python -m tests.accuracy`, which runs the studies (`--full` runs finer ladders, `--page` writes
the page from what is there). Every study is what `kolk accuracy SCENE --vary KEY=A,B` does on any
scene.

- **time** and **error**: over those of the default at the same spacings (geometric means).
- **cost**: time for the same error over that of the default, by the power laws through both
  ladders: above 1 the default is the better choice. Missing where an error does not fall with the
  spacing, as the distance from an experiment does not.
- An error many times smaller that does not fall with the spacing is one where errors of opposite
  sign cancel: see what the same choice does in the other cases.

What follows for the defaults stands in [choices](../choices.md).
"""


def keep(study: Study, case: str) -> None:
    """Writes a study's picture and its figures into the folder."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    study.plot(FOLDER / f"{case}.png")
    first = study.base.records[0]
    data = {
        "case": case,
        "title": study.scene.title or case,
        "machine": first.machine,
        "threads": first.threads,
        "quantity": study.leading,
        "sentences": study.sentences,
        "table": runs_markdown(study),
        "choices": [_choice(study, v.label) for v in study.variants[1:]],
    }
    text = json.dumps(data, indent=1, ensure_ascii=False) + "\n"
    (FOLDER / f"{case}.json").write_text(text, encoding="utf-8")


def _choice(study: Study, label: str) -> dict[str, Any]:
    """Ratios of one alternative to the scene as it is; None where there is none."""
    rungs, base = study.ladders[label], study.base
    found: dict[str, Any] = {
        "label": _name(study, label),
        "time": None,
        "error": None,
        "cost": None,
    }
    if not rungs.records:
        found["failed"] = rungs.failed[0].outcome if rungs.failed else "failed"
        return found
    ours, theirs = study.curve(), study.curve(variant=label)
    common = [(a, b) for a in base.records for b in rungs.records if a.spacing == b.spacing]
    errors = dict(zip(ours.spacing.tolist(), ours.error.tolist(), strict=True))
    ratio = [
        e / errors[h]
        for h, e in zip(theirs.spacing.tolist(), theirs.error.tolist(), strict=True)
        if errors.get(h)
    ]
    found["time"] = _mean([b.costs.wall / a.costs.wall for a, b in common])
    found["error"] = _mean(ratio)
    gain = saving(base, rungs, ours, theirs) if ours.basis != "experiment" else math.nan
    found["cost"] = 1.0 / gain if math.isfinite(gain) else None
    return found


def _name(study: Study, label: str) -> str:
    """A label; a sound speed as a multiple of the automatic one, so that cases can be compared."""
    if ".sound_speed=" in label:
        return f"sound_speed × {float(label.partition('=')[2]) / study.scene.sound_speed:.2g}"
    return label


def _mean(ratios: Sequence[float]) -> float | None:
    known = [r for r in ratios if r > 0.0]
    return math.exp(sum(map(math.log, known)) / len(known)) if known else None


def results() -> list[dict[str, Any]]:
    """What the studies have left, in the order of their subjects."""
    from .choices import SUBJECTS

    paths = [FOLDER / f"{subject.case}.json" for subject in SUBJECTS]
    return [json.loads(p.read_text(encoding="utf-8")) for p in paths if p.is_file()]


def page() -> str:
    """The whole page."""
    found = results()
    parts = [HEAD, "![Cost of each choice for the same error](choices.png)\n", overview(found)]
    for data in found:
        parts.append(f"## {data['title']}\n")
        parts.append("\n".join(f"- {line}" for line in data["sentences"]) + "\n")
        parts.append(f"![{data['title']}]({data['case']}.png)\n")
        parts.append(data["table"])
        parts.append(f"Machine: {data['machine']}, threads: {data['threads']}.\n")
    return "\n".join(parts)


def overview(found: Sequence[dict[str, Any]]) -> str:
    """All choices against all cases: time × error, and the cost for the same error."""
    labels = list(dict.fromkeys(c["label"] for data in found for c in data["choices"]))
    lines = [
        "| choice | " + " | ".join(data["case"] for data in found) + " |",
        "|---|" + "---|" * len(found),
    ]
    for label in labels:
        cells = []
        for data in found:
            mine = [c for c in data["choices"] if c["label"] == label]
            cells.append("; ".join(_cell(c) for c in mine))
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _cell(choice: dict[str, Any]) -> str:
    if choice.get("failed"):
        return str(choice["failed"])
    text = f"time {choice['time']:.2f}, error {choice['error']:.2f}"
    return text + (f", **cost {choice['cost']:.2f}**" if choice["cost"] else "")


def draw() -> None:
    """`choices.png`: the cost of each choice for the same error, a mark for each case."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    from kolk.render import style

    found = results()
    choices = [choice for data in found for choice in data["choices"] if choice["cost"]]
    shown = list(dict.fromkeys(choice["label"] for choice in choices))
    if not shown:
        return
    with style.look():
        made = style.figure(8.0, 1.6 + 0.3 * max(len(shown), 3))
        made.set_layout_engine("constrained")
        axes = made.add_subplot()
        style.plot_axes(axes)
        for data, ink, mark in zip(
            found,
            (style.RUN, style.REFERENCE, style.SECOND, "#2a9d8f", "#c98b1b", "#6c757d"),
            "osD^vP",
            strict=False,
        ):
            points = [(c["cost"], shown.index(c["label"])) for c in data["choices"] if c["cost"]]
            if points:
                x, y = zip(*points, strict=True)
                axes.plot(x, y, mark, color=ink, ms=7, label=data["title"], alpha=0.85)
        axes.axvline(1.0, color=style.INK, lw=1.0)
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(FixedLocator([0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0]))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
        axes.set_yticks(range(len(shown)), shown)
        axes.invert_yaxis()
        axes.set_xlabel("time for the same error over that of the default (right: default better)")
        axes.set_title("What each choice costs for the same error")
        axes.legend(loc="best", fontsize=7.5)
        style.save(made, FOLDER / "choices.png")
