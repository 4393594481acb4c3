"""The one place where errors become messages and exit statuses.

| status | meaning |
|---|---|
| 0 | done |
| 1 | the run began and ended early: unstable, disk full, ... |
| 2 | bad input: nothing was run |
| 130 | interrupted with the state saved |
"""

from __future__ import annotations

import functools
import os
import shlex
import sys
import traceback
from collections.abc import Callable, Sequence
from typing import ParamSpec

import typer

DONE, ENDED_EARLY, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

DEBUG = "--debug"
"""May stand anywhere on the command line; errors then show their traceback."""

Parameters = ParamSpec("Parameters")

_debugging = False


def main(arguments: Sequence[str] | None = None) -> None:
    """The command `kolk`; exits with one of the statuses above."""
    global _debugging
    from kolk.cli.app import app

    words = list(sys.argv[1:] if arguments is None else arguments)
    _debugging = DEBUG in words
    app([word for word in words if word != DEBUG], prog_name="kolk")


def gated(verb: Callable[Parameters, None]) -> Callable[Parameters, None]:
    """A verb whose errors end the command with one message on standard error and a status."""

    @functools.wraps(verb)
    def run_verb(*args: Parameters.args, **kwargs: Parameters.kwargs) -> None:
        try:
            verb(*args, **kwargs)
        except typer.Exit:
            raise
        except BrokenPipeError:
            # The reader of our output went away (`kolk cases | head`): nothing is wrong.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        except (Exception, KeyboardInterrupt) as error:
            if _debugging:
                traceback.print_exc()
            status, message = explain(error)
            print(f"kolk: {message}", file=sys.stderr)
            raise typer.Exit(status) from None

    return run_verb


def explain(error: BaseException) -> tuple[int, str]:
    """Exit status and message of an error."""
    from kolk.errors import InstabilityError, KolkError
    from kolk.execution import RunInterrupted, RunStopped
    from kolk.study.study import StudyInterrupted

    if isinstance(error, RunInterrupted):
        folder = shlex.quote(str(error.folder))
        again = f"render {folder}" if error.finished else f"run {folder} --resume"
        return INTERRUPTED, f"{error}; to go on:  kolk {again}"
    if isinstance(error, StudyInterrupted):
        return INTERRUPTED, str(error)
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, "interrupted before the run began; nothing was saved"
    if isinstance(error, (InstabilityError, RunStopped)):
        return ENDED_EARLY, str(error)
    if isinstance(error, KolkError):
        return BAD_INPUT, str(error)
    if isinstance(error, MemoryError):
        return BAD_INPUT, "this machine's memory does not hold the scene: use a larger spacing"
    return ENDED_EARLY, (
        f"an error that should not happen ({type(error).__name__}: {error}); "
        "repeat the command with --debug and report what it prints"
    )
