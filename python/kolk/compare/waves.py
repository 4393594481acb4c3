"""A standing wave against the linear one: its damping and its frequency."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from kolk import references
from kolk.references import StandingWave

from .fields import FrameLike, fluid
from .result import ComparisonResult

FloatArray = npt.NDArray[np.float64]

FEWEST_PERIODS = 1.0
"""Of a record that a damping rate can be read off."""


def mode_share(frame: FrameLike, wave: StandingWave, bed: float = 0.0) -> float:
    """Share of the wave's first mode in the velocity of the fluid: 1 for the linear wave at t = 0.

    A projection: what else moves, higher harmonics among it, does not count. bed: its height, m.
    """
    x, u = fluid(frame, "velocity")
    mode = wave.velocity(x - np.array([0.0, bed + wave.depth]), 0.0)
    return float(np.sum(u * mode) / np.sum(mode**2))


def fit_wave(time: FloatArray, share: FloatArray, wave: StandingWave) -> tuple[float, float]:
    """Angular frequency (rad/s) and damping (1/s) of ``share`` = a e^(nt) cos(wt + b).

    NaN where no such wave is found. ``wave``: where to look first.
    """
    from scipy.optimize import curve_fit

    def decaying(t: FloatArray, a: float, n: float, w: float, b: float) -> FloatArray:
        return np.asarray(a * np.exp(n * t) * np.cos(w * t + b))

    try:
        guess = (1.0, wave.damping, wave.frequency, 0.0)
        found, _ = curve_fit(decaying, time, share, p0=guess)
    except RuntimeError:
        return math.nan, math.nan
    return float(found[2]), float(found[1])


def compare_standing_wave(
    frames: Sequence[FrameLike], wave: StandingWave, bed: float = 0.0
) -> list[ComparisonResult]:
    """Damping rate and frequency of the first mode against the linear roots.

    Nothing for a record shorter than a period, or where no wave is found.
    """
    time = np.array([frame.time for frame in frames])
    if len(time) < 8 or time[-1] < FEWEST_PERIODS * wave.period:
        return []
    share = np.array([mode_share(frame, wave, bed) for frame in frames])
    frequency, damping = fit_wave(time, share, wave)
    if not math.isfinite(frequency):
        return []
    source = "linear standing wave with viscosity"
    rows = (
        ("damping rate", damping, wave.damping, "1/s"),
        ("frequency", frequency, wave.frequency, "rad/s"),
    )
    return [
        ComparisonResult(
            name=name,
            probe="velocity",
            value=value,
            reference=exact,
            unit=unit,
            sentence=(
                f"Over {time[-1] / wave.period:.3g} periods the {name} is {value:.4g} {unit}; "
                f"that of the linear wave is {exact:.4g} ({value / exact - 1.0:+.1%})."
            ),
            source=source,
            details={"relative_error": value / exact - 1.0, "time": float(time[-1])},
        )
        for name, value, exact, unit in rows
    ]


def wave_of(parameters: dict[str, float]) -> StandingWave:
    """The wave that the parameters of a comparison name."""
    return references.standing_wave(
        wavelength=parameters["wavelength"],
        depth=parameters["depth"],
        amplitude=parameters["amplitude"],
        viscosity=parameters.get("viscosity", 0.0),
        gravity=parameters["gravity"],
    )
