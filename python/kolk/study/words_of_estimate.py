"""An estimate in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kolk.progress import duration

from .words import percent

if TYPE_CHECKING:
    from .estimate import Estimate, Interval


def describe(found: Estimate) -> str:
    """Some lines of plain text."""
    fine = found.pilots[-1]
    parts = sorted(found.parts.items(), key=lambda part: -part[1])
    largest = ", ".join(f"{name} {duration(s)}" for name, s in parts if s > 0.02 * found.wall.value)
    exact = found.particles.low == found.particles.high
    lines = [
        f"{found.name} at a spacing of {found.spacing:.4g} m, {fine.threads} threads:",
        f"  particles  {found.particles.value:,.0f}" + ("" if exact else _range(found.particles)),
        f"  steps      {found.steps.value:,.0f}{_range(found.steps)}",
        f"  memory     {size(found.memory.value)} "
        f"({size(found.memory.low)} to {size(found.memory.high)})",
        f"  time       {duration(found.wall.value)} "
        f"({duration(found.wall.low)} to {duration(found.wall.high)}): {largest}",
    ]
    if found.error is not None:
        lines.append(
            f"  error      {percent(found.error.value)} "
            f"({percent(found.error.low)} to {percent(found.error.high)}), {found.error_of}"
        )
    else:
        lines.append("  error      unknown: no study of this scene; make one with  kolk accuracy")
    lines.append("Pictures and film come on top (--no-pictures leaves them out).")
    return "\n".join(lines)


def _range(interval: Interval) -> str:
    return f" ({interval.low:,.0f} to {interval.high:,.0f})"


def size(count: float) -> str:
    """Bytes as a reader says them."""
    return f"{count / 1e9:.2f} GB" if count >= 1e9 else f"{count / 1e6:.0f} MB"
