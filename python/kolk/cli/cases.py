"""`kolk cases`: the built-in scenes."""

from __future__ import annotations

import shutil
import textwrap

from kolk.cli.gate import gated


@gated
def cases() -> None:
    """List the built-in scenes: what each shows, its reference, and what it costs."""
    from kolk import cases as built_in

    width = min(max(shutil.get_terminal_size().columns, 60), 100)
    for name in built_in.names():
        case = built_in.get(name)
        print(f"{name}: {case.title}")
        for label, text in (
            ("shows", case.shows),
            ("source", case.source),
            ("reference", case.reference),
            ("cost", case.cost),
        ):
            print(
                textwrap.fill(
                    text,
                    width,
                    initial_indent=f"    {label:<11}",
                    subsequent_indent=" " * 15,
                )
            )
        print()
    print("Run one with  kolk run NAME")
