"""Bad scenes: each gives one clear error that names the key, and never a traceback of ours."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kolk import cases
from kolk.errors import KolkError, SceneError
from kolk.scene import Scene, load, loads, memory, template

GOOD = template("tank")


def edited(old: str, new: str) -> str:
    assert GOOD.count(old) == 1, old
    return GOOD.replace(old, new)


BOX = "shape = { box = { from = [0.0, 0.0], to = [0.6, 0.3] } }\ndensity"
TANK = 'shape = { tank = { from = [0.0, 0.0], to = [1.61, 0.6], open = ["top"] } }'
SPACING = "spacing = 0.01   "
MORE_WATER = '[[fluid]]\nname = "more"\n'
PROBES = "# Probes: pressure, level, front, force or field."

BAD: dict[str, tuple[str, str]] = {
    "misspelt key": (
        edited("until = 2.0 ", "untill = 2.0 "),
        "untill: unknown key; did you mean 'until'",
    ),
    "misspelt key of a body": (
        edited("density = 1000.0", "densty = 1000.0"),
        "fluid.water.densty: unknown key; did you mean 'density'",
    ),
    "unknown key without a neighbour": (
        edited("density = 1000.0", "qqq = 1000.0"),
        "fluid.water.qqq: unknown key. Allowed here: name, shape",
    ),
    "missing key": (edited(SPACING, "# "), "spacing: is missing"),
    "number in quotes": (
        edited(SPACING, 'spacing = "0.01"'),
        'spacing: found "0.01", must be a number',
    ),
    "negative spacing": (
        edited(SPACING, "spacing = -0.01"),
        "spacing: found -0.01, must be greater than 0",
    ),
    "zero spacing": (edited(SPACING, "spacing = 0"), "spacing: found 0, must be greater than 0"),
    "spacing not finite": (
        edited(SPACING, "spacing = nan"),
        "spacing: found nan, must be a finite number",
    ),
    "true for a number": (
        edited(SPACING, "spacing = true"),
        "spacing: found true, must be a number",
    ),
    "dimension": (
        edited("dimension = 2  ", "dimension = 4  "),
        "dimension: found 4, must be 2 or 3",
    ),
    "gravity of the wrong length": (
        edited("gravity = [0.0, -9.81]", "gravity = [0.0, 0.0, -9.81]"),
        "gravity: found [0.0, 0.0, -9.81], must have 2 numbers: the dimension is 2",
    ),
    "kernel": (
        edited("until = 2.0 ", 'kernel = "wendland-c3"\nuntil = 2.0 '),
        'kernel: found "wendland-c3"',
    ),
    "no fluid": (GOOD[: GOOD.index("[[fluid]]")], "fluid: is missing"),
    "one table for a list": (
        edited("[[fluid]]", "[fluid]"),
        "fluid: found one table, must be a list",
    ),
    "unknown shape": (
        edited("box = { from = [0.0, 0.0], to = [0.6", "bx = { from = [0.0, 0.0], to = [0.6"),
        "fluid.water.shape.bx: unknown key; did you mean 'box'",
    ),
    "two shapes": (
        edited(BOX, BOX.replace("shape = {", "shape = { disc = { centre = [1, 1], radius = 1 },")),
        "fluid.water.shape: found box and disc, must be exactly one of",
    ),
    "no shape": (edited(BOX, "density"), "fluid.water.shape: is missing"),
    "inverted box": (
        edited(BOX, BOX.replace("[0.6, 0.3]", "[0.6, -0.3]")),
        "fluid.water.shape.box.to: found y = -0.3, must be greater than 'from'",
    ),
    "shape of the other dimension": (
        edited(BOX, BOX.replace("[0.0, 0.0]", "[0, 0, 0]").replace("[0.6, 0.3]", "[1, 1, 1]")),
        "fluid.water.shape.box: is a shape in 3D, but the scene's dimension is 2",
    ),
    "side that does not exist": (
        edited(TANK, TANK.replace('"top"', '"front"')),
        'wall.tank.shape.tank.open: found "front", which a tank in 2D does not have',
    ),
    "polygon that crosses itself": (
        edited(BOX, "shape = { polygon = { points = [[0,0],[1,1],[1,0],[0,1]] } }\ndensity"),
        "fluid.water.shape.polygon.points: is no simple polygon",
    ),
    "empty viscosity": (
        edited("viscosity = { artificial = 0.02 }", "viscosity = {}"),
        "fluid.water.viscosity: is empty",
    ),
    "sound speed": (
        edited('sound_speed = "auto"', 'sound_speed = "fast"'),
        'fluid.water.sound_speed: found "fast", must be "auto" or a speed',
    ),
    "expression": (
        edited("density = 1000.0", 'density = 1000.0\nvelocity = ["import os", 0.0]'),
        'fluid.water.velocity: found "import os", which is no expression',
    ),
    "expression of z in 2D": (
        edited("density = 1000.0", 'density = 1000.0\nvelocity = ["z", 0.0]'),
        'fluid.water.velocity: found "z": there is no z in 2D',
    ),
    "expression that is not finite": (
        edited("density = 1000.0", 'density = 1000.0\nvelocity = ["1/(x-x)", 0.0]'),
        "fluid.water.velocity: is not finite at",
    ),
    "probe of an unknown body": (
        edited('force = { body = "tank" }', 'force = { body = "tonk" }'),
        "probe.load.force.body: found \"tonk\", which is no wall; did you mean 'tank'",
    ),
    "probe of two kinds": (
        edited(
            "level = { at = [0.5, 0.0] }", 'level = { at = [0.5, 0.0] }\nforce = { body = "tank" }'
        ),
        "probe.level: found level and force, must be exactly one",
    ),
    "probe of no kind": (
        edited("level = { at = [0.5, 0.0] }", ""),
        "probe.level: measures nothing",
    ),
    "two probes of one name": (
        edited('name = "level"', 'name = "P2"'),
        'probe.P2.name: found a second probe "P2"',
    ),
    "two bodies of one name": (
        edited(
            PROBES,
            '[[wall]]\nname = "Water"\nshape = { disc = { centre = [1, 0.3], radius = 0.1 } }',
        ),
        'wall.Water.name: found a second body "Water"',
    ),
    "name with a slash": (
        edited('name = "tank"\ntitle', 'name = "a/b"\ntitle'),
        'name: found "a/b"',
    ),
    "two materials": (
        edited(
            PROBES,
            MORE_WATER + "shape = { box = { from = [0.7, 0], to = [0.9, 0.3] } }\n"
            "density = 800.0\nviscosity = { artificial = 0.02 }",
        ),
        "fluid.more.density: differs from that of 'water': all fluids of a scene share one",
    ),
    "overlapping fluids": (
        edited(
            PROBES,
            MORE_WATER + "shape = { box = { from = [0.5, 0], to = [0.9, 0.3] } }\n"
            "viscosity = { artificial = 0.02 }",
        ),
        "fluid.more.shape: 300 of 1,200 particles lie inside fluid 'water'",
    ),
    "fluid in a wall": (
        edited(
            PROBES,
            '[[wall]]\nname = "post"\nshape = { disc = { centre = [0.3, 0.1], radius = 0.1 } }',
        ),
        "particles lie inside wall 'post'",
    ),
    "fluid outside the tank": (
        edited(BOX, BOX.replace("[0.6, 0.3]", "[1.7, 0.3]")),
        "particles lie outside tank 'tank'",
    ),
    "empty fluid": (
        edited(
            BOX,
            "shape = { difference = { of = { box = { from = [0, 0], to = [0.6, 0.3] } }, "
            "minus = [{ box = { from = [-1, -1], to = [2, 2] } }] } }\ndensity",
        ),
        "fluid.water.shape.difference: is empty",
    ),
    "spacing too coarse": (
        edited(SPACING, "spacing = 0.2"),
        "spacing: found 0.2 m, too coarse for fluid 'water', which is 0.3 m across",
    ),
    "more than the memory": (
        edited(SPACING, "spacing = 1e-7"),
        "spacing: found 1e-07 m, which makes about",
    ),
    "period too short": (
        edited("until = 2.0 ", "periodic = { x = [0.0, 0.05] }\nuntil = 2.0 "),
        "periodic.x: found a period of 0.05 m, must be at least two support radii",
    ),
    "period upside down": (
        edited("until = 2.0 ", "periodic = { x = [1.0, 0.0] }\nuntil = 2.0 "),
        "periodic.x: found [1.0, 0.0], must be [low, high]",
    ),
    "nothing sets the sound speed": (
        edited("gravity = [0.0, -9.81]", ""),
        "is missing: without gravity nothing says what is up",
    ),
    "diffusion": (
        edited('density_diffusion = "antuono"', 'density_diffusion = "antuono2"'),
        'numerics.density_diffusion: found "antuono2", must be "auto"',
    ),
    "list of the wrong length": (
        edited("at = [1.61, 0.015]", "at = [1.61]"),
        "probe.P2.pressure.at: found [1.61], must have at least 2 entries",
    ),
    "broken TOML": (edited(SPACING, "spacing = = 0.01"), "line 7, column 11: broken TOML"),
    "TOML that ends early": ('name = "tank', "broken TOML"),
    "key given twice": (edited(SPACING, "dimension = 2\nspacing = 0.01"), "line 7, column"),
}


@pytest.mark.parametrize("what", BAD)
def test_a_bad_scene_file(what: str, tmp_path: Path) -> None:
    text, message = BAD[what]
    file = tmp_path / "bad.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(file).bodies()
    assert message in str(caught.value)
    for foreign in ("pydantic", "validation error", "Traceback", "type=", "errors.pydantic"):
        assert foreign not in str(caught.value)
    # The library's own error is not shown behind ours.
    assert caught.value.__cause__ is None
    assert caught.value.__suppress_context__ or caught.value.__context__ is None


def test_the_template_is_good() -> None:
    assert loads(GOOD).bodies()


def test_several_problems_are_told_at_once() -> None:
    text = edited("density = 1000.0", "densty = 1000.0").replace("until = 2.0 ", "until = -2.0 ")
    with pytest.raises(SceneError) as caught:
        loads(text)
    assert "2 problems in the scene" in str(caught.value)
    assert {p.path for p in caught.value.problems} == {("until",), ("fluid", "water", "densty")}


JUNK: list[object] = [
    "",
    "x",
    -1,
    0,
    10**400,
    1e300,
    -1e-300,
    1e-12,
    1e12,
    "1e300 * x",
    "log(x - 9)",
    [1e50, 1e50, 1e50],
    float("inf"),
    True,
    [],
    {},
    [[]],
    [1, "a"],
    [1.0, 2.0, 3.0, 4.0],
    {"self": 1},
    {"name": 3},
    [{"name": "x"}],
    [None],
    b"bytes",
    np.array([1.0, np.nan]),
    object(),
]


def places(value: object, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Paths of all that is nested in ``value``."""
    if path:
        yield path
    if isinstance(value, dict):
        for key, part in value.items():
            yield from places(part, (*path, key))
    elif isinstance(value, list):
        for i, part in enumerate(value):
            yield from places(part, (*path, i))


def test_junk_in_any_place_is_a_scene_error_or_a_scene() -> None:
    good = loads(GOOD).replace(
        {
            "periodic": {"z": [0.0, 1.0]},
            "dimension": 3,
            "spacing": 0.1,
            "gravity": [0.0, 0.0, -9.81],
            "fluid.0.velocity": ["x", 0.0, 0.0],
            "fluid.0.shape": {
                "union": [
                    {"polygon": {"points": [[0, 0], [1, 0], [0, 1]], "from": 0.0, "to": 1.0}},
                    {"cylinder": {"from": [0, 0, 0], "to": [0, 0, 1], "radius": 1.0}},
                    {"sphere": {"centre": [0, 0, 0], "radius": 1.0}},
                    {
                        "difference": {
                            "of": {"box": {"from": [0, 0, 0], "to": [1, 1, 1]}},
                            "minus": [
                                {"function": {"from": [0, 0, 0], "to": [1, 1, 1], "value": "x"}}
                            ],
                        }
                    },
                ]
            },
            "wall.0.shape.tank": {"from": [0, 0, 0], "to": [2, 2, 2], "open": ["top"]},
            "probe": [
                {"name": "p", "pressure": {"at": [0, 0, 0], "diameter": 0.1}, "every": 0.1},
                {"name": "l", "level": {"at": [0, 0, 0], "direction": [0, 0, 1]}},
                {"name": "f", "front": {"axis": "x", "body": "water"}},
                {"name": "load", "force": {"body": "tank"}},
                {"name": "u", "field": {"quantity": "velocity", "at": [0, 0, 0]}},
            ],
        }
    )
    data = good.plain()
    tried = 0
    for path in places(data):
        for junk in JUNK:
            changed = copy.deepcopy(data)
            here: Any = changed
            for part in path[:-1]:
                here = here[part]
            here[path[-1]] = junk
            try:
                Scene(**changed).bodies()
            except SceneError as error:
                assert "pydantic" not in str(error)
                assert len(str(error).splitlines()[0]) < 400
            tried += 1
    assert tried > 1000


def test_a_misspelt_key_is_not_also_missing() -> None:
    with pytest.raises(SceneError) as caught:
        loads(edited(SPACING, "spacng = 0.01"))
    assert [p.path for p in caught.value.problems] == [("spacng",)]


def test_missing_file(tmp_path: Path) -> None:
    (tmp_path / "tank.toml").write_text(GOOD, encoding="utf-8")
    with pytest.raises(SceneError, match=r"found no such file; did you mean 'tank\.toml'"):
        load(tmp_path / "tonk.toml")
    with pytest.raises(SceneError, match="found no such file"):
        load(tmp_path / "tonk.py")


def test_a_folder_and_a_binary_are_no_scene(tmp_path: Path) -> None:
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    with pytest.raises(SceneError, match="cannot be read"):
        load(folder)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="UTF-8"):
        load(tmp_path / "binary.toml")


def test_unknown_case() -> None:
    with pytest.raises(SceneError, match="'dam-brake'; did you mean 'dam-break'"):
        load("dam-brake")
    with pytest.raises(SceneError, match="There is dam-break, dam-break-box"):
        cases.get("nothing")


def test_a_file_of_another_kind(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text("a: 1", encoding="utf-8")
    with pytest.raises(SceneError, match=r"neither \.toml nor \.py"):
        load(file)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\n", "defines no 'scene'"),
        (
            "import kolk\nmine = kolk.load('still-water')\n",
            "found a scene called 'mine': rename it",
        ),
        ("scene = 3\n", "'scene' is of type int, must be kolk.Scene"),
        ("scene = (\n", "line 1, column"),
        ("x = 1\ny = x / 0\n", "line 2: raised ZeroDivisionError"),
        ("import nothing_such\n", "line 1: raised ModuleNotFoundError"),
        ("import kolk\nscene = kolk.Scene(nme='a')\n", "nme: unknown key; did you mean 'name'"),
    ],
)
def test_a_bad_python_file(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(file)
    assert str(caught.value).startswith(str(file))
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("spacng", 0.1, "spacng: unknown key; did you mean 'spacing'"),
        ("fluid.watr.density", 1.0, "fluid.watr: names nothing; did you mean 'water'"),
        ("fluid.water.density.x", 1.0, "fluid.water.density.x: 'density' is no table"),
        ("fluid.9.density", 1.0, "fluid.9: names nothing. There is water"),
        ("until", "long", 'until: found "long", must be a number'),
        ("spacing", None, "spacing: is missing"),
    ],
)
def test_bad_replacements(key: str, value: object, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        loads(GOOD).replace({key: value})
    assert message in str(caught.value)


def test_missing_and_broken_particle_files(tmp_path: Path) -> None:
    text = edited(BOX, 'particles = "water.npz"\ndensity')
    file = tmp_path / "own.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match=r"fluid\.water\.particles: found no file at"):
        load(file)
    (tmp_path / "water.npz").write_bytes(b"nonsense")
    with pytest.raises(SceneError, match=r"is no readable \.npz file"):
        load(file)


def test_memory_is_compared_with_what_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available", lambda: 100_000)
    with pytest.raises(SceneError, match=r"spacing: found 0\.01 m.*use a spacing of"):
        loads(GOOD).bodies()


def test_functions_in_python_that_return_nonsense() -> None:
    scene = loads(GOOD)
    for function in (lambda x: x[:3], lambda x: "a", lambda x: x * float("nan")):
        with pytest.raises(SceneError, match=r"fluid\.water\.velocity: (gave|cannot|is not)"):
            scene.replace({"fluid.water.velocity": function}).bodies()


def test_every_error_is_ours_and_a_value_error() -> None:
    assert issubclass(SceneError, KolkError) and issubclass(SceneError, ValueError)
    with pytest.raises(ValueError):
        Scene()
