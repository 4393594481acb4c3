"""What must not matter: where a scene lies, in which units and directions, in which order.

A dam break's particles are moved, turned, mirrored, measured in other units or shuffled; after some
steps, everything carried back, each is where it was before, to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import kolk
from kolk.simulation import Precision
from tanks import body, tank

Floats = NDArray[np.float64]

SPACING = 1.0 / 64.0
STEPS = 60


@dataclass(frozen=True)
class Flow:
    """A scene in arrays."""

    water: Floats
    velocity: Floats
    density: Floats
    mass: Floats
    wall: Floats
    gravity: tuple[float, ...] = (0.0, -9.81)
    sound: float = 20.0
    spacing: float = SPACING
    steps: int = STEPS
    reference: float = 1000.0

    def run(self, precision: Precision = "f64") -> tuple[Floats, Floats, Floats]:
        """Position, velocity and density of the water after some steps of fixed length."""
        scene = kolk.Scene(
            name="flow",
            dimension=2,
            spacing=self.spacing,
            gravity=list(self.gravity),
            until=1e9,
            fluid=[
                kolk.Fluid.from_arrays(
                    name="water",
                    position=self.water,
                    velocity=self.velocity,
                    density=self.density,
                    mass=self.mass,
                    reference_density=self.reference,
                    sound_speed=self.sound,
                    viscosity={"artificial": 0.05},
                )
            ],
            wall=[kolk.Wall.from_arrays(self.wall, name="tank")],
        )
        sim = kolk.Simulation(scene, precision=precision, threads=1)
        sim.advance_to(1e9, self.steps)
        water = sim.bodies["water"]
        return water.position, water.velocity, water.density


def flow() -> Flow:
    """A small dam break, its water already on its way."""
    scene = tank(
        spacing=SPACING,
        fluid=[{"name": "water", "shape": {"box": {"from": [0.0, 0.0], "to": [0.25, 0.25]}}}],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [0.5, 0.375], "open": ["top"]}},
            }
        ],
    )
    water = body(scene, "water")
    x = water.position
    velocity = 0.3 * np.stack([np.sin(9.0 * x[:, 1]), np.cos(7.0 * x[:, 0])], axis=1)
    return Flow(x, velocity, water.density, water.mass, body(scene, "tank").position)


def apart(a: Floats, b: Floats, unit: float) -> float:
    """Largest difference of two arrays, in some unit."""
    return float(np.max(np.abs(a - b))) / unit


PLAIN: dict[str, tuple[Floats, Floats, Floats]] = {}


def plain(precision: Precision = "f64") -> tuple[Floats, Floats, Floats]:
    """The flow as it is, run once."""
    if precision not in PLAIN:
        PLAIN[precision] = flow().run(precision)
    return PLAIN[precision]


def check(
    changed: Flow,
    back: Callable[[Floats], Floats],
    turn: Callable[[Floats], Floats],
    tolerance: float,
    precision: Precision = "f64",
    density: float = 1.0,
) -> None:
    """Runs the changed flow and carries it back: positions by `back`, velocities by `turn`."""
    x, v, rho = plain(precision)
    y, w, sigma = changed.run(precision)
    assert apart(back(y), x, SPACING) < tolerance
    assert apart(turn(w), v, 1.0) < tolerance
    assert apart(sigma * density, rho, 1000.0) < tolerance


def same(values: Floats) -> Floats:
    return values


quick = settings(
    max_examples=4, deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True
)


@quick
@given(st.integers(-1_000_000, 1_000_000), st.integers(-1_000_000, 1_000_000))
def test_a_scene_may_lie_anywhere(right: int, up: int) -> None:
    shift = SPACING * np.array([right, up])
    plain_flow = flow()
    moved = replace(plain_flow, water=plain_flow.water + shift, wall=plain_flow.wall + shift)
    # A position a million spacings away has 2e-10 of a spacing for its last digit.
    check(moved, lambda x: x - shift, same, 1e-7)


def test_a_scene_a_million_spacings_away_in_mixed_precision() -> None:
    shift = SPACING * np.array([1e6, -1e6])
    plain_flow = flow()
    moved = replace(plain_flow, water=plain_flow.water + shift, wall=plain_flow.wall + shift)
    # Pairs are in single precision relative to their cell, wherever that is.
    check(moved, lambda x: x - shift, same, 1e-3, "mixed")


@quick
@given(st.sampled_from([1e3, 1e-3, 0.3048, 7.0]), st.sampled_from([1e3, 1e-3, 60.0]))
def test_units_do_not_matter(length: float, time: float) -> None:
    f, speed = flow(), length / time
    scaled = replace(
        f,
        water=f.water * length,
        wall=f.wall * length,
        velocity=f.velocity * speed,
        mass=f.mass * length**2,
        gravity=tuple(g * length / time**2 for g in f.gravity),
        sound=f.sound * speed,
        spacing=f.spacing * length,
    )
    check(scaled, lambda x: x / length, lambda v: v / speed, 1e-8)


@quick
@given(st.sampled_from([1e-3, 1.2, 13_600.0]))
def test_the_unit_of_mass_does_not_matter(density: float) -> None:
    f, ratio = flow(), density / 1000.0
    heavy = replace(f, density=f.density * ratio, mass=f.mass * ratio, reference=density)
    check(heavy, same, same, 1e-8, density=1.0 / ratio)


@pytest.mark.parametrize("quarter", [1, 2, 3])
def test_a_scene_may_be_turned_by_right_angles(quarter: int) -> None:
    angle = 0.5 * math.pi * quarter
    turn = np.round(np.array([[math.cos(angle), -math.sin(angle)],
                              [math.sin(angle), math.cos(angle)]]))  # fmt: skip
    f = flow()
    turned = replace(
        f,
        water=f.water @ turn.T,
        wall=f.wall @ turn.T,
        velocity=f.velocity @ turn.T,
        gravity=tuple(turn @ np.array(f.gravity)),
    )
    check(turned, lambda x: x @ turn, lambda v: v @ turn, 1e-8)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_scene_may_be_mirrored(axis: int) -> None:
    mirror = np.ones(2)
    mirror[axis] = -1.0
    f = flow()
    mirrored = replace(
        f,
        water=f.water * mirror,
        wall=f.wall * mirror,
        velocity=f.velocity * mirror,
        gravity=tuple(np.array(f.gravity) * mirror),
    )
    check(mirrored, lambda x: x * mirror, lambda v: v * mirror, 1e-8)


@quick
@given(st.integers(0, 2**32 - 1))
def test_particles_may_come_in_any_order(seed: int) -> None:
    f = flow()
    order = np.random.default_rng(seed).permutation(len(f.water))
    walls = np.random.default_rng(seed + 1).permutation(len(f.wall))
    shuffled = replace(
        f,
        water=f.water[order],
        velocity=f.velocity[order],
        density=f.density[order],
        mass=f.mass[order],
        wall=f.wall[walls],
    )
    place = np.argsort(order)
    x, v, rho = plain()
    y, w, sigma = shuffled.run()
    assert apart(y[place], x, SPACING) < 1e-8
    assert apart(w[place], v, 1.0) < 1e-8
    assert apart(sigma[place], rho, 1000.0) < 1e-8


@pytest.mark.parametrize("threads", [2, 3, 8])
def test_threads_do_not_change_a_bit(threads: int) -> None:
    scene = tank()
    one, many = kolk.Simulation(scene, threads=1), kolk.Simulation(scene, threads=threads)
    for sim in (one, many):
        sim.advance_to(1e9, 40)
    first, second = one.state(), many.state()
    assert all(np.array_equal(first[name], second[name]) for name in first)
