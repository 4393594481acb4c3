"""Error against spacing of one ladder, for one quantity, and what it promises elsewhere."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .ladder import Variant
from .law import EXPECTED_SCATTER, PowerLaw, observed_order
from .quantity import STATISTICS, Quantity, quantities
from .record import Record
from .verdict import Verdict, judge_law

Floats = NDArray[np.float64]
Basis = Literal["analytic", "experiment", "extrapolation"]

ALL_PROBES = "all probes"
"""The worst of all columns of all probes."""

REACH = 2.0
"""Finest spacing of a ladder over one that it may still speak of."""

NEIGHBOUR = 1.5
"""Spacing over another one up to which their errors are taken for alike where no law holds."""

PROMISED = 0.95
"""Probability that an error stays within what is promised."""


@dataclass(frozen=True)
class Curve:
    """Errors of a ladder's levels, as shares."""

    name: str
    basis: Basis
    spacing: Floats
    """(n,) m, falling."""
    error: Floats
    """(n,) shares of the reference's size, or of the quantity's scale."""
    law: PowerLaw | None
    verdict: Verdict
    parts: tuple[Quantity, ...] = field(default=(), repr=False)
    """The quantities behind an extrapolated error."""

    @property
    def order(self) -> tuple[float, float, float]:
        """Observed order and its confidence interval; see `verdict` for whether it means anything.

        Of an error against a reference the slope of log(error); of an extrapolation the power that
        fits all levels, of the quantity with the largest error where there are several.
        """
        if self.basis == "extrapolation" and self.parts:
            worst = max(self.parts, key=lambda part: part.level_error(0))
            found = worst.expansion
            if found is not None:
                return found.free_order, found.free_low, found.free_high
        if self.law is not None:
            return self.law.order, self.law.low, self.law.high
        return math.nan, -math.inf, math.inf

    def expected(self, spacing: float) -> float:
        """The error to expect at a spacing (m); NaN where the ladder says nothing about it."""
        if not self.speaks_of(spacing):
            return math.nan
        if self.basis == "extrapolation" and self.parts:
            return max(_expected(part, spacing) for part in self.parts)
        return self.law.value(spacing) if self.law is not None else math.nan

    def promised(self, spacing: float) -> float:
        """The error that a run at a spacing (m) will not exceed, with a probability of 95 %.

        Infinite where nothing can be promised: no sound verdict, or beyond the ladder's reach.
        """
        if not self.speaks_of(spacing):
            return math.inf
        if self.basis == "extrapolation" and self.parts:
            return max(part.bar_at(spacing) for part in self.parts)
        if self.law is None:
            return math.inf
        if self.verdict.kind in ("not falling", "not asymptotic"):
            # Errors that the spacing does not set: as bad as the levels around.
            near = self.spacing <= spacing * NEIGHBOUR
            return float(np.max(self.error[near])) * math.exp(2.0 * EXPECTED_SCATTER)
        return self.law.upper(spacing, PROMISED)

    @property
    def finest(self) -> float:
        """The finest spacing (m) that the ladder speaks of: beyond its end only with an order."""
        trusted = self.verdict.sound or (self.verdict.kind == "too short" and self.spacing.size > 2)
        return float(self.spacing[-1]) / (REACH if trusted else 1.0)

    def speaks_of(self, spacing: float) -> bool:
        """Whether a spacing (m) is in the ladder or a little finer than it."""
        return self.finest * (1 - 1e-9) <= spacing <= float(self.spacing[0]) * (1 + 1e-9)

    def spacing_for(self, error: float) -> float:
        """Largest spacing (m) at which an error is promised; NaN where none can be."""
        steps = np.geomspace(self.spacing[0], self.finest, 200)
        for spacing in steps:
            if self.promised(float(spacing)) <= error:
                return float(spacing)
        return math.nan


def _expected(part: Quantity, spacing: float) -> float:
    if part.expansion is None:
        return math.nan
    return float(np.sqrt(np.mean(part.expansion.error(spacing) ** 2))) / part.scale


@dataclass(frozen=True)
class Ladder:
    """The runs of one variant, from coarse to fine."""

    variant: Variant
    records: tuple[Record, ...]
    """Those that reached their end."""
    failed: tuple[Record, ...] = ()
    truth: Ladder | None = field(default=None, repr=False)
    """The ladder whose extrapolation the errors of this one are taken from; None for its own."""

    @property
    def spacing(self) -> Floats:
        """(n,) m."""
        return np.array([record.spacing for record in self.records])

    @property
    def wall(self) -> Floats:
        """(n,) s."""
        return np.array([record.costs.wall for record in self.records])

    @cached_property
    def quantities(self) -> tuple[Quantity, ...]:
        """What its probes recorded."""
        return tuple(quantities(self.records))

    @cached_property
    def cost(self) -> PowerLaw | None:
        """Wall time against spacing; None for times that say nothing: too few, or not alone."""
        if len(self.records) < 2 or not all(record.alone for record in self.records):
            return None
        return observed_order(self.spacing, self.wall)

    @property
    def names(self) -> list[str]:
        """What `curve` knows: errors against references, then quantities, then all of them."""
        scored = [score.name for score in self.records[0].scores] if self.records else []
        own = [quantity.name for quantity in self.quantities]
        single = [f"{name} {statistic}" for name in own for statistic in STATISTICS]
        return [*scored, *own, *single, *([ALL_PROBES] if own else [])]

    @property
    def leading(self) -> str:
        """The error that a study speaks of unless another is asked for.

        That against an exact solution; else that of all probes; but where some probes do not
        converge (an impact is chaotic) and there is an experiment, the distance from it.
        """
        scored = self.records[0].scores if self.records else ()
        if scored and (scored[0].basis == "analytic" or not self._of_all().verdict.sound):
            return scored[0].name
        return ALL_PROBES

    def curve(self, name: str) -> Curve:
        """The curve of an error against a reference, of a quantity, or of all quantities.

        Raises KeyError for a name that is not in `names`.
        """
        if name == ALL_PROBES and self.quantities:
            return self._of_all()
        for quantity in self.quantities:
            if quantity.name == name:
                return self._extrapolated(name, (quantity,))
            for statistic in STATISTICS:
                if name == f"{quantity.name} {statistic}":
                    return self._extrapolated(name, (quantity.reduced(statistic),))
        return self._scored(name)

    def _scored(self, name: str) -> Curve:
        found = [
            (record.spacing, score)
            for record in self.records
            for score in record.scores
            if score.name == name and score.error > 0.0
        ]
        if not found:
            raise KeyError(name)
        spacing = np.array([h for h, _ in found])
        error = np.array([score.error for _, score in found])
        law = observed_order(spacing, error) if len(found) > 1 else None
        verdict = judge_law(law, spacing.tolist(), error.tolist())
        basis: Basis = found[0][1].basis
        if basis == "experiment" and verdict.sound:
            verdict = Verdict(
                "not asymptotic",
                "an experiment has errors of its own, and effects that the scene leaves out: "
                "the distance from it has no order",
            )
        return Curve(name, basis, spacing, error, law, verdict)

    def _of_all(self) -> Curve:
        curves = [self._extrapolated(q.name, (q,)) for q in self.quantities]
        error = np.max([curve.error for curve in curves], axis=0)
        worst = curves[int(np.argmax([np.nan_to_num(curve.error[0]) for curve in curves]))]
        unsound = next((c for c in curves if not c.verdict.sound), None)
        verdict = worst.verdict
        if unsound is not None and verdict.sound:
            verdict = Verdict(unsound.verdict.kind, f"{unsound.name}: {unsound.verdict.reason}")
        elif unsound is not None:
            verdict = Verdict(verdict.kind, f"{worst.name}: {verdict.reason}")
        return Curve(
            ALL_PROBES,
            "extrapolation",
            self.spacing,
            error,
            _law(self.spacing, error),
            verdict,
            self.quantities,
        )

    def _extrapolated(self, name: str, parts: tuple[Quantity, ...]) -> Curve:
        quantity = parts[0]
        error = np.array([quantity.level_error(i) for i in range(len(self.records))])
        if self.truth is not None:
            # Where the base has no such probe, its own extrapolation has to do.
            with contextlib.suppress(KeyError):
                error = distance(quantity, self.truth.curve(name).parts[0])
        law = _law(self.spacing, error)
        return Curve(name, "extrapolation", self.spacing, error, law, quantity.verdict, parts)


def _law(spacing: Floats, error: Floats) -> PowerLaw | None:
    known = np.isfinite(error) & (error > 0.0)
    return observed_order(spacing[known], error[known]) if known.sum() > 1 else None


def distance(quantity: Quantity, truth: Quantity) -> Floats:
    """(n,) RMS distance of a quantity's levels from the extrapolation of another ladder's, share
    of that one's scale."""
    expansion = truth.expansion
    best = expansion.limit if expansion is not None else truth.value[-1]
    at = np.interp(quantity.time, truth.time, best)
    return np.asarray(np.sqrt(np.mean((quantity.value - at) ** 2, axis=1)) / truth.scale)


def ladder(variant: Variant, records: Sequence[Record], truth: Ladder | None = None) -> Ladder:
    """A ladder from records in any order."""
    by_size = sorted(records, key=lambda record: -record.spacing)
    return Ladder(
        variant,
        tuple(record for record in by_size if record.done),
        tuple(record for record in by_size if not record.done),
        truth,
    )
