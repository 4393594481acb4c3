"""Every hard case as a test: short in the test command, in full by `pytest -m stability`."""

import pytest

from .suite import Result, get, names, timed


def check(name: str, result: Result) -> None:
    """Fails with every figure that is beyond its limits."""
    missed = [f"{figure}, must be {figure.limit}" for figure in result.missed]
    assert not missed, f"{get(name).title}, {result.variant}\n" + "\n".join(missed)


@pytest.mark.parametrize(("name", "variant"), [(n, v) for n in names() for v in get(n).short])
def test_short(name: str, variant: str) -> None:
    check(name, timed(lambda: get(name).run(variant)))


@pytest.mark.stability
@pytest.mark.parametrize(("name", "variant"), [(n, v) for n in names() for v in get(n).full])
def test_full(name: str, variant: str) -> None:
    check(name, timed(lambda: get(name).run(variant)))


@pytest.mark.parametrize("name", [n for n in names() if get(n).without])
def test_without_its_remedy_it_fails(name: str) -> None:
    without = get(name).without
    assert without is not None
    result = without()
    assert result.missed, f"{get(name).title}: {get(name).remedy} is not what keeps it alive"
