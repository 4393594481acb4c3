"""What the system knows of this process and of the others."""

from __future__ import annotations

import os
from pathlib import Path


def peak_memory() -> int:
    """Largest resident size of this process so far, bytes.

    On Linux from the process's status: `getrusage` there remembers the parent's size from before
    the start of a program.
    """
    try:
        for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    except (OSError, ValueError):
        pass
    try:
        import resource
        import sys
    except ImportError:
        return 0
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def busy_seconds() -> float:
    """Seconds that all processors together have been busy since the start; NaN where unknown."""
    try:
        first = Path("/proc/stat").read_text(encoding="ascii").splitlines()[0].split()
        ticks = [int(x) for x in first[1:]]
        # user, nice, system, irq, softirq: idle, waiting for disks and guests' double counts out.
        busy = ticks[0] + ticks[1] + ticks[2] + sum(ticks[5:7])
        return busy / os.sysconf("SC_CLK_TCK")
    except (OSError, ValueError, IndexError, AttributeError):
        return float("nan")
