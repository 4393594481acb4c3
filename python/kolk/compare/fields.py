"""Whole fields against analytic solutions: Taylor-Green, channel flows, still water."""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from kolk import references

from .norms import norms
from .result import ComparisonResult

FloatArray = npt.NDArray[np.float64]


class FrameLike(Protocol):
    """What a comparison or a picture needs of a frame."""

    time: float

    @property
    def position(self) -> npt.NDArray[Any]: ...
    def rows(self, kind: str) -> npt.NDArray[np.bool_]: ...
    def field(self, name: str) -> npt.NDArray[Any]: ...


def fluid(frame: FrameLike, *names: str) -> list[FloatArray]:
    """Positions (m, D) of the fluid particles of a frame, then each field (m,) or (m, D)."""
    wet = frame.rows("fluid")
    return [np.asarray(frame.position, np.float64)[wet]] + [
        np.asarray(frame.field(name), np.float64)[wet] for name in names
    ]


def compare_taylor_green(
    first: FrameLike, frame: FrameLike, *, viscosity: float, speed: float, length: float
) -> list[ComparisonResult]:
    """Decay of the velocity since ``first``, and the L1 and L2 norms of the velocity error.

    viscosity: kinematic, m^2/s; speed: largest at t = 0, m/s; length: period, m.
    """
    (_, before), (x, u) = fluid(first, "velocity"), fluid(frame, "velocity")
    rate = references.taylor_green_decay_rate(viscosity, length)
    expected = math.exp(rate * (frame.time - first.time))
    decay = _rms(u) / _rms(before)
    exact, _ = references.taylor_green(
        x, frame.time, viscosity=viscosity, speed=speed, length=length
    )
    error = norms(u, exact)
    source = "Taylor-Green vortex (Taylor & Green 1937)"
    reynolds = speed * length / viscosity
    return [
        ComparisonResult(
            name="decay of the velocity",
            probe="velocity",
            value=decay,
            reference=expected,
            unit="1",
            sentence=(
                f"At t = {frame.time:.3g} s the velocity (RMS) is down to {decay:.4f} of its "
                f"start; the exact decay at Re {reynolds:.3g} is {expected:.4f} "
                f"({decay / expected - 1.0:+.1%})."
            ),
            source=source,
            details={"relative_error": decay / expected - 1.0, "time": frame.time},
        ),
        _norm_result("velocity", error.l1, error.l2, error.largest, frame.time, source),
    ]


def compare_channel(
    frame: FrameLike,
    kind: str,
    *,
    width: float,
    viscosity: float,
    drive: float,
    origin: float = 0.0,
    along: int = 0,
    across: int = 1,
) -> list[ComparisonResult]:
    """Velocity along a channel against the series of Morris 1997.

    kind: ``poiseuille`` (drive: body force, m/s^2) or ``couette`` (drive: plate speed, m/s).
    The lower plate lies at ``origin`` (m) of axis ``across``, the flow goes along axis ``along``.
    """
    x, u = fluid(frame, "velocity")
    y = x[:, across] - origin
    if kind == "poiseuille":
        exact = references.poiseuille(
            y, frame.time, width=width, viscosity=viscosity, acceleration=drive
        )
    else:
        exact = references.couette(y, frame.time, width=width, viscosity=viscosity, speed=drive)
    error = norms(u[:, along], exact, scale=float(np.abs(exact).max()))
    source = f"{kind.capitalize()} flow, series of Morris et al. 1997"
    return [
        ComparisonResult(
            name="velocity profile, L2",
            probe="velocity",
            value=error.l2,
            reference=None,
            unit="1",
            sentence=(
                f"At t = {frame.time:.3g} s the velocity profile is {error.l2:.2%} (L2) of the "
                f"largest velocity away from the series; L1 {error.l1:.2%}, largest error "
                f"{error.largest:.2%}."
            ),
            source=source,
            details={"l1": error.l1, "largest": error.largest, "time": frame.time},
        )
    ]


def compare_hydrostatic(
    frame: FrameLike, *, surface: float, bottom: float, density: float, gravity: float, up: int = -1
) -> list[ComparisonResult]:
    """Pressure and motion of water that should stand still.

    surface, bottom: heights (m) along axis ``up``; the error is given as a share of rho g H.
    """
    x, p, u = fluid(frame, "pressure", "velocity")
    depth = surface - bottom
    exact = references.hydrostatic_pressure(
        x[:, up], surface=surface, density=density, gravity=gravity
    )
    error = norms(p, exact, scale=density * gravity * depth)
    # particles have equal masses: the mass cancels in the ratio of the energies
    energy = 0.5 * float(np.mean(np.sum(u**2, axis=1))) / (gravity * depth)
    source = "hydrostatic pressure rho g (H - z)"
    return [
        ComparisonResult(
            name="pressure, L2",
            probe="pressure",
            value=error.l2,
            reference=None,
            unit="rho g H",
            sentence=(
                f"At t = {frame.time:.3g} s the pressure is {error.l2:.2%} of rho g H (L2) from "
                f"hydrostatic; L1 {error.l1:.2%}, largest error {error.largest:.2%}."
            ),
            source=source,
            details={"l1": error.l1, "largest": error.largest, "time": frame.time},
        ),
        ComparisonResult(
            name="kinetic energy",
            probe="velocity",
            value=energy,
            reference=0.0,
            unit="m g H",
            sentence=(
                f"At t = {frame.time:.3g} s the kinetic energy of the water is {energy:.1e} m g H; "
                "still water has none."
            ),
            source=source,
            details={"time": frame.time},
        ),
    ]


def _norm_result(
    probe: str, l1: float, l2: float, largest: float, time: float, source: str
) -> ComparisonResult:
    return ComparisonResult(
        name=f"{probe}, L2",
        probe=probe,
        value=l2,
        reference=None,
        unit="1",
        sentence=(
            f"At t = {time:.3g} s the {probe} is {l2:.2%} (L2) from the exact solution; "
            f"L1 {l1:.2%}, largest error {largest:.2%}."
        ),
        source=source,
        details={"l1": l1, "largest": largest, "time": time},
    )


def _rms(u: FloatArray) -> float:
    return float(np.sqrt(np.mean(np.sum(u**2, axis=-1))))
