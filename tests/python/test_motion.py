"""Walls in prescribed motion and gravity over time, as scenes have them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kolk
from kolk.errors import SceneError
from kolk.scene import Scene, loads
from tanks import tank

PISTON = {"translate": {"velocity": [0.3, 0.0], "start": 0.1, "end": 0.4}}


def moving(motion: dict[str, Any]) -> Scene:
    """A tank that moves."""
    return tank().replace({"wall.tank.motion": motion})


@pytest.mark.parametrize(
    "motion",
    [
        PISTON,
        {"rotate": [{"centre": [0.5, 0.0], "rate": 0.2}, {"centre": [0.0, 0.0], "rate": -0.1}]},
        {"sinus": {"angle": 0.07, "centre": [0.5, 0.0], "frequency": 0.6, "phase": 0.3}},
        {"table": {"time": [0.0, 1.0], "displacement": [[0.0, 0.0], [0.1, 0.2]]}},
    ],
)
def test_a_scene_file_keeps_a_motion(motion: dict[str, Any]) -> None:
    scene = moving(motion)
    again = loads(scene.to_toml())
    assert again.engine_config() == scene.engine_config()
    assert again.wall[0].motion == scene.wall[0].motion


@pytest.mark.parametrize(
    ("motion", "message"),
    [
        ({}, "motion: is empty"),
        ({"rotate": {"rate": 1.0}}, "centre: is missing"),
        ({"sinus": {"frequency": 1.0}}, "found neither"),
        ({"sinus": {"angle": 1.0, "frequency": 1.0}}, "centre: is missing"),
        ({"translate": {"velocity": [1.0, 0.0, 0.0]}}, "must have 2 numbers"),
        ({"translate": {"velocity": [1.0, 0.0], "start": 1.0, "end": 0.5}}, "before the start"),
        ({"table": {"time": [0.0, 0.0], "angle": [0.0, 1.0], "centre": [0, 0]}}, "ascending"),
        ({"table": {"time": [0.0, 1.0], "displacement": [[0.0, 0.0]]}}, "1 entries for 2 times"),
        ({"table": {"file": "nowhere.csv"}}, "cannot be read"),
        ({"spin": 1.0}, "unknown key"),
    ],
)
def test_a_wrong_motion_is_named(motion: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message) as caught:
        moving(motion)
    assert "wall.tank.motion" in str(caught.value)


def test_a_table_is_read_from_a_file_beside_the_scene(tmp_path: Path) -> None:
    (tmp_path / "roll.csv").write_text("time, angle\n0.0, 0.0\n0.5, 2.0 # degrees\n1.0; 4.0\n")
    file = tmp_path / "scene.toml"
    text = (
        tank()
        .to_toml()
        .replace(
            'slip = "free"',
            'slip = "free"\nmotion.table = { file = "roll.csv", scale = 0.5, centre = [0.5, 0] }',
        )
    )
    file.write_text(text)
    found = kolk.load(file).wall[0].motion
    assert found is not None
    assert found.table[0].angle == (0.0, 1.0, 2.0)
    assert loads(kolk.load(file).to_toml()).wall[0].motion == found, "the numbers are in the scene"


def test_a_wall_is_where_and_as_fast_as_the_scene_says() -> None:
    scene = moving(PISTON)
    simulation = kolk.Simulation(scene)
    start = simulation.bodies["tank"].position
    for time, way, speed in ((0.05, 0.0, 0.0), (0.2, 0.03, 0.3), (0.45, 0.09, 0.0)):
        simulation.advance_to(time)
        wall = simulation.bodies["tank"]
        np.testing.assert_allclose(
            wall.position - start, np.tile([way, 0.0], (len(start), 1)), atol=1e-12
        )
        np.testing.assert_allclose(wall.velocity[:, 0], speed, atol=1e-7)
        turn, offset = simulation.pose("tank")
        np.testing.assert_array_equal(turn, np.eye(2))
        np.testing.assert_allclose(offset, [way, 0.0], atol=1e-12)


def test_the_sound_speed_knows_how_fast_a_wall_will_be() -> None:
    wheel = {"rotate": {"centre": [0.5, 0.0], "rate": 100.0}}
    farthest = np.hypot(0.5 + 0.16, 0.6)
    assert moving(wheel).sound_speed == pytest.approx(1000.0 * farthest, rel=0.1)


def test_a_sensor_is_carried_along_by_its_wall() -> None:
    """A tank that sinks steadily: the pressure at its floor stays that of still water."""
    sinking = tank(
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [1.0, 0.3]}},
                "velocity": [0.0, -0.5],
            }
        ],
        probe=[{"name": "floor", "pressure": {"at": [0.5, 0.0], "body": "tank"}}],
    ).replace({"wall.tank.motion": {"translate": {"velocity": [0.0, -0.5]}}})
    from kolk.probes import build_probes

    simulation = kolk.Simulation(sinking)
    ((probe, _),) = build_probes(sinking, simulation)
    values = []
    while simulation.time < 0.4:
        simulation.advance(0.01)
        values += list(probe.evaluate(simulation))
    assert np.mean(values) == pytest.approx(1000.0 * 9.81 * 0.3, rel=0.03)


def test_the_moment_is_about_the_point_asked_for() -> None:
    from kolk.probes import build_probes

    about = [0.5, 0.2]
    force = {"body": "tank"}
    scene = tank(
        probe=[
            {"name": "origin", "force": force},
            {"name": "point", "force": {**force, "about": about}},
        ]
    )
    simulation = kolk.Simulation(scene)
    simulation.advance(0.02)
    (origin, _), (point, _) = build_probes(scene, simulation)
    fx, fy, moment = origin.evaluate(simulation)
    shifted = moment - (about[0] * fy - about[1] * fx)
    assert point.evaluate(simulation) == pytest.approx((fx, fy, shifted))


def test_gravity_over_time_is_kept_and_checked() -> None:
    gravity = {"base": [0.0, -9.81], "sinus": {"amplitude": [1.0, 0.0], "frequency": 0.5}}
    scene = tank(gravity=gravity)
    assert scene.gravity_at_start == (0.0, -9.81)
    assert loads(scene.to_toml()).engine_config() == scene.engine_config()
    with pytest.raises(SceneError, match="gravity: does not change"):
        tank(gravity={"base": [0.0, -9.81]})
    with pytest.raises(SceneError, match=r"gravity\.base: found \[1\.0, 0\.0, 0\.0\]"):
        tank(gravity={**gravity, "base": [1.0, 0.0, 0.0]})


def test_the_surface_follows_gravity_that_turns_slowly() -> None:
    """Gravity leans over by 0.1 in 1.5 s, slowly beside the first sloshing period of 0.8 s."""
    lean, end = 0.1, 2.0
    time = np.linspace(0.0, 1.5, 16)
    tilt = lean * 0.5 * (1.0 - np.cos(np.pi * time / 1.5))
    scene = tank(
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [0.4, 0.2]}},
                "viscosity": {"artificial": 0.1},
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [0.4, 0.4], "open": ["top"]}},
            }
        ],
        gravity={
            "table": {
                "time": time,
                "value": np.stack([9.81 * np.sin(tilt), -9.81 * np.cos(tilt)], 1),
            }
        },
    )
    simulation = kolk.Simulation(scene)
    slopes = []
    while simulation.time < end:
        simulation.advance(0.05)
        if simulation.time > 1.5:
            x = simulation.bodies["water"].position[:, 0]
            # The first moment of the water tells the slope of its surface: m = slope w² / (12 h).
            slopes.append(12.0 * 0.2 * np.mean(x - 0.2) / 0.4**2)
    assert np.mean(slopes) == pytest.approx(np.tan(lean), rel=0.03)


def test_a_rotating_cylinder_feels_the_torque_of_couette_flow() -> None:
    """Between a rotating cylinder and one at rest: M = 4 pi mu w a² b² / (b² - a²) per length."""
    inner, outer, rate, viscosity = 0.5, 1.0, 1.0, 0.02

    def flow(x: np.ndarray) -> np.ndarray:
        r2 = np.sum(x**2, axis=1)
        spin = rate * inner**2 / (outer**2 - inner**2) * (outer**2 / r2 - 1.0)
        return spin[:, None] * np.stack([-x[:, 1], x[:, 0]], axis=1)

    ring = {
        "difference": {
            "of": {"disc": {"centre": [0, 0], "radius": outer}},
            "minus": [{"disc": {"centre": [0, 0], "radius": inner}}],
        }
    }
    shell = {
        "difference": {
            "of": {"disc": {"centre": [0, 0], "radius": outer + 0.2}},
            "minus": [{"disc": {"centre": [0, 0], "radius": outer}}],
        }
    }
    scene = Scene(
        name="couette",
        dimension=2,
        spacing=0.04,
        until=1.0,
        fluid=[
            {"name": "oil", "shape": ring, "velocity": flow, "viscosity": {"laminar": viscosity}}
        ],
        wall=[
            {
                "name": "shaft",
                "shape": {"disc": {"centre": [0, 0], "radius": inner}},
                "slip": "no",
                "motion": {"rotate": {"centre": [0, 0], "rate": rate}},
            },
            {"name": "housing", "shape": shell, "slip": "no"},
        ],
        numerics={"free_surface": False, "background_pressure": 1000.0 * 0.5**2 * 4},
    )
    exact = 4.0 * np.pi * 1000.0 * viscosity * rate * inner**2 * outer**2 / (outer**2 - inner**2)
    simulation = kolk.Simulation(scene)
    # The start, with a hole in the order of the particles at the walls, sends waves around first.
    simulation.advance_to(1.7)
    torques = []
    while simulation.time < 3.0:
        simulation.advance(0.05)
        torques.append([simulation.force(name)["moment"][0] for name in ("shaft", "housing")])
    shaft, housing = np.mean(torques, axis=0)
    assert shaft == pytest.approx(-exact, rel=0.05)
    assert housing == pytest.approx(exact, rel=0.05)
