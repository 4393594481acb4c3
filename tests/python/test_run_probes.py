"""Probes against fluids whose answer is known: lattices beside walls, given pressures."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import kolk
from kolk.probes import (
    SurgeFront,
    Surroundings,
    WallPressure,
    WaterLevel,
    front_of,
    level_of,
    sensor_face,
    wall_normal,
)

Floats = NDArray[np.float64]
SPACING = 0.01


def tank(height: float, spacing: float = SPACING) -> Surroundings:
    """Water of a height at rest in a tank of 0.4 m, and the tank, two-dimensional."""
    scene = kolk.Scene(
        name="tank",
        dimension=2,
        spacing=spacing,
        gravity=[0.0, -9.81],
        until=1.0,
        fluid=[{"name": "water", "shape": {"box": {"from": [0, 0], "to": [0.4, height]}}}],
        wall=[{"name": "tank", "shape": {"tank": {"from": [0, 0], "to": [0.4, 0.5]}}}],
    )
    bodies = {body.name: body for body in scene.bodies()}
    simulation: Any = SimpleNamespace(scene=scene, initial=bodies)
    return Surroundings.of(simulation)


class Still:
    """A simulation that stands still: kernel sums over given particles."""

    def __init__(self, around: Surroundings, fluid: Floats | None = None) -> None:
        self.around = around
        self.fluid = around.fluid if fluid is None else fluid
        self.bodies = {"water": SimpleNamespace(position=self.fluid)}

    def sample(self, points: Floats, fields: list[str]) -> dict[str, Floats]:
        h = self.around.smoothing_length
        kernel = kolk.kernel(self.around.kernel, 2)
        apart = np.linalg.norm(points[:, None] - self.fluid[None], axis=2)
        weight = np.stack([kernel.value(np.ascontiguousarray(row), h) for row in apart])
        fill = weight.sum(axis=1) * self.around.spacing**2
        depth = self.fluid[:, 1].max() + 0.5 * self.around.spacing - points[:, 1]
        pressure = np.where(fill > 0.0, 9810.0 * depth, 0.0)
        return {"fill": fill, "pressure": pressure}


@pytest.mark.parametrize("place", [0.2, 0.0, 0.4, 0.013])
@pytest.mark.parametrize("height", [0.05, 0.1, 0.3])
def test_the_level_of_still_water(height: float, place: float) -> None:
    around = tank(height)
    probe = WaterLevel("level", [place, 0.0], None, around)
    (level,) = probe.evaluate(Still(around))  # type: ignore[arg-type]
    assert level == pytest.approx(height, abs=0.1 * SPACING)


def test_a_level_is_continuous_down_to_a_film_and_nothing() -> None:
    around = tank(0.3)
    probe = WaterLevel("level", [0.2, 0.0], None, around)
    levels = []
    for layers in range(6):
        film = around.fluid[around.fluid[:, 1] < layers * SPACING]
        far = np.array([[9.0, 9.0]])
        levels += probe.evaluate(Still(around, np.concatenate([film, far])))  # type: ignore[arg-type]
    np.testing.assert_allclose(levels, SPACING * np.arange(6), atol=0.1 * SPACING)


def test_a_level_is_the_first_surface_from_below() -> None:
    share = np.array([1.0, 1.0, 1.0, 0.75, 0.25, 0.0, 0.0, 0.9, 1.0, 0.0])
    assert level_of(share, np.ones(10), 0.1, 1) == pytest.approx(0.35)
    assert level_of(np.ones(5), np.ones(5), 0.1, 1) == pytest.approx(0.4)
    assert level_of(np.zeros(5), np.ones(5), 0.1, 1) == 0.0


@pytest.mark.parametrize(
    ("point", "normal"),
    [
        ((0.4, 0.2), (-1, 0)),
        ((0.0, 0.2), (1, 0)),
        ((0.2, 0.0), (0, 1)),
        ((0.2, 0.5), (0, -1)),
        ((0.4, 0.003), (-1, 0)),
        ((0.4, 0.0071), (-1, 0)),
        ((0.397, 0.0), (0, 1)),
    ],
)
def test_normals_point_into_the_fluid(
    point: tuple[float, float], normal: tuple[float, float]
) -> None:
    found = wall_normal(np.array(point), tank(0.1))
    np.testing.assert_array_equal(found, normal)


def test_there_is_no_normal_away_from_walls() -> None:
    assert wall_normal(np.array([0.2, 0.2]), tank(0.1)) is None


def test_a_sensor_face_is_even_and_flat() -> None:
    segment = sensor_face(np.array([-1.0, 0.0]), 0.02, 9)
    np.testing.assert_allclose(segment.mean(axis=0), 0.0, atol=1e-15)
    assert np.ptp(segment[:, 1]) == pytest.approx(0.02 * 8 / 9)
    normal = np.array([0.6, 0.0, 0.8])
    disc = sensor_face(normal, 0.02, 400)
    np.testing.assert_allclose(disc @ normal, 0.0, atol=1e-15)
    radius = np.linalg.norm(disc, axis=1)
    assert radius.max() < 0.01
    # The mean of r^2 over a disc is R^2 / 2.
    assert np.mean(radius**2) == pytest.approx(0.5e-4, rel=1e-3)


def test_wall_pressure_is_the_mean_over_the_wet_face() -> None:
    around = tank(0.1)
    still = Still(around)
    deep = WallPressure("P", [0.4, 0.05], 0.02, around)
    assert deep.evaluate(still)[0] == pytest.approx(9810.0 * 0.05, rel=1e-9)  # type: ignore[arg-type]
    # The lower half of this sensor is buried in the floor and left out.
    corner = WallPressure("P", [0.4, 0.0], 0.02, around)
    assert len(corner.points) < 9
    assert (corner.points[:, 1] > -0.5 * SPACING).all()
    dry = WallPressure("P", [0.4, 0.3], 0.02, around)
    assert dry.evaluate(still) == (0.0,)  # type: ignore[arg-type]


def test_the_front_is_the_tip_of_the_connected_flow() -> None:
    row = np.array([0.0, 1.0, 2.0, 3.0, 9.0, 10.0])
    assert front_of(row, 2.0, 0.5) == 3.5
    assert front_of(np.array([1.0]), 2.0, 0.5) == 1.5


def test_drops_and_splashes_are_no_front() -> None:
    around = tank(0.1)
    probe = SurgeFront("front", 0, ["water"], around)
    drops = np.array([[0.9, 0.005], [0.95, 0.02], [2.0, 0.4]])
    splash = np.column_stack([np.linspace(0.4, 1.0, 61), np.full(61, 0.2)])
    fluid = np.concatenate([around.fluid, drops, splash])
    assert probe.evaluate(Still(around, fluid)) == (pytest.approx(0.4),)  # type: ignore[arg-type]
    back = SurgeFront("front", 0, ["water"], around, sign=-1)
    assert back.evaluate(Still(around, fluid)) == (pytest.approx(0.0),)  # type: ignore[arg-type]
