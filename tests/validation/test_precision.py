"""Mixed precision gives no accuracy away: it moves an error by less than a tenth of it."""

from __future__ import annotations

import pytest

from . import running
from .suite import get

SMOOTH = {
    "taylor_green": 50,
    "still_water": 25,
    "channel_flow": 20,
    "stretching_drop": 25,
    "standing_wave": 25,
}
"""Flows whose outcome is not chance: a splash differs as much between two runs of one precision."""


@pytest.mark.validation
@pytest.mark.parametrize(("name", "resolution"), SMOOTH.items())
def test_mixed_precision_moves_an_error_by_less_than_a_tenth(
    name: str, resolution: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = get(name)
    mixed = case.run(resolution).figures
    monkeypatch.setattr(running, "PRECISION", "f64")
    double = case.run(resolution).figures
    for ours, theirs in zip(mixed, double, strict=True):
        print(f"{name}: {ours.name}: mixed {ours.value:.6g}, f64 {theirs.value:.6g}")
        assert abs(ours.value - theirs.value) < 0.1 * theirs.value, ours.name
