"""Error norms of a field against an analytic solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Norms:
    """Relative norms of an error; a vector counts by its length."""

    l1: float
    l2: float
    largest: float


def norms(value: npt.ArrayLike, exact: npt.ArrayLike, scale: float | None = None) -> Norms:
    """Norms of ``value - exact``, both (n,) or (n, D), relative to those of ``exact``.

    With ``scale`` the mean (L1), root mean square (L2) and largest error are divided by it instead:
    for profiles where "1 % of the largest velocity" is meant.
    """
    error = _length(np.asarray(value, np.float64) - np.asarray(exact, np.float64))
    size = _length(np.asarray(exact, np.float64))
    by_one = float(size.mean()) if scale is None else scale
    by_two = float(np.sqrt(np.mean(size**2))) if scale is None else scale
    by_largest = float(size.max()) if scale is None else scale
    return Norms(
        l1=float(error.mean()) / by_one,
        l2=float(np.sqrt(np.mean(error**2))) / by_two,
        largest=float(error.max()) / by_largest,
    )


def _length(x: FloatArray) -> FloatArray:
    return np.abs(x) if x.ndim == 1 else np.asarray(np.linalg.norm(x, axis=-1))
