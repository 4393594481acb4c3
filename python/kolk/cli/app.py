"""The typer application: options of the command itself, and its verbs."""

from __future__ import annotations

from typing import Annotated

import typer

from kolk.cli import accuracy, bench, cases, check, estimate, explain, new, render, report, run

app = typer.Typer(
    name="kolk",
    help="Smoothed particle hydrodynamics: run scenes, look at what they left behind.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from kolk.output.summary import version

        print(f"kolk {version()}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show tracebacks of errors.")] = False,
) -> None:
    """Options that stand before a verb (`--debug` may stand anywhere; the gate takes it out)."""


for verb in (
    run.run,
    cases.cases,
    check.check,
    explain.explain,
    estimate.estimate,
    accuracy.accuracy,
    bench.bench,
    new.new,
    render.render,
    report.report,
):
    app.command()(verb)
