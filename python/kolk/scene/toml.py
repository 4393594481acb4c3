"""Writing scenes: complete, and read back to the same particles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import AoT, InlineTable, Item, Table

from kolk.errors import Problem, SceneError
from kolk.output.atomic import write_bytes, write_text

from .arrays import Particles
from .expression import Expression
from .model import Scene

_INLINE = {"shape", "viscosity", "pressure", "level", "front", "force", "field", "periodic"}


def to_toml(scene: Scene) -> str:
    """The text of a scene file. Raises SceneError where the scene has more than text can hold."""
    problems = [
        Problem(path, "is a Python object, which no scene file holds: write with scene.save(path)")
        for path in _beyond_text(scene)
    ]
    if problems:
        raise SceneError(problems=problems)
    return _text(_complete(scene))


def save(scene: Scene, path: Path) -> None:
    """Write the scene file and the particles that it needs beside it."""
    data = _complete(scene)
    bodies = {body.name: body for body in scene.bodies()} if _beyond_text(scene) else {}
    for table in ("fluid", "wall"):
        for entry in data.get(table, []):
            if not any(where[:2] == (table, entry["name"]) for where in _beyond_text(scene)):
                continue
            body = bodies[entry["name"]]
            file = path.with_name(f"{body.name}.npz")
            full = Particles(body.position, body.velocity, body.density, body.mass)
            if table == "wall":
                full = Particles(body.position, mass=body.mass)
            full.save(file)
            # The particles are as they start: nothing is left to evaluate or to shift.
            for key in ("shape", "arrangement", "jitter", "seed"):
                entry.pop(key, None)
            if table == "fluid":
                for key in ("velocity", "pressure"):
                    entry.pop(key, None)
                entry["sound_speed"] = scene.sound_speed
            entry["particles"] = file.name
    for table in ("fluid", "wall"):
        for entry in data.get(table, []):
            _bring_files(entry.get("shape"), path, entry["name"])
    write_text(path, _text(data), "write the scene")


def _bring_files(shape: Any, path: Path, name: str) -> None:
    """Copy the files of a shape beside the scene file, under names of the body's own."""
    if isinstance(shape, list):
        for i, part in enumerate(shape, 1):
            _bring_files(part, path, f"{name}-{i}")
    elif isinstance(shape, dict):
        for kind, part in shape.items():
            if kind in ("mesh", "outline"):
                source = Path(part["file"])
                copy = path.with_name(f"{name}{source.suffix.lower()}")
                if not copy.exists() or not copy.samefile(source):
                    write_bytes(copy, source.read_bytes(), "copy a shape's file")
                part["file"] = copy.name
            elif kind in ("union", "difference", "of", "minus"):
                _bring_files(part, path, f"{name}-{kind}" if kind != "difference" else name)


def _beyond_text(scene: Scene) -> list[tuple[str, ...]]:
    """Paths of what only Python can hold: functions and arrays."""
    found: list[tuple[str, ...]] = []

    def look(value: Any, path: tuple[str, ...]) -> None:
        if isinstance(value, dict):
            for key, part in value.items():
                look(part, (*path, key))
        elif isinstance(value, list):
            for part in value:
                name = part.get("name") if isinstance(part, dict) else None
                look(part, path if name is None else (*path, name))
        elif isinstance(value, Particles) or (
            callable(value) and not isinstance(value, Expression)
        ):
            found.append(path)

    look(scene.plain(), ())
    return found


def _complete(scene: Scene) -> dict[str, Any]:
    data = scene.model_dump(exclude_none=True)
    plain: dict[str, Any] = _texts(data)
    return {key: value for key, value in plain.items() if value not in ([], {})}


def _texts(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _texts(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_texts(part) for part in value]
    return value.text if isinstance(value, Expression) else value


def _text(data: dict[str, Any]) -> str:
    document = tomlkit.document()
    document.add(tomlkit.comment("kolk scene, complete: SI units, defaults written out"))
    for key, value in data.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            tables: AoT = tomlkit.aot()
            for entry in value:
                tables.append(_table(entry))
            document.add(key, tables)
        elif isinstance(value, dict) and key not in _INLINE:
            document.add(key, _table(value))
        else:
            document.add(key, _item(value))
    return tomlkit.dumps(document)


def _table(data: dict[str, Any]) -> Table:
    table = tomlkit.table()
    for key, value in data.items():
        table.add(key, _item(value))
    return table


def _item(value: Any) -> Item | Any:
    if isinstance(value, dict):
        inline: InlineTable = tomlkit.inline_table()
        for key, part in value.items():
            inline.append(key, _item(part))
        return inline
    if isinstance(value, list):
        array = tomlkit.array()
        for part in value:
            array.append(_item(part))
        return array
    return tomlkit.item(value)
