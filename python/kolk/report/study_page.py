"""The report of a study."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from kolk.render import style
from kolk.study.quantity import STATISTICS, Quantity

from .page import download, drawn, escape, folded, items, page, table

if TYPE_CHECKING:
    from kolk.study.study import Study


def study_page(study: Study) -> str:
    """The whole file."""
    title = f"What accuracy costs: {study.scene.title or study.scene.name}"
    runs = sum(map(len, study.records.values()))
    lead = f"{runs} runs, {len(study.variants)} sets of settings"
    return page(
        title,
        escape(lead),
        [
            ("What it shows", items(study.sentences)),
            ("Error against time", drawn(study.plot()) if study.base.records else ""),
            ("Runs", _runs(study)),
            ("Probes with their error bars", _bars(study)),
            ("Records at all levels", _records(study)),
            ("How errors are told", METHOD),
            ("Settings", _settings(study)),
            ("Machine", table(("", ""), _machine(study), 0)),
            ("How to reproduce it", _reproduce(study)),
        ],
    )


METHOD = """<p>Against an exact solution the error is the norm named, and its order the slope of
log(error) over log(spacing) with Student's interval. Without one, a power series in the spacing is
fitted to all levels (E&ccedil;a and Hoekstra 2014, J. Comput. Phys. 262, 104&ndash;130); the error
bar is the grid convergence index of Roache (1994), 1.25 times the error that the fit leaves where
the order is that of the scheme and 3 times it elsewhere, plus the scatter about the fit, plus twice
the compression of the fluid, the error of weak compressibility that no spacing removes. Where the
levels show no convergence, no order is stated.</p>"""


def _runs(study: Study) -> str:
    rows = []
    for row in study.table.to_dict("records"):
        error = f"{100.0 * row['error']:.3g} %" if math.isfinite(row["error"]) else ""
        rows.append(
            (
                row["settings"],
                f"{row['spacing']:.4g}",
                f"{row['particles']:,}",
                f"{row['steps']:,}",
                error if row["outcome"] == "done" else row["outcome"],
                f"{row['wall']:.3g}" + "" if row["undisturbed"] else f"{row['wall']:.3g} *",
                f"{row['cpu']:.3g}",
                f"{row['memory']:.0f}",
                "yes" if row["pareto"] else "",
            )
        )
    heads = (
        "settings",
        "spacing, m",
        "particles",
        "steps",
        "error",
        "wall, s",
        "CPU, s",
        "memory, MiB",
        "Pareto front",
    )
    return table(heads, rows)


def _bars(study: Study) -> str:
    rows: list[tuple[Any, ...]] = []
    for row in study.bars.to_dict("records"):
        figures = [
            f"{row[name]:.4g}" + f" ± {row[f'{name} ±']:.2g}" * math.isfinite(row[f"{name} ±"])
            for name in STATISTICS
        ]
        share = row["record ±"]
        order = f"{row['order']:.2f}" if math.isfinite(row["order"]) else row["verdict"]
        record = f"± {100.0 * share:.2g} %" if math.isfinite(share) else ""
        rows.append((f"{row['probe']}, {row['unit']}", f"{row['spacing']:.4g}", *figures, record))
        rows[-1] = (*rows[-1], order)
    heads = ("probe", "spacing, m", "mean", "largest", "last tenth", "record (RMS)", "order")
    return table(heads, rows)


def _records(study: Study) -> str:
    found = [_record(quantity) for quantity in study.base.quantities if quantity.time.size > 2]
    return f'<div class="grid">{"".join(found)}</div>' if found else ""


def _record(quantity: Quantity) -> str:
    """All levels of a quantity over time, the extrapolation, and the bar of the finest."""
    with style.look():
        made = style.figure(5.6, 3.2)
        made.set_layout_engine("constrained")
        axes = made.add_subplot()
        style.plot_axes(axes)
        levels = len(quantity.spacing)
        for i, spacing in enumerate(quantity.spacing):
            ink = style.RUN if i == levels - 1 else style.QUIET
            strength = 1.0 if i == levels - 1 else 0.25 + 0.5 * i / levels
            label = f"{spacing:.3g} m"
            axes.plot(quantity.time, quantity.value[i], color=ink, alpha=strength, label=label)
        if quantity.expansion is not None:
            half = quantity.expansion.level_bar(levels - 1) + quantity.floor * quantity.scale
            finest = quantity.value[-1]
            axes.fill_between(
                quantity.time,
                finest - half,
                finest + half,
                color=style.RUN,
                alpha=0.18,
                lw=0,
                label="error bar",
            )
            if quantity.verdict.sound:
                axes.plot(
                    quantity.time,
                    quantity.expansion.limit,
                    color=style.REFERENCE,
                    lw=1.0,
                    ls="--",
                    label="extrapolated",
                )
            low, high = float(quantity.value.min()), float(quantity.value.max())
            room = 0.3 * (high - low) or 1.0
            axes.set_ylim(low - room, high + room)
        axes.set_title(quantity.name)
        axes.set_xlabel("t [s]")
        axes.set_ylabel(f"{quantity.kind} [{quantity.unit}]")
        axes.legend(fontsize=7.0, loc="best")
        return drawn(made)


def _settings(study: Study) -> str:
    text = (study.folder / "scene.toml").read_text(encoding="utf-8")
    return folded("The complete scene, defaults written out", f"<pre>{escape(text)}</pre>")


def _machine(study: Study) -> list[tuple[str, Any]]:
    records = [r for runs in study.records.values() for r in runs]
    first = records[0]
    return [
        ("processor", first.machine),
        ("threads", ", ".join(sorted({str(r.threads) for r in records}))),
        ("kolk", first.version),
        ("runs measured alone", f"{sum(r.alone for r in records)} of {len(records)}"),
        ("of them undisturbed", str(sum(not r.disturbed for r in records))),
    ]


def _reproduce(study: Study) -> str:
    text = (study.folder / "scene.toml").read_text(encoding="utf-8")
    spacings = ",".join(f"{r.spacing:.17g}" for r in study.base.records)
    version = f"=={study.base.records[0].version}" if study.base.records else ""
    changes = [v.changes for v in study.variants[1:]]
    vary = "".join(f" --vary {key}={value}" for change in changes for key, value in change.items())
    return (
        f"<p>Save {download('scene.toml', text)}, then</p>"
        f"<pre>pip install kolk{escape(version)}"
        f"\nkolk accuracy scene.toml --spacings {escape(spacings)}{escape(vary)}</pre>"
    )
