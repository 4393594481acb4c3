"""Every hard case as a test: short in the test command, in full by `pytest -m stability`."""

import pytest

from .suite import Result, get, names, timed


def check(name: str, result: Result) -> None:
    """Fails with every figure that is beyond its limits."""
    missed = [f"{figure}, must be {figure.limit}" for figure in result.missed]
    missed += [result.stopped] if result.stopped else []
    assert not missed, f"{get(name).title}, {result.variant}\n" + "\n".join(missed)


MISSED = {
    "corners": ("wedge of 15°, H", "speed and pressure in the wedge, where a lattice does not fit"),
    "thin_plate": ("one layer", "force on a plate of one layer"),
}
"""Limits that are known to be missed, which variants, and how: kept as they are, to be met."""


def marked(name: str, variant: str) -> object:
    """The case, said to miss its limits where it does."""
    part, why = MISSED.get(name, ("", ""))
    marks = [pytest.mark.xfail(reason=why)] if why and part in variant else []
    return pytest.param(name, variant, marks=marks)


@pytest.mark.parametrize(("name", "variant"), [marked(n, v) for n in names() for v in get(n).short])
def test_short(name: str, variant: str) -> None:
    check(name, timed(lambda: get(name).run(variant), variant))


@pytest.mark.stability
@pytest.mark.parametrize(("name", "variant"), [(n, v) for n in names() for v in get(n).full])
def test_full(name: str, variant: str) -> None:
    check(name, timed(lambda: get(name).run(variant), variant))


@pytest.mark.parametrize("name", [n for n in names() if get(n).without])
def test_without_its_remedy_it_fails(name: str) -> None:
    without = get(name).without
    assert without is not None
    result = timed(without)
    assert result.failed, f"{get(name).title}: {get(name).remedy} is not what keeps it alive"
