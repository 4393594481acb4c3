"""An explanation for people: tables on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from .report import EffectReport, Explanation


def show(found: Explanation, console: Console) -> None:
    """Print the explanation."""
    from rich import box
    from rich.table import Table

    def line(text: str) -> None:
        console.print(text, highlight=False, markup=False, soft_wrap=True)

    counts = ", ".join(f"{n:,} {kind}" for kind, n in found.particles.items() if n)
    line(f"{found.scene}: {counts} particles, {found.precision}")
    pilot = found.pilot
    if pilot is not None:
        line(
            f"measured on a pilot of {pilot.particles:,} fluid particles at a spacing of "
            f"{pilot.spacing:.4g} m, {pilot.steps} steps of each variant; time step "
            f"{found.time_step:.3g} s, set by the {found.limit} limit"
        )
    table = Table(box=box.SIMPLE, padding=(0, 0, 0, 1))
    table.add_column("effect", overflow="fold", min_width=16)
    numbers = ["bytes", "sweeps", "limit"]
    if pilot is not None:
        numbers += ["ns", "noise", "share"]
    for name in numbers:
        table.add_column(name, justify="right", no_wrap=True)
    for effect in found.effects:
        if effect.on:
            cells = [
                effect.name,
                str(effect.bytes_per_particle or ""),
                str(effect.sweeps or ""),
                effect.limit or "",
            ]
            table.add_row(*cells, *(_cost(effect) if pilot is not None else []))
    if pilot is not None:
        table.add_section()
        parts = pilot.sum_over_whole * pilot.whole.value
        table.add_row(
            "sum of the parts",
            *[""] * 3,
            _figure(parts),
            "",
            f"{100.0 * pilot.sum_over_whole:.1f} %",
        )
        table.add_row(
            "whole step",
            f"{pilot.bytes_per_particle:.0f}",
            "",
            "",
            _figure(pilot.whole.value),
            f"{pilot.whole.low:.0f} .. {pilot.whole.high:.0f}",
            "100.0 %",
        )
    console.print(table)
    line("bytes per particle, sweeps and time-step limits that an effect alone needs")
    if pilot is not None:
        line("ns of one processor per particle-step (fluid particles)")
    line("On:")
    for effect in found.effects:
        if effect.on:
            line(f"  {effect.name}: {effect.why}")
            line(f"    {effect.what}; {effect.where}")
    line("Off:")
    for effect in found.effects:
        if not effect.on:
            line(f"  {effect.name}: {effect.why}")
    integrator = next(c for c in found.choices if c.key == "numerics.integrator")
    line(f"Integrated in time by: {integrator.value}")
    line("Chosen by kolk:")
    for choice in found.choices:
        if choice.automatic:
            line(f"  {choice}")
    if found.suggestions:
        line("Advice:")
        for suggestion in found.suggestions:
            line(f"  {suggestion.advice.effect}: {suggestion.advice.text}")
            figure = f" ({suggestion.figure})" if suggestion.figure else ""
            line(f"    {suggestion.advice.setting}{figure}")
    else:
        line("Advice: none; nothing is missing, nothing is idle")
    if pilot is not None:
        for name, why in pilot.unmeasured.items():
            line(f"Not measured: the pilot does not run without {name}: {why}")


def _figure(nanoseconds: float) -> str:
    return f"{nanoseconds:.1f}" if nanoseconds < 1000.0 else f"{nanoseconds:.0f}"


def _cost(effect: EffectReport) -> list[str]:
    cost = effect.cost
    if cost is None:
        return ["in pressure", "", ""] if effect.name == "contact" else ["", "", ""]
    interval = cost.nanoseconds
    return [
        _figure(interval.value),
        f"{interval.low:.0f} .. {interval.high:.0f}",
        f"{100.0 * cost.share:.1f} %",
    ]
