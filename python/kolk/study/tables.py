"""The tables of a study: runs, and the statistics of probes with their error bars."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from kolk.output.atomic import write_text

from .quantity import STATISTICS

if TYPE_CHECKING:
    from .study import Study

MEBI = 2.0**20


def table(study: Study) -> pd.DataFrame:
    """One row a run: settings, spacing (m), particles, steps, times (s), memory (MiB), errors."""
    front = set(study.front)
    rows: list[dict[str, Any]] = []
    for label, rungs in study.ladders.items():
        curve = study.curve(variant=label) if rungs.records else None
        errors = (
            {} if curve is None else dict(zip(curve.spacing.tolist(), curve.error, strict=True))
        )
        level = {} if curve is None else {h: i for i, h in enumerate(curve.spacing.tolist())}
        for record in (*rungs.records, *rungs.failed):
            costs = record.costs
            rows.append(
                {
                    "settings": label,
                    "spacing": record.spacing,
                    "particles": record.particles["total"],
                    "steps": record.steps,
                    "error": errors.get(record.spacing, math.nan),
                    "wall": costs.wall,
                    "cpu": costs.cpu,
                    "particle_steps_per_second": record.particle_steps / max(costs.stepping, 1e-9),
                    "memory": costs.peak_memory / MEBI,
                    "pareto": (label, level.get(record.spacing, -1)) in front,
                    "outcome": record.outcome,
                    "undisturbed": not record.disturbed,
                    **{f"error: {s.name}": s.error for s in record.scores},
                }
            )
    return pd.DataFrame(rows)


def bars(study: Study) -> pd.DataFrame:
    """Every probe of the scene as it is on every level: statistics with their error bars, and the
    record's error and bar (shares of the scale), order and verdict."""
    rows: list[dict[str, Any]] = []
    for q in study.base.quantities:
        order = q.expansion.free_order if q.expansion is not None else math.nan
        for level, spacing in enumerate(q.spacing):
            row: dict[str, Any] = {"probe": q.name, "unit": q.unit, "spacing": float(spacing)}
            for name in STATISTICS:
                row[name] = float(q.statistic(name)[level])
                row[f"{name} ±"] = q.statistic_bar(name, level)
            row |= {
                "record error": q.level_error(level),
                "record ±": q.level_bar(level),
                "order": order if q.verdict.sound else math.nan,
                "verdict": q.verdict.kind,
            }
            rows.append(row)
    return pd.DataFrame(rows)


def write_tables(study: Study) -> list[Path]:
    """Writes runs and bars as Markdown, CSV and JSON; returns the paths."""
    folder = study.folder
    runs, probes = table(study), bars(study)
    made = []
    for name, frame in (("runs", runs), ("probes", probes)):
        for suffix, text in (
            ("csv", frame.to_csv(index=False)),
            ("json", frame.to_json(orient="records", indent=1) + "\n"),
        ):
            write_text(folder / f"{name}.{suffix}", text, "write the tables of the study")
            made.append(folder / f"{name}.{suffix}")
    text = f"{runs_markdown(study)}\n{bars_markdown(study)}"
    write_text(folder / "tables.md", text, "write the tables of the study")
    return [*made, folder / "tables.md"]


def runs_markdown(study: Study) -> str:
    """The runs as a table in Markdown."""
    frame = table(study)
    if not len(frame):
        return ""
    lines = [
        "| settings | spacing, m | particles | steps | error | wall, s | CPU, s | "
        "particle-steps/s | memory, MiB | Pareto |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in frame.to_dict("records"):
        error = f"{100 * row['error']:.3g} %" if math.isfinite(row["error"]) else ""
        if row["outcome"] != "done":
            error = str(row["outcome"])
        mark = "" if row["undisturbed"] else " *"
        cells = [
            str(row["settings"]),
            f"{row['spacing']:.4g}",
            f"{row['particles']:,}",
            f"{row['steps']:,}",
            error,
            f"{row['wall']:.3g}{mark}",
            f"{row['cpu']:.3g}",
            f"{row['particle_steps_per_second'] / 1e6:.3g} M",
            f"{row['memory']:.0f}",
            "yes" if row["pareto"] else "",
        ]
        lines.append("| " + " | ".join(cells) + " |")
    if not frame["undisturbed"].all():
        lines.append("\n\\* with other programs, or other runs, beside it")
    return "\n".join(lines) + "\n"


def bars_markdown(study: Study) -> str:
    """The probes' statistics at the finest level with their error bars, in Markdown."""
    frame = bars(study)
    if not len(frame):
        return ""
    finest = frame[frame["spacing"] == frame["spacing"].min()]
    lines = [
        f"| probe, at {frame['spacing'].min():.4g} m | mean | largest | last tenth | "
        "whole record (RMS) | order |",
        "|---|---|---|---|---|---|",
    ]
    for row in finest.to_dict("records"):
        figures = [
            f"{row[name]:.4g}" + (f" ± {row[f'{name} ±']:.2g}" * math.isfinite(row[f"{name} ±"]))
            for name in STATISTICS
        ]
        share = row["record ±"]
        record = f"± {100 * share:.2g} %" if math.isfinite(share) else ""
        order = f"{row['order']:.2f}" if math.isfinite(row["order"]) else row["verdict"]
        cells = [f"{row['probe']}, {row['unit']}", *figures, record, order]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"
