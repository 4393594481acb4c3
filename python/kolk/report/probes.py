"""The probes of a run as curves: beside their references, with the error bars of a study."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from kolk.compare import common_shift, records
from kolk.compare.front import ALIGNED_AT, align_front
from kolk.render import curves, style

from .page import drawn

if TYPE_CHECKING:
    from kolk.cases import Comparison
    from kolk.results import Run
    from kolk.study.quantity import Quantity
    from kolk.study.study import Study


def probe_curves(run: Run, study: Study | None) -> str:
    """One picture a probe."""
    asked = records.comparisons(run)
    shift = common_shift(run, asked)
    known = {q.name: q for q in study.base.quantities} if study is not None else {}
    found = []
    for name in run.probes:
        table = run.probes[name]
        if len(table) < 2:
            continue
        about = run.probes.about.get(name, {})
        matches = [c for c in asked if c.probe == name and c.kind != "analytic"]
        match = matches[0] if matches else None
        label = f"{about.get('quantity', name)} [{about.get('unit', '')}]"
        with style.look():
            made = style.figure(5.6, 3.2)
            made.set_layout_engine("constrained")
            axes = made.add_subplot()
            bars = [q for key, q in known.items() if key.split(".")[0] == name]
            drawn_bars = [
                _bar(axes, run, quantity, match, shift)
                for quantity in bars
                if match is None or quantity.name.split(".")[-1] in _columns(match, name)
            ]
            curves.draw(axes, table, match, label, shift, 7.0, matches[1:])
            axes.set_title(name)
            told = (
                "band: error bar of the discretisation, by the study of the scene"
                if any(drawn_bars)
                else ""
            )
            found.append(drawn(made, told))
    return f'<div class="grid">{"".join(found)}</div>' if found else ""


def _columns(match: Comparison, name: str) -> tuple[str, ...]:
    """The last part of the names of the quantities that a comparison shows."""
    column = records.probe_column(match)
    return (name,) if column == "value" else (column,)


def _bar(axes: Axes, run: Run, quantity: Quantity, match: Comparison | None, shift: float) -> bool:
    """The band of a quantity's error bar around the run's curve, in the units of the axes."""
    expansion = quantity.expansion
    spacing = float(run.scene.spacing)
    near = 0.45 * quantity.spacing[-1] <= spacing <= 1.05 * quantity.spacing[0]
    if expansion is None or not near:
        return False
    name, _, column = quantity.name.partition(".")
    table = run.probes[name]
    time = table["time"].to_numpy(np.float64)
    value = table[column or "value"].to_numpy(np.float64)
    half = np.interp(time, quantity.time, expansion.bar(spacing))
    half += quantity.floor * quantity.scale
    scale_time = scale_value = 1.0
    origin = moved = 0.0
    if match is not None:
        reference = records.reference_of(match)
        scale_time, scale_value = match.scale_time, match.scale_value
        if match.kind == "front":
            origin = match.parameters.get("origin", 0.0)
            level = match.parameters.get("align", ALIGNED_AT)
            found = align_front(time, value - origin, reference, scale_time, scale_value, level)
            moved = found.shift if math.isfinite(found.shift) else 0.0
        else:
            moved = shift if reference.kind == "experiment" else 0.0
            if reference.units[records.reference_column(match)] == "Pa":
                scale_value *= 1000.0
    axes.fill_between(
        time / scale_time + moved,
        (value - origin - half) / scale_value,
        (value - origin + half) / scale_value,
        color=style.RUN,
        alpha=0.18,
        lw=0,
        label="error bar",
    )
    return True
