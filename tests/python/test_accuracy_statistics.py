"""Orders, error bars and verdicts on made-up ladders whose truth is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kolk.errors import KolkError
from kolk.study.expansion import expand
from kolk.study.law import observed_order
from kolk.study.richardson import grid_convergence_index, richardson, three_grid_order
from kolk.study.verdict import judge_expansion, judge_ladder, judge_law

LADDER = np.array([0.04, 0.028, 0.02, 0.014])


@pytest.mark.parametrize("order", [0.5, 1.0, 1.7, 2.0])
def test_a_power_law_is_found_exactly(order: float) -> None:
    law = observed_order(LADDER, 3.0 * LADDER**order)
    assert law.order == pytest.approx(order, abs=1e-12)
    assert law.high - law.low < 1e-6
    assert law.value(0.01) == pytest.approx(3.0 * 0.01**order)
    assert law.spacing_for(3.0 * 0.01**order) == pytest.approx(0.01)
    assert judge_law(law, list(LADDER), list(3.0 * LADDER**order)).sound


def test_the_interval_of_the_order_covers_the_truth_as_often_as_it_says() -> None:
    random = np.random.default_rng(1)
    for levels in (3, 4, 6):
        h = 0.04 / math.sqrt(2.0) ** np.arange(levels)
        hits = 0
        for _ in range(1000):
            law = observed_order(h, 2.0 * h**1.5 * np.exp(random.normal(0.0, 0.1, levels)))
            hits += law.low <= 1.5 <= law.high
        assert 0.93 <= hits / 1000 <= 0.97


def test_a_prediction_covers_new_runs() -> None:
    """With the expected scatter as the truth the pooled variance errs on neither side."""
    random = np.random.default_rng(2)
    below = 0
    for _ in range(2000):
        law = observed_order(LADDER, LADDER**1.3 * np.exp(random.normal(0.0, 0.15, 4)))
        below += 0.01**1.3 * math.exp(random.normal(0.0, 0.15)) <= law.upper(0.01)
    assert below / 2000 >= 0.94


def test_a_safe_spacing_keeps_the_error_with_the_stated_probability() -> None:
    law = observed_order(LADDER, [0.041, 0.027, 0.021, 0.0138])
    h = law.safe_spacing_for(0.02)
    assert h < law.spacing_for(0.02)
    assert law.upper(h) == pytest.approx(0.02)


def test_errors_that_are_none_are_refused() -> None:
    with pytest.raises(KolkError, match="positive"):
        observed_order([0.1, 0.2], [0.0, 1.0])
    with pytest.raises(KolkError, match="two different"):
        observed_order([0.1, 0.1], [1.0, 1.0])
    with pytest.raises(KolkError, match="three different"):
        expand([0.1, 0.2], [1.0, 2.0])


def test_three_grids_give_their_order_and_their_limit() -> None:
    """Celik et al. (2008) with unequal ratios; the extrapolated value is the exact one."""
    h1, h2, h3 = 0.01, 0.013, 0.021
    f = [5.0 + 40.0 * h**1.8 for h in (h1, h2, h3)]
    order = three_grid_order(*f, h2 / h1, h3 / h2)
    assert order == pytest.approx(1.8, abs=1e-9)
    assert richardson(f[0], f[1], h2 / h1, order) == pytest.approx(5.0)
    bar = grid_convergence_index(f[0], f[1], h2 / h1, order)
    assert bar == pytest.approx(1.25 * (f[0] - 5.0))


def test_the_published_example_of_celik() -> None:
    """Table 1 of Celik et al. (2008): 18,000, 8,000 and 4,500 cells in 2D; p = 1.53, 2.2 %."""
    r21, r32 = (18000 / 8000) ** 0.5, (8000 / 4500) ** 0.5
    order = three_grid_order(6.063, 5.972, 5.863, r21, r32)
    assert order == pytest.approx(1.53, abs=0.01)
    assert richardson(6.063, 5.972, r21, order) == pytest.approx(6.1685, abs=2e-3)
    index = grid_convergence_index(6.063, 5.972, r21, order) / 6.063
    assert index == pytest.approx(0.022, abs=5e-4)


@pytest.mark.parametrize("values", [(1.0, 1.1, 1.05), (1.0, 1.2, 1.3), (1.0, 1.0, 1.0)])
def test_three_grids_without_convergence_have_no_order(values: tuple[float, ...]) -> None:
    assert math.isnan(three_grid_order(*values, 1.5, 1.5)) or values == (1.0, 1.2, 1.3)
    if values == (1.0, 1.2, 1.3):
        # Differences that grow towards the finer grids.
        assert math.isnan(three_grid_order(*values, 1.5, 1.5))


def record(h: float, order: float, noise: np.ndarray | float = 0.0) -> np.ndarray:
    t = np.linspace(0.0, 1.0, 50)
    return np.sin(5.0 * t) + 3.0 * np.cos(3.0 * t) * h**order + noise


@pytest.mark.parametrize("order", [0.7, 1.0, 1.5, 2.0])
def test_an_expansion_finds_order_and_limit_of_a_record(order: float) -> None:
    fit = expand(LADDER, np.array([record(h, order) for h in LADDER]))
    assert fit.form == "power"
    assert fit.free_order == pytest.approx(order, abs=1e-4)
    np.testing.assert_allclose(fit.limit, record(0.0, order), atol=1e-5)
    truth = np.abs(record(LADDER[-1], order) - record(0.0, order))
    np.testing.assert_allclose(fit.level_bar(3), 1.25 * truth, atol=1e-5)
    assert judge_expansion(fit, list(LADDER), 1.0).sound


def test_a_single_value_on_three_levels_is_celiks_index() -> None:
    h = [0.02, 0.013, 0.01]
    f = [5.0 + 40.0 * x**1.8 for x in h]
    fit = expand(h, f)
    expected = grid_convergence_index(f[2], f[1], 1.3, 1.8)
    assert fit.level_bar(2)[0] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("levels", [3, 4, 5])
@pytest.mark.parametrize("order", [1.0, 2.0])
def test_bars_hold_the_truth_in_nine_cases_of_ten(levels: int, order: float) -> None:
    """Noise of a tenth to a third of the finest level's error, on single values and records."""
    random = np.random.default_rng(3)
    h = 0.04 / math.sqrt(2.0) ** np.arange(levels)
    inside = total = 0
    for case in range(200):
        size = random.uniform(0.1, 0.3) * h[-1] ** order
        if case % 2:
            values = 2.0 + h**order + random.normal(0.0, size, levels)
            values, truth = values[:, None], np.array([2.0])
        else:
            noise = random.normal(0.0, size, (levels, 50))
            values = np.array([record(x, order, e) for x, e in zip(h, noise, strict=True)])
            truth = record(0.0, order)
        fit = expand(h, values)
        for i in range(levels):
            wrong = np.sqrt(np.mean((values[i] - truth) ** 2))
            inside += wrong <= np.sqrt(np.mean(fit.level_bar(i) ** 2))
            total += 1
    assert inside / total >= 0.9


def test_pure_noise_gets_a_bar_but_no_order() -> None:
    random = np.random.default_rng(4)
    inside = sound = 0
    for _ in range(200):
        values = 1.0 + random.normal(0.0, 0.01, 4)
        fit = expand(LADDER, values)
        inside += sum(abs(values[i] - 1.0) <= fit.level_bar(i)[0] for i in range(4))
        sound += judge_expansion(fit, list(LADDER), 1.0).sound
    assert inside / 800 >= 0.9
    assert sound / 200 <= 0.15


def test_the_interval_of_a_free_order_covers_the_truth() -> None:
    random = np.random.default_rng(5)
    hits = 0
    for _ in range(200):
        noise = random.normal(0.0, 0.03 * LADDER[-1], (4, 50))
        values = np.array([record(x, 1.2, e) for x, e in zip(LADDER, noise, strict=True)])
        fit = expand(LADDER, values)
        hits += fit.free_low <= 1.2 <= fit.free_high
    assert hits / 200 >= 0.9


def test_too_short_a_ladder_is_called_so() -> None:
    assert "2 levels" in (judge_ladder([0.02, 0.01]) or pytest.fail("no verdict")).reason
    assert "1.20 times" in (judge_ladder([0.012, 0.011, 0.01]) or pytest.fail("none")).reason
    assert judge_ladder(list(LADDER)) is None
    law = observed_order([0.04, 0.02], [0.02, 0.01])
    assert judge_law(law, [0.04, 0.02], [0.02, 0.01]).kind == "too short"


def test_an_error_that_nears_a_floor_has_no_order() -> None:
    h = np.array([0.04, 0.02, 0.01, 0.005])
    e = 0.01 + 5.0 * h**2
    verdict = judge_law(observed_order(h, e), list(h), list(e))
    assert verdict.kind == "not asymptotic"
    assert "floor" in verdict.reason


def test_an_error_that_does_not_fall_has_no_order() -> None:
    e = np.array([0.010, 0.011, 0.0105, 0.012])
    assert judge_law(observed_order(LADDER, e), list(LADDER), list(e)).kind == "not falling"


def test_scattered_errors_have_no_order() -> None:
    e = np.array([0.10, 0.02, 0.09, 0.015])
    verdict = judge_law(observed_order(LADDER, e), list(LADDER), list(e))
    assert not verdict.sound


def test_a_quantity_before_its_asymptotic_range_has_no_order() -> None:
    """Two terms of opposite sign: the levels turn round on the way."""
    h = np.array([0.08, 0.04, 0.02, 0.01])
    f = 1.0 + 2.0 * h - 40.0 * h**2
    assert not judge_expansion(expand(h, f), list(h), 1.0).sound


def test_levels_that_do_not_differ_say_nothing() -> None:
    verdict = judge_expansion(expand(LADDER, np.ones((4, 3))), list(LADDER), 1.0)
    assert verdict.kind == "nothing to show"
