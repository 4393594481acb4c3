"""Shapes: signed distances against closed forms and sampling, bounds, sizes, lattices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kolk.errors import SceneError
from kolk.scene import (
    Box,
    Cylinder,
    Difference,
    Disc,
    Function,
    Polygon,
    Shape,
    Sphere,
    Tank,
    Union,
)
from kolk.scene.expression import Expression
from kolk.scene.fill import lattice

SQUARE = Box(from_=[0, 0], to=[2, 1])
L_SHAPE = Polygon(points=[[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]])

FLAT: list[Shape] = [
    SQUARE,
    Disc(centre=[0.3, -0.2], radius=0.7),
    L_SHAPE,
    Union([SQUARE, Disc(centre=[2, 1], radius=0.5)]),
    Difference(of=SQUARE, minus=[Disc(centre=[1, 0.5], radius=0.3)]),
    Function(from_=[-1, -1], to=[1, 1], value="hypot(x, y) - 0.8"),
]
SOLID: list[Shape] = [
    Box(from_=[0, 0, 0], to=[1, 2, 3]),
    Sphere(centre=[1, 1, 1], radius=0.9),
    Cylinder(from_=[0, 0, 0], to=[1, 1, 1], radius=0.4),
    Polygon(points=[[0, 0], [2, 0], [0, 1]], from_=-0.5, to=0.5),
]


def cloud(shape: Shape, n: int, margin: float = 0.5) -> np.ndarray:
    low, high = shape.bounds()
    return np.random.default_rng(0).uniform(low - margin, high + margin, (n, len(low)))


def test_distance_from_a_box() -> None:
    points = np.array([[1.0, 0.5], [3.0, 0.5], [3.0, 2.0], [1.9, 0.5], [2.0, 0.3]])
    expected = [-0.5, 1.0, math.sqrt(2.0), -0.1, 0.0]
    np.testing.assert_allclose(SQUARE.distance(points), expected, atol=1e-14)


def test_distance_from_a_polygon_that_is_not_convex() -> None:
    points = np.array([[1.5, 1.5], [0.5, 0.5], [1.25, 0.9], [-1.0, 3.0], [0.5, 1.5]])
    expected = [0.5, -0.5, -0.1, math.sqrt(2.0), -0.5]
    np.testing.assert_allclose(L_SHAPE.distance(points), expected, atol=1e-14)


def test_distance_from_a_cylinder() -> None:
    pipe = Cylinder(from_=[0, 0, 0], to=[0, 0, 2], radius=0.5)
    points = np.array([[0, 0, 1.0], [1.5, 0, 1.0], [0, 0, 3.0], [1.5, 0, 3.0], [0.3, 0, 0.1]])
    np.testing.assert_allclose(
        pipe.distance(points), [-0.5, 1.0, 1.0, math.sqrt(2.0), -0.1], atol=1e-14
    )


def test_a_rectangle_as_box_and_as_polygon_is_the_same() -> None:
    polygon = Polygon(points=[[0, 0], [2, 0], [2, 1], [0, 1]])
    points = cloud(SQUARE, 500)
    np.testing.assert_allclose(polygon.distance(points), SQUARE.distance(points), atol=1e-14)
    assert polygon.size() == pytest.approx(SQUARE.size())


@pytest.mark.parametrize("shape", FLAT + SOLID, ids=lambda s: type(s).__name__)
def test_nothing_lies_outside_the_bounds(shape: Shape) -> None:
    points = cloud(shape, 5000)
    low, high = shape.bounds()
    inside = points[shape.contains(points)]
    assert len(inside) > 100
    assert (inside >= low).all() and (inside <= high).all()


@pytest.mark.parametrize(
    "shape",
    [s for s in FLAT + SOLID if not isinstance(s, Function)],
    ids=lambda s: type(s).__name__,
)
def test_distance_changes_no_faster_than_the_point(shape: Shape) -> None:
    """Every signed distance has a Lipschitz constant of 1."""
    a = cloud(shape, 2000)
    b = a + np.random.default_rng(1).normal(0.0, 0.05, a.shape)
    change = np.abs(shape.distance(a) - shape.distance(b))
    assert (change <= np.linalg.norm(a - b, axis=1) + 1e-12).all()


@pytest.mark.parametrize(
    "shape",
    [SQUARE, L_SHAPE, Disc(centre=[0, 0], radius=1), *SOLID],
    ids=lambda s: type(s).__name__,
)
def test_size_is_the_share_of_points_inside(shape: Shape) -> None:
    points = cloud(shape, 200_000, 0.0)
    low, high = shape.bounds()
    share = shape.contains(points).mean()
    assert share * np.prod(high - low) == pytest.approx(shape.size(), rel=0.02)


def test_a_tank_is_solid_beyond_its_closed_faces() -> None:
    tank = Tank(from_=[0, 0], to=[2, 1], open=["top"])
    points = np.array([[1, 0.5], [-0.1, 0.5], [1, -0.2], [1, 1.5], [-0.1, 1.5], [2.3, 0.5]])
    assert tank.contains(points).tolist() == [False, True, True, False, True, True]
    # The lid is open: the nearest solid over the middle is a side.
    np.testing.assert_allclose(
        tank.distance(points), [0.5, -0.1, -0.2, 1.0, -0.1, -0.3], atol=1e-14
    )


@pytest.mark.parametrize(
    ("dimension", "side", "axis", "end"),
    [
        (2, "left", 0, 0),
        (2, "right", 0, 1),
        (2, "bottom", 1, 0),
        (2, "top", 1, 1),
        (3, "left", 0, 0),
        (3, "front", 1, 0),
        (3, "back", 1, 1),
        (3, "bottom", 2, 0),
        (3, "top", 2, 1),
    ],
)
def test_names_of_sides(dimension: int, side: str, axis: int, end: int) -> None:
    tank = Tank(from_=[0.0] * dimension, to=[1.0] * dimension, open=[side])
    beyond = np.full((1, dimension), 0.5)
    beyond[0, axis] = 1.5 if end else -0.5
    assert not tank.contains(beyond)[0]
    assert Tank(from_=[0.0] * dimension, to=[1.0] * dimension).contains(beyond)[0]


@settings(deadline=None, max_examples=60)
@given(
    size=st.tuples(*[st.floats(0.05, 3.0)] * 2),
    corner=st.tuples(*[st.floats(-10.0, 10.0)] * 2),
    spacing=st.floats(0.01, 0.05),
)
def test_the_lattice_of_a_box_is_half_a_cell_from_each_face(
    size: tuple[float, float], corner: tuple[float, float], spacing: float
) -> None:
    box = Box(from_=corner, to=[c + s for c, s in zip(corner, size, strict=True)])
    points, steps = lattice(box, spacing)
    low, high = box.bounds()
    np.testing.assert_allclose(points.min(axis=0) - low, steps / 2, atol=1e-12)
    np.testing.assert_allclose(high - points.max(axis=0), steps / 2, atol=1e-12)
    assert len(points) * np.prod(steps) == pytest.approx(box.size(), rel=1e-9)
    assert (np.abs(steps / spacing - 1.0) <= 1.0).all()


def test_decimal_fractions_divide_as_they_should() -> None:
    polygon = Polygon(points=[[0, 0], [0.3, 0], [0.3, 0.1], [0, 0.1]])
    points, _ = lattice(polygon, 0.1)
    assert len(points) == 3


def test_a_ball_is_filled_symmetrically() -> None:
    ball = Disc(centre=[0.3, 0.7], radius=0.25)
    points, _ = lattice(ball, 0.013)
    inside = points[ball.contains(points)]
    np.testing.assert_allclose(inside.mean(axis=0), [0.3, 0.7], atol=1e-12)
    assert len(inside) * 0.013**2 == pytest.approx(ball.size(), rel=0.02)


def test_union_and_difference_agree_with_logic() -> None:
    disc = Disc(centre=[2, 1], radius=0.5)
    points = cloud(SQUARE, 2000)
    a, b = SQUARE.contains(points), disc.contains(points)
    assert (Union([SQUARE, disc]).contains(points) == (a | b)).all()
    assert (Difference(of=SQUARE, minus=[disc]).contains(points) == (a & ~b)).all()


def test_a_function_of_position_in_python() -> None:
    shape = Function(from_=[-1, -1], to=[1, 1], value=lambda x: np.abs(x).sum(axis=1) - 0.5)
    points, _ = lattice(shape, 0.01)
    assert shape.contains(points).sum() * 0.01**2 == pytest.approx(0.5, rel=0.02)


def test_a_function_that_returns_nonsense_is_named() -> None:
    shape = Function(from_=[-1, -1], to=[1, 1], value=lambda x: x)
    with pytest.raises(SceneError, match=r"function\.value: gave an array of shape \(3, 2\)"):
        shape.distance(np.zeros((3, 2)))
    with pytest.raises(SceneError, match="not finite"):
        Function(from_=[-1, -1], to=[1, 1], value="log(x)").distance(np.zeros((3, 2)))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 + 2 * x", 1.0 + 2.0 * 0.3),
        ("-cos(2*pi*x) * sin(2*pi*y)", -math.cos(0.6 * math.pi) * math.sin(1.4 * math.pi)),
        ("max(x, y) ** 2", 0.49),
        ("hypot(x, y) / 2", math.hypot(0.3, 0.7) / 2),
        ("3", 3.0),
    ],
)
def test_expressions(text: str, expected: float) -> None:
    np.testing.assert_allclose(Expression(text)(np.array([[0.3, 0.7]])), [expected])


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os')",
        "x.real",
        "(lambda: 1)()",
        "[x for x in y]",
        "x if y else z",
        "sin(x, y)",
        "sin",
        "open('f')",
        "x == y",
        "x[0]",
        "'a'",
        "",
        "2 +",
        "True",
        "1j",
    ],
)
def test_expressions_hold_nothing_but_arithmetic(text: str) -> None:
    with pytest.raises(ValueError, match=r"allowed are|takes"):
        Expression(text)


def test_a_huge_power_is_infinite_and_quick() -> None:
    assert np.isinf(Expression("9 ** 9 ** 9 ** 9")(np.zeros((1, 2)))[0])
