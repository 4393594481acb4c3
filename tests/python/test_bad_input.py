"""Bad input from the command line: one clear error, status 2, no traceback, nothing left behind."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from kolk.cli import main

TITLE = 'name = "tank"\n'

# What is wrong; text of the tank's scene, what replaces it; what the message must say.
SCENES: list[tuple[str, str, str, list[str]]] = [
    ("unknown key", TITLE, TITLE + "spacng = 1\n", ["spacng", "spacing"]),
    ("key of another table", "until = 0.1", "until = 0.1\ndensity = 1.0", ["density"]),
    ("missing key", "spacing = 0.05\n", "", ["spacing", "missing"]),
    ("text for a number", "spacing = 0.05", 'spacing = "fine"', ["spacing", "fine", "number"]),
    ("no number", "until = 0.1", "until = nan", ["until", "nan"]),
    ("negative spacing", "spacing = 0.05", "spacing = -0.05", ["spacing", "-0.05", "greater"]),
    ("zero duration", "until = 0.1", "until = 0.0", ["until", "greater"]),
    ("four dimensions", "dimension = 2", "dimension = 4", ["dimension", "4", "2 or 3"]),
    ("gravity in 3D", "[0.0, -9.81]", "[0.0, 0.0, -9.81]", ["gravity", "2 numbers"]),
    ("no fluid", "[[fluid]]", "[[probe]]", ["fluid", "missing"]),
    ("one table for a list", "[[fluid]]", "[fluid]", ["fluid", "[[fluid]]"]),
    ("unknown shape", "box = {", "cube = {", ["fluid.water.shape", "cube", "box"]),
    ("3D shape in 2D", "[0.4, 0.3]", "[0.4, 0.3, 0.1]", ["fluid.water.shape"]),
    ("shape inside out", "to = [0.4, 0.3]", "to = [-0.4, 0.3]", ["fluid.water.shape", "to"]),
    ("fluid outside its tank", "to = [0.4, 0.3]", "to = [1.4, 0.3]", ["water", "tank"]),
    ("spacing too coarse", "spacing = 0.05", "spacing = 0.5", ["spacing", "0.5"]),
    ("memory beyond the machine", "spacing = 0.05", "spacing = 1e-7", ["spacing", "GB"]),
    ("bodies of one name", 'name = "tank"\nshape', 'name = "water"\nshape', ["water", "name"]),
    ("unknown kernel", TITLE, TITLE + 'kernel = "gauss"\n', ["kernel", "gauss", "wendland-c2"]),
    ("unknown side", 'open = ["top"]', 'open = ["lid"]', ["wall.tank.shape", "lid", "top"]),
    ("negative density", "viscosity =", "density = -1.0\nviscosity =", ["density", "-1"]),
    ("two kinds of probe", "front = {", "level = { at = [0.1, 0.0] }\nfront = {", ["probe.front"]),
    ("force on no wall", 'body = "tank"', 'body = "tonk"', ["probe.load", "tonk", "tank"]),
    ("unknown field", '"velocity"', '"vorticity"', ["probe.speed", "vorticity", "velocity"]),
    ("frames backwards", "every = 0.02", "every = -0.02", ["output.every", "-0.02", "greater"]),
    ("broken TOML", "spacing = 0.05", "spacing = = 0.05", ["line 3", "TOML"]),
    ("period too short", "until = 0.1", "until = 0.1\nperiodic = { x = [0.0, 0.1] }", ["periodic"]),
    (
        "overlapping bodies",
        "[[wall]]",
        '[[fluid]]\nname = "more"\nshape = { box = { from = [0.2, 0.0], to = [0.6, 0.3] } }\n'
        "viscosity = { artificial = 0.02 }\n\n[[wall]]",
        ["more", "water"],
    ),
    (
        "two materials",
        "[[wall]]",
        '[[fluid]]\nname = "oil"\nshape = { box = { from = [0.5, 0.0], to = [0.9, 0.3] } }\n'
        "density = 800.0\n\n[[wall]]",
        ["oil", "density"],
    ),
    (
        "empty fluid",
        "box = { from = [0.0, 0.0], to = [0.4, 0.3] }",
        "difference = { of = { box = { from = [0.0, 0.0], to = [0.4, 0.3] } }, "
        "minus = [{ box = { from = [-1.0, -1.0], to = [1.0, 1.0] } }] }",
        ["fluid.water", "particle"],
    ),
]

# What is wrong; words after `kolk`; what the message must say.
COMMANDS: list[tuple[str, list[str], list[str]]] = [
    ("unknown scene", ["run", "dam-brake"], ["dam-brake", "dam-break"]),
    ("missing file", ["run", "nothing.toml"], ["nothing.toml", "no such file"]),
    ("missing Python file", ["run", "nothing.py"], ["nothing.py", "no such file"]),
    ("no scene at all", ["run"], ["SCENE"]),
    ("unknown verb", ["walk", "tank.toml"], ["walk"]),
    ("unknown option", ["run", "tank.toml", "--spaced", "1"], ["--spaced"]),
    ("words for a number", ["run", "tank.toml", "--spacing", "fine"], ["--spacing"]),
    ("negative duration", ["run", "tank.toml", "--until", "-1"], ["until", "-1"]),
    ("half a setting", ["run", "tank.toml", "--set", "spacing"], ["--set spacing", "KEY=VALUE"]),
    ("unknown setting", ["run", "tank.toml", "--set", "fluid.oil.density=1"], ["oil", "water"]),
    ("unknown precision", ["run", "tank.toml", "--precision", "f16"], ["f16", "mixed"]),
    ("negative threads", ["run", "tank.toml", "--threads", "-2"], ["threads", "-2"]),
    ("nothing to resume", ["run", "tank.toml", "--resume"], ["tank", "without --resume"]),
    ("nothing there", ["run", "tank.toml", "--resume", "--out", "here"], ["here", "no run"]),
    ("go on and start over", ["run", "tank.toml", "--resume", "--force"], ["exclude each other"]),
    ("folder is a file", ["run", "tank.toml", "--out", "tank.toml"], ["tank.toml", "--out"]),
    ("folder in a file", ["run", "tank.toml", "--out", "tank.toml/a"], ["tank.toml", "--out"]),
    ("folder of others", ["run", "tank.toml", "--out", "."], ["other files", "--force"]),
    ("pictures of nothing", ["render", "nothing"], ["nothing", "folder of a kolk run"]),
    ("scene to no TOML", ["new", "scene.txt"], ["scene.txt", ".toml"]),
    ("scene over a scene", ["new", "tank.toml"], ["tank.toml exists", "--force"]),
    ("scene into nowhere", ["new", "no/such/folder.toml"], ["folder.toml", "No such file"]),
]

PYTHON = {
    "defines no scene": ("x = 1\n", ["defines no 'scene'"]),
    "scene is no scene": ("scene = 3\n", ["kolk.Scene"]),
    "syntax": ("scene = (\n", ["line 1"]),
    "raises": ("scene = 1 / 0\n", ["line 1", "ZeroDivisionError"]),
}

ARRAYS = {
    "one axis": ("np.zeros(4)", ["position", "shape", "(4,)"]),
    "four axes": ("np.zeros((4, 4))", ["position", "(4, 4)"]),
    "text": ("np.array([['a', 'b']])", ["position", "real numbers"]),
    "NaN": ("np.full((4, 2), np.nan)", ["position[0]", "finite"]),
    "nothing": ("np.zeros((0, 2))", ["position", "no particles"]),
    "other lengths": ("np.eye(2), velocity=np.zeros((3, 2))", ["velocity", "(3, 2)", "(2, 2)"]),
    "negative mass": ("np.eye(2), mass=np.array([1.0, -1.0])", ["mass[1]", "-1", "greater"]),
    "negative density": ("np.eye(2), density=np.array([1.0, 0.0])", ["density[1]", "greater"]),
}


def assert_refused(words: list[str], says: list[str], capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(words)
    captured = capfd.readouterr()
    assert end.value.code == 2, captured
    for part in says:
        assert part in captured.err
    assert captured.err.count("kolk: ") == 1 or "Error: " in captured.err
    assert "Traceback" not in captured.err
    assert "\n\n\n" not in captured.err
    assert captured.out == ""
    assert not Path("runs").exists()


@pytest.mark.parametrize(
    ("old", "new", "says"), [s[1:] for s in SCENES], ids=[s[0] for s in SCENES]
)
def test_scenes(
    tank: Path, capfd: pytest.CaptureFixture[str], old: str, new: str, says: list[str]
) -> None:
    text = tank.read_text(encoding="utf-8")
    assert old in text
    Path("bad.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    assert_refused(["run", "bad.toml"], says, capfd)


@pytest.mark.parametrize(("words", "says"), [c[1:] for c in COMMANDS], ids=[c[0] for c in COMMANDS])
def test_commands(
    tank: Path, capfd: pytest.CaptureFixture[str], words: list[str], says: list[str]
) -> None:
    assert_refused(words, says, capfd)


@pytest.mark.parametrize(("text", "says"), PYTHON.values(), ids=PYTHON.keys())
def test_python_scenes(
    tank: Path, capfd: pytest.CaptureFixture[str], text: str, says: list[str]
) -> None:
    Path("bad.py").write_text(text, encoding="utf-8")
    assert_refused(["run", "bad.py"], ["bad.py", *says], capfd)


@pytest.mark.parametrize(("arguments", "says"), ARRAYS.values(), ids=ARRAYS.keys())
def test_arrays(
    tank: Path, capfd: pytest.CaptureFixture[str], arguments: str, says: list[str]
) -> None:
    text = (
        "import kolk, numpy as np\n"
        f"water = kolk.Fluid.from_arrays({arguments})\n"
        'scene = kolk.Scene(name="own", dimension=2, spacing=0.1, until=1.0, fluid=[water])\n'
    )
    Path("bad.py").write_text(text, encoding="utf-8")
    assert_refused(["run", "bad.py"], says, capfd)


def test_a_file_that_is_no_text(tank: Path, capfd: pytest.CaptureFixture[str]) -> None:
    Path("bad.toml").write_bytes(np.arange(256, dtype=np.uint8).tobytes())
    assert_refused(["run", "bad.toml"], ["bad.toml", "UTF-8"], capfd)


def test_a_folder_that_may_not_be_written(
    tank: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    locked = Path("locked")
    locked.mkdir()
    locked.chmod(0o555)
    if os.access(locked, os.W_OK):
        # The superuser may write anywhere: let the system refuse in its own words.
        def refuse(*_: object, **__: object) -> None:
            raise PermissionError(13, os.strerror(13), str(locked))

        monkeypatch.setattr(Path, "mkdir", refuse)
    assert_refused(["run", "tank.toml", "--out", "locked/run"], ["locked/run", "--out"], capfd)


@pytest.mark.skipif(sys.platform != "linux", reason="/proc is a read-only file system on Linux")
def test_a_read_only_disk(tank: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert_refused(["run", "tank.toml", "--out", "/proc/kolk"], ["/proc/kolk", "--out"], capfd)


def test_a_damaged_checkpoint(tank: Path, capfd: pytest.CaptureFixture[str]) -> None:
    folder = Path("here")
    with pytest.raises(SystemExit) as end:
        main(["run", "tank.toml", "--out", "here", "--quiet"])
    assert end.value.code == 0
    (folder / "checkpoint.h5").write_bytes(b"torn")
    resume = ["run", "tank.toml", "--out", "here", "--resume"]
    assert_refused(resume, ["checkpoint.h5", "cannot be read"], capfd)
    (folder / "checkpoint.h5").unlink()
    assert_refused(resume, ["nothing to resume"], capfd)
