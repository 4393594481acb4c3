"""The tables that the comparison prints: figures of each code, and kolk's ratio to each peer."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median

from figures import Figures

Rows = dict[str, list[Figures]]
Column = tuple[str, Callable[[Figures], float | None], Callable[[float], str]]

COLUMNS: list[Column] = [
    ("M particle-steps/s", lambda f: f.particle_steps / 1e6, "{:.3f}".format),
    ("M evaluations/s", lambda f: f.evaluations / 1e6, "{:.3f}".format),
    ("M pairs/s", lambda f: f.pairs / 1e6, "{:.1f}".format),
    ("s/s", lambda f: f.physical, "{:.2e}".format),
    ("MiB", lambda f: f.memory / 2**20, "{:.0f}".format),
    ("error", lambda f: f.error, "{:.4f}".format),
]
COUNTS: list[Column] = [
    ("fluid", lambda f: f.fluid, "{:.0f}".format),
    ("wall", lambda f: f.wall, "{:.0f}".format),
    ("neighbours", lambda f: f.neighbours, "{:.1f}".format),
    ("steps", lambda f: f.steps, "{:.0f}".format),
]


def middle(rows: list[Figures], of: Callable[[Figures], float | None]) -> float | None:
    """Median of a figure over the rounds; None where a run has none."""
    values = [value for row in rows if (value := of(row)) is not None]
    return median(values) if values else None


def show(head: list[str], body: list[list[str]]) -> None:
    """A plain table: the first column to the left, the others to the right."""
    lines = [head, *body]
    widths = [max(len(line[i]) for line in lines) for i in range(len(head))]
    for line in lines:
        cells = [line[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(line[1:], widths[1:], strict=True)]
        print("  " + "  ".join(cells))


def print_figures(results: Rows) -> None:
    """One row for each code: medians over the rounds."""
    if not results:
        return
    columns = COUNTS + COLUMNS
    body = []
    for label, rows in results.items():
        cells = [label]
        for _, of, text in columns:
            value = middle(rows, of)
            cells.append("-" if value is None else text(value))
        body.append(cells)
    show(["", *(name for name, _, _ in columns)], body)


def is_peer(label: str) -> bool:
    return not label.startswith("kolk")


def print_ratios(results: Rows) -> None:
    """kolk over peer for each pair with the same kernel and support, taken round by round."""
    body = []
    for ours, our_rows in results.items():
        for theirs, their_rows in results.items():
            same_support = ("narrow" in ours) == theirs.startswith("SPlisHSPlasH")
            if is_peer(ours) or not is_peer(theirs) or not same_support:
                continue
            cells = [f"{ours} / {theirs}"]
            for _, of, _ in COLUMNS:
                cells.append(ratio(our_rows, their_rows, of))
            body.append(cells)
    if body:
        show(["ratio", *(name for name, _, _ in COLUMNS)], body)


def ratio(ours: list[Figures], theirs: list[Figures], of: Callable[[Figures], float | None]) -> str:
    """Median over the rounds of our figure over theirs."""
    quotients = []
    for mine, other in zip(ours, theirs, strict=False):
        upper, lower = of(mine), of(other)
        if upper is not None and lower:
            quotients.append(upper / lower)
    return f"{median(quotients):.2f}" if quotients else "-"
