"""Two-dimensional drops with a linear velocity field: they stay ellipses, so ODEs describe them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class DropHistory:
    """Semi-axes and strain rate of an elliptical drop against time, each (n,), SI units."""

    time: FloatArray
    x: FloatArray
    """Semi-axis along x, m."""
    y: FloatArray
    """Semi-axis along y, m."""
    rate: FloatArray
    """A of the velocity field (-A x, A y), 1/s."""
    centre_pressure: FloatArray
    """p_c of p = p_c (1 - x^2/a^2 - y^2/b^2), Pa."""


def stretching_drop(
    time: npt.ArrayLike, *, radius: float = 1.0, rate: float = 100.0, density: float = 1000.0
) -> DropHistory:
    """A disc of ``radius`` (m) that starts with the velocity (-A0 x, A0 y), free of any force.

    ``a' = -A a, b' = A b, A' = A^2 (a^2 - b^2)/(a^2 + b^2)``, ``p_c = rho a^2 (A^2 - A')/2``.
    ``time`` ascending from 0, s; ``rate`` A0, 1/s. Incompressible and inviscid.
    Source: Monaghan, J. Comput. Phys. 110 (1994) 399-406; the pressure follows from Euler's
    equation along x.
    """
    return _ellipse(time, radius, rate, 0.0, density)


def oscillating_drop(
    time: npt.ArrayLike,
    *,
    radius: float = 1.0,
    rate: float = 1.0,
    force: float = 1.0,
    density: float = 1000.0,
) -> DropHistory:
    """The same under the central force -B^2 r per mass, ``force`` = B in 1/s: it oscillates.

    ``a' = -A a, b' = A b, A' = (A^2 + B^2)(a^2 - b^2)/(a^2 + b^2)``,
    ``p_c = rho a^2 (A^2 + B^2 - A')/2``. For A0 = B the period is 4.82734/B.
    Source: Monaghan and Rafiee, Int. J. Numer. Meth. Fluids 71 (2013) 537-561.
    """
    return _ellipse(time, radius, rate, force, density)


def oscillating_drop_period(rate: float = 1.0, force: float = 1.0) -> float:
    """Period of :func:`oscillating_drop`, s: twice the time from one A = 0 (extreme) to the next.

    Found from the ODE; 4.82734/B for A0 = B.
    """
    from scipy.integrate import solve_ivp

    def extreme(_t: float, state: FloatArray) -> float:
        return float(state[1])

    solved = solve_ivp(
        _slope(force), (0.0, 40.0 / force), [0.0, rate], events=extreme, rtol=1e-11, atol=1e-13
    )
    crossings = solved.t_events[0]
    return float(2.0 * (crossings[1] - crossings[0]))


def _slope(force: float) -> Callable[[float, FloatArray], list[float]]:
    """Right-hand side for (ln(a/R), A): a b = R^2 leaves one axis; the logarithm keeps it > 0."""

    def slope(_t: float, state: FloatArray) -> list[float]:
        stretch, rate = state
        # (a^2 - b^2)/(a^2 + b^2) with a = R e^s, b = R e^-s
        return [-rate, (rate**2 + force**2) * np.tanh(2.0 * stretch)]

    return slope


def _ellipse(
    time: npt.ArrayLike, radius: float, rate: float, force: float, density: float
) -> DropHistory:
    from scipy.integrate import solve_ivp

    t = np.atleast_1d(np.asarray(time, np.float64))
    slope = _slope(force)
    solved = solve_ivp(
        slope, (0.0, max(float(t[-1]), 1e-300)), [0.0, rate], t_eval=t, rtol=1e-11, atol=1e-13
    )
    stretch, strain = solved.y
    a = radius * np.exp(stretch)
    change = (strain**2 + force**2) * np.tanh(2.0 * stretch)
    return DropHistory(
        time=t,
        x=a,
        y=radius * np.exp(-stretch),
        rate=strain,
        centre_pressure=0.5 * density * a**2 * (strain**2 + force**2 - change),
    )
