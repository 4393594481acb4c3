"""`python -m tests.stability [CASE ...]`: runs hard cases, in short, and says how they went.

`--full` runs the full ones that have no result of this engine yet (`--again`: all), keeps each
result when it is there and writes `docs/stability.md`; a long run that is cut goes on from where it
was. `--page` writes the page from the results that are there; `--list` names the cases; `--variant`
runs only variants with such a word. Exit status 1 where a limit is missed.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from dataclasses import replace

from ..validation.__main__ import machine
from .report import PAGE, WITHOUT, keep, kept, page
from .suite import FOLDER, Result, get, names, timed
from .watching import THREADS, keep_states


def engine() -> str:
    """The last commit that changed the engine or what resolves its numbers."""
    parts = ["src", "Cargo.toml", "Cargo.lock", "python/kolk/scene", "python/kolk/simulation.py"]
    words = ["git", "log", "-1", "--format=%h", "--abbrev=8", "--", *parts]
    root = FOLDER.parents[1]
    return subprocess.run(words, cwd=root, capture_output=True, text=True).stdout.strip()


def say(name: str, result: Result) -> None:
    """Prints the figures of a result."""
    print(f"{name}  {result.variant}  {result.seconds:.1f} s, {result.steps:,} steps, "
          f"{result.retries} retries", flush=True)  # fmt: skip
    for figure in result.figures:
        print(f"    {figure}  {figure.limit}" + ("" if figure.passed else "  MISSED"))
    if result.stopped:
        print(f"    stopped: {result.stopped}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.stability", description=__doc__)
    parser.add_argument("case", nargs="*", help="cases to run; all if none is named")
    parser.add_argument("--full", action="store_true", help="the full versions, and the page")
    parser.add_argument("--again", action="store_true", help="also what has a result already")
    parser.add_argument("--variant", default="", help="only variants with this in their names")
    parser.add_argument("--page", action="store_true", help="only write the page")
    parser.add_argument("--list", action="store_true", help="name the cases")
    chosen = parser.parse_args()
    if unknown := set(chosen.case) - set(names()):
        parser.error(f"no case is called {', '.join(sorted(unknown))}; --list names them")
    if chosen.list:
        print("\n".join(names()))
        return 0
    missed, where = False, {"engine": engine(), "machine": f"{machine()}, threads: {THREADS}"}
    if chosen.full:
        keep_states(where["engine"])
    for name in [] if chosen.page else chosen.case or names():
        case = get(name)
        variants = [v for v in (case.full if chosen.full else case.short) if chosen.variant in v]
        runs = [(v, lambda case=case, v=v: case.run(v)) for v in variants]
        if case.without is not None:
            runs.append((WITHOUT, case.without))
        for variant, run in runs:
            if chosen.full and not chosen.again and kept(name, variant, where["engine"]):
                continue
            result = replace(timed(run, variant), variant=variant)
            say(name, result)
            missed |= result.failed != (variant == WITHOUT)
            if chosen.full:
                keep(name, result, where)
    if chosen.full or chosen.page:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(page(), encoding="utf-8")
        print(f"wrote {PAGE}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
