"""`kolk bench`: how fast this machine runs kolk."""

from __future__ import annotations

from typing import Annotated

import typer

from kolk.cli.gate import gated


@gated
def bench(
    threads: Annotated[int, typer.Option("--threads", help="0: every core.")] = 0,
    seconds: Annotated[
        float,
        typer.Option("--seconds", help="About how long to measure, s.", min=5.0, max=3600.0),
    ] = 45.0,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", help="Do not say what is being measured.")
    ] = False,
) -> None:
    """Measure how fast this machine runs kolk, in under a minute."""
    import dataclasses
    import sys
    from json import dumps

    from kolk import bench as benches

    def say(text: str) -> None:
        if not quiet:
            print(f"kolk: {text} ...", file=sys.stderr)

    found = benches.measure(threads=threads, seconds=seconds, say=say)
    if json:
        print(dumps(dataclasses.asdict(found), indent=2))
        return
    from rich.console import Console

    from kolk.bench.table import show

    show(found, Console())
