"""`kolk report`: one HTML file about a run or a study."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kolk.cli.gate import gated

SECONDS = 5.0
"""About how long the effects are measured for."""


@gated
def report(
    run: Annotated[
        str,
        typer.Argument(
            metavar="RUN", help="The folder of a run or a study, or its name under runs/."
        ),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", help="The file.", show_default="RUN/report.html")
    ] = None,
    effects: Annotated[
        bool,
        typer.Option(
            "--effects/--no-effects", help="Measure what each effect costs, in some seconds."
        ),
    ] = True,
) -> None:
    """Write one self-contained HTML file about a run or a study."""
    from kolk.report import report as write

    print(write(run, out, effects=SECONDS if effects else 0.0))
