"""Proves that an effect that is off costs nothing: instructions and bytes with it and without it.

    python benches/without.py [--target FOLDER] [--write] [EFFECT ...]

For each effect (all of `EFFECTS` if none is named) a work tree of HEAD is made in which the effect
does not exist: the place where assembly chooses it is cut out, so that nothing refers to its code
and none of it is compiled in. `benches/instructions.rs` then counts what scenes that do not use
the effect execute per particle and step (callgrind, AVX2, one thread) and allocate, and the figures
are held against those of the whole. Ends with status 1 where they differ by more than half a per
cent, or by a byte. ``--write`` puts the table into docs/effects.md. Builds go into FOLDER; each
effect takes some minutes. Needs valgrind and git.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 0.005
"""Largest difference that passes: what a compiler makes of the same code moves below it."""
LINE = re.compile(r"^(2d|3d) (mixed|f64)\s+(\w+)\s+([\d.]+)\s+(\d+)$", re.MULTILINE)
HEADING = "## What an absent effect costs\n"
CATALOGUE = "src/simulation/catalogue.rs"
ASSEMBLY = "src/simulation/assembly.rs"
RATES = "src/simulation/density_rates.rs"
WALLS = "src/simulation/wall_values.rs"
SOLVER = "src/simulation/solver.rs"

Counts = Mapping[tuple[str, str, str], tuple[float, int]]
"""Instructions per particle and step, and bytes, by dimension, precision and form of diffusion."""


@dataclass(frozen=True)
class Cut:
    """A part of a source file that is replaced."""

    file: str
    start: str
    """Expression that the part starts with; it must occur once."""
    end: str
    """Where it ends: with the ";" of the statement, the "," of the field, or as the next block."""
    instead: str = ""

    def apply(self, text: str) -> str:
        """The text without the part. Ends the program where it is not found."""
        found = list(re.finditer(self.start, text))
        if len(found) != 1:
            sys.exit(
                f"{self.file}: found {len(found)} places that match {self.start!r}, expected one: "
                "the source has changed, change benches/without.py with it"
            )
        begin = found[0].start()
        if self.end == "}":
            begin = text.index("{", begin)
        depth = 0
        for k in range(begin, len(text)):
            depth += (text[k] in "([{") - (text[k] in ")]}")
            if depth == 0 and text[k] == self.end:
                return text[:begin] + self.instead + text[k + 1 :]
        sys.exit(f"{self.file}: {self.start!r} has no end")


def stage(key: str) -> Cut:
    """A stage, by its key in the configuration: its line in the list of stages."""
    return Cut(CATALOGUE, rf"add\(c\s*\.{key}\b", ";")


def arm(file: str, pattern: str) -> Cut:
    """An arm of a match, which nothing gets to."""
    return Cut(file, re.escape(pattern) + r" =>(?= \{)", "}", "{ unreachable!() }")


def body(file: str, function: str, instead: str = "") -> Cut:
    """The body of a function."""
    return Cut(file, rf"\bfn {function}\b", "}", f"{{ {instead} }}")


EFFECTS: dict[str, tuple[Cut, ...]] = {
    "turbulence": (stage("turbulence"),),
    "Herschel-Bulkley": (stage("herschel_bulkley"),),
    "surface tension": (stage("surface_tension"),),
    "linear drag": (stage("linear_drag"),),
    "Riemann dissipation": (
        stage("riemann_viscosity"),
        arm(RATES, "Some((DiffusionForm::Riemann, delta))"),
    ),
    "tensile control": (arm(CATALOGUE, "TensileForm::Sun"),),
    "artificial stress": (arm(CATALOGUE, "TensileForm::Monaghan"),),
    "laminar viscosity": (
        arm(ASSEMBLY, "(None, Some((ViscosityForm::Morris, nu)))"),
        arm(ASSEMBLY, "(None, Some((ViscosityForm::MonaghanGingold, nu)))"),
        arm(ASSEMBLY, "(Some(a), Some((_, nu)))"),
    ),
    "acoustic damper": (
        Cut("src/step/motion.rs", r"pressure \+ damper \* rate\[i\]", ";", "pressure;"),
    ),
    "particle shifting": (
        body(RATES, "rates_with", "let _ = dt; self.run_density_rates(diffusion, ())"),
        body(RATES, "shift_of_a_step", "let _ = dt; None"),
        body(RATES, "shifts_now", "false"),
        body(SOLVER, "shift", ""),
    ),
    "moving walls": (
        body(SOLVER, "move_walls", "let _ = time;"),
        Cut(SOLVER, r"set\.moving = Some\(", ";"),
        Cut(WALLS, r"if let Some\(moving\) = &wall\.moving", "}", "{ let _ = moving; }"),
        Cut(WALLS, r"accelerated: wall\.moving\.is_some\(\)", ",", "accelerated: false,"),
    ),
    "gravity over time": (body("src/simulation/gravity.rs", "set_gravity", "let _ = time;"),),
    "walls of facets": (
        body("src/simulation/facet_walls.rs", "facet_walls", "let _ = facets; None"),
        body("src/simulation/facet_walls.rs", "add_facet_forces"),
        body("src/simulation/facet_walls.rs", "add_facet_rates"),
    ),
}
"""How each effect is taken out of the sources."""


def run(*command: str, folder: Path = ROOT, **environment: str) -> str:
    """Standard output of a command that must succeed."""
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return done.stdout


def count(tree: Path, target: Path) -> Counts:
    """What the bench counts in a work tree. Ends the program where it counts nothing."""
    printed = run(
        "cargo",
        "bench",
        "--quiet",
        "--bench",
        "instructions",
        folder=tree,
        CARGO_TARGET_DIR=str(target),
        # One vector unit is counted: the others need not be compiled. What a cut leaves unused
        # is no matter here. After a cut only what depends on it is compiled again.
        RUSTFLAGS="--cfg kolk_avx2_only --allow warnings",
        CARGO_INCREMENTAL="1",
        CARGO_PROFILE_BENCH_DEBUG="0",
    )
    found = {(d, p, f): (float(n), int(b)) for d, p, f, n, b in LINE.findall(printed)}
    if not found:
        sys.exit(f"no counts; is valgrind installed?\n{printed}")
    return found


def without(tree: Path, effects: list[str]) -> None:
    """Takes effects out of the sources in ``tree``."""
    run("git", "checkout", "--quiet", "--", ".", folder=tree)
    for cut in (cut for effect in effects for cut in EFFECTS[effect]):
        file = tree / cut.file
        file.write_text(cut.apply(file.read_text(encoding="utf-8")), encoding="utf-8")


def row(whole: Counts, cut: Counts) -> tuple[dict[tuple[str, str], float], int]:
    """What an effect that is off adds: share of the instructions by dimension and precision (the
    largest of the forms of diffusion), and bytes."""
    added: dict[tuple[str, str], float] = {}
    for case, (instructions, _) in whole.items():
        share = instructions / cut[case][0] - 1.0
        added[case[:2]] = max(added.get(case[:2], 0.0), share, key=abs)
    return added, max((whole[case][1] - cut[case][1] for case in whole), key=abs)


def table(rows: Mapping[str, tuple[dict[tuple[str, str], float], int]]) -> str:
    """The rows as Markdown."""
    columns = [(d, p) for d in ("2d", "3d") for p in ("mixed", "f64")]
    names = [f"{d.upper()}, {p}" for d, p in columns]
    lines = [f"| without | {' | '.join(names)} | bytes |", "|---" * 6 + "|"]
    for effect, (added, held) in rows.items():
        shares = [f"{100.0 * added[column]:+.3f} %" for column in columns]
        lines.append(f"| {effect} | {' | '.join(shares)} | {held:+d} |")
    return "\n".join(lines)


def write(lines: str) -> None:
    """Puts the table into docs/effects.md, in the place of the last one."""
    file = ROOT / "docs" / "effects.md"
    before, heading, after = file.read_text(encoding="utf-8").partition(HEADING)
    old = re.search(r"^\| without .*?(?=^[^|]|\Z)", after, re.MULTILINE | re.DOTALL)
    if not heading or old is None:
        sys.exit(f"{file}: found no table under {HEADING.strip()!r}")
    made = after[: old.start()] + lines + "\n" + after[old.end() :]
    file.write_text(before + heading + made, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("effects", nargs="*", metavar="EFFECT", help="the effects to take out")
    parser.add_argument("--target", type=Path, default=ROOT / "target" / "without")
    parser.add_argument("--write", action="store_true", help="into docs/effects.md")
    given = parser.parse_args()
    if unknown := set(given.effects) - set(EFFECTS):
        parser.error(f"no effect {unknown.pop()!r}; there are: {', '.join(EFFECTS)}")
    effects = given.effects or list(EFFECTS)
    tree = given.target / "tree"
    run("git", "worktree", "add", "--force", "--detach", "--quiet", str(tree), "HEAD")
    try:
        whole = count(tree, given.target)
        rows = {}
        # All together too: what each of them adds could hide below what a compiler makes of it.
        for taken in [*([e] for e in effects), effects]:
            name = taken[0] if len(taken) == 1 else "all of these"
            without(tree, taken)
            rows[name] = row(whole, count(tree, given.target))
            print(table({name: rows[name]}).splitlines()[-1], flush=True)
    finally:
        run("git", "worktree", "remove", "--force", str(tree))
    print(table(rows))
    if given.write:
        write(table(rows))
    if dear := [
        name
        for name, (added, held) in rows.items()
        if held != 0 or max(map(abs, added.values())) > MOST
    ]:
        sys.exit(f"not free where it is off: {', '.join(dear)}")


if __name__ == "__main__":
    main()
