"""A program of kolk in a process of its own, so that its time and memory are its alone."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from kolk.errors import RunError

PATIENCE = 5.0
"""Seconds that an interrupted process has to end by itself."""


def run_alone(module: str, *arguments: str) -> None:
    """Runs `python -m module arguments` and waits for it. Raises `RunError` where it fails.

    An interruption (Ctrl-C) ends the process too.
    """
    package = str(Path(__file__).parents[2])
    path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
    process = subprocess.Popen(
        [sys.executable, "-m", module, *arguments],
        env={**os.environ, "PYTHONPATH": path},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        # Ctrl-C reaches this process, which ends the other in its own time.
        start_new_session=True,
    )
    try:
        _, errors = process.communicate()
    except BaseException:
        process.terminate()
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        raise
    if process.returncode:
        lines = [line for line in errors.splitlines() if line.strip()]
        last = lines[-1] if lines else f"it ended with status {process.returncode}"
        if process.returncode == -9:
            last = "the system killed it, most likely for want of memory: use a larger spacing"
        raise RunError(f"a run of the study failed: {last}")
