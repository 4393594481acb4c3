"""From words on the command line to a scene: names, files, run folders, `--set`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kolk.errors import SceneError

if TYPE_CHECKING:
    from kolk.scene import Scene

SceneWord = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A built-in scene (see kolk cases), a .toml file, a .py file that defines `scene`, "
        "or the folder of a run.",
    ),
]
Spacing = Annotated[
    float | None, typer.Option("--spacing", help="Initial particle spacing, m.", metavar="M")
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Any key of the scene, such as fluid.water.viscosity.artificial=0.05; repeatable.",
    ),
]


def run_folder(word: str) -> Path | None:
    """The folder of a run that `word` names, if it does."""
    path = Path(word)
    return path if (path / "scene.toml").is_file() else None


def find_scene(word: str, settings: Sequence[str], **given: float | None) -> Scene:
    """Loads the scene that `word` names and applies the settings and the options `given`.

    Raises `SceneError`.
    """
    from kolk.scene import load

    folder = run_folder(word)
    scene = load(folder / "scene.toml" if folder else word)
    changes: dict[str, Any] = dict(parse_setting(setting) for setting in settings)
    changes |= {key: value for key, value in given.items() if value is not None}
    return scene.replace(changes) if changes else scene


def parse_setting(setting: str) -> tuple[str, Any]:
    """`KEY=VALUE` as a key and a value: TOML's notation, or a bare word as text."""
    import sys

    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib

    key, sign, text = setting.partition("=")
    key, text = key.strip(), text.strip()
    if not sign or not key or not text:
        raise SceneError(
            f"--set {setting}: must be KEY=VALUE, such as fluid.water.viscosity.artificial=0.05"
        )
    try:
        return key, tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return key, text
