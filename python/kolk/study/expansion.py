"""Error bars from a ladder whose exact solution is unknown, by least squares over its levels.

Eça and Hoekstra (2014), "A procedure for the estimation of the numerical uncertainty of CFD
calculations based on grid refinement studies", J. Comput. Phys. 262, 104-130: a power series in
the spacing is fitted to all levels, with and without weights, in four forms; the form with the
least scatter is kept; the bar is the error that it leaves times a factor of safety, plus the
scatter, plus what the level itself lies off the fit.

Here a value may be a record over time: one order for all of it, as Celik et al. (2008) take one
order for a profile, and everything else at each time. Fits with a given order are linear, so that
only the order is searched for (variable projection, Golub and Pereyra 1973).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kolk.errors import KolkError

from .law import CONFIDENCE
from .richardson import SAFETY, SAFETY_UNSURE

Floats = NDArray[np.float64]
Form = Literal["power", "first", "second", "first and second"]

ORDERS = (0.5, 2.1)
"""Range of observed orders that count as those of a second-order scheme."""

SEARCHED = (0.05, 6.0)
"""Range in which the order of the free power is looked for."""


@dataclass(frozen=True)
class Expansion:
    """f(h) = limit + Σ terms[k] h^exponents[k] through the levels of a ladder."""

    form: Form
    spacing: Floats
    """(n,) m."""
    value: Floats
    """(n, m) of the levels."""
    exponents: tuple[float, ...]
    limit: Floats
    """(m,) extrapolated to spacing zero."""
    terms: Floats
    """(k, m)."""
    scatter: float
    """Standard deviation of the levels about the fit (RMS over m); 0 where nothing is left over."""
    free_order: float
    """Order of the fit with a free power, whatever form was kept; NaN where it has no optimum."""
    free_low: float
    """Lower end of its confidence interval."""
    free_high: float
    observations: float
    """Independent values among the m."""

    @property
    def range(self) -> float:
        """Largest distance (RMS over m) between two levels."""
        n = len(self.spacing)
        return max(_rms(self.value[i] - self.value[j]) for i in range(n) for j in range(i))

    @property
    def step(self) -> float:
        """The range over the number of steps: what a level changes (Δφ)."""
        return self.range / (len(self.spacing) - 1)

    @property
    def reliable(self) -> bool:
        """Whether the order is in the range of the scheme and the scatter below the step."""
        inside = self.form != "power" or ORDERS[0] <= self.exponents[0] <= ORDERS[1]
        free = math.isfinite(self.free_order) and ORDERS[0] <= self.free_order <= ORDERS[1]
        return inside and free and self.scatter < self.step

    def at(self, spacing: float) -> Floats:
        """(m,) the fit at a spacing (m)."""
        return self.limit + self.error(spacing)

    def error(self, spacing: float) -> Floats:
        """(m,) what the fit says a value at a spacing (m) is off its limit."""
        powers = np.array([spacing**p for p in self.exponents])
        return np.asarray(powers @ self.terms)

    def bar(self, spacing: float, off: Floats | None = None) -> Floats:
        """(m,) half-width of the error bar of a value at a spacing (m), at about 95 %.

        off (m,): what the value lies off the fit; none for a value not computed yet.
        """
        error = np.abs(self.error(spacing))
        away = np.zeros_like(error) if off is None else np.abs(off)
        if self.scatter < self.step or self.step == 0.0:
            safety = SAFETY if self.reliable else SAFETY_UNSURE
            return np.asarray(safety * error + self.scatter + away)
        noise = self.scatter / self.step
        wide = SAFETY_UNSURE * noise * (error + self.scatter + away)
        # A fit through noise may extrapolate anywhere: no wider than the bar of those authors'
        # earlier procedure for data without convergence, three times their range.
        return np.asarray(np.minimum(wide, np.maximum(SAFETY_UNSURE * self.range, self.scatter)))

    def level_bar(self, level: int) -> Floats:
        """(m,) half-width of the error bar of one of the ladder's levels."""
        spacing = float(self.spacing[level])
        return self.bar(spacing, self.value[level] - self.at(spacing))

    def level_error(self, level: int) -> Floats:
        """(m,) a level less the limit."""
        return np.asarray(self.value[level] - self.limit)


def expand(
    spacing: ArrayLike,
    value: ArrayLike,
    *,
    independent: float | None = None,
    confidence: float = CONFIDENCE,
) -> Expansion:
    """The expansion through values (n,) or (n, m) at spacings (n,), n of at least three.

    independent: how many of the m values tell something of their own (neighbouring times do not);
    estimated from the differences of the levels where it is not given.
    """
    h = np.asarray(spacing, np.float64)
    f = np.asarray(value, np.float64)
    f = f[:, None] if f.ndim == 1 else f
    if len(h) < 3 or len(np.unique(h)) != len(h) or len(f) != len(h):
        raise KolkError("spacing: an expansion needs values at three different spacings or more")
    if not np.isfinite(f).all():
        raise KolkError("value: must be finite")
    count = _independent(f) if independent is None else independent
    free, low, high = _free_order(h, f, count, confidence)
    best = _kept(h, f, free, count)
    return Expansion(
        form=best[1],
        spacing=h,
        value=f,
        exponents=best[2],
        limit=best[3][0],
        terms=best[3][1:],
        scatter=best[0],
        free_order=free,
        free_low=low,
        free_high=high,
        observations=count,
    )


_Candidate = tuple[float, Form, tuple[float, ...], Floats]


def _kept(h: Floats, f: Floats, free: float, count: float) -> _Candidate:
    """The form with the least scatter among those that the free order allows."""
    forms: list[tuple[Form, tuple[float, ...]]]
    if math.isfinite(free) and ORDERS[0] <= free <= ORDERS[1]:
        forms = [("power", (free,))]
    elif math.isfinite(free) and free > ORDERS[1]:
        # Faster than the scheme: the leading terms happen to cancel, and must not be trusted to.
        forms = [("first", (1.0,)), ("second", (2.0,))]
    else:
        forms = [("first", (1.0,)), ("second", (2.0,))]
        if len(h) > 3:
            forms.append(("first and second", (1.0, 2.0)))
    candidates: list[_Candidate] = []
    for form, exponents in forms:
        for weights in _weights(h):
            exact = exponents
            if form == "power":
                exact = (_optimum(h, f, weights) or free,)
            solution, squares = _solve(h, f, exact, weights)
            used = 1.0 + len(exact) + (1.0 / count if form == "power" else 0.0)
            freedom = len(h) - used
            scatter = math.sqrt(squares / freedom) / _c4(freedom) if freedom > 1e-9 else 0.0
            candidates.append((scatter, form, exact, solution))
    return min(candidates, key=lambda candidate: candidate[0])


def _c4(freedom: float) -> float:
    """Mean of a sample's standard deviation over the true one (Holtzman 1950): 0.80 for one."""
    from scipy.special import gammaln

    half = 0.5 * freedom
    return math.sqrt(1.0 / half) * math.exp(float(gammaln(half + 0.5) - gammaln(half)))


def _weights(h: Floats) -> tuple[Floats, Floats]:
    """All levels alike, and the finer ones heavier (Eça and Hoekstra's w = 1/h), of mean one."""
    fine = (1.0 / h) / np.mean(1.0 / h)
    return np.ones_like(h), fine


def _solve(
    h: Floats, f: Floats, exponents: tuple[float, ...], weights: Floats
) -> tuple[Floats, float]:
    """Coefficients (1 + k, m), and the weighted squares summed over levels, averaged over m."""
    root = np.sqrt(weights)[:, None]
    design = np.stack([np.ones_like(h), *(h**p for p in exponents)], axis=1)
    solution, *_ = np.linalg.lstsq(root * design, root * f, rcond=None)
    residual = root * (f - design @ solution)
    return solution, float(np.sum(np.mean(residual**2, axis=1)))


def _squares(h: Floats, f: Floats, orders: Floats, weights: Floats) -> Floats:
    """(k,) what `_solve` leaves with one term, for many orders (k,) at once."""
    total = float(weights.sum())
    power = h[None, :] ** orders[:, None]
    power -= (power @ weights / total)[:, None]
    centred = f - weights @ f / total
    own = np.sum(weights * power**2, axis=1)
    shared = (weights * power) @ centred
    left = np.sum(weights[:, None] * centred**2, axis=0) - shared**2 / own[:, None]
    return np.asarray(np.mean(np.maximum(left, 0.0), axis=1))


def _optimum(h: Floats, f: Floats, weights: Floats) -> float | None:
    """The order with the least squares, or None where it lies at the ends of the search."""
    low, high = SEARCHED
    best = math.nan
    for _ in range(6):
        grid = np.linspace(low, high, 60)
        i = int(np.argmin(_squares(h, f, grid, weights)))
        if math.isnan(best) and i in (0, len(grid) - 1):
            return None
        best = float(grid[i])
        low, high = float(grid[max(i - 1, 0)]), float(grid[min(i + 1, len(grid) - 1)])
    return best


def _free_order(
    h: Floats, f: Floats, count: float, confidence: float
) -> tuple[float, float, float]:
    """Order of the free power with its interval: where the squares rise by Student's t² s².

    (the likelihood-ratio interval of a nonlinear parameter, Bates and Watts 1988, chapter 6).
    """
    from scipy.stats import t

    even = np.ones_like(h)
    order = _optimum(h, f, even)
    if order is None:
        return math.nan, -math.inf, math.inf
    least = float(_squares(h, f, np.array([order]), even)[0])
    freedom = (len(h) - 2.0) * count - 1.0
    if freedom < 1e-9:
        return order, -math.inf, math.inf
    # Squares are means over m of sums over levels; s² is least count / freedom, and it rises by
    # t² s² / count.
    quantile = float(t.ppf(0.5 * (1.0 + confidence), freedom))
    bound = least * (1.0 + quantile**2 / freedom)
    grid = np.linspace(*SEARCHED, 600)
    inside = grid[_squares(h, f, grid, even) <= bound]
    low = min([*inside, order])
    high = max([*inside, order])
    return (
        order,
        -math.inf if low <= SEARCHED[0] else float(low),
        math.inf if high >= SEARCHED[1] else float(high),
    )


def _independent(f: Floats) -> float:
    """Independent values in a record: its length over the correlation time of level differences.

    Integrated autocorrelation with the window of Sokal (1997): summed until it is shorter than a
    fifth of the lag.
    """
    m = f.shape[1]
    if m < 4:
        return 1.0
    difference = f[-1] - f[-2]
    centred = difference - difference.mean()
    power = float(centred @ centred)
    if power == 0.0:
        return 1.0
    correlation = 1.0
    for lag in range(1, m // 2):
        correlation += 2.0 * float(centred[lag:] @ centred[:-lag]) / power
        if lag >= 5.0 * correlation:
            break
    return float(np.clip(m / max(correlation, 1.0), 1.0, m))


def _rms(x: Floats) -> float:
    return float(np.sqrt(np.mean(x**2)))
