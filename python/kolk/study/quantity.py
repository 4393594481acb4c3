"""What converges: the records of one probe over a ladder, set on one clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .expansion import Expansion, expand
from .record import Track
from .verdict import Verdict, judge_expansion

Floats = NDArray[np.float64]

INSTANTS = 200
"""Most instants of the common clock."""

STATISTICS = ("mean", "largest", "last")
"""Single figures of a record: over all of it, at its highest, and over its last tenth."""

LAST = 0.1

COMPRESSIBLE = 2.0
"""Share of a quantity's scale that a weakly compressible fluid may be off an incompressible one,
over its compression: the error of the model, which no spacing removes (of order Ma², Monaghan
1994). A column of still water, compressed by δ at its bottom, shows 1.8 δ there."""


@dataclass(frozen=True)
class Quantity:
    """One column of a probe on every level of a ladder, from coarse to fine."""

    name: str
    """Such as `P2`, `plates.x`."""
    kind: str
    """pressure, level, front, force, velocity, energy, ..."""
    unit: str
    spacing: Floats
    """(n,) m, falling."""
    time: Floats
    """(m,) s."""
    value: Floats
    """(n, m)."""
    scale: float
    """Largest size of the quantity, in its unit: what errors are shares of."""
    expansion: Expansion | None = field(repr=False)
    """Of the whole record; None for fewer than three levels."""
    verdict: Verdict
    floor: float = 0.0
    """Share of the scale that the compressibility of the fluid adds to every error bar."""

    def level_error(self, level: int) -> float:
        """Distance (RMS over time) of a level from the extrapolated record, share of the scale.

        Without an extrapolation, from the finest level; NaN for that one itself.
        """
        if self.expansion is None:
            if level == len(self.spacing) - 1:
                return float("nan")
            return _rms(self.value[level] - self.value[-1]) / self.scale
        return _rms(self.expansion.level_error(level)) / self.scale

    def level_bar(self, level: int) -> float:
        """Half-width (RMS over time) of a level's error bar, share of the scale; NaN if unknown."""
        if self.expansion is None:
            return float("nan")
        return _rms(self.expansion.level_bar(level)) / self.scale + self.floor

    def bar_at(self, spacing: float) -> float:
        """Half-width of the error bar of a run at any spacing (m), share of the scale."""
        if self.expansion is None:
            return float("nan")
        expansion = self.expansion
        off = np.full_like(expansion.limit, expansion.scatter)
        return _rms(expansion.bar(spacing, off)) / self.scale + self.floor

    def statistic(self, name: str) -> Floats:
        """(n,) one of STATISTICS of every level."""
        if name == "mean":
            return np.asarray(self.value.mean(axis=1))
        if name == "largest":
            return np.asarray(self.value[:, self._peak()])
        return np.asarray(self.value[:, -max(1, round(LAST * len(self.time))) :].mean(axis=1))

    def statistic_bar(self, name: str, level: int) -> float:
        """Half-width of the error bar of a statistic of a level, in the quantity's unit."""
        if len(self.spacing) < 3:
            return float("nan")
        bar = float(expand(self.spacing, self.statistic(name)).level_bar(level)[0])
        return bar + self.floor * self.scale

    def reduced(self, statistic: str) -> Quantity:
        """One of STATISTICS as a quantity of its own, on the same scale."""
        value = self.statistic(statistic)[:, None]
        expansion = expand(self.spacing, value) if len(set(self.spacing)) >= 3 else None
        return Quantity(
            f"{self.name} {statistic}",
            self.kind,
            self.unit,
            self.spacing,
            self.time[-1:],
            value,
            self.scale,
            expansion,
            judge_expansion(expansion, self.spacing.tolist(), self.scale),
            self.floor,
        )

    def _peak(self) -> int:
        """The instant at which the finest level is largest."""
        return int(np.argmax(np.abs(self.value[-1])))


class Recorded(Protocol):
    """As much of a `Record` as is needed here."""

    @property
    def spacing(self) -> float: ...
    @property
    def compression(self) -> float: ...
    @property
    def tracks(self) -> Mapping[str, Track]: ...


def quantities(records: Sequence[Recorded]) -> list[Quantity]:
    """Every column of every probe that all records have, from coarse to fine.

    Columns that are zero to rounding on all levels (a sensor that stays dry) are left out.
    """
    by_size = sorted(records, key=lambda record: -record.spacing)
    floor = COMPRESSIBLE * by_size[-1].compression if by_size else 0.0
    found: list[Quantity] = []
    for name in by_size[0].tracks if by_size else ():
        tracks = [record.tracks[name] for record in by_size if name in record.tracks]
        if len(tracks) == len(by_size) and all(len(track.rows) > 1 for track in tracks):
            spacing = np.array([record.spacing for record in by_size])
            found += _columns(tracks, spacing, floor)
    return found


def _columns(tracks: Sequence[Track], spacing: Floats, floor: float) -> list[Quantity]:
    first = tracks[0]
    clock = common_clock(tracks)
    values = {
        column: np.array([np.interp(clock, t.rows[:, 0], t.rows[:, 1 + i]) for t in tracks])
        for i, column in enumerate(first.columns)
    }
    # Components of a vector share a scale: the small ones are no worse for being small.
    vector = [c for c in first.columns if c in ("x", "y", "z")]
    length = float(np.sqrt(sum(values[c][-1] ** 2 for c in vector)).max()) if vector else 0.0
    found = []
    for column, value in values.items():
        scale = length if column in vector else _scale(first.quantity, value[-1])
        size = float(np.max(np.abs(value)))
        if not scale or size < 1e-9 * max(scale, 1e-30) or not np.isfinite(value).all():
            continue
        if column in vector and size < 1e-3 * scale:
            continue
        name = first.name if column == "value" else f"{first.name}.{column}"
        expansion = expand(spacing, value) if len(set(spacing)) >= 3 else None
        verdict = judge_expansion(expansion, spacing.tolist(), scale)
        unit = first.unit.split(",")[0]
        found.append(
            Quantity(
                name,
                first.quantity,
                unit,
                spacing,
                clock,
                value,
                scale,
                expansion,
                verdict,
                floor,
            )
        )
    return found


def common_clock(tracks: Sequence[Track]) -> Floats:
    """Instants that all records cover, as many as the shortest has, at most INSTANTS."""
    start = max(float(track.rows[0, 0]) for track in tracks)
    end = min(float(track.rows[-1, 0]) for track in tracks)
    count = min(INSTANTS, *(len(track.rows) for track in tracks))
    return np.linspace(start, end, max(count, 2))


def _scale(kind: str, finest: Floats) -> float:
    """A front's way, since its origin is anyone's choice; of anything else its largest size."""
    if kind == "front":
        return float(np.ptp(finest)) or float(np.max(np.abs(finest)))
    return float(np.max(np.abs(finest)))


def _rms(x: Floats) -> float:
    return float(np.sqrt(np.mean(x**2)))
