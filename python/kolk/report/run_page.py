"""The report of a run."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from kolk.errors import KolkError
from kolk.progress import duration

from .page import Raw, bar, download, escape, folded, items, page, picture, table
from .probes import probe_curves

if TYPE_CHECKING:
    from kolk.results import Run
    from kolk.study.study import Study


def run_page(run: Run, effects: float = 0.0) -> str:
    """The whole file. A run without a summary (killed) gets what there is.

    effects: seconds to measure on this machine what each effect costs; 0 for not.
    """
    scene, summary = run.scene, run.summary
    study = _study(run)
    title = str(scene.title or scene.name)
    return page(
        title,
        _lead(run),
        [
            ("Outcome", _outcome(run)),
            ("Against the reference", _references(summary)),
            ("Pictures", "".join(picture(path) for path in _shown(run))),
            ("Probes", probe_curves(run, study) + _bars(run, study)),
            ("Costs by phase", _phases(summary)),
            ("Costs by effect" if effects else "Effects", _effects(run, effects)),
            ("Stability and energy", _stability(summary)),
            ("Settings", _settings(run)),
            ("Machine and versions", _machine(summary)),
            ("How to reproduce it", _reproduce(run)),
        ],
    )


def _study(run: Run) -> Study | None:
    """The study of the run's scene, if there is one where studies go."""
    from kolk.study.known import study_of

    try:
        return study_of(run.scene)
    except KolkError:
        return None


def _lead(run: Run) -> str:
    summary = run.summary
    if not summary:
        return "This run was ended before it could write its summary."
    steps, counts = summary["steps"]["total"], summary["particles"]["total"]
    return escape(
        f"{counts:,} particles, {steps:,} steps, {duration(summary['seconds']['total'])}, "
        f"spacing {run.scene.spacing:.4g} m, {summary['scene']['precision']}, "
        f"{summary['scene']['threads']} threads, kolk {summary['kolk']}"
    )


def _outcome(run: Run) -> str:
    summary = run.summary
    if not summary:
        return '<p class="bad">unfinished</p>'
    mark = "" if run.outcome == "done" else ' class="bad"'
    text = (
        f"<p{mark}>{escape(run.outcome)} at t = {summary['time']['reached']:g} of "
        f"{summary['time']['until']:g} s"
    )
    text += f": {escape(summary['reason'])}</p>" if summary.get("reason") else "</p>"
    lines = list(summary.get("notes", []))
    promise = run.folder / "promise.json"
    # One older than the scene is of a run that was there before.
    if promise.is_file() and promise.stat().st_mtime >= run.files.scene.stat().st_mtime:
        try:
            kept = json.loads(promise.read_text(encoding="utf-8"))
            lines = [*kept["promise"], *kept["outcome"], *lines]
        except (ValueError, KeyError):
            lines.append(f"{promise.name} cannot be read")
    return text + items(lines)


def _references(summary: dict[str, Any]) -> str:
    return items(r["sentence"] for r in summary.get("references", []))


def _shown(run: Run) -> list[Any]:
    """Pictures and one film; those of single probes are drawn anew with their error bars."""
    films = [p for p in run.pictures if p.suffix in (".mp4", ".gif")]
    stills = [p for p in run.pictures if p.suffix == ".png" and not p.name.startswith("probe-")]
    return [*stills, *films[:1]]


def _bars(run: Run, study: Study | None) -> str:
    """The error bars that a study gives the probes at the run's spacing."""
    if study is None:
        return ""
    spacing = float(run.scene.spacing)
    rows = []
    for q in study.base.quantities:
        share = q.bar_at(spacing)
        if math.isfinite(share):
            expansion = q.expansion
            assert expansion is not None
            order = f"{expansion.free_order:.2f}" if q.verdict.sound else q.verdict.kind
            rows.append((q.name, f"± {share * q.scale:.3g} {q.unit}", f"{share:.2%}", order))
    heads = ("probe", "error bar (RMS over the record)", "of its largest value", "order")
    made = table(heads, rows)
    told = f"By the study in {escape(study.folder)}, {len(study.base.records)} levels."
    return f"<p>{told}</p>{made}" if made else ""


def _phases(summary: dict[str, Any]) -> str:
    if not summary:
        return ""
    total = max(float(summary["seconds"]["total"]), 1e-9)
    spent = {k: float(v["seconds"]) for k, v in summary["seconds"]["phases"].items()}
    spent["other"] = max(total - sum(spent.values()), 0.0)
    rows = [
        (name, f"{seconds:.2f} s", f"{seconds / total:.1%}", bar(seconds / total))
        for name, seconds in sorted(spent.items(), key=lambda item: -item[1])
        if seconds >= 5e-4 * total
    ]
    speed = float(summary["particle_steps_per_second"]) / 1e6
    memory = sum(summary["memory"].values()) / 2**20
    return (
        table(("phase", "time", "share", ""), rows, 2)
        + f"<p>{speed:.2f} million particle-steps/s in the engine, which held {memory:.1f} MiB.</p>"
    )


def _effects(run: Run, seconds: float) -> str:
    """What each effect that is on costs, measured now; what the run knows of them otherwise."""
    summary = run.summary
    if not (seconds and summary):
        return _carried(summary)
    from kolk.explain import explain

    try:
        found = explain(run.scene, precision=summary["scene"]["precision"], seconds=seconds)
    except KolkError as error:
        return _carried(summary) + f"<p>What they cost could not be measured: {escape(error)}</p>"
    rows = []
    for effect in found.effects:
        if not effect.on:
            continue
        cost = effect.cost
        told: tuple[object, ...] = ("", "", "")
        if cost is not None:
            within = f"{cost.nanoseconds.value:.0f} ({cost.nanoseconds.low:.0f} to "
            told = (f"{within}{cost.nanoseconds.high:.0f})", f"{cost.share:.1%}", bar(cost.share))
        rows.append((effect.name, *told, effect.why, effect.source))
    heads = ("effect", "ns a particle-step", "share", "", "why it is on", "source")
    told_how = (
        "Measured for this report by short runs with and without each effect, on one thread; "
        "figures of a processor that does nothing else."
    )
    return table(heads, rows, 2) + f"<p>{told_how}</p>"


def _carried(summary: dict[str, Any]) -> str:
    rows = [
        (
            effect["name"],
            "on" if effect["on"] else "off",
            ", ".join(effect["columns"]) or "none",
            effect["bytes_per_particle"],
            effect["dt_limit"] or "",
        )
        for effect in summary.get("effects", [])
    ]
    heads = ("effect", "", "columns of its own", "bytes a particle", "limit of the time step")
    made = table(heads, rows, 0)
    told = "Effects between particles share the sweeps of forces and continuity above."
    return f"{made}<p>{told}</p>" if made else ""


def _stability(summary: dict[str, Any]) -> str:
    if not summary:
        return ""
    rows = [(k.replace("_", " "), _figure(v)) for k, v in summary["stability"].items()]
    budget = summary["energy"]
    energy: list[tuple[str, str]] = []
    for when in ("initial", "final"):
        energy += [(f"{k}, {when}", _figure(v)) for k, v in budget[when].items()]
    energy += [(f"dissipated by {k}", _figure(v)) for k, v in budget["dissipated"].items() if v]
    energy.append(("unaccounted", _figure(budget["unaccounted"])))
    limits = [(f"steps set by {k}", f"{v:,}") for k, v in summary["steps"]["by_limit"].items() if v]
    return (
        '<div class="grid"><div>'
        + table(("over the run", ""), [*rows, *limits])
        + "</div><div>"
        + table(("energy, J", ""), energy)
        + "</div></div>"
    )


def _figure(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "unknown"}[value]
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def _settings(run: Run) -> str:
    text = run.files.scene.read_text(encoding="utf-8")
    return folded("The complete scene, defaults written out", f"<pre>{escape(text)}</pre>")


def _machine(summary: dict[str, Any]) -> str:
    if not summary:
        return ""
    about = dict(summary["machine"])
    if about.get("memory"):
        about["memory"] = f"{about['memory'] / 2**30:.1f} GiB"
    rows = [*about.items(), *summary["versions"].items()]
    return table(("", ""), rows, 0)


def _reproduce(run: Run) -> str:
    text = run.files.scene.read_text(encoding="utf-8")
    own = sorted(path.name for path in run.folder.glob("*.npz"))
    beside = f", and {', '.join(own)} from the run's folder beside it" if own else ""
    summary = run.summary
    options = ""
    if summary:
        scene = summary["scene"]
        options = f" --precision {scene['precision']} --threads {scene['threads']}"
    version = f"=={summary['kolk']}" if summary else ""
    return (
        f"<p>Save {Raw(download('scene.toml', text))}{escape(beside)}, then</p>"
        f"<pre>pip install kolk{escape(version)}\nkolk run scene.toml{escape(options)}</pre>"
        "<p>The same version gives the same bits for any number of threads on processors with the "
        "same vector unit.</p>"
    )
