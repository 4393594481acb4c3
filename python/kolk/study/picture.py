"""The picture of a study: error against time, logarithmic, with the Pareto front."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from kolk.render import style

from .curve import ALL_PROBES, Curve, Ladder
from .ladder import DEFAULT

if TYPE_CHECKING:
    from .study import Study

INKS = (
    style.RUN,
    style.REFERENCE,
    style.SECOND,
    "#2a9d8f",
    "#c98b1b",
    "#6c757d",
    "#9b5de5",
    "#005f73",
    "#bb3e03",
    "#588157",
    "#e07a9b",
    "#3d405b",
    "#94a61b",
)
MARKERS = "osD^vP<>Xhp*d"

CROWDED = 5
"""Ladders from which on their names stand beside the picture."""


def picture(study: Study, path: Path | None = None) -> Figure:
    """Error against wall time; beside it the discretisation error alone, where the leading error
    is the distance from an experiment."""
    names = [study.leading]
    scored = study.base.records[0].scores if study.base.records else ()
    if study.leading == ALL_PROBES and scored:
        names.append(scored[0].name)
    with style.look():
        wide = 2.4 if len(study.ladders) >= CROWDED else 0.0
        made = style.figure(7.0 * (1.0 if len(names) == 1 else 1.5) + wide, 4.8)
        made.set_layout_engine("constrained")
        for i, name in enumerate(names):
            axes = made.add_subplot(1, len(names), i + 1)
            _panel(axes, study, name, front=i == 0)
        made.suptitle(
            f"What accuracy costs: {study.scene.title or study.scene.name}",
            x=0.01,
            ha="left",
            fontweight="bold",
            fontsize=11,
        )
        if len(study.ladders) >= CROWDED:
            handles, labels = made.axes[0].get_legend_handles_labels()
            made.legend(handles, labels, loc="outside right upper", fontsize=7.5)
        if path is not None:
            style.save(made, path)
    return made


def _panel(axes: Axes, study: Study, name: str, *, front: bool) -> None:
    style.plot_axes(axes)
    for i, (label, rungs) in enumerate(study.ladders.items()):
        try:
            curve = rungs.curve(name)
        except KeyError:
            continue
        _draw(axes, curve, rungs, label, INKS[i % len(INKS)], MARKERS[i % len(MARKERS)], i == 0)
    if not any(np.any(np.isfinite(line.get_ydata())) for line in axes.lines):
        axes.text(0.5, 0.5, "one level has no error to show", ha="center", transform=axes.transAxes)
        return
    if front:
        _front(axes, study)
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis, unit in ((axes.xaxis, ""), (axes.yaxis, " %")):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda v, _, u=unit: f"{v:.3g}{u}"))
        axis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("wall time [s]")
    axes.set_ylabel("error")
    against = {
        "analytic": "exact solution",
        "experiment": "experiment",
        "extrapolation": "extrapolation",
    }[study.base.curve(name).basis]
    axes.set_title(f"{name}, against the {against}")
    axes.margins(0.14)
    if len(study.ladders) < CROWDED:
        axes.legend(loc="best", fontsize=7.5)


def _draw(
    axes: Axes, curve: Curve, rungs: Ladder, label: str, ink: str, marker: str, first: bool
) -> None:
    wall = {record.spacing: record.costs.wall for record in rungs.records}
    known = np.isfinite(curve.error) & (curve.error > 0.0)
    spacing, error = curve.spacing[known], 100.0 * curve.error[known]
    time = np.array([wall[float(h)] for h in spacing])
    order, low, high = curve.order
    told = label if label != DEFAULT else "the scene as it is"
    if curve.verdict.sound:
        half = 0.5 * (high - low)
        told += f", order {order:.2f}" + (f" ± {half:.2f}" if math.isfinite(half) else "")
    axes.plot(time, error, marker=marker, color=ink, ms=5, lw=1.3, label=told)
    if first:
        for t, e, h in zip(time, error, spacing, strict=True):
            axes.annotate(
                f"{h:.3g} m",
                (t, e),
                textcoords="offset points",
                xytext=(5, 5),
                fontsize=7.5,
                color=ink,
            )


def _front(axes: Axes, study: Study) -> None:
    points = []
    for label, i in study.front:
        curve = study.curve(variant=label)
        wall = {r.spacing: r.costs.wall for r in study.ladders[label].records}
        points.append((wall[float(curve.spacing[i])], 100.0 * float(curve.error[i])))
    if points:
        time, error = np.array(points).T
        axes.plot(
            time,
            error,
            ls="none",
            marker="o",
            ms=11,
            mfc="none",
            mec=style.INK,
            mew=0.9,
            label="Pareto front",
        )
