"""One figure of a run set beside one figure of a reference."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class ComparisonResult:
    """One figure of a run and what it should be."""

    name: str
    """What is compared, such as ``first peak``."""
    probe: str
    """Probe or field that the figure comes from."""
    value: float
    """The run's figure; NaN where the run does not reach so far (``sentence`` says so)."""
    reference: float | tuple[float, float] | None
    """The reference's figure, its range (low, high), or None where 0 is meant: an error norm."""
    unit: str
    sentence: str
    """The same in plain English."""
    source: str = ""
    """Title of the reference."""
    details: Mapping[str, float] = field(default_factory=dict)
    """Further figures: the shift in time, the stretch compared, ..."""

    def as_dict(self) -> dict[str, object]:
        """JSON-ready; NaN becomes None because JSON has none."""
        reference: object = self.reference
        if isinstance(self.reference, tuple):
            reference = [_plain(x) for x in self.reference]
        elif self.reference is not None:
            reference = _plain(self.reference)
        return {
            "name": self.name,
            "probe": self.probe,
            "value": _plain(self.value),
            "reference": reference,
            "unit": self.unit,
            "sentence": self.sentence,
            "source": self.source,
            "details": {key: _plain(x) for key, x in self.details.items()},
        }


def _plain(x: float) -> float | None:
    return float(x) if math.isfinite(x) else None
