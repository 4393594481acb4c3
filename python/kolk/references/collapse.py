"""Shallow-water dam breaks: Ritter (dry bed) and Stoker (wet bed)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from kolk.errors import KolkError

FloatArray = npt.NDArray[np.float64]


def ritter(
    x: npt.ArrayLike, time: float, *, depth: float, gravity: float = 9.81
) -> tuple[FloatArray, FloatArray]:
    """Depth (m) and velocity (m/s) at ``x`` (m), the dam at x = 0 with water of ``depth`` at x < 0.

    With c0 = sqrt(g h0) and xi = x/t, between -c0 and 2 c0::

        h = (2 c0 - xi)^2 / (9 g)      u = 2/3 (c0 + xi)

    Depth h0 at rest before, dry after. Frictionless bed, long waves: it knows no vertical
    acceleration, so near the dam and at early times a real collapse is slower.
    Source: Ritter, Zeitschrift des VDI 36 (1892) 947-954.
    """
    if time <= 0.0:
        raise KolkError(f"ritter: time is {time} s; the solution starts after the break: give > 0")
    c0 = np.sqrt(gravity * depth)
    xi = np.clip(np.asarray(x, np.float64) / time, -c0, 2.0 * c0)
    height = (2.0 * c0 - xi) ** 2 / (9.0 * gravity)
    velocity = np.where(height > 0.0, 2.0 / 3.0 * (c0 + xi), 0.0)
    return height, velocity


@dataclass(frozen=True)
class DamBreakStates:
    """Constant state between fan and bore of Stoker's dam break, SI units."""

    depth: float
    """Depth between the tail of the fan and the bore, m."""
    velocity: float
    """Velocity there, m/s."""
    bore_speed: float
    """Speed of the bore, m/s."""
    tail_speed: float
    """Speed of the tail of the fan, m/s; below 0 it runs upstream."""


def stoker_states(upstream: float, downstream: float, *, gravity: float = 9.81) -> DamBreakStates:
    """Middle state for depths ``upstream`` > ``downstream`` > 0, m.

    The middle depth h solves fan = bore::

        2 (sqrt(g h0) - sqrt(g h)) = (h - h1) sqrt(g (h + h1) / (2 h h1))

    and S = u h / (h - h1). Source: Stoker, Water Waves (1957), section 10.8.
    """
    from scipy.optimize import brentq

    if not 0.0 < downstream < upstream:
        raise KolkError(
            f"stoker: depths are {upstream} m upstream and {downstream} m downstream; "
            "allowed is 0 < downstream < upstream (a dry bed is ritter)"
        )

    def fan(h: float) -> float:
        return float(2.0 * (np.sqrt(gravity * upstream) - np.sqrt(gravity * h)))

    def mismatch(h: float) -> float:
        bore = (h - downstream) * np.sqrt(gravity * (h + downstream) / (2.0 * h * downstream))
        return float(fan(h) - bore)

    h = float(brentq(mismatch, downstream, upstream, xtol=1e-15 * upstream, rtol=1e-14))
    u = fan(h)
    return DamBreakStates(
        depth=h,
        velocity=u,
        bore_speed=u * h / (h - downstream),
        tail_speed=float(u - np.sqrt(gravity * h)),
    )


def stoker(
    x: npt.ArrayLike, time: float, *, upstream: float, downstream: float, gravity: float = 9.81
) -> tuple[FloatArray, FloatArray]:
    """Depth (m) and velocity (m/s) at ``x`` (m) for the dam at x = 0; see :func:`stoker_states`.

    Source: Stoker, Water Waves (1957), section 10.8.
    """
    if time <= 0.0:
        raise KolkError(f"stoker: time is {time} s; the solution starts after the break: give > 0")
    states = stoker_states(upstream, downstream, gravity=gravity)
    xi = np.asarray(x, np.float64) / time
    height, velocity = ritter(
        np.minimum(xi, states.tail_speed) * time, time, depth=upstream, gravity=gravity
    )
    middle = (xi > states.tail_speed) & (xi <= states.bore_speed)
    height = np.where(middle, states.depth, height)
    velocity = np.where(middle, states.velocity, velocity)
    ahead = xi > states.bore_speed
    return np.where(ahead, downstream, height), np.where(ahead, 0.0, velocity)
