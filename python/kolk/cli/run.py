"""`kolk run`: runs a scene and says how it went."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from kolk.cli.gate import gated
from kolk.cli.scenes import SceneWord, Settings, Spacing, find_scene, run_folder
from kolk.simulation import DEFAULT_PRECISION

if TYPE_CHECKING:
    from kolk.simulation import Precision


@gated
def run(
    scene: SceneWord,
    spacing: Spacing = None,
    until: Annotated[
        float | None, typer.Option("--until", help="End of the run, s.", metavar="S")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", help="The run's folder.", show_default="runs/NAME, or runs/NAME-2 ..."
        ),
    ] = None,
    threads: Annotated[int, typer.Option("--threads", help="0: every core.")] = 0,
    precision: Annotated[
        str | None,
        typer.Option(
            "--precision",
            help="f64, or mixed: pair arithmetic in f32.",
            show_default=f"{DEFAULT_PRECISION}, or the resumed run's",
        ),
    ] = None,
    settings: Settings = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the run in the folder.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Start over in a folder that holds a run.")
    ] = False,
    tolerance: Annotated[
        str | None,
        typer.Option(
            "--tolerance",
            metavar="SHARE",
            help="Choose the spacing for an error, such as 2%; studies the scene where needed.",
        ),
    ] = None,
    budget: Annotated[
        str | None,
        typer.Option(
            "--budget", metavar="TIME", help="Choose the finest spacing for a time, such as 10min."
        ),
    ] = None,
    quantity: Annotated[
        str | None,
        typer.Option("--quantity", metavar="NAME", help="What --tolerance speaks of: a probe."),
    ] = None,
    pictures: Annotated[
        bool | None,
        typer.Option(
            "--pictures/--no-pictures", help="Pictures and film.", show_default="as the scene says"
        ),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show nothing but errors.")] = False,
) -> None:
    """Run a scene; its results go into a folder."""
    from kolk import runner
    from kolk.cli.closing import closing
    from kolk.progress import silence

    found = find_scene(scene, settings or [], spacing=spacing, until=until)
    promise = None
    if tolerance is not None or budget is not None:
        from kolk.cli.promises import promised

        with silence(quiet):
            promise = promised(
                found,
                tolerance,
                budget,
                quantity,
                fixed=spacing is not None or resume,
                precision=cast("Precision | None", precision),
                threads=threads,
                quiet=quiet,
            )
        found, precision = promise.scene, promise.precision
    if resume and out is None:
        out = run_folder(scene)
    finished = runner.run(
        found,
        out,
        precision=cast("Precision | None", precision),
        threads=threads,
        resume=resume,
        force=force,
        quiet=quiet,
        pictures=pictures,
    )
    if not quiet:
        print(closing(finished))
    if promise is not None:
        from kolk.cli.promises import settled

        settled(promise, finished)
