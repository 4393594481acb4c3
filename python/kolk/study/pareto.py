"""The runs that no other beats in both time and error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike


def pareto_front(time: ArrayLike, error: ArrayLike) -> list[int]:
    """Indices of the runs for which none is at least as fast and at least as exact (and better in
    one of them), in order of time. Runs without a finite error are never among them."""
    t, e = np.asarray(time, np.float64), np.asarray(error, np.float64)
    order: Sequence[int] = [int(i) for i in np.lexsort((e, t)) if np.isfinite(e[i])]
    front: list[int] = []
    for i in order:
        if not front or e[i] < e[front[-1]]:
            front.append(i)
    return front
