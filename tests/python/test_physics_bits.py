"""The same bits: for any number of threads, and for a simulation that was interrupted."""

from typing import Any, Literal

import numpy as np
import pytest

import kolk

Precision = Literal["f64", "mixed"]
UNTIL = 0.3
"""s: by then the column has fallen and the cells have been sorted many times."""


def dam(dimension: int) -> kolk.Scene:
    """A small dam break with everything that a step can hold but laminar viscosity."""
    high = [0.3, 0.3] if dimension == 2 else [0.3, 0.1, 0.3]
    tank = [0.8, 0.6] if dimension == 2 else [0.8, 0.1, 0.6]
    return kolk.Scene(
        name="dam",
        dimension=dimension,
        spacing=0.01 if dimension == 2 else 0.025,
        gravity=[0.0] * (dimension - 1) + [-9.81],
        until=UNTIL,
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0] * dimension, "to": high}},
                "viscosity": {"artificial": 0.02},
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0] * dimension, "to": tank, "open": ["top"]}},
            }
        ],
    )


def vortex() -> kolk.Scene:
    """The periodic vortex, shifting and laminar viscosity included, coarser than its case."""
    return kolk.load("taylor-green").replace(spacing=1 / 32)


def differing(one: kolk.Simulation, other: kolk.Simulation) -> list[str]:
    """Names of what is not the same to the last bit in two simulations."""
    names = []
    for body in one.bodies:
        ours, theirs = one.bodies[body].arrays(), other.bodies[body].arrays()
        names += [f"{body}.{k}" for k in ours if ours[k].tobytes() != theirs[k].tobytes()]
    if (one.time, one.step_count) != (other.time, other.step_count):
        names.append("time or steps")
    return names


SCENES = {"dam-2d": lambda: dam(2), "dam-3d": lambda: dam(3), "vortex": vortex}


@pytest.mark.parametrize("precision", ["f64", "mixed"])
@pytest.mark.parametrize("name", SCENES)
def test_one_and_two_threads_give_the_same_bits(name: str, precision: Precision) -> None:
    scene = SCENES[name]()
    one = kolk.Simulation(scene, precision=precision, threads=1)
    two = kolk.Simulation(scene, precision=precision, threads=2)
    assert one.threads == 1
    assert two.threads == 2
    one.advance_to(UNTIL)
    two.advance_to(UNTIL)
    assert one.step_count > 100
    assert not differing(one, two)


@pytest.mark.parametrize("precision", ["f64", "mixed"])
@pytest.mark.parametrize("name", SCENES)
def test_an_interrupted_simulation_goes_on_to_the_same_bits(
    name: str, precision: Precision
) -> None:
    scene = SCENES[name]()
    undisturbed = kolk.Simulation(scene, precision=precision, threads=1)
    undisturbed.advance_to(UNTIL)
    first = kolk.Simulation(scene, precision=precision, threads=1)
    # not at a round number: between two sorts, in the middle of everything
    first.advance_to(UNTIL, max_steps=77)
    kept: dict[str, Any] = first.state()
    first.advance_to(UNTIL)  # what goes on after the state was taken must not reach into it
    second = kolk.Simulation(scene, precision=precision, threads=2)
    second.restore(kept)
    assert second.step_count == 77
    second.advance_to(UNTIL)
    assert not differing(undisturbed, second)
    assert not differing(undisturbed, first)


def test_a_state_taken_changes_nothing() -> None:
    quiet, watched = (kolk.Simulation(dam(2), threads=1) for _ in range(2))
    quiet.advance_to(0.05)
    while watched.time < 0.05:
        watched.advance_to(0.05, max_steps=10)
        watched.state()
        assert np.isfinite(watched.energy.total)
        watched.sample([[0.1, 0.1]], ["pressure", "velocity"])
    assert not differing(quiet, watched)
