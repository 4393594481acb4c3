"""The scene: files, replacement, and the particles that fill it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kolk.check import check
from kolk.errors import ArrayError, SceneError
from kolk.scene import Box, Fluid, Scene, Wall, load, loads, schema, template
from tanks import GRAVITY, body, tank

# Files


def test_the_template_loads_and_has_no_warnings(tmp_path: Path) -> None:
    file = tmp_path / "new.toml"
    file.write_text(template("new"), encoding="utf-8")
    scene = load(file)
    assert scene.name == "new"
    assert check(scene).warnings == ()


def test_toml_is_complete_and_reads_back_to_the_same_scene() -> None:
    scene = tank(
        periodic={"x": [0.0, 1.0]},
        wall=[{"name": "bed", "shape": {"box": {"from": [0, -0.1], "to": [1, 0]}}}],
        probe=[
            {"name": "p", "pressure": {"at": [0.5, 0.0], "diameter": 0.01}, "every": 1e-3},
            {"name": "u", "field": {"quantity": "velocity", "at": [0.1, 0.1]}},
        ],
    ).replace({"fluid.water.velocity": ["0.1 * y", 0.0], "fluid.water.jitter": 0.1})
    text = scene.to_toml()
    again = loads(text)
    assert again == scene
    assert again.to_toml() == text
    assert "density_diffusion" in text and "smoothing_ratio" in text
    for mine, other in zip(scene.bodies(), again.bodies(), strict=True):
        for column in ("position", "velocity", "density", "mass"):
            np.testing.assert_array_equal(getattr(mine, column), getattr(other, column))
    assert scene.engine_config() == again.engine_config()


@settings(deadline=None, max_examples=50)
@given(
    spacing=st.floats(1e-3, 0.05),
    x=st.floats(-5.0, 5.0),
    viscosity=st.floats(0.0, 1.0),
)
def test_any_number_survives_a_scene_file(spacing: float, x: float, viscosity: float) -> None:
    scene = tank(
        spacing=spacing,
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [x, 0.0], "to": [x + 1.0, 0.3]}},
                "viscosity": {"artificial": viscosity},
            }
        ],
    )
    assert loads(scene.to_toml()) == scene


def test_functions_and_own_particles_are_saved_beside_the_scene(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    scene = tank(
        fluid=[
            Fluid(
                name="spin",
                shape=Box(from_=[0, 0], to=[0.2, 0.2]),
                velocity=lambda x: np.stack([-x[:, 1], x[:, 0]], axis=1),
            ),
            Fluid.from_arrays(
                name="mine", position=rng.uniform([0.4, 0.0], [0.6, 0.2], (50, 2)), density=1000.0
            ),
        ]
    )
    with pytest.raises(SceneError, match=r"scene\.save"):
        scene.to_toml()
    scene.save(tmp_path / "scene.toml")
    again = load(tmp_path / "scene.toml")
    assert {p.name for p in tmp_path.iterdir()} == {"scene.toml", "spin.npz", "mine.npz"}
    for mine, other in zip(scene.bodies(), again.bodies(), strict=True):
        for column in ("position", "velocity", "density", "mass"):
            np.testing.assert_array_equal(getattr(mine, column), getattr(other, column))
    assert again.engine_config() == scene.engine_config()


def test_a_python_file_that_defines_a_scene(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "import kolk\nscene = kolk.load('still-water').replace(spacing=0.05, name='mine')\n",
        encoding="utf-8",
    )
    assert load(file).name == "mine"


def test_the_shipped_schema_is_the_model_s() -> None:
    assert json.loads(schema.shipped()) == schema.schema(), (
        "write it anew with python -m kolk.scene.schema"
    )


def test_the_schema_knows_every_key_of_a_scene() -> None:
    made = schema.schema()
    assert set(made["properties"]) == set(Scene.keys())
    assert made["additionalProperties"] is False
    assert "from" in made["$defs"]["Box"]["properties"]


# Immutability and replacement


def test_a_scene_does_not_change() -> None:
    scene = tank()
    with pytest.raises(ValueError, match="frozen"):
        scene.spacing = 0.1
    with pytest.raises(ValueError, match="read-only"):
        scene.bodies()[0].position[0, 0] = 1.0


def test_replace_reaches_every_key_and_leaves_the_old_scene() -> None:
    scene = tank()
    other = scene.replace(
        {
            "fluid.water.viscosity.artificial": 0.05,
            "numerics.shifting": "sun",
            "wall.0.slip": "no",
        },
        spacing=0.01,
    )
    assert other.spacing == 0.01
    assert other.fluid[0].viscosity is not None and other.fluid[0].viscosity.artificial == 0.05
    assert other.wall[0].slip == "no"
    assert scene.fluid[0].viscosity is None and scene.spacing == 0.02
    assert other.replace({"fluid.water.viscosity": None}).fluid[0].viscosity is None


def test_the_frame_interval_follows_the_end_of_the_run() -> None:
    scene = tank()
    assert scene.output.every == pytest.approx(0.01)
    assert scene.replace(until=2.0).output.every == pytest.approx(0.02)
    assert scene.replace({"output.every": 0.5}, until=2.0).output.every == 0.5


def test_replace_keeps_functions_and_arrays() -> None:
    scene = tank(
        fluid=[Fluid.from_arrays(name="mine", position=[[0.1, 0.1], [0.12, 0.1], [0.1, 0.12]])]
    )
    assert len(scene.replace(until=0.5).bodies()[0]) == 3


# Particles


def test_fluid_stands_half_a_cell_from_the_wall_and_has_its_exact_mass() -> None:
    water = body(tank(), "water")
    assert len(water) == 30 * 15
    assert water.position.min() == pytest.approx(0.01)
    assert water.mass.sum() == pytest.approx(1000.0 * 0.6 * 0.3, rel=1e-12)
    assert all(c.flags.c_contiguous for c in (water.position, water.velocity, water.density))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_tank_has_its_layers_and_corners(dimension: int) -> None:
    low, high = [0.0] * dimension, [0.4] * dimension
    scene = Scene(
        name="t",
        dimension=dimension,
        spacing=0.1,
        until=1.0,
        gravity=[0.0] * (dimension - 1) + [-GRAVITY],
        fluid=[{"name": "w", "shape": {"box": {"from": low, "to": [0.2] * dimension}}}],
        wall=[{"name": "t", "shape": {"tank": {"from": low, "to": high, "open": ["top"]}}}],
    )
    layers = scene.wall_layers
    assert layers == {2: 4, 3: 4}[dimension]
    outer = (4 + 2 * layers) ** (dimension - 1) * (4 + layers)
    assert len(body(scene, "t")) == outer - 4**dimension


def test_no_particle_stands_in_another() -> None:
    scene = tank(
        wall=[
            {"name": "tank", "shape": {"tank": {"from": [0, 0], "to": [1.0, 0.6]}}},
            {"name": "block", "shape": {"box": {"from": [0.7, 0.0], "to": [0.8, 0.2]}}},
        ]
    )
    every = np.concatenate([b.position for b in scene.bodies()])
    distance = np.linalg.norm(every[:, None] - every[None], axis=2)
    np.fill_diagonal(distance, 1.0)
    assert distance.min() > 0.9 * scene.spacing


def test_a_thick_wall_is_hollow_and_no_fluid_can_tell() -> None:
    scene = tank(
        wall=[{"name": "block", "shape": {"box": {"from": [0.6, -0.5], "to": [1.6, 0.5]}}}]
    )
    block = scene.wall[0].shape
    assert block is not None
    depth = -block.shape.distance(body(scene, "block").position)
    assert depth.min() == pytest.approx(0.01)
    assert scene.support - scene.spacing < depth.max() < scene.support


def test_the_same_seed_gives_the_same_jitter() -> None:
    scene = tank().replace({"fluid.water.jitter": 0.2, "fluid.water.seed": 3})
    again = scene.replace({"fluid.water.seed": 3})
    other = scene.replace({"fluid.water.seed": 4})
    np.testing.assert_array_equal(body(scene, "water").position, body(again, "water").position)
    assert (body(scene, "water").position != body(other, "water").position).any()
    moved = np.abs(body(scene, "water").position - body(tank(), "water").position)
    assert 0.0 < moved.max() <= 0.2 * 0.02 * (1 + 1e-12)


def test_jitter_stays_within_the_period() -> None:
    scene = Scene(
        name="p",
        dimension=2,
        spacing=0.1,
        until=1.0,
        periodic={"x": [0, 1], "y": [0, 1]},
        fluid=[
            {
                "name": "f",
                "shape": {"box": {"from": [0, 0], "to": [1, 1]}},
                "jitter": 0.49,
                "sound_speed": 10.0,
            }
        ],
    )
    position = scene.bodies()[0].position
    assert (position >= 0.0).all() and (position < 1.0).all()


def test_own_particles_arrive_as_given_and_are_copied() -> None:
    position = np.random.default_rng(0).uniform(0.1, 0.5, (20, 2))
    velocity = np.ones((20, 2))
    density = np.full(20, 1001.0)
    fluid = Fluid.from_arrays(position=position, velocity=velocity, density=density, name="mine")
    before = position.copy()
    scene = tank(fluid=[fluid])
    position[:] = 0.0
    mine = body(scene, "mine")
    np.testing.assert_array_equal(mine.position, before)
    np.testing.assert_array_equal(mine.density, density)
    np.testing.assert_allclose(mine.mass, 1000.0 * 0.02**2)


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"position": [1.0, 2.0]}, "position: found an array of shape"),
        ({"position": np.zeros((3, 4))}, "must be \\(n, 2\\) or \\(n, 3\\)"),
        ({"position": np.zeros((0, 2))}, "found no particles"),
        ({"position": [[0.0, np.nan]]}, r"position\[0\]: found"),
        ({"position": [["a", "b"]]}, "position: found an array of type"),
        ({"position": [[0.0, 1.0], [2.0]]}, "position: found rows of different lengths"),
        ({"position": [[0j, 1.0]]}, "must be real numbers"),
        ({"position": [[0.0, 0.0]], "velocity": [[0.0]]}, "velocity: found an array of shape"),
        ({"position": [[0.0, 0.0]], "density": [-1.0]}, r"density\[0\]: found -1"),
        ({"position": [[0.0, 0.0]], "mass": [0.0]}, r"mass\[0\]: found 0"),
        ({"position": [[0.0, 0.0]], "mass": [1.0, 2.0]}, "mass: found an array of shape"),
    ],
)
def test_own_particles_that_cannot_be(arrays: dict[str, object], message: str) -> None:
    with pytest.raises(ArrayError, match=message):
        Fluid.from_arrays(**arrays)


def test_a_wall_of_own_particles() -> None:
    wall = Wall.from_arrays(position=[[0.9, 0.1], [0.9, 0.12]], name="grid", slip="no")
    assert len(body(tank(wall=[wall]), "grid")) == 2
