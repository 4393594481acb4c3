"""An environment of its own for each peer, made from its requirement file and kept."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
FOLDER = HERE / ".envs"
PRELOADS = ("", "libGLdispatch.so.0")


class Unavailable(Exception):
    """A peer that does not install or does not load here; the message says which and why."""


@dataclass(frozen=True)
class Code:
    """One of the codes of the comparison: what to install, what to import, which worker runs it."""

    name: str
    worker: str
    module: str
    requirements: str | None  # None: the interpreter that runs this script has it


@dataclass(frozen=True)
class Environment:
    """An interpreter that can run a worker, and the variables it needs."""

    python: Path
    variables: dict[str, str]

    def run(
        self, arguments: list[str], *, threads: int = 1, timeout: float = 60.0
    ) -> subprocess.CompletedProcess[str]:
        """Runs the interpreter with ``arguments`` and returns what it printed."""
        variables = {
            **os.environ,
            **self.variables,
            "OMP_NUM_THREADS": str(threads),
            "OPENBLAS_NUM_THREADS": "1",
        }
        return subprocess.run(
            [str(self.python), *arguments],
            env=variables,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            check=False,
        )


def last_words(text: str) -> str:
    """The last line that says something, for a report of one line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1][:200] if lines else "no message"


def prepare(code: Code) -> Environment:
    """Makes the code's environment, or finds it made, and proves that it imports.

    Raises Unavailable where it cannot be installed or imported.
    """
    if code.requirements is None:
        return loadable(code, Path(sys.executable), {})
    wanted = (HERE / code.requirements).read_text(encoding="utf-8")
    home = FOLDER / code.module
    stamp = home / "installed.txt"
    python = home / "bin" / "python"
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != wanted:
        print(f"installing {code.name} into {home.relative_to(HERE)}", flush=True)
        install(code, home, python)
        stamp.write_text(wanted, encoding="utf-8")
    # The peers keep compiled code and settings in the home folder: give them one of their own.
    return loadable(code, python, {"HOME": str(home)})


def install(code: Code, home: Path, python: Path) -> None:
    steps = [
        [sys.executable, "-m", "venv", "--clear", str(home)],
        [str(python), "-m", "pip", "install", "--quiet", "-r", str(HERE / str(code.requirements))],
    ]
    for step in steps:
        try:
            done = subprocess.run(step, capture_output=True, text=True, timeout=1800, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise Unavailable(f"{code.name} does not install here: {error}") from error
        if done.returncode:
            reason = last_words(done.stderr or done.stdout)
            raise Unavailable(f"{code.name} does not install here: {reason}")


def loadable(code: Code, python: Path, variables: dict[str, str]) -> Environment:
    """The environment that imports the module, with a system library put first if need be."""
    reason = ""
    for preload in PRELOADS:
        extra = {"LD_PRELOAD": preload} if preload else {}
        environment = Environment(python, {**variables, **extra})
        done = environment.run(["-c", f"import {code.module}"])
        if done.returncode == 0:
            return environment
        died = f"killed by signal {-done.returncode}" if done.returncode < 0 else ""
        reason = reason or died or last_words(done.stderr)
    raise Unavailable(f"{code.name} installs but does not import here: {reason}")
