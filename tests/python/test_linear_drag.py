"""Linear drag: Darcy's law, against its exact solutions."""

from __future__ import annotations

import math

import numpy as np
import pytest

import kolk
from kolk.errors import SceneError

RATE = 3.0
SPEED = 0.5


def box(**about: object) -> kolk.Scene:
    """Fluid that fills a periodic square, slowed by drag."""
    return kolk.Scene(
        **{
            "name": "porous",
            "dimension": 2,
            "spacing": 0.1,
            "until": 1.0,
            "periodic": {"x": [0.0, 1.0], "y": [0.0, 1.0]},
            "fluid": [
                {
                    "name": "water",
                    "shape": {"box": {"from": [0.0, 0.0], "to": [1.0, 1.0]}},
                    "velocity": [SPEED, 0.0],
                    "drag": RATE,
                }
            ],
            **about,
        }
    )


def speed(scene: kolk.Scene, until: float) -> tuple[float, kolk.Simulation]:
    """Mean speed along x at a time, m/s."""
    sim = kolk.Simulation(scene, precision="f64")
    sim.advance_to(until)
    return float(np.mean(sim.bodies["water"].velocity[:, 0])), sim


@pytest.mark.parametrize("integrator", ["symplectic", "predictor-corrector", "rk4"])
def test_a_stream_slows_down_exponentially_with_the_order_of_the_integrator(
    integrator: str,
) -> None:
    exact = SPEED * math.exp(-RATE * 0.8)
    errors = []
    for step in (0.01, 0.005):
        numerics = {"time_step": step, "integrator": integrator, "expected_speed": SPEED}
        errors.append(abs(speed(box(numerics=numerics), 0.8)[0] / exact - 1.0))
    assert errors[0] < 1e-2
    least = {"symplectic": 0.9, "predictor-corrector": 1.9, "rk4": 3.9}[integrator]
    assert errors[1] < 1e-11 or math.log2(errors[0] / errors[1]) > least


def test_under_gravity_it_nears_darcys_speed() -> None:
    scene = box(gravity=[6.0, 0.0]).replace(
        {"fluid.water.velocity": None, "numerics.expected_speed": 2.0}
    )
    found, _ = speed(scene, 4.0)
    assert found == pytest.approx(6.0 / RATE * (1.0 - math.exp(-4.0 * RATE)), rel=1e-3)


def test_what_it_takes_stands_in_the_energy_budget() -> None:
    # The budget is audited in one step of several: many short ones.
    scene = box(numerics={"expected_speed": SPEED, "time_step": 5e-4})
    before = 0.5 * 1000.0 * SPEED**2
    _, sim = speed(scene, 0.5)
    taken = sim.energy.dissipated["linear drag"]
    assert taken == pytest.approx(before * (1.0 - math.exp(-2.0 * RATE * 0.5)), rel=5e-3)
    assert sim.energy.kinetic + taken == pytest.approx(before, rel=5e-3)


def test_a_rate_beyond_that_of_sound_shortens_the_step() -> None:
    fast = box(numerics={"expected_speed": SPEED}).replace({"fluid.water.drag": 1e4})
    _, sim = speed(fast, 0.002)
    assert sim.time_step <= 0.8 / 1e4 * (1.0 + 1e-12)
    assert sim.steps_by_limit["viscous"] > 0


def test_a_rate_is_above_zero() -> None:
    with pytest.raises(SceneError, match=r"fluid\.water\.drag"):
        box().replace({"fluid.water.drag": 0.0})
