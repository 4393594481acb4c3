"""Scenes by name or from files: built-in, ``.toml``, or ``.py`` that defines ``scene``."""

from __future__ import annotations

import re
import runpy
import sys
from pathlib import Path
from typing import Any

from kolk.errors import KolkError, SceneError

from .base import nearest
from .mesh import place_shapes
from .model import Scene
from .motion import place_files

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def load(source: str | Path) -> Scene:
    """The scene that ``source`` names: a built-in case, a ``.toml`` or a ``.py`` file.

    Raises SceneError for an unknown name, a missing or broken file, and whatever is wrong in it.
    """
    path = Path(source)
    if path.suffix == ".toml":
        return _prefixed(path, lambda: loads(_read(path), path.parent))
    if path.suffix == ".py":
        return _prefixed(path, lambda: _from_python(path))
    return _built_in(str(source))


def loads(text: str, folder: str | Path = ".") -> Scene:
    """The scene in the ``text`` of a scene file; paths in it are relative to ``folder``.

    Raises SceneError.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError(_broken(error)) from None
    for table in ("fluid", "wall"):
        entries = data.get(table)
        if isinstance(entries, dict):
            raise SceneError(f"{table}: found one table, must be a list: write [[{table}]]")
        for entry in entries if isinstance(entries, list) else []:
            if isinstance(entry, dict) and isinstance(entry.get("particles"), str):
                entry["particles"] = str(Path(folder) / entry["particles"])
    place_files(data, Path(folder))
    place_shapes(data, Path(folder))
    if isinstance(data.get("probe"), dict):
        raise SceneError("probe: found one table, must be a list: write [[probe]]")
    return Scene(**data)


def _broken(error: Exception) -> str:
    text = str(error)
    place = re.search(r"\(at line (\d+), column (\d+)\)", text)
    if place:
        what = text[: place.start()].strip()
        return f"line {place[1]}, column {place[2]}: broken TOML: {what}"
    return f"at the end of the file: broken TOML: {text.replace(' (at end of document)', '')}"


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        siblings = [p.name for p in path.parent.glob("*.toml")] if path.parent.is_dir() else []
        raise SceneError(
            f"found no such file{nearest(path.name, siblings) or '.'} Write a new one with "
            f"'kolk new {path}'"
        ) from None
    except UnicodeDecodeError as error:
        raise SceneError(f"is no text in UTF-8 (byte {error.start}): save it as UTF-8") from None
    except OSError as error:
        raise SceneError(f"cannot be read: {error.strerror}") from None


def _prefixed(path: Path, make: Any) -> Scene:
    """Run ``make``; its errors name the file."""
    try:
        scene = make()
    except SceneError as error:
        raise SceneError(f"{path}: {error}", error.problems) from None
    assert isinstance(scene, Scene)
    return scene


def _from_python(path: Path) -> Scene:
    if not path.is_file():
        raise SceneError("found no such file: give the path of a .py file that defines 'scene'")
    try:
        # As a script of its own, beside whose file its imports are found.
        sys.path.insert(0, str(path.parent.resolve()))
        try:
            names = runpy.run_path(str(path), run_name="kolk_scene")
        finally:
            sys.path.pop(0)
    except KolkError:
        raise
    except SyntaxError as error:
        raise SceneError(f"line {error.lineno}, column {error.offset}: {error.msg}") from None
    except Exception as error:
        line = _line_in(path, error)
        at = f"line {line}: " if line else ""
        raise SceneError(f"{at}raised {type(error).__name__}: {error}") from error
    scene = names.get("scene")
    if scene is None:
        public = [n for n, v in names.items() if isinstance(v, Scene)]
        have = f"; found a scene called '{public[0]}': rename it" if public else ""
        raise SceneError(f"defines no 'scene'{have}. A .py file must set scene = kolk.Scene(...)")
    if not isinstance(scene, Scene):
        raise SceneError(
            f"'scene' is of type {type(scene).__name__}, must be kolk.Scene: "
            "set scene = kolk.Scene(...)"
        )
    return scene


def _line_in(path: Path, error: Exception) -> int | None:
    line, trace = None, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == str(path):
            line = trace.tb_lineno
        trace = trace.tb_next
    return line


def _built_in(name: str) -> Scene:
    from kolk import cases

    if name in cases.names():
        return cases.get(name).scene
    hint = nearest(name, cases.names()) or "."
    if Path(name).exists():
        raise SceneError(
            f"{name}: is neither .toml nor .py: give a scene file, or a built-in scene: "
            f"{', '.join(cases.names())}"
        )
    raise SceneError(
        f"no built-in scene is called '{name}'{hint} There is {', '.join(cases.names())}. "
        "A file must end in .toml or .py"
    )
