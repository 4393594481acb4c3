"""`kolk new`: a commented scene to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kolk.cli.gate import gated
from kolk.errors import RunError
from kolk.output.atomic import write_text
from kolk.output.folder import safe_name


@gated
def new(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The scene to write (.toml).")],
    force: Annotated[bool, typer.Option("--force", help="Overwrite a file.")] = False,
) -> None:
    """Write a commented scene to start from."""
    from kolk.scene import template

    if file.suffix != ".toml":
        raise RunError(f"{file}: a scene file ends in .toml; try  kolk new {file.stem}.toml")
    if file.exists() and not force:
        raise RunError(f"{file} exists: choose another name, or overwrite it with --force")
    # A scene's name begins with a letter or a digit and holds no dot.
    name = safe_name(file.stem).replace(".", "_").lstrip("_+-") or "scene"
    write_text(file, template(name).replace("FILE", str(file)), "write the scene")
    print(f"wrote {file}; next:  kolk check {file}")
