"""A drop under surface tension against the theory of small oscillations."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from kolk.references import CapillaryDrop

from .fields import FrameLike, fluid
from .result import ComparisonResult

FloatArray = npt.NDArray[np.float64]

CORE = 0.3
"""Part of the radius within which the pressure at the centre is averaged."""


def strain(frame: FrameLike) -> float:
    """Rate (1/s) at which a drop stretches along x and shrinks along y (and z), about its middle.

    A projection on the velocity of the mode n = 2, which is linear: (x, -y), (2 x, -y, -z)/2.
    """
    x, u = fluid(frame, "velocity")
    mode = x - x.mean(axis=0)
    mode[:, 1:] *= -1.0 / (x.shape[1] - 1)
    return float(np.sum((u - u.mean(axis=0)) * mode) / np.sum(mode**2))


def central_pressure(frame: FrameLike, radius: float) -> float:
    """Mean pressure (Pa) near the middle of a drop."""
    x, p = fluid(frame, "pressure")
    near = np.sum((x - x.mean(axis=0)) ** 2, axis=1) < (CORE * radius) ** 2
    return float(p[near].mean())


def fit_oscillation(time: FloatArray, rate: FloatArray, drop: CapillaryDrop) -> tuple[float, float]:
    """Angular frequency (rad/s) and damping (1/s) of ``rate`` = a e^(-nt) cos(wt + b).

    NaN where no such oscillation is found. ``drop``: where to look first.
    """
    from scipy.optimize import curve_fit

    def decaying(t: FloatArray, a: float, n: float, w: float, b: float) -> FloatArray:
        return np.asarray(a * np.exp(-n * t) * np.cos(w * t + b))

    scale, unit = float(np.max(np.abs(rate))), drop.frequency
    try:
        found, _ = curve_fit(decaying, time * unit, rate / scale, p0=(1.0, 0.0, 1.0, 0.0))
    except RuntimeError:
        return math.nan, math.nan
    return float(found[2]) * unit, float(found[1]) * unit


def compare_capillary_drop(
    frames: Sequence[FrameLike], drop: CapillaryDrop
) -> list[ComparisonResult]:
    """Frequency and mean pressure at the centre, over whole periods.

    Nothing for a record shorter than a period, or where nothing oscillates.
    """
    time = np.array([frame.time for frame in frames])
    if len(time) < 8 or time[-1] < 0.999 * drop.period:
        return []
    frequency, _ = fit_oscillation(time, np.array([strain(f) for f in frames]), drop)
    if not math.isfinite(frequency):
        return []
    whole = time <= math.floor(1.001 * time[-1] / drop.period) * drop.period * 1.001
    pressure = np.array([central_pressure(f, drop.radius) for f in frames])[whole]
    mean = float(np.trapezoid(pressure, time[whole]) / np.ptp(time[whole]))
    rows = (
        ("frequency", frequency, drop.frequency, "rad/s", "Rayleigh's drop"),
        ("mean pressure at the centre", mean, drop.pressure, "Pa", "Laplace's pressure"),
    )
    return [
        ComparisonResult(
            name=name,
            probe="drop",
            value=value,
            reference=exact,
            unit=unit,
            sentence=(
                f"Over {time[-1] / drop.period:.3g} periods the {name} is {value:.4g} {unit}; "
                f"in theory {exact:.4g} ({value / exact - 1.0:+.1%})."
            ),
            source=source,
            details={"relative_error": value / exact - 1.0, "time": float(time[-1])},
        )
        for name, value, exact, unit, source in rows
    ]


def drop_of(parameters: dict[str, float]) -> CapillaryDrop:
    """The drop that the parameters of a comparison name."""
    return CapillaryDrop(
        radius=parameters["radius"],
        tension=parameters["tension"],
        density=parameters["density"],
        viscosity=parameters.get("viscosity", 0.0),
        dimension=int(parameters.get("dimension", 2)),
    )
