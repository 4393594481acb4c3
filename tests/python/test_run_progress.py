"""What a run shows of itself while it works."""

import io
import sys

import pytest

from kolk import progress
from kolk.progress import Progress, duration


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def show(monkeypatch: pytest.MonkeyPatch, stream: io.StringIO, quiet: bool = False) -> str:
    monkeypatch.setattr(sys, "stderr", stream)
    with Progress(2.0, start=1.0, quiet=quiet) as bar:
        for step in range(1, 5):
            bar.update(1.0 + 0.25 * step, 1000 * step, 1.5e-4)
    return stream.getvalue()


def test_a_short_run_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    assert show(monkeypatch, io.StringIO()) == ""
    assert show(monkeypatch, Terminal()) == ""


def test_plain_lines_where_there_is_no_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    lines = show(monkeypatch, io.StringIO()).splitlines()
    # The next line is due only after a while.
    assert len(lines) == 1
    assert lines[0].startswith(" 25.0 %  t = 1.25 of 2 s, step 1,000, Δt = 0.00015 s, ")
    assert lines[0].endswith(" left")


def test_a_bar_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setenv("COLUMNS", "140")
    shown = show(monkeypatch, Terminal())
    assert "100%" in shown
    assert "step 4,000" in shown


def test_quiet_is_quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    assert show(monkeypatch, io.StringIO(), quiet=True) == ""


@pytest.mark.parametrize(
    ("seconds", "said"),
    [
        (0.04, "0.0 s"),
        (9.94, "9.9 s"),
        (9.96, "10 s"),
        (59.6, "1 min 00 s"),
        (200.0, "3 min 20 s"),
        (7500.0, "2 h 05 min"),
        (float("inf"), "unknown time"),
        (float("nan"), "unknown time"),
    ],
)
def test_durations_are_said_as_people_say_them(seconds: float, said: str) -> None:
    assert duration(seconds) == said
