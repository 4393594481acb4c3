"""Every validation case as a test: short in the test command, in full by `pytest -m validation`."""

import pytest

from .running import run_level
from .suite import get, names


def check(name: str, resolutions: tuple[int, ...]) -> None:
    """Runs a case and fails with every figure that is beyond its bound."""
    case = get(name)
    missed = [
        f"{case.unit} = {resolution}: {figure.name} is {figure.shown(figure.value)}, "
        f"must be at most {figure.shown(figure.bound)}"
        for resolution in resolutions
        for figure in run_level(case, resolution).missed
    ]
    assert not missed, f"{case.title}\n" + "\n".join(missed)


@pytest.mark.parametrize("name", [n for n in names() if get(n).short])
def test_short(name: str) -> None:
    check(name, get(name).short)


@pytest.mark.validation
@pytest.mark.parametrize("name", names())
def test_full(name: str) -> None:
    check(name, get(name).full)
