"""Scenes small enough to run in a test."""

from collections.abc import Callable
from pathlib import Path

import pytest

TANK = """\
name = "tank"
dimension = 2
spacing = 0.05
gravity = [0.0, -9.81]
until = 0.1

[[fluid]]
name = "water"
shape = { box = { from = [0.0, 0.0], to = [0.4, 0.3] } }
viscosity = { artificial = 0.02 }

[[wall]]
name = "tank"
shape = { tank = { from = [0.0, 0.0], to = [1.0, 0.6], open = ["top"] } }

[[probe]]
name = "P"
pressure = { at = [0.0, 0.1], diameter = 0.05 }

[[probe]]
name = "level"
level = { at = [0.2, 0.0] }

[[probe]]
name = "front"
front = { axis = "x" }

[[probe]]
name = "load"
force = { body = "tank" }

[[probe]]
name = "speed"
field = { quantity = "velocity", at = [0.3, 0.1] }

[output]
every = 0.02
pictures = false
"""


@pytest.fixture
def tank(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scene file of a small dam break; the working directory is an empty folder of its own."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "tank.toml"
    path.write_text(TANK, encoding="utf-8")
    return path


Variant = Callable[[str, str], Path]


@pytest.fixture
def variant(tank: Path) -> Variant:
    """Writes `bad.toml`: the tank with a piece of its text replaced by another."""

    def write(old: str, new: str) -> Path:
        assert old in TANK, f"the tank's scene has no {old!r}"
        path = tank.with_name("bad.toml")
        path.write_text(TANK.replace(old, new, 1), encoding="utf-8")
        return path

    return write
