"""`kolk accuracy`: what accuracy costs in time, for any scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from kolk.cli.gate import gated
from kolk.cli.scenes import SceneWord, Settings, find_scene
from kolk.errors import SceneError

if TYPE_CHECKING:
    from kolk.simulation import Precision


@gated
def accuracy(
    scene: SceneWord,
    spacings: Annotated[
        str | None,
        typer.Option(
            "--spacings",
            metavar="M,M,...",
            help="Spacings of the ladder, m; three or more give an order.",
            show_default="four around the scene's own",
        ),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="KEY=A,B",
            help="Alternatives of a key, such as kernel=cubic,wendland-c4; repeatable.",
        ),
    ] = None,
    cross: Annotated[
        bool, typer.Option("--cross", help="Every combination of the alternatives.")
    ] = False,
    quantity: Annotated[
        str | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="The error to speak of: a probe, or an error against the reference.",
            show_default="the exact solution's, else the worst probe's",
        ),
    ] = None,
    until: Annotated[
        float | None, typer.Option("--until", help="End of the runs, s.", metavar="S")
    ] = None,
    settings: Settings = None,
    precision: Annotated[
        str | None, typer.Option("--precision", help="f64, or mixed.", show_default="mixed")
    ] = None,
    threads: Annotated[int, typer.Option("--threads", help="0: every core.")] = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="The study's folder.", show_default="studies/NAME"),
    ] = None,
    store: Annotated[
        Path | None,
        typer.Option("--store", help="Where finished runs are kept.", show_default="studies/runs"),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show the sentences alone.")] = False,
) -> None:
    """Measure what accuracy costs in time: runs over spacings and settings.

    Finished runs are kept: a study that was interrupted goes on when it is called again.
    """
    from kolk.study.ladder import parse_vary
    from kolk.study.study import accuracy as measure
    from kolk.study.tables import bars_markdown, runs_markdown

    study = measure(
        find_scene(scene, settings or [], until=until),
        None if spacings is None else parse_spacings(spacings),
        vary=parse_vary(vary or []),
        cross=cross,
        quantity=quantity,
        precision=cast("Precision | None", precision),
        threads=threads,
        out=out,
        store=store,
        quiet=quiet,
    )
    print("\n".join(study.sentences))
    if not quiet:
        print()
        print(runs_markdown(study))
        print(bars_markdown(study))
        print(f"Study: {study.folder}  (picture: {study.folder / 'accuracy.png'})")


def parse_spacings(text: str) -> list[float]:
    """`0.02,0.01` as numbers. Raises `SceneError`."""
    try:
        return [float(piece) for piece in text.split(",") if piece.strip()]
    except ValueError:
        raise SceneError(
            f"--spacings {text}: must be lengths in m with commas between, such as 0.02,0.014,0.01"
        ) from None
