"""Walls and fluid from files: exact distances, and faults named where they are."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import kolk
import solids
from kolk import check
from kolk.errors import SceneError
from kolk.scene import Mesh, Outline, Scene, distance

WRITERS = {".stl": solids.write_stl, ".obj": solids.write_obj, ".ply": solids.write_ply}
LOW, HIGH = [0.0, -1.0, 0.5], [2.0, 1.0, 1.5]


@pytest.fixture
def points() -> np.ndarray:
    return np.random.default_rng(5).uniform(-1.5, 2.5, (2000, 3))


@pytest.mark.parametrize("suffix", WRITERS)
def test_the_distance_from_a_box_is_exact_in_every_format(tmp_path, points, suffix):
    file = WRITERS[suffix](tmp_path / f"box{suffix}", solids.box(LOW, HIGH))
    mesh = Mesh(file=str(file))
    expected = distance.box(points, np.array(LOW), np.array(HIGH))
    np.testing.assert_allclose(mesh.distance(points), expected, atol=1e-6)
    assert mesh.size() == pytest.approx(4.0)
    np.testing.assert_allclose(mesh.bounds(), [LOW, HIGH])
    assert mesh.triangles().shape == (12, 3, 3)


def test_the_distance_from_a_ball_converges_with_the_square_of_its_facets(tmp_path, points):
    errors = []
    for halvings in (3, 4):
        file = solids.write_obj(tmp_path / f"{halvings}.obj", solids.ball(1.0, halvings))
        exact = distance.ball(points, np.zeros(3), 1.0)
        errors.append(np.abs(Mesh(file=str(file)).distance(points) - exact).max())
    assert errors[0] < 0.02
    assert errors[0] / errors[1] > 3.3


def test_scale_and_translate_are_applied_in_this_order(tmp_path, points):
    file = solids.write_stl(tmp_path / "box.stl", solids.box([0, 0, 0], [1000, 2000, 500]))
    mesh = Mesh(file=str(file), scale=1e-3, translate=[1.0, 0.0, -1.0])
    low, high = np.array([1.0, 0.0, -1.0]), np.array([2.0, 2.0, -0.5])
    np.testing.assert_allclose(mesh.distance(points), distance.box(points, low, high), atol=1e-6)


def test_a_surface_turned_inside_out_is_turned_back(tmp_path, points):
    corners, faces = solids.box(LOW, HIGH)
    right = Mesh(file=str(solids.write_obj(tmp_path / "right.obj", (corners, faces))))
    wrong = Mesh(file=str(solids.write_obj(tmp_path / "wrong.obj", (corners, faces[:, ::-1]))))
    np.testing.assert_array_equal(right.distance(points), wrong.distance(points))
    assert right.size() == wrong.size() > 0.0


def test_a_vessel_gives_the_walls_of_the_tank_that_it_is(tmp_path):
    file = solids.write_stl(tmp_path / "vessel.stl", solids.box([0, 0, 0], [0.6, 0.4, 0.4]))
    common = {
        "name": "vessel",
        "dimension": 3,
        "spacing": 0.05,
        "gravity": [0.0, 0.0, -9.81],
        "until": 1.0,
        "fluid": [
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0, 0.0], "to": [0.3, 0.4, 0.2]}},
            }
        ],
    }
    tank = {"tank": {"from": [0.0, 0.0, 0.0], "to": [0.6, 0.4, 0.4]}}
    vessel = {"mesh": {"file": str(file), "solid": "outside"}}
    walls = [
        Scene(**common, wall=[{"name": "w", "shape": shape}]).bodies()[1].position
        for shape in (tank, vessel)
    ]
    # The mesh is filled as deep as the kernel reaches everywhere; the tank's corners are square.
    rounded = {tuple(np.round(x, 9)) for x in walls[1]}
    square = {tuple(np.round(x, 9)) for x in walls[0]}
    assert rounded <= square
    missing = np.array(sorted(square - rounded))
    depth = distance.box(missing, np.zeros(3), np.array([0.6, 0.4, 0.4]))
    assert depth.min() >= 0.05 * 4 - 1e-9


def test_fluid_fills_a_mesh(tmp_path):
    file = solids.write_ply(tmp_path / "ball.ply", solids.ball(0.5))
    scene = Scene(
        name="drop",
        dimension=3,
        spacing=0.05,
        until=0.1,
        fluid=[
            {
                "name": "drop",
                "shape": {"mesh": {"file": str(file)}},
                "sound_speed": 10.0,
            }
        ],
    )
    (drop,) = scene.bodies()
    assert len(drop) * 0.05**3 == pytest.approx(math.pi / 6, rel=0.02)
    assert np.linalg.norm(drop.position, axis=1).max() < 0.5
    # The lattice is symmetric about the centre: a drop at rest stays where it is.
    np.testing.assert_allclose(drop.position.mean(axis=0), 0.0, atol=1e-12)


def test_holes_are_named_where_they_are(tmp_path):
    corners, faces = solids.ball(2.0, 3)
    at = corners[faces].mean(axis=1)
    top, side = at[:, 2] > 1.7, at[:, 0] > 1.9
    file = solids.write_stl(tmp_path / "torn.stl", (corners, faces[~(top | side)]))
    with pytest.raises(SceneError) as caught:
        Mesh(file=str(file))
    message = str(caught.value)
    assert "not closed: found 2 holes" in message
    # The larger first: around the north pole, then around the positive x axis.
    first, second = message.split(";")[:2]
    pole = np.array([float(x) for x in first.split("[")[1].split("]")[0].split(",")])
    east = np.array([float(x) for x in second.split("[")[1].split("]")[0].split(",")])
    assert np.linalg.norm(pole / np.linalg.norm(pole) - [0, 0, 1]) < 0.1
    assert np.linalg.norm(east / np.linalg.norm(east) - [1, 0, 0]) < 0.1


def test_a_face_that_is_turned_round_is_named(tmp_path):
    corners, faces = solids.box(LOW, HIGH)
    faces[3] = faces[3][::-1]
    file = solids.write_obj(tmp_path / "turned.obj", (corners, faces))
    with pytest.raises(SceneError, match="3 edges whose faces disagree about the outside"):
        Mesh(file=str(file))


SQUARE = "x, y\n0 0\n1 0\n1 1\n0 1\n"

BAD = {
    "no such file": ("none.stl", None, 'file: found no file ".*none.stl": give its path'),
    "another format": ("a.step", "x", r"must end in .stl, .obj or .ply"),
    "broken": ("a.stl", "solid x\nfacet hello", "cannot be read"),
    "no triangles": ("a.obj", "v 0 0 0\nv 1 0 0\n", "no triangles|cannot be read"),
    "a sheet": ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n", "encloses nothing"),
}
BAD_OUTLINES = {
    "open": ("0 0\n1 0\n2 0.5\n2 1\n1 1.5\n-1 1\n-3 5\n", "not closed: found a gap of 5.83"),
    "crossing": ("0 0\n1 1\n1 0\n0 1\n", "Self-intersection"),
    "words": ("0 0\n1 zero\n1 1\n", 'line 2: found "1 zero", must be two numbers'),
    "not finite": ("0 0\n1 nan\n1 1\n", "line 2: found 1 nan, must be finite"),
    "two points": ("0 0\n1 0\n", "polyline of 2 points, must be 3 or more"),
    "nothing": ("# only this\n", "holds no points"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_surfaces_are_refused(tmp_path, case):
    name, text, message = BAD[case]
    if text is not None:
        (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match=message):
        Mesh(file=str(tmp_path / name))


@pytest.mark.parametrize("case", BAD_OUTLINES)
def test_bad_outlines_are_refused(tmp_path, case):
    text, message = BAD_OUTLINES[case]
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match=message):
        Outline(file=str(tmp_path / "a.csv"))


def test_an_outline_is_the_polygon_that_it_draws(tmp_path, points):
    (tmp_path / "a.csv").write_text(SQUARE + "\n# a hole\n0.2 0.2\n0.2 0.8\n0.8 0.8\n0.8 0.2\n")
    outline = Outline(file=str(tmp_path / "a.csv"), scale=2.0, translate=[1.0, 0.0])
    outer = distance.box(points[:, :2], np.array([1.0, 0.0]), np.array([3.0, 2.0]))
    inner = distance.box(points[:, :2], np.array([1.4, 0.4]), np.array([2.6, 1.6]))
    expected = np.maximum(outer, -inner)
    np.testing.assert_allclose(outline.distance(points[:, :2]), expected, atol=1e-12)
    vessel = Outline(file=str(tmp_path / "a.csv"), solid="outside")
    assert vessel.hollow()
    np.testing.assert_allclose(vessel.bounds(0.1), [[-0.1, -0.1], [1.1, 1.1]])


def test_layers_follow_an_outline_half_a_spacing_behind_it(tmp_path):
    around = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    lines = "\n".join(f"{x} {y}" for x, y in ring)
    (tmp_path / "a.csv").write_text(lines, encoding="utf-8")
    for solid, side in (("inside", -1.0), ("outside", 1.0)):
        outline = Outline(file=str(tmp_path / "a.csv"), solid=solid)
        found = outline.layers(0.05, 3)
        assert found is not None
        radius = np.linalg.norm(found, axis=1)
        layer = np.round((radius - 1.0) / (side * 0.05) - 0.5).astype(int)
        assert set(layer) == {0, 1, 2}
        np.testing.assert_allclose(radius, 1.0 + side * 0.05 * (layer + 0.5), atol=3e-4)
        for k in range(3):
            # As far apart along the layer as the layers are.
            expected = 2.0 * np.pi * (1.0 + side * 0.05 * (k + 0.5)) / 0.05
            assert np.sum(layer == k) == pytest.approx(expected, abs=1.0)
        np.testing.assert_array_less(outline.distance(found), 0.0)


def test_an_outline_is_no_shape_in_3d(tmp_path):
    (tmp_path / "a.csv").write_text(SQUARE, encoding="utf-8")
    with pytest.raises(SceneError, match=r"wall.w.shape.outline: is a shape in 2D"):
        Scene(
            name="a",
            dimension=3,
            spacing=0.1,
            until=1.0,
            fluid=[{"name": "f", "shape": {"sphere": {"centre": [0, 0, 0], "radius": 1.0}}}],
            wall=[{"name": "w", "shape": {"outline": {"file": str(tmp_path / "a.csv")}}}],
        )


TEXT = """\
name = "bump"
dimension = 2
spacing = 0.02
gravity = [0.0, -9.81]
until = 0.05

[[fluid]]
name = "water"
shape = { difference = { of = { box = { from = [0.0, 0.0], to = [1.0, 0.3] } }, minus = [
    { outline = { file = "parts/bump.csv" } } ] } }
viscosity = { artificial = 0.02 }

[[wall]]
name = "tank"
shape = { tank = { from = [0.0, 0.0], to = [1.0, 0.6], open = ["top"] } }

[[wall]]
name = "bump"
shape = { outline = { file = "parts/bump.csv" } }

[output]
pictures = false
"""


def test_files_are_found_beside_the_scene_and_kept_with_the_run(tmp_path, monkeypatch):
    here, parts = tmp_path / "here", tmp_path / "here" / "parts"
    parts.mkdir(parents=True)
    (parts / "bump.csv").write_text("0.4 0\n0.6 0\n0.5 0.2\n0.4 0\n", encoding="utf-8")
    (here / "bump.toml").write_text(TEXT, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    scene = kolk.load("here/bump.toml")
    before = [body.position for body in scene.bodies()]
    assert min(len(position) for position in before) > 30
    drawn = check.picture(scene, tmp_path / "set-up.png")
    assert drawn.stat().st_size > 10_000
    run = kolk.run(scene, "runs/bump", quiet=True, threads=1)
    # What the run was made of is in its folder: the files it came from may go.
    (parts / "bump.csv").unlink()
    again = kolk.load(Path(run.folder) / "scene.toml")
    for old, new in zip(before, again.bodies(), strict=True):
        np.testing.assert_array_equal(old, new.position)


def test_a_mesh_is_drawn(tmp_path):
    file = solids.write_obj(tmp_path / "ball.obj", solids.ball(0.2, 3))
    scene = Scene(
        name="ball",
        dimension=3,
        spacing=0.05,
        gravity=[0.0, 0.0, -9.81],
        until=0.1,
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0, 0.0], "to": [0.4, 0.4, 0.3]}},
            }
        ],
        wall=[
            {"name": "tank", "shape": {"tank": {"from": [0, 0, 0], "to": [1, 0.4, 0.6]}}},
            {"name": "ball", "shape": {"mesh": {"file": str(file), "translate": [0.7, 0.2, 0.2]}}},
        ],
    )
    assert check.picture(scene, tmp_path / "set-up.png").stat().st_size > 10_000
    assert "ball" in check.describe(scene)
