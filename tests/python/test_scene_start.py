"""A scene before it runs: initial state, the engine's configuration, and what a check says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import kolk
from kolk.check import check, describe, picture
from kolk.scene import Scene, load, loads, material
from tanks import GRAVITY, body, tank

DROP = {
    "name": "water",
    "shape": {"disc": {"centre": [0.5, 0.5], "radius": 0.3}},
    "sound_speed": 10,
}
BED = {"name": "bed", "shape": {"box": {"from": [0.0, -0.2], "to": [1.0, 0.0]}}}


# Physics at the start


@pytest.mark.parametrize("eos", ["tait", "linear"])
def test_still_water_starts_in_balance_with_its_own_weight(eos: str) -> None:
    """dp/dz = -rho(p) g, by central differences of the closed form."""
    z = np.linspace(0.0, 0.3, 3001)
    with_eos = {"reference_density": 1000.0, "sound_speed": 20.0, "eos": eos}
    p = material.hydrostatic_pressure(z, 0.3, gravity=GRAVITY, **with_eos)
    rho = material.density_at(p, **with_eos)
    slope = (p[2:] - p[:-2]) / (z[2:] - z[:-2])
    np.testing.assert_allclose(slope, -GRAVITY * rho[1:-1], rtol=1e-8)
    assert p[-1] == 0.0
    assert p[0] == pytest.approx(1000.0 * GRAVITY * 0.3, rel=0.01)


def test_the_surface_of_hydrostatic_water_is_the_top_of_its_box() -> None:
    water = body(tank(), "water")
    c0 = tank().sound_speed
    top = water.position[:, 1] == water.position[:, 1].max()
    pressure = 1000.0 * c0**2 / 7.0 * ((water.density[top] / 1000.0) ** 7 - 1.0)
    np.testing.assert_allclose(pressure, 1000.0 * GRAVITY * 0.01, rtol=1e-3)


def test_automatic_sound_speed() -> None:
    fall = 2 * np.sqrt(GRAVITY * 0.3)
    assert tank().sound_speed == pytest.approx(10 * fall)
    lifted = tank(
        fluid=[{"name": "water", "shape": {"box": {"from": [0.0, 0.2], "to": [0.6, 0.5]}}}]
    )
    assert lifted.sound_speed == pytest.approx(20 * np.sqrt(GRAVITY * 0.5))
    assert tank(numerics={"expected_speed": 5.0}).sound_speed == pytest.approx(50.0)
    jet = tank().replace({"fluid.water.velocity": [3.0, 4.0]})
    assert jet.sound_speed == pytest.approx(50.0)
    fixed = tank().replace({"fluid.water.sound_speed": 33.0})
    assert fixed.sound_speed == 33.0


def test_gravity_along_a_period_makes_no_depth() -> None:
    scene = kolk.load("poiseuille")
    assert not scene.weight.any()
    np.testing.assert_array_equal(scene.bodies()[0].density, 1000.0)
    assert scene.sound_speed == pytest.approx(2.5e-4)


def test_velocity_by_expression_and_by_function() -> None:
    by_text = tank().replace({"fluid.water.velocity": ["-y", "x"]})
    by_code = tank().replace(
        {"fluid.water.velocity": lambda x: np.stack([-x[:, 1], x[:, 0]], axis=1)}
    )
    np.testing.assert_array_equal(body(by_text, "water").velocity, body(by_code, "water").velocity)


# The engine's configuration


def test_an_absent_effect_is_null() -> None:
    config = json.loads(
        Scene(
            name="free",
            dimension=3,
            spacing=0.1,
            until=1.0,
            fluid=[
                {
                    "name": "drop",
                    "shape": {"sphere": {"centre": [0, 0, 0], "radius": 1}},
                    "sound_speed": 10,
                }
            ],
            numerics={"density_diffusion": "none", "shifting": "none", "acoustic_damper": 0},
        ).engine_config()
    )
    for key in (
        "gravity",
        "artificial_viscosity",
        "laminar_viscosity",
        "density_diffusion",
        "acoustic_damper",
        "shifting",
        "wall",
        "courant",
        "time_step",
    ):
        assert config[key] is None, key
    assert config["periodic"] == [None, None, None]
    assert config["sound_speed"] == 10.0


def test_every_effect_reaches_the_engine() -> None:
    scene = tank(
        numerics={"shifting": "sun", "density_diffusion": "fourtakas", "wall": "dynamic"}
    ).replace({"fluid.water.viscosity": {"artificial": 0.1, "beta": 0.2, "laminar": 1e-6}})
    config = json.loads(scene.engine_config())
    assert config["artificial_viscosity"] == {"alpha": 0.1, "beta": 0.2}
    assert config["laminar_viscosity"] == {"kinematic": 1e-6, "form": "monaghan-gingold"}
    assert config["density_diffusion"] == {"form": "fourtakas", "delta": 0.1}
    assert config["shifting"] == {"form": "sun", "free_surface": True, "every": 1}
    assert config["wall"] == {"method": "dynamic", "slip": "free", "suction": False}
    assert config["smoothing_length"] == pytest.approx(0.04)


@pytest.mark.parametrize(
    ("scene", "surface"),
    [
        (tank(), True),
        (tank(numerics={"free_surface": False}), False),
        (tank(gravity=None), False),
        (tank(gravity=None, wall=[], fluid=[DROP]), True),
        (tank(gravity=[1.0, 0.0], periodic={"x": [0.0, 1.0]}, wall=[BED]), False),
        (tank(gravity=None, periodic={"x": [0, 1], "y": [0, 1]}, wall=[], fluid=[DROP]), False),
    ],
)
def test_what_a_free_surface_decides(scene: Scene, surface: bool) -> None:
    scene = scene.replace(
        {"fluid.water.viscosity": {"laminar": 1e-3}, "fluid.water.sound_speed": 10.0}
    )
    assert scene.free_surface is surface
    config = json.loads(scene.engine_config())
    assert config["laminar_viscosity"]["form"] == ("monaghan-gingold" if surface else "morris")
    closed = not surface and scene.periodic is None
    form = "consistent" if closed else "sun"
    assert config["shifting"] == {"form": form, "free_surface": surface, "every": 1}
    assert config["acoustic_damper"] == (0.3 if surface else None)
    if scene.wall:
        assert config["wall"]["suction"] is not surface


def test_the_smoothing_ratio_is_that_of_the_dimension_unless_given() -> None:
    assert tank().smoothing_length == pytest.approx(2.0 * 0.02)
    assert kolk.load("dam-break-box").smoothing_length == pytest.approx(1.7 * 0.02)
    given = tank(smoothing_ratio=1.5)
    assert given.replace(spacing=0.01).smoothing_length == pytest.approx(0.015)
    assert given.replace(smoothing_ratio=None).smoothing_length == pytest.approx(0.04)
    assert loads(tank().to_toml()).smoothing_length == pytest.approx(0.04)


# Checking


def test_a_scene_is_described_in_words() -> None:
    text = describe(tank().replace({"fluid.water.viscosity": {"artificial": 0.02}}))
    for part in ("water", "450 particles", "4 layers", "sound speed 34.31", "no warnings"):
        assert part in text


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"spacing": 0.06}, "5 particles across"),
        ({"smoothing_ratio": 3.0}, "neighbours per particle"),
        ({"fluid.water.sound_speed": 5.0}, "sound speed of 5 m/s is below"),
        ({"fluid.water.viscosity": None}, "no viscosity"),
        ({"wall": []}, "fall for ever"),
        ({"probe": [{"name": "p", "pressure": {"at": [1.1, 0.1]}}]}, "inside wall 'tank'"),
        (
            {
                "wall": [
                    {"name": "a", "shape": {"box": {"from": [0.7, 0.0], "to": [0.72, 0.3]}}},
                ]
            },
            "is 1 layer thick",
        ),
        (
            {
                "wall": [
                    {"name": "a", "shape": {"box": {"from": [0.7, 0.0], "to": [0.9, 0.3]}}},
                    {"name": "b", "shape": {"box": {"from": [0.8, 0.0], "to": [1.0, 0.3]}}},
                ]
            },
            "'b' and 'a' overlap",
        ),
    ],
)
def test_warnings(changes: dict[str, object], message: str) -> None:
    import re

    scene = tank().replace({"fluid.water.viscosity.artificial": 0.02}).replace(changes)
    assert any(re.search(message, w) for w in check(scene).warnings), check(scene).warnings


def test_a_picture_of_the_set_up(tmp_path: Path) -> None:
    for name in ("dam-break", "dam-break-box"):
        scene = load(name)
        made = picture(scene.replace(spacing=scene.spacing * 4), tmp_path / f"{name}.png")
        assert made.read_bytes().startswith(b"\x89PNG")
