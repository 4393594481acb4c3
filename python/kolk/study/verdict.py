"""Whether a ladder of spacings shows an order at all: too short, not asymptotic, or sound."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from .expansion import ORDERS, Expansion
from .law import PowerLaw

Kind = Literal["asymptotic", "too short", "not asymptotic", "not falling", "nothing to show"]

FEWEST_LEVELS = 3
SHORTEST_SPAN = 1.8
"""Coarsest over finest spacing below which differences of levels are mostly scatter."""

WIDEST_INTERVAL = 1.0
"""Half-width of an order's confidence interval beyond which it says nothing."""

LAW_ORDERS = (0.4, 2.6)
"""Range of the order of an error against a reference; a little wider than the scheme's, as a
reference's own error and a start from rest bend the law."""

STALLED = 0.3
"""Order between the two finest levels below which an error has stopped to fall."""

NOTHING = 1e-9
"""Share of a quantity's scale below which levels do not differ."""


@dataclass(frozen=True)
class Verdict:
    """What may be said of an order, and why."""

    kind: Kind
    reason: str = ""

    @property
    def sound(self) -> bool:
        """Whether an order may be stated."""
        return self.kind == "asymptotic"


def judge_ladder(spacing: Sequence[float]) -> Verdict | None:
    """The verdict on the ladder alone, or None where it is long enough."""
    levels = len(set(spacing))
    if levels < FEWEST_LEVELS:
        return Verdict(
            "too short",
            f"the ladder has {levels} level{'s' * (levels != 1)}; an order needs "
            f"{FEWEST_LEVELS}, and its interval a fourth",
        )
    span = max(spacing) / min(spacing)
    if span < SHORTEST_SPAN:
        return Verdict(
            "too short",
            f"the coarsest spacing is only {span:.2f} times the finest; it should be "
            f"{SHORTEST_SPAN:g} times or more",
        )
    return None


def judge_law(law: PowerLaw | None, spacing: Sequence[float], error: Sequence[float]) -> Verdict:
    """The verdict on errors against a reference."""
    short = judge_ladder(spacing)
    if short is not None:
        return short
    if law is None:
        return Verdict("nothing to show", "the errors vanish")
    by_size = sorted(zip(spacing, error, strict=True))
    (h1, e1), (h2, e2) = by_size[:2]
    last = math.log(e2 / e1) / math.log(h2 / h1)
    if law.order <= 0.0 or (law.levels > FEWEST_LEVELS and last < 0.0 and law.low <= 0.0):
        return Verdict(
            "not falling",
            "the error does not fall with the spacing: something else than the spacing makes it, "
            "or the ladder is too coarse",
        )
    if last < STALLED:
        return Verdict(
            "not asymptotic",
            f"the error falls with order {last:.1f} only between the two finest levels: it nears "
            "a floor that the spacing does not set",
        )
    if not LAW_ORDERS[0] <= law.order <= LAW_ORDERS[1]:
        return Verdict(
            "not asymptotic",
            f"the levels give {law.order:.1f}, no order that the scheme can have",
        )
    return _judge_interval(law.low, law.high) or Verdict("asymptotic")


def judge_expansion(expansion: Expansion | None, spacing: Sequence[float], scale: float) -> Verdict:
    """The verdict on a quantity without a reference, whose scale is given in its unit."""
    short = judge_ladder(spacing)
    if short is not None:
        return short
    if expansion is None or expansion.step <= NOTHING * scale:
        return Verdict("nothing to show", "the levels do not differ")
    if expansion.scatter >= expansion.step:
        return Verdict(
            "not asymptotic",
            "the levels scatter as much as they differ: the flow is chaotic, or the ladder is too "
            "coarse",
        )
    if not math.isfinite(expansion.free_order):
        return Verdict(
            "not falling", "the levels do not approach a limit: their differences do not shrink"
        )
    if not ORDERS[0] <= expansion.free_order <= ORDERS[1]:
        return Verdict(
            "not asymptotic",
            f"the levels give {expansion.free_order:.1f}, no order that the scheme can have",
        )
    return _judge_interval(expansion.free_low, expansion.free_high) or Verdict("asymptotic")


def _judge_interval(low: float, high: float) -> Verdict | None:
    """A half-width too large for an order; an infinite one is that of a ladder without spare."""
    half = 0.5 * (high - low)
    if np.isfinite(half) and half > WIDEST_INTERVAL:
        return Verdict(
            "too short",
            f"the order would lie anywhere between {low:.1f} and {high:.1f}: add a level",
        )
    return None
