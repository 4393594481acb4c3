"""What a picture shows of a frame: values, their label, their range of colours."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.colors import Normalize

from kolk.compare.fields import FrameLike, fluid

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Scales:
    """Sizes that make pictures of a case dimensionless, as its experiment does; SI."""

    depth: float
    """H, m."""
    gravity: float
    density: float

    @property
    def time(self) -> float:
        """sqrt(H/g), s."""
        return math.sqrt(self.depth / self.gravity)

    @property
    def speed(self) -> float:
        """sqrt(g H), m/s."""
        return math.sqrt(self.gravity * self.depth)

    @property
    def pressure(self) -> float:
        """rho g H, Pa."""
        return self.density * self.gravity * self.depth


@dataclass(frozen=True)
class Quantity:
    """A field of the fluid and the unit in which it is shown."""

    name: str
    label: str
    unit: float
    """SI value of one on the colour bar."""

    def of(self, frame: FrameLike) -> tuple[FloatArray, FloatArray]:
        """Positions (m, D) of the fluid and the values (m,) in this quantity's unit."""
        if self.name == "speed":
            x, velocity = fluid(frame, "velocity")
            return x, np.linalg.norm(velocity, axis=1) / self.unit
        x, value = fluid(frame, self.name)
        return x, value / self.unit


@dataclass(frozen=True)
class FreeSurface(Quantity):
    """1 for the particles of the free surface, 0 inside (:func:`kolk.free_surface`).

    The particles of walls count as neighbours: a wall is no free surface.
    """

    smoothing_length: float
    """m."""
    kernel: str
    spacing: float
    """m."""
    periods: tuple[tuple[float, float] | None, ...]

    def of(self, frame: FrameLike) -> tuple[FloatArray, FloatArray]:
        from kolk import free_surface

        x = np.asarray(frame.position, np.float64)
        volume = np.full(len(x), self.spacing ** x.shape[1])
        on, _, _ = free_surface(
            x,
            volume,
            np.ones(len(x)),
            self.smoothing_length,
            self.kernel,
            periodic=self.periods,
        )
        wet = frame.rows("fluid")
        return x[wet], on[wet].astype(np.float64)


_PREFIXES = (("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6))


def quantity(name: str, scales: Scales | None = None, sample: Iterable[FrameLike] = ()) -> Quantity:
    """``speed``, ``pressure`` or ``density``; dimensionless where the case has scales.

    Otherwise in the SI unit whose prefix suits the largest values of the frames in ``sample``.
    """
    plain = _quantity(name, scales)
    if scales or name not in {"speed", "pressure"}:
        return plain
    peaks = [
        float(np.percentile(np.abs(v), 99.5)) for v in (plain.of(f)[1] for f in sample) if len(v)
    ]
    top = max(peaks, default=1.0) * plain.unit
    allowed = _PREFIXES if name == "pressure" else _PREFIXES[1:]
    prefix, unit = next((p for p in allowed if top >= p[1]), ("", 1.0) if top == 0 else allowed[-1])
    # 0.3 m/s reads better than 300 mm/s
    if name == "speed" and unit == 1e-3 and top >= 0.05:
        prefix, unit = "", 1.0
    return Quantity(name, f"{name} [{prefix}{'m/s' if name == 'speed' else 'Pa'}]", unit)


def _quantity(name: str, scales: Scales | None) -> Quantity:
    if name == "speed":
        if scales:
            return Quantity(name, r"speed / $\sqrt{gH}$", scales.speed)
        return Quantity(name, "speed [m/s]", 1.0)
    if name == "pressure":
        if scales:
            return Quantity(name, r"pressure / $\rho g H$", scales.pressure)
        return Quantity(name, "pressure [Pa]", 1.0)
    return Quantity(name, f"{name} [kg/m³]" if name == "density" else name, 1.0)


def colour_range(shown: Quantity, frames: Iterable[FrameLike]) -> Normalize:
    """One range for several frames: 0 to the 99.5th percentile, below 0 only where much is.

    Percentiles, so that the few particles of an impact do not darken the rest.
    """
    ends = [np.percentile(v, [0.5, 99.5]) for v in (shown.of(f)[1] for f in frames) if len(v)]
    low, high = (min(e[0] for e in ends), max(e[1] for e in ends)) if ends else (0.0, 1.0)
    # a density lies near its reference, far from 0; the other fields start at 0
    if shown.name != "density" and low > -0.1 * abs(high):
        low = 0.0
    return Normalize(float(low), float(high) if high > low else float(low) + 1.0)


def time_label(time: float, scales: Scales | None = None) -> str:
    """``t = 0.42 s`` and, where the case has scales, the same in sqrt(H/g)."""
    text = f"t = {time:.3f} s" if 0.0 < time < 0.1 else f"t = {time:.2f} s"
    if scales:
        text += rf"  ({time / scales.time:.2f} $\sqrt{{H/g}}$)"
    return text


def spread(frames: Sequence[FrameLike], count: int) -> list[int]:
    """Indices of ``count`` frames spread evenly over a series, the last included.

    The start is left out where there are enough frames: nothing has moved yet.
    """
    last = len(frames) - 1
    if last < count:
        return list(range(last + 1))
    return sorted({round(last * (i + 1) / count) for i in range(count)})
