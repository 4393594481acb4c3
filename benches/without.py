"""Proves that what a scene does not ask for costs it nothing: instructions before and after.

    python benches/without.py BEFORE [AFTER]

counts the instructions per particle and step (`benches/instructions.rs`, callgrind, AVX2, one
thread) of scenes that use none of what came in between, at two revisions: BEFORE, the last one in
which an effect did not exist, and AFTER (the working tree's HEAD if absent), which has it. Each is
built in a work tree and a target folder of its own. Ends with status 1 where a scene executes more
than half a per cent more instructions than before. Needs valgrind and git.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 1.005
"""Largest ratio that passes: what moves between two builds by itself is below it."""
LINE = re.compile(r"^(2d|3d) (mixed|f64)\s+(\w+)\s+([\d.]+)$", re.MULTILINE)


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


def count(revision: str, folder: Path) -> dict[tuple[str, str, str], float]:
    """Instructions per particle and step by dimension, precision and form of diffusion."""
    tree = folder / "tree"
    run("git", "worktree", "add", "--detach", "--quiet", str(tree), revision)
    try:
        printed = run(
            "cargo",
            "bench",
            "--quiet",
            "--bench",
            "instructions",
            folder=tree,
            CARGO_TARGET_DIR=str(folder / "target"),
            # One vector unit is counted: the others need not be compiled.
            RUSTFLAGS="--cfg kolk_avx2_only",
        )
    finally:
        run("git", "worktree", "remove", "--force", str(tree))
    found = {(d, p, f): float(n) for d, p, f, n in LINE.findall(printed)}
    if not found:
        sys.exit(f"{revision}: no counts; is valgrind installed?\n{printed}")
    return found


def main() -> None:
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    revisions = [sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else "HEAD"]
    with tempfile.TemporaryDirectory(prefix="kolk-without-") as name:
        before, after = (
            count(revision, Path(name) / f"{k}") for k, revision in enumerate(revisions)
        )
    print(f"instructions per particle and step: {revisions[0]} against {revisions[1]}")
    worst = 0.0
    for key in before.keys() & after.keys():
        worst = max(worst, after[key] / before[key])
    for key in sorted(before.keys() & after.keys()):
        ratio = after[key] / before[key]
        print(f"{' '.join(key):22} {before[key]:10.1f} {after[key]:10.1f} {ratio:8.4f}")
    if worst > MOST:
        sys.exit(f"a scene executes {100 * (worst - 1):.2f} % more instructions than before")


if __name__ == "__main__":
    main()
