"""`kolk explain`: which effects a scene runs, why, and what each costs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, cast

import typer

from kolk.cli.gate import gated
from kolk.cli.scenes import SceneWord, Settings, Spacing, find_scene
from kolk.simulation import DEFAULT_PRECISION

if TYPE_CHECKING:
    from kolk.simulation import Precision


@gated
def explain(
    scene: SceneWord,
    spacing: Spacing = None,
    precision: Annotated[
        str, typer.Option("--precision", help="f64, or mixed: pair arithmetic in f32.")
    ] = DEFAULT_PRECISION,
    settings: Settings = None,
    seconds: Annotated[
        float,
        typer.Option("--seconds", help="About how long to measure, s.", min=0.0, max=3600.0),
    ] = 10.0,
    measured: Annotated[
        bool, typer.Option("--measure/--no-measure", help="Measure what each effect costs.")
    ] = True,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", help="Do not say what is being measured.")
    ] = False,
) -> None:
    """Say which effects a scene runs, why, and what each costs."""
    import sys
    from json import dumps

    from kolk.explain import explain as explained

    def say(text: str) -> None:
        if not quiet:
            print(f"kolk: {text} ...", file=sys.stderr)

    found = explained(
        find_scene(scene, settings or [], spacing=spacing),
        precision=cast("Precision", precision),
        seconds=seconds,
        measured=measured,
        say=say,
    )
    if json:
        print(dumps(found.plain(), indent=2))
        return
    from rich.console import Console

    from kolk.explain.table import show

    show(found, Console())
