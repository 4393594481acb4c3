"""`kolk render`: pictures and film of a run that is already there."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from kolk.cli.gate import gated


@gated
def render(
    run: Annotated[
        str,
        typer.Argument(metavar="RUN", help="The folder of a run, or its name under runs/."),
    ],
    film: Annotated[bool, typer.Option("--film/--no-film", help="Make the film too.")] = True,
) -> None:
    """Draw pictures and a film of a run."""
    from pathlib import Path

    from kolk.output.folder import newest_folder
    from kolk.render import missing, render_run
    from kolk.results import Run

    named = None if Path(run).exists() else newest_folder(run)
    found = Run(named.path if named else run)
    made = render_run(found, film=film)
    for line in missing(found.frames[0].dimension):
        print(f"kolk: {line}", file=sys.stderr)
    for path in made:
        print(path)
