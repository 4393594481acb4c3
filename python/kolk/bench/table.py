"""The figures for people: one table, a column for each flow and precision."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from .measure import Bench, Figures

ROWS: tuple[tuple[str, Callable[[Figures], str]], ...] = (
    ("fluid particles", lambda f: f"{f.particles:,}"),
    ("neighbours", lambda f: f"{f.neighbours:.0f}"),
    ("M particle-steps/s", lambda f: f"{f.particle_steps.median / 1e6:.2f}"),
    ("  slowest window", lambda f: f"{f.particle_steps.low / 1e6:.2f}"),
    ("  fastest window", lambda f: f"{f.particle_steps.high / 1e6:.2f}"),
    ("M pairs/s, whole step", lambda f: f"{f.pairs / 1e6:.0f}"),
    ("M pairs/s, in sweeps", lambda f: f"{f.pairs_in_sweeps / 1e6:.0f}"),
    ("share of peak there", lambda f: f"{100.0 * f.share_of_peak:.1f} %"),
    ("bytes per particle", lambda f: f"{f.bytes_per_particle:.0f}"),
)


def show(bench: Bench, console: Console) -> None:
    """Print the table."""
    from rich import box
    from rich.table import Table

    peak = ", ".join(
        f"{bench.peak[p] / 1e9:,.0f} Gflop/s in {name}"
        for p, name in (("mixed", "f32"), ("f64", "f64"))
    )
    console.print(
        f"{bench.machine.get('processor')}, {bench.threads} threads, {bench.vector_unit}; "
        f"peak {peak}",
        highlight=False,
        soft_wrap=True,
    )
    table = Table(box=box.SIMPLE, padding=(0, 0, 0, 1))
    table.add_column("whole steps, settled flow", no_wrap=True)
    for f in bench.flows:
        kind, _, neighbours = f.flow.partition(", ")
        head = f"{kind} {neighbours.partition(' ')[0]}\n{f.precision}"
        table.add_column(head, justify="right", no_wrap=True)
    for name, value in ROWS:
        table.add_row(name, *(value(f) for f in bench.flows))
    table.add_section()
    table.add_row("ns per particle-step", *(f"{sum(f.phases.values()):.1f}" for f in bench.flows))
    for phase in dict.fromkeys(name for f in bench.flows for name in f.phases):
        cells = (f"{f.phases[phase]:.1f}" if phase in f.phases else "" for f in bench.flows)
        table.add_row(f"  {phase}", *cells)
    console.print(table)
    per_pair = {f.dimension: f.flops_per_pair for f in bench.flows}
    console.print(
        "Particles are the fluid's; a pair is a neighbour of a particle, counted once a step, at "
        + " and ".join(f"{n} flops in {d}D" for d, n in sorted(per_pair.items(), reverse=True))
        + f" (both sweeps). Measured in {bench.seconds:.0f} s.",
        highlight=False,
        soft_wrap=True,
    )
