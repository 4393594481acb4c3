"""`python -m tests.validation [CASE ...]`: runs cases in full and writes `docs/validation.md`.

`--short` runs the short versions instead and writes nothing; `--list` names the cases; `--page`
writes the page from the results that are there. Exit status 1 where a figure is beyond its bound.
"""

from __future__ import annotations

import argparse
import platform
import sys
from pathlib import Path

from .report import PAGE, keep, page
from .running import THREADS, run_level
from .suite import Case, Level, get, names


def machine() -> str:
    """The processor, as the results name it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.machine()


def run_case(name: str, case: Case, resolutions: tuple[int, ...]) -> list[Level]:
    """Runs a case and says each figure."""
    levels = []
    for resolution in resolutions:
        level = run_level(case, resolution)
        levels.append(level)
        print(f"{name}  {case.unit} = {resolution}  {level.seconds:.1f} s", flush=True)
        for figure in level.figures:
            limit = "" if figure.bound is None else f"  bound {figure.shown(figure.bound)}"
            goal = "" if figure.goal is None else f"  goal {figure.shown(figure.goal)}"
            missed = "" if figure.passed else "  BEYOND ITS BOUND"
            print(f"    {figure.name}: {figure.shown(figure.value)}{limit}{goal}{missed}")
    return levels


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.validation", description=__doc__)
    parser.add_argument("case", nargs="*", help="cases to run; all if none is named")
    parser.add_argument("--short", action="store_true", help="the short versions, nothing written")
    parser.add_argument("--page", action="store_true", help="only write the page")
    parser.add_argument("--list", action="store_true", help="name the cases")
    chosen = parser.parse_args()
    if unknown := set(chosen.case) - set(names()):
        parser.error(f"no case is called {', '.join(sorted(unknown))}; --list names them")
    if chosen.list:
        print("\n".join(names()))
        return 0
    missed = False
    for name in [] if chosen.page else chosen.case or names():
        case = get(name)
        levels = run_case(name, case, case.short if chosen.short else case.full)
        missed |= any(level.missed for level in levels)
        if not chosen.short:
            keep(name, case, levels, f"{machine()}, threads: {THREADS}")
    if not chosen.short:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(page(), encoding="utf-8")
        print(f"wrote {PAGE}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
