"""Mixed precision costs next to nothing: less than a tenth of the discretisation's own error."""

import math
from typing import Literal

import numpy as np
import numpy.typing as npt
import pytest

import kolk
from kolk.references import hydrostatic_pressure, poiseuille, stretching_drop, taylor_green

Precision = Literal["f64", "mixed"]
Field = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]
"""Values of the simulation, and what they should be."""


def vortex(precision: Precision) -> Field:
    """Speed (RMS) of the Taylor-Green vortex: its disordered particles part like any chaos."""
    sim = kolk.Simulation(kolk.load("taylor-green"), precision=precision, threads=1)
    fluid = sim.bodies["fluid"]
    speeds = []
    times = (0.1, 0.2, 0.3, 0.4, 0.5)
    for time in times:
        sim.advance_to(time)
        exact, _ = taylor_green(fluid.position, time, viscosity=0.01)
        speeds.append((_rms(fluid.velocity), _rms(exact)))
    found, wanted = np.array(speeds).T
    return found, wanted


def channel(precision: Precision) -> Field:
    """Velocity of every particle of the Poiseuille flow."""
    sim = kolk.Simulation(
        kolk.load("poiseuille").replace(spacing=1e-3 / 25), precision=precision, threads=1
    )
    sim.advance_to(0.2)
    fluid = sim.bodies["fluid"]
    exact = poiseuille(fluid.position[:, 1], 0.2, width=1e-3, viscosity=1e-6, acceleration=2e-4)
    return fluid.velocity[:, 0], exact


def water(precision: Precision) -> Field:
    """Pressure of every particle of the still water, before it could begin to wander."""
    sim = kolk.Simulation(kolk.load("still-water"), precision=precision, threads=1)
    sim.advance_to(math.sqrt(0.5 / 9.81))
    fluid = sim.bodies["water"]
    return fluid.pressure, hydrostatic_pressure(fluid.position[:, 1], surface=0.5)


def drop(precision: Precision) -> Field:
    """Position of every particle of a stretching drop: a linear map of where it started."""
    until = 0.004
    scene = kolk.Scene(
        name="drop",
        dimension=2,
        spacing=0.05,
        until=until,
        fluid=[
            {
                "name": "drop",
                "shape": {"disc": {"centre": [0.0, 0.0], "radius": 1.0}},
                "velocity": ["-100 * x", "100 * y"],
                "pressure": "5e6 * (1 - x*x - y*y)",
            }
        ],
    )
    sim = kolk.Simulation(scene, precision=precision, threads=1)
    body = sim.bodies["drop"]
    start = body.position
    sim.advance_to(until)
    axes = stretching_drop([0.0, until])
    return body.position, start * [axes.x[-1], axes.y[-1]]


def _rms(value: npt.NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(value**2)))


@pytest.mark.parametrize("case", [vortex, channel, water, drop])
def test_mixed_differs_by_less_than_a_tenth_of_the_error(case: object) -> None:
    assert callable(case)
    (fine, exact), (mixed, _) = case("f64"), case("mixed")
    error, difference = _rms(fine - exact), _rms(mixed - fine)
    assert difference > 0.0, "mixed precision computed the very same: is it on?"
    assert difference < 0.1 * error, f"mixed is off by {difference:.2e}, the error is {error:.2e}"
