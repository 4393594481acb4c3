"""`kolk estimate`: particles, memory, steps and time before a run."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, cast

import typer

from kolk.cli.gate import gated
from kolk.cli.scenes import SceneWord, Settings, Spacing, find_scene

if TYPE_CHECKING:
    from kolk.simulation import Precision


@gated
def estimate(
    scene: SceneWord,
    spacing: Spacing = None,
    until: Annotated[
        float | None, typer.Option("--until", help="End of the run, s.", metavar="S")
    ] = None,
    settings: Settings = None,
    precision: Annotated[
        str | None, typer.Option("--precision", help="f64, or mixed.", show_default="mixed")
    ] = None,
    threads: Annotated[int, typer.Option("--threads", help="0: every core.")] = 0,
    seconds: Annotated[
        float, typer.Option("--seconds", help="Of steps in each of the two pilots.")
    ] = 3.0,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False,
) -> None:
    """Estimate particles, memory, steps and time by a pilot run of a few seconds."""
    from kolk.study.estimate import estimate as work_out

    found = work_out(
        find_scene(scene, settings or [], spacing=spacing, until=until),
        precision=cast("Precision | None", precision),
        threads=threads,
        seconds=seconds,
    )
    print(json.dumps(found.as_dict(), indent=2) if as_json else found)
