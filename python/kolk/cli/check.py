"""`kolk check`: validates and describes a scene without running it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kolk.cli.gate import gated
from kolk.cli.scenes import SceneWord, Settings, Spacing, find_scene


@gated
def check(
    scene: SceneWord,
    spacing: Spacing = None,
    settings: Settings = None,
    picture: Annotated[
        bool, typer.Option("--picture", help="Draw the set-up, into NAME-set-up.png.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", help="Draw the set-up into this file.", metavar="PNG")
    ] = None,
) -> None:
    """Validate and describe a scene without running it."""
    from kolk import check as checking

    found = find_scene(scene, settings or [], spacing=spacing)
    print(checking.describe(found))
    if picture or out is not None:
        print(checking.picture(found, out or Path(f"{found.name}-set-up.png")))
