"""`python -m tests.accuracy.promises [bars|tolerance|budget|estimates ...]`: are promises kept?

- **bars**: the true error of every probe inside its stated bar, reference withheld;
- **tolerance**: `--tolerance` of 5, 2 and 1 % on four cases with exact solutions, with their
  reference and (`--blind`) with it withheld;
- **budget**: `--budget` on several scenes;
- **estimates**: particles, steps, memory and wall time of five scenes in 2D and 3D.

Wall times and budgets mean something on a quiet machine only.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time as clock
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import kolk
from kolk.study.estimate import estimate
from kolk.study.job import make_job
from kolk.study.promise import PromiseError, choose
from kolk.study.quantity import STATISTICS, quantities
from kolk.study.store import Store
from kolk.study.study import accuracy
from kolk.study.worker import tracks

from .trials import Trial, trials

TOLERANCES = (0.05, 0.02, 0.01)
BUDGETS = (
    ("taylor-green", 20.0),
    ("taylor-green", 60.0),
    ("poiseuille", 20.0),
    ("poiseuille", 60.0),
    ("still-water", 30.0),
    ("still-water", 90.0),
    ("dam-break", 30.0),
    ("dam-break", 90.0),
    ("dam-break-column", 60.0),
    ("dam-break-column", 120.0),
)
ESTIMATES = (
    ("taylor-green", 0.0125),
    ("still-water", 0.0125),
    ("poiseuille", 1.6e-5),
    ("dam-break", 0.005),
    ("dam-break-column", 0.015),
)


def row(*cells: object) -> None:
    """A row of a table in Markdown, at once."""
    print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def head(*cells: str) -> None:
    row(*cells)
    print("|" + "---|" * len(cells), flush=True)


def chosen_trials(cases: Sequence[str]) -> list[Trial]:
    """The trials of the cases named; all for none."""
    return [trial for trial in trials() if not cases or trial.case in cases]


def bars(threads: int, cases: Sequence[str]) -> None:
    """Counts the bars that hold, over cases, probes, levels and statistics."""
    head(
        "case",
        "probe",
        "record: held of levels",
        *STATISTICS,
        "finest: error",
        "its bar",
        "verdict",
    )
    held = total = 0
    for trial in chosen_trials(cases):
        study = accuracy(
            trial.blind, trial.ladder, threads=threads, out=f"studies/{trial.blind.name}"
        )
        for q in study.base.quantities:
            if q.name not in trial.exact:
                continue
            exact = trial.exact[q.name](q.time)
            levels = range(len(q.spacing))
            wrong = [float(np.sqrt(np.mean((q.value[i] - exact) ** 2))) / q.scale for i in levels]
            kept = [wrong[i] <= q.level_bar(i) for i in levels]
            cells = [f"{sum(kept)} of {len(kept)}"]
            held, total = held + sum(kept), total + len(kept)
            for name in STATISTICS:
                values = q.statistic(name)
                truth = float(_statistic(name, exact, q.value[-1]))
                right = [abs(values[i] - truth) <= q.statistic_bar(name, i) for i in levels]
                cells.append(f"{sum(right)} of {len(right)}")
                held, total = held + sum(right), total + len(right)
            row(
                trial.case,
                q.name,
                *cells,
                f"{wrong[-1]:.3%}",
                f"{q.level_bar(len(q.spacing) - 1):.3%}",
                q.verdict.kind,
            )
    print(f"\n{held} of {total} bars hold the truth: {held / total:.0%}\n", flush=True)


def _statistic(name: str, exact: np.ndarray, finest: np.ndarray) -> float:
    """A statistic of the exact record, as `Quantity.statistic` takes it."""
    if name == "mean":
        return float(exact.mean())
    if name == "largest":
        return float(exact[int(np.argmax(np.abs(finest)))])
    return float(exact[-max(1, round(0.1 * len(exact))) :].mean())


def tolerance(threads: int, cases: Sequence[str], *, blind: bool) -> None:
    """Runs what each tolerance leads to and sets the true error beside it."""
    head("case", "reference", "tolerance", "spacing", "promised", "true error", "")
    kept = made = refused = 0
    for trial in chosen_trials(cases):
        scene = trial.blind if blind else trial.known
        for wanted in TOLERANCES:
            told = "withheld" if blind else "known"
            try:
                found = choose(scene, tolerance=wanted, threads=threads, quiet=True)
            except PromiseError as error:
                refused += 1
                row(trial.case, told, f"{wanted:.0%}", "", "", "", f"refused: {error}")
                continue
            wrong = true_error(trial, found.scene, found.of, threads)
            made, kept = made + 1, kept + (wrong <= wanted)
            promised = math.nan if found.error is None else found.error
            row(
                trial.case,
                told,
                f"{wanted:.0%}",
                f"{found.scene.spacing:.4g}",
                f"{promised:.2%}",
                f"{wrong:.2%}",
                "kept" if wrong <= wanted else "NOT kept",
            )
    print(f"\n{kept} of {made} tolerances kept, {refused} refused\n", flush=True)


def true_error(trial: Trial, scene: kolk.Scene, of: str, threads: int) -> float:
    """The error of a run against the exact solution: the case's own, or the worst probe's."""
    from kolk.study.scores import scores

    with tempfile.TemporaryDirectory(prefix="kolk-trial-") as folder:
        run = kolk.run(scene, Path(folder) / "run", threads=threads, quiet=True, pictures=False)
        for score in scores(run):
            if score.name == of:
                return score.error

        class Shown:
            spacing = scene.spacing
            compression = 0.0

        Shown.tracks = tracks(run)  # type: ignore[attr-defined]
        errors = [
            float(np.sqrt(np.mean((q.value[0] - trial.exact[q.name](q.time)) ** 2))) / q.scale
            for q in quantities([Shown()])  # type: ignore[list-item]
            if q.name in trial.exact
        ]
    return max(errors)


def budget(threads: int, cases: Sequence[str]) -> None:
    """Runs what each budget leads to and sets the time used beside it."""
    head("scene", "budget", "spacing", "used", "share", "")
    kept = 0
    chosen = [(name, seconds) for name, seconds in BUDGETS if not cases or name in cases]
    for name, seconds in chosen:
        begun = clock.perf_counter()
        try:
            found = choose(kolk.load(name), budget=seconds, threads=threads, quiet=True)
        except PromiseError as error:
            row(name, f"{seconds:g} s", "", "", "", f"refused: {error}")
            continue
        with tempfile.TemporaryDirectory(prefix="kolk-trial-") as folder:
            kolk.run(found.scene, Path(folder) / "run", threads=threads, quiet=True, pictures=False)
        used = clock.perf_counter() - begun
        good = abs(used / seconds - 1.0) <= 0.15
        kept += good
        row(
            name,
            f"{seconds:g} s",
            f"{found.scene.spacing:.4g}",
            f"{used:.0f} s",
            f"{used / seconds:.0%}",
            "kept" if good else "NOT kept",
        )
    print(f"\n{kept} of {len(chosen)} budgets used within 15 %\n", flush=True)


def estimates(threads: int) -> None:
    """Estimates of five scenes and what became of them, as estimate over truth."""
    head("scene", "spacing", "particles", "steps", "memory", "wall", "wall inside its interval")
    store = Store()
    for name, spacing in ESTIMATES:
        scene = kolk.load(name).replace(spacing=spacing)
        found = estimate(scene, threads=threads)
        truth = store.measure(make_job(scene, None, threads))
        costs = truth.costs
        row(
            name,
            f"{spacing:g}",
            f"{found.particles.value / truth.particles['total'] - 1.0:+.1%}",
            f"{found.steps.value / truth.steps - 1.0:+.1%}",
            f"{found.memory.value / costs.peak_memory - 1.0:+.1%}",
            f"{found.wall.value / costs.wall - 1.0:+.1%} of {costs.wall:.1f} s",
            "yes" if found.wall.holds(costs.wall) else "no",
        )
    print(flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.accuracy.promises", description=__doc__)
    kinds = ("bars", "tolerance", "budget", "estimates")
    parser.add_argument("kind", nargs="*", help=f"{', '.join(kinds)}; all if none is named")
    parser.add_argument("--blind", action="store_true", help="tolerances without the reference")
    parser.add_argument("--case", action="append", default=[], help="only this case; repeatable")
    parser.add_argument("--threads", type=int, default=0, help="0: every core")
    chosen = parser.parse_args()
    if unknown := set(chosen.kind) - set(kinds):
        parser.error(f"nothing is called {', '.join(sorted(unknown))}: {', '.join(kinds)}")
    wanted = chosen.kind or kinds
    if "bars" in wanted:
        bars(chosen.threads, chosen.case)
    if "estimates" in wanted:
        estimates(chosen.threads)
    if "tolerance" in wanted:
        tolerance(chosen.threads, chosen.case, blind=chosen.blind)
    if "budget" in wanted:
        budget(chosen.threads, chosen.case)
    return 0


if __name__ == "__main__":
    sys.exit(main())
