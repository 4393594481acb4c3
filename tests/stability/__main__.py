"""`python -m tests.stability [CASE ...]`: runs hard cases, in short, and says how they went.

`--full` runs the full ones, keeps their results and writes `docs/stability.md`; `--page` writes the
page from the results that are there; `--list` names the cases. Exit status 1 where a limit is
missed.
"""

from __future__ import annotations

import argparse
import sys

from ..validation.__main__ import machine
from .report import PAGE, keep, page
from .suite import Result, get, names, timed
from .watching import THREADS


def say(name: str, result: Result) -> None:
    """Prints the figures of a result."""
    print(f"{name}  {result.variant}  {result.seconds:.1f} s, {result.steps:,} steps, "
          f"{result.retries} retries", flush=True)  # fmt: skip
    for figure in result.figures:
        print(f"    {figure}  {figure.limit}" + ("" if figure.passed else "  MISSED"))


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.stability", description=__doc__)
    parser.add_argument("case", nargs="*", help="cases to run; all if none is named")
    parser.add_argument("--full", action="store_true", help="the full versions, and the page")
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
        results = []
        for variant in case.full if chosen.full else case.short:
            results.append(timed(lambda case=case, variant=variant: case.run(variant)))
            say(name, results[-1])
        missed |= any(result.missed for result in results)
        without = timed(case.without) if case.without is not None else None
        if without is not None:
            print(f"  without {case.remedy}:")
            say(name, without)
            missed |= not without.missed
        if chosen.full:
            keep(name, results, without, f"{machine()}, threads: {THREADS}")
    if chosen.full or chosen.page:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(page(), encoding="utf-8")
        print(f"wrote {PAGE}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
