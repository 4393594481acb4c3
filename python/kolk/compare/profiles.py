"""Liquids with yield stress against what is known of them: a channel's profile, a slump's reach."""

from __future__ import annotations

from typing import Any

import numpy as np

from kolk import references

from .fields import FrameLike, fluid
from .norms import norms
from .result import ComparisonResult


def compare_yielding_channel(frame: FrameLike, **flow: Any) -> list[ComparisonResult]:
    """Velocity along a channel (axis x, heights from y = 0) against the steady profile.

    ``flow``: the arguments of `references.herschel_bulkley` but the heights.
    """
    x, u = fluid(frame, "velocity")
    exact = references.herschel_bulkley(x[:, 1], **flow)
    error = norms(u[:, 0], exact, scale=float(exact.max()))
    return [
        ComparisonResult(
            name="velocity profile, L2",
            probe="velocity",
            value=error.l2,
            reference=None,
            unit="1",
            sentence=(
                f"At t = {frame.time:.3g} s the velocity profile is {error.l2:.2%} (L2) of the "
                f"plug's velocity away from the steady one; largest error {error.largest:.2%}."
            ),
            source="steady flow of a Herschel-Bulkley liquid (Bird et al. 1987)",
            details={"l1": error.l1, "largest": error.largest, "time": frame.time},
        )
    ]


def compare_slump(frame: FrameLike, spacing: float, **mud: float) -> list[ComparisonResult]:
    """How far a heap has run from x = 0, against the shape at which its yield stress holds it.

    ``mud``: the arguments of `references.slump`.
    """
    (x,) = fluid(frame)
    reach = float(np.max(x[:, 0])) + 0.5 * spacing
    exact = references.slump(**mud)
    return [
        ComparisonResult(
            name="run-out",
            probe="front_x",
            value=reach,
            reference=exact,
            unit="m",
            sentence=(
                f"At t = {frame.time:.3g} s the mud has run {reach:.3f} m; a heap that comes to "
                f"rest slowly stops at {exact:.3f} m ({reach / exact - 1.0:+.1%})."
            ),
            source="final shape of Bingham mud (Liu & Mei 1989)",
            details={"relative_error": reach / exact - 1.0, "time": frame.time},
        )
    ]
