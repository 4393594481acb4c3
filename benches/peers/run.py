"""kolk beside PySPH and SPlisHSPlasH: the same scenes, particles and threads, alternately.

    python benches/peers/run.py            # a few minutes
    python benches/peers/run.py --full     # finer, longer, more rounds

Each run is a process of its own. The rounds go kolk, peer, kolk, peer, ..., so that a machine whose
speed drifts slows both. See README.md beside this file for what is compared and how.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

from environments import HERE, Code, Environment, Unavailable, last_words, prepare
from figures import Figures, read
from scenes import Scene, make
from table import print_figures, print_ratios

KOLK = Code("kolk", "kolk_worker.py", "kolk", None)
PYSPH = Code("PySPH", "pysph_worker.py", "pysph", "requirements-pysph.txt")
SPLISH = Code(
    "SPlisHSPlasH", "splishsplash_worker.py", "pysplishsplash", "requirements-splishsplash.txt"
)
CODES = (KOLK, PYSPH, SPLISH)


@dataclass(frozen=True)
class Entrant:
    """A code in one of its variants. ``narrow``: with SPlisHSPlasH's kernel and support."""

    code: Code
    variant: str
    narrow: bool

    @property
    def label(self) -> str:
        return f"{self.code.name} {self.variant}".strip()


WIDE = [Entrant(KOLK, "mixed", False), Entrant(KOLK, "f64", False), Entrant(PYSPH, "", False)]
NARROW = [
    Entrant(KOLK, "narrow-mixed", True),
    Entrant(SPLISH, "wcsph", True),
    Entrant(SPLISH, "dfsph", True),
]


@dataclass(frozen=True)
class Task:
    """A scene at one resolution: ``steps`` for its speed; 0: to the end, for its error."""

    scene: str
    cells: int
    steps: int

    @property
    def title(self) -> str:
        length = f"{self.steps} steps" if self.steps else "to the end"
        return f"{make(self.scene, self.cells).name}, {self.cells} cells, {length}"

    def entrants(self) -> list[Entrant]:
        return WIDE if self.scene == "taylor-green" else WIDE + NARROW


SHORT = [
    Task("dam-break-2d", 200, 60),
    Task("dam-break-3d", 32, 12),
    Task("taylor-green", 280, 40),
    Task("dam-break-2d", 40, 0),
    Task("dam-break-3d", 10, 0),
    Task("taylor-green", 50, 0),
]
FULL = [
    Task("dam-break-2d", 200, 300),
    Task("dam-break-3d", 46, 40),
    Task("taylor-green", 280, 300),
    Task("dam-break-2d", 100, 0),
    Task("dam-break-3d", 20, 0),
    Task("taylor-green", 100, 0),
]


SCENES = ["dam-break-2d", "dam-break-3d", "taylor-green"]


class Failed(Exception):
    """A run that did not end well; the message says why."""


def run(
    task: Task, entrant: Entrant, environment: Environment, threads: int, timeout: float
) -> Figures:
    """One run in a process of its own. Raises Failed."""
    scene: Scene = make(task.scene, task.cells, narrow=entrant.narrow)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        arguments = [str(HERE / entrant.code.worker), "--folder", name]
        arguments += ["--scene", task.scene, "--cells", str(task.cells)]
        arguments += ["--steps", str(task.steps), "--threads", str(threads)]
        arguments += ["--variant", entrant.variant]
        try:
            done = environment.run(arguments, threads=threads, timeout=timeout)
        except subprocess.TimeoutExpired as error:
            raise Failed(f"not done after {timeout:.0f} s") from error
        if done.returncode:
            raise Failed(f"exit status {done.returncode}: {last_words(done.stderr)}")
        try:
            return read(folder, scene)
        except (OSError, ValueError, KeyError) as error:
            raise Failed(str(error)) from error


def compare(
    task: Task, environments: dict[str, Environment], rounds: int, threads: int, timeout: float
) -> dict[str, list[Figures]]:
    """All rounds of a task, the entrants in turn; one that fails is told and left out."""
    entrants = [e for e in task.entrants() if e.code.name in environments]
    results: dict[str, list[Figures]] = {entrant.label: [] for entrant in entrants}
    failed: set[str] = set()
    print(f"\n{task.title}", flush=True)
    for _ in range(rounds):
        for entrant in entrants:
            if entrant.label in failed:
                continue
            try:
                figures = run(task, entrant, environments[entrant.code.name], threads, timeout)
            except Failed as error:
                print(f"  {entrant.label} does not run: {error}", flush=True)
                failed.add(entrant.label)
                continue
            results[entrant.label].append(figures)
    return {label: rows for label, rows in results.items() if rows}


def prepare_all(names: list[str]) -> dict[str, Environment]:
    """The environments of the codes asked for, those left out that do not install or import."""
    environments = {}
    for code in CODES:
        if code.name.lower() not in names:
            continue
        try:
            environments[code.name] = prepare(code)
        except Unavailable as error:
            print(error, file=sys.stderr)
    return environments


def parse(arguments: list[str] | None) -> argparse.Namespace:
    names = [code.name.lower() for code in CODES]
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--full", action="store_true", help="finer, longer, more rounds")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, help="default: 2, with --full 5")
    parser.add_argument("--codes", nargs="+", choices=names, default=names)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=SCENES)
    parser.add_argument("--json", type=Path, help="also write the figures to this file")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    options = parse(arguments)
    environments = prepare_all(options.codes)
    if not environments:
        print("no code to run", file=sys.stderr)
        return 1
    rounds = options.rounds or (5 if options.full else 2)
    timeout = 3600.0 if options.full else 600.0
    everything = {}
    for task in FULL if options.full else SHORT:
        if task.scene not in options.scenes:
            continue
        results = compare(task, environments, rounds, options.threads, timeout)
        print_figures(results)
        print_ratios(results)
        everything[task.title] = {
            label: [asdict(row) for row in rows] for label, rows in results.items()
        }
    if options.json is not None:
        options.json.write_text(json.dumps(everything, indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
