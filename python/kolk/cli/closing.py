"""The last words of a run on the terminal, from its summary."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kolk.progress import duration

if TYPE_CHECKING:
    from kolk.results import Run


def closing(run: Run) -> str:
    """Outcome, comparison with the reference, time by phase, where the files are."""
    summary = run.summary
    parts = [outcome(summary)]
    if summary["references"]:
        parts.append(
            "Against the reference:\n" + _list(r["sentence"] for r in summary["references"])
        )
    parts.append(phases(summary["seconds"]))
    if any(choice["automatic"] for choice in summary["choices"]):
        parts.append(chosen(summary))
    parts.append(_files(run))
    if summary["notes"]:
        parts.append("Notes:\n" + _list(summary["notes"]))
    return "\n\n".join(parts)


def outcome(summary: dict[str, Any]) -> str:
    """How far the run came, and at what speed."""
    scene, steps, seconds = summary["scene"], summary["steps"], summary["seconds"]["total"]
    lines = [
        f"{scene['title'] or scene['name']}: {summary['outcome']} at t = "
        f"{summary['time']['reached']:g} s",
        f"{summary['particles']['total']:,} particles, {steps['total']:,} steps in "
        f"{duration(seconds)}; {summary['particle_steps_per_second'] / 1e6:.2f} million "
        f"particle-steps/s in the engine ({scene['precision']}, {scene['threads']} threads)",
    ]
    lines.append(stability_line(summary))
    stability = summary["stability"]
    if stability["mach_left_range"]:
        lines.append(
            f"Warning: the Mach number reached {stability['mach']:.2f}; the fluid was compressed "
            "more than this method is made for. Raise sound_speed, or numerics.expected_speed."
        )
    return "\n".join(lines)


def stability_line(summary: dict[str, Any]) -> str:
    """The stability report in one line."""
    report, particles = summary["stability"], summary["particles"]["fluid"]
    rest = summary["scene"].get("density")

    def number(count: int, one: str, many: str) -> str:
        return f"no {many}" if not count else f"{count:,} {one if count == 1 else many}"

    low, high = report["density_min"], report["density_max"]
    density = f"density {low / rest:.3f} to {high / rest:.3f} ρ0" if rest else ""
    parts = [
        number(report["leaks"], "leak", "leaks"),
        f"closest pair {report['closest_pair']:.2f} Δp"
        + (f" ({100 * report['crowded'] / particles:.2g} % crowded)" if report["crowded"] else ""),
        number(report["voids"], "void", "voids"),
        density,
        f"Mach {report['mach']:.2f}",
        f"energy grew by at most {100 * report['energy_growth']:.2g} %",
        number(report["retries"], "retry", "retries"),
    ]
    return "Stability: " + ", ".join(part for part in parts if part)


def phases(seconds: dict[str, Any]) -> str:
    """A table of the time by phase, the largest first."""
    total = max(float(seconds["total"]), 1e-9)
    spent = {name: float(entry["seconds"]) for name, entry in seconds["phases"].items()}
    spent["other"] = max(total - sum(spent.values()), 0.0)
    rows = sorted(spent.items(), key=lambda row: -row[1])
    lines = [
        f"  {name:<14}{time:>9.2f} s {100.0 * time / total:>6.1f} %"
        for name, time in rows
        if time >= 0.0005 * total
    ]
    return "\n".join(["Time by phase:", *lines, f"  {'total':<14}{total:>9.2f} s  100.0 %"])


def chosen(summary: dict[str, Any]) -> str:
    """What the scene left to kolk, and why kolk chose as it did."""
    made = [
        f"{choice['key']} = {_value(choice['value'])}: {choice['reason']}"
        for choice in summary["choices"]
        if choice["automatic"]
    ]
    return "Chosen by kolk:\n" + _list(made)


def _value(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value).lower()


def _files(run: Run) -> str:
    lines = [f"Results: {run.folder}  (ParaView: {run.files.fields.name})"]
    if run.pictures:
        lines.append("Pictures:\n" + _list(run.pictures))
    return "\n".join(lines)


def _list(items: Any) -> str:
    return "\n".join(f"  {item}" for item in items)
