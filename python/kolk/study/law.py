"""The power law of an error: observed order by least squares, its interval, its predictions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kolk.errors import KolkError

Floats = NDArray[np.float64]

CONFIDENCE = 0.95
"""Of every interval, unless another is asked for."""

EXPECTED_SCATTER = 0.15
"""Scatter of log(error) about its power law that is assumed before a ladder has shown its own."""

WEIGHT_OF_EXPECTED = 3.0
"""Degrees of freedom that the expected scatter counts for against those of the ladder."""


@dataclass(frozen=True)
class PowerLaw:
    """E = C h^p through errors on a ladder of spacings, fitted in logarithms."""

    order: float
    """p"""
    low: float
    """Lower end of the order's confidence interval; minus infinity for two levels."""
    high: float
    log_constant: float
    """log C, at h in m."""
    residuals: float
    """Sum of squares of the residuals in log E."""
    freedom: int
    """Levels less the two parameters."""
    centre: float
    """Mean of log h."""
    spread: float
    """Sum of squares of log h about its mean."""
    levels: int

    def value(self, spacing: float) -> float:
        """The error at a spacing (m)."""
        return math.exp(self.log_constant + self.order * math.log(spacing))

    def interval(self, spacing: float, confidence: float = CONFIDENCE) -> tuple[float, float]:
        """Prediction interval of a new error at a spacing (m).

        The scatter is the ladder's own pooled with the expected one, by their degrees of freedom
        (the scaled inverse chi-squared prior of a variance: Gelman et al. 2013, Bayesian Data
        Analysis, section 2.6): three levels alone would leave one degree of freedom.
        """
        from scipy.stats import t

        weight = WEIGHT_OF_EXPECTED + self.freedom
        variance = (WEIGHT_OF_EXPECTED * EXPECTED_SCATTER**2 + self.residuals) / weight
        distance = math.log(spacing) - self.centre
        own = 1.0 + 1.0 / self.levels + distance**2 / self.spread
        half = float(t.ppf(0.5 * (1.0 + confidence), weight)) * math.sqrt(variance * own)
        value = self.value(spacing)
        return value * math.exp(-half), value * math.exp(half)

    def upper(self, spacing: float, confidence: float = CONFIDENCE) -> float:
        """Error that a new run at a spacing (m) exceeds with probability 1 - confidence."""
        return self.interval(spacing, 2.0 * confidence - 1.0)[1]

    def spacing_for(self, error: float) -> float:
        """Spacing (m) at which the law passes through a value; NaN for a law without slope."""
        if self.order == 0.0:
            return math.nan
        return math.exp((math.log(error) - self.log_constant) / self.order)

    def safe_spacing_for(self, error: float, confidence: float = CONFIDENCE) -> float:
        """Largest spacing (m) whose `upper` is within an error; NaN where there is none."""
        from scipy.optimize import brentq

        if self.order <= 0.0:
            return math.nan
        start = self.spacing_for(error)

        def excess(log_spacing: float) -> float:
            return math.log(self.upper(math.exp(log_spacing), confidence) / error)

        high = math.log(start)
        low = high
        for _ in range(60):
            low -= 0.25
            if excess(low) <= 0.0:
                return math.exp(float(brentq(excess, low, high)))
        return math.nan


def observed_order(
    spacing: ArrayLike, error: ArrayLike, confidence: float = CONFIDENCE
) -> PowerLaw:
    """The law through errors (n,) > 0 at spacings (n,) in m; n of at least two, all different.

    The interval of the order is that of Student's t for a slope; for two levels it is the whole
    line. Raises `KolkError` for errors that are not positive and finite.
    """
    from scipy.stats import linregress, t

    h, e = np.asarray(spacing, np.float64), np.asarray(error, np.float64)
    if len(h) < 2 or len(h) != len(e) or len(np.unique(h)) < 2:
        raise KolkError("spacing: an order needs errors at two different spacings or more")
    if not (np.isfinite(e).all() and (e > 0.0).all() and (h > 0.0).all()):
        raise KolkError(f"error: found {e.tolist()}, must be positive and finite")
    x, y = np.log(h), np.log(e)
    fit = linregress(x, y)
    freedom = len(h) - 2
    residual = y - (fit.intercept + fit.slope * x)
    half = math.inf
    if freedom:
        half = float(t.ppf(0.5 * (1.0 + confidence), freedom)) * float(fit.stderr)
    return PowerLaw(
        order=float(fit.slope),
        low=float(fit.slope) - half,
        high=float(fit.slope) + half,
        log_constant=float(fit.intercept),
        residuals=float(residual @ residual),
        freedom=freedom,
        centre=float(x.mean()),
        spread=float(np.sum((x - x.mean()) ** 2)),
        levels=len(h),
    )
