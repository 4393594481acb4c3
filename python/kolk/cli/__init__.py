"""The command `kolk`: one file per verb, errors handled once (`gate`)."""

from kolk.cli.gate import main

__all__ = ["main"]
