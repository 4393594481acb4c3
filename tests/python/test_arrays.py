"""The array functions: right, gentle to their inputs, and clear about what is wrong with them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import kolk
from kolk import _core

Floats = NDArray[np.float64]

KERNELS = ("wendland-c2", "wendland-c4", "wendland-c6", "cubic", "quintic")
H = 0.15
SPACING = 0.1


def block(dim: int, seed: int = 1) -> Floats:
    """A jittered lattice of the unit cube, spacing 0.1."""
    axis = (np.arange(10) + 0.5) * SPACING
    nodes = np.stack(np.meshgrid(*[axis] * dim), axis=-1).reshape(-1, dim)
    return nodes + np.random.default_rng(seed).uniform(-0.3, 0.3, nodes.shape) * SPACING


def particles(dim: int = 2) -> tuple[Floats, Floats, Floats]:
    """Position, mass and density."""
    position = block(dim)
    count = len(position)
    return position, np.full(count, 1000 * SPACING**dim), np.full(count, 1000.0)


# --- kernels and the equation of state ---------------------------------------------------------


@pytest.mark.parametrize("name", KERNELS)
@pytest.mark.parametrize("dim", [1, 2, 3])
def test_kernels_integrate_to_one_and_their_gradient_is_their_slope(name: str, dim: int) -> None:
    kernel = kolk.kernel(name, dim)
    assert (kernel.name, kernel.dim) == (name, dim)
    r = np.linspace(0, kernel.support * H, 20001)
    surface = [2 * np.ones_like(r), 2 * np.pi * r, 4 * np.pi * r**2][dim - 1]
    assert np.trapezoid(surface * kernel.value(r, H), r) == pytest.approx(1, abs=1e-6)
    scale = abs(kernel.gradient(r, H)).max()
    slope = np.gradient(kernel.value(r, H), r)
    np.testing.assert_allclose(kernel.gradient(r, H)[1:-1], slope[1:-1], atol=1e-4 * scale)


def test_kernels_take_numbers_and_arrays_of_any_shape() -> None:
    kernel = kolk.kernel("cubic", 1)
    assert kernel.support == 2.0
    assert isinstance(kernel.value(0.0, 1.0), float)
    assert kernel.value(0, 1) == pytest.approx(2 / 3)
    assert kernel.gradient(5.0, 1.0) == 0
    assert kernel.value([[0.0, 1.0, 3.0]], 1.0).shape == (1, 3)
    assert kernel.value(np.empty((0, 4)), 1.0).shape == (0, 4)
    assert repr(kernel) == 'kolk.kernel("cubic", 1)'


@pytest.mark.parametrize("gamma", [1.0, 1.4, 7.0])
def test_tait_and_its_inverse(gamma: float) -> None:
    density = np.linspace(900, 1200, 7)
    pressure = kolk.tait_pressure(density, 1000, 30.0, gamma)
    stiffness = 30.0**2 * 1000 / gamma
    np.testing.assert_allclose(pressure, stiffness * ((density / 1000) ** gamma - 1), atol=1e-6)
    np.testing.assert_allclose(kolk.tait_density(pressure, 1000, 30.0, gamma), density, rtol=1e-14)
    assert isinstance(kolk.tait_pressure(1010.0, 1000, 30.0), float)
    assert kolk.tait_pressure(1000.0, 1000.0, 30.0) == 0


# --- neighbours --------------------------------------------------------------------------------


@settings(max_examples=100, deadline=None)
@given(
    st.integers(1, 3).flatmap(
        lambda dim: arrays(
            np.float64,
            st.tuples(st.integers(0, 60), st.just(dim)),
            elements=st.floats(-2, 2, width=16) | st.floats(-1e6, 1e6),
        )
    ),
    st.floats(0.05, 1.5),
    st.booleans(),
)
def test_neighbours_are_all_pairs(position: Floats, radius: float, periodic: bool) -> None:
    periods = [(-2.0, 2.0)] * position.shape[1] if periodic else None
    offsets, indices = kolk.neighbours(position, radius, periods)
    assert (offsets.dtype, indices.dtype) == (np.int64, np.uint32)
    expected = kolk.all_pairs(position, radius, periods)
    np.testing.assert_array_equal(offsets, expected[0])
    np.testing.assert_array_equal(indices, expected[1])


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_neighbours_are_those_that_scipy_finds(dim: int) -> None:
    position = np.random.default_rng(4).uniform(0, 1, (2000, dim))
    offsets, indices = kolk.neighbours(position, 0.11, [(0, 1)] * dim)
    rows = cKDTree(position, boxsize=1).query_ball_point(position, 0.11, return_sorted=True)
    for i, row in enumerate(rows):
        found = indices[offsets[i] : offsets[i + 1]]
        np.testing.assert_array_equal(found, [j for j in row if j != i])


# --- operators ---------------------------------------------------------------------------------


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("dim", [1, 2, 3])
def test_linear_fields_are_exact(kernel: str, dim: int) -> None:
    position, mass, density = particles(dim)
    slope = np.arange(1.0, 1 + 2 * dim).reshape(2, dim)
    value = position @ slope.T + [3.0, -1.0]
    gradient = kolk.gradient(position, value, mass, density, H, kernel)
    assert gradient.shape == (len(position), 2, dim)
    np.testing.assert_allclose(gradient, np.broadcast_to(slope, gradient.shape), atol=1e-10)
    one = kolk.gradient(position, value[:, 0], mass, density, H, kernel)
    np.testing.assert_allclose(one, gradient[:, 0], atol=1e-14)
    divergence = kolk.divergence(position, 2 * position, mass, density, H, kernel)
    np.testing.assert_allclose(divergence, 2 * dim, atol=1e-10)
    laplacian = _core.laplacian(position, value, mass, density, H, kernel)
    assert laplacian.shape == value.shape
    np.testing.assert_allclose(laplacian, 0, atol=1e-9)


def test_operators_on_a_periodic_wave() -> None:
    axis = (np.arange(40) + 0.5) / 40
    position = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    mass, density = np.full(1600, 1 / 1600), np.ones(1600)
    wave, slope = np.sin(2 * np.pi * position[:, 0]), np.cos(2 * np.pi * position[:, 0])
    rest: dict[str, Any] = {"periodic": [(0, 1), (0, 1)], "correct": False}
    args = (mass, density, 1.5 / 40, "quintic")
    found = kolk.gradient(position, wave, *args, **rest)
    np.testing.assert_allclose(found[:, 0], 2 * np.pi * slope, atol=0.03 * 2 * np.pi)
    np.testing.assert_allclose(found[:, 1], 0, atol=1e-10)
    found = _core.laplacian(position, wave, *args, **rest)
    np.testing.assert_allclose(found, -4 * np.pi**2 * wave, atol=0.03 * 4 * np.pi**2)


def test_interpolation() -> None:
    position, mass, density = particles()
    points = np.array([[0.5, 0.5], [0.02, 0.02], [7.0, 0.5]])
    value = np.column_stack([np.full(len(position), 4.0), position[:, 0]])
    found = kolk.interpolate(points, position, value, mass, density, H, outside=np.nan)
    assert found.shape == (3, 2)
    np.testing.assert_allclose(found[:2, 0], 4.0, rtol=1e-13)
    assert found[0, 1] == pytest.approx(0.5, abs=0.03)
    assert np.isnan(found[2]).all()
    plain = kolk.interpolate(
        points, position, np.ones(len(position)), mass, density, H, normalise=False
    )
    assert plain.shape == (3,)
    assert plain[0] == pytest.approx(1, abs=0.1)
    assert plain[1] < 0.5
    assert plain[2] == 0


def test_density_diffusion() -> None:
    position, mass, density = particles()
    density = density + position @ [2.0, -5.0]
    args = (position, mass, density, H, 40.0)
    np.testing.assert_allclose(kolk.density_diffusion(*args), 0, atol=1e-9)
    molteni = kolk.density_diffusion(*args, form="molteni")
    assert abs(molteni).max() > 10
    assert mass / density @ molteni == pytest.approx(0, abs=1e-10)
    np.testing.assert_allclose(
        kolk.density_diffusion(*args, form="molteni", delta=0.2), 2 * molteni, rtol=1e-13
    )
    # Without gravity hydrostatics explains nothing.
    fourtakas = kolk.density_diffusion(
        *args, form="fourtakas", gravity=[0, 0], reference_density=1000
    )
    np.testing.assert_allclose(fourtakas, molteni, rtol=1e-13)


def test_particle_shift() -> None:
    position, mass, density = particles()
    args = (position, mass, density, H, SPACING)
    periodic = [(0, 1), (0, 1)]

    def unevenness(position: Floats) -> float:
        one = np.ones(len(position))
        whole = kolk.interpolate(
            position, position, one, mass, density, H, normalise=False, periodic=periodic
        )
        return float(np.std(whole))

    sun = kolk.particle_shift(*args, time_step=0.01, speed=1.0, periodic=periodic)
    lind = kolk.particle_shift(*args, form="lind", periodic=periodic)
    for shift in (sun, lind):
        assert shift.shape == position.shape
        assert unevenness(position + shift) < 0.95 * unevenness(position)
    assert np.linalg.norm(sun, axis=1).max() <= 0.5 * 0.01 * (1 + 1e-12)
    # At a free surface the free shift would blow the block apart.
    free = kolk.particle_shift(*args, form="lind", free_surface=False)
    kept = kolk.particle_shift(*args, form="lind")
    rim = position[:, 1] > 0.93
    assert free[rim, 1].mean() > 3 * abs(kept[rim, 1]).mean()


def test_free_surface() -> None:
    # Rings of particles: the outermost face outwards, the innermost inwards, no other is surface.
    ring = np.concatenate([np.full(round(2 * np.pi * (k + 0.5)), k) for k in range(6, 18)])
    turn = np.concatenate(
        [np.arange(n) / n + 0.3 * k for k in range(6, 18) for n in [round(2 * np.pi * (k + 0.5))]]
    )
    outwards = np.stack([np.cos(2 * np.pi * turn), np.sin(2 * np.pi * turn)], axis=1)
    position = SPACING * (ring + 0.5)[:, None] * outwards
    count = len(position)
    mass, density = np.full(count, 1000 * SPACING**2), np.full(count, 1000.0)
    on, normal, eigenvalue = kolk.free_surface(position, mass, density, 2 * SPACING)
    assert on.dtype == np.bool_
    np.testing.assert_array_equal(on, (ring == 6) | (ring == 17))
    along = np.sum(normal * outwards, axis=1)
    assert along[ring == 17].min() > 0.99
    assert along[ring == 6].max() < -0.99
    assert eigenvalue[on].max() < 0.75 < eigenvalue[(ring > 8) & (ring < 15)].min()


# --- inputs ------------------------------------------------------------------------------------


def calls() -> dict[str, tuple[Callable[..., Any], dict[str, Any]]]:
    """Every function with arguments that it takes."""
    position, mass, density = particles()
    cloud = {"position": position, "mass": mass, "density": density, "h": H}
    field = {**cloud, "value": position[:, 0].copy()}
    return {
        "neighbours": (kolk.neighbours, {"position": position, "radius": 0.2}),
        "all_pairs": (kolk.all_pairs, {"position": position, "radius": 0.2}),
        "tait_pressure": (
            kolk.tait_pressure,
            {"density": density, "reference_density": 1000.0, "sound_speed": 30.0},
        ),
        "tait_density": (
            kolk.tait_density,
            {"pressure": density, "reference_density": 1000.0, "sound_speed": 30.0},
        ),
        "value": (kolk.kernel("cubic", 2).value, {"r": mass, "h": H}),
        "interpolate": (kolk.interpolate, {**field, "points": position + 0.01}),
        "gradient": (kolk.gradient, field),
        "divergence": (kolk.divergence, {**field, "value": position * 2}),
        "laplacian": (_core.laplacian, field),
        "density_diffusion": (kolk.density_diffusion, {**cloud, "sound_speed": 30.0}),
        "particle_shift": (
            kolk.particle_shift,
            {**cloud, "spacing": SPACING, "time_step": 0.1, "speed": 1.0},
        ),
        "free_surface": (kolk.free_surface, cloud),
    }


def outputs(result: Any) -> list[NDArray[Any]]:
    return list(result) if isinstance(result, tuple) else [result]


@pytest.mark.parametrize("name", calls())
def test_inputs_of_any_layout_give_the_same_and_are_never_changed(name: str) -> None:
    function, arguments = calls()[name]
    expected = outputs(function(**arguments))

    def strided(x: Any) -> Any:
        return (
            np.repeat(np.repeat(x, 2, axis=0), 2, axis=-1)[::2, ..., ::2]
            if x.ndim > 1
            else (np.repeat(x, 2)[::2])
        )

    layouts: list[Callable[[Floats], Any]] = [
        strided,
        np.asfortranarray,
        lambda x: x.astype(">f8"),
        lambda x: x.tolist(),
        lambda x: np.frombuffer(b"\0" + x.tobytes(), np.uint8)[1:].view(x.dtype).reshape(x.shape),
    ]
    for layout in layouts:
        given_in = {
            key: layout(x) if isinstance(x, np.ndarray) else x for key, x in arguments.items()
        }
        before = {key: np.array(x) for key, x in given_in.items()}
        for x in given_in.values():
            if isinstance(x, np.ndarray) and x.flags.owndata:
                x.flags.writeable = False
        for found, wanted in zip(outputs(function(**given_in)), expected, strict=True):
            np.testing.assert_array_equal(found, wanted)
        for key, x in given_in.items():
            np.testing.assert_array_equal(np.array(x), before[key])


@pytest.mark.parametrize("name", calls())
def test_outputs_own_their_memory(name: str) -> None:
    function, arguments = calls()[name]
    for found in outputs(function(**arguments)):
        assert found.flags.owndata
        assert found.flags.writeable
        assert found.flags.c_contiguous
        for x in arguments.values():
            assert not isinstance(x, np.ndarray) or not np.shares_memory(found, x)


def spoil(key: str, x: Any) -> list[Any]:
    """Wrong things to pass instead of a good argument."""
    if not isinstance(x, np.ndarray):
        return [-1.0, 0.0, np.nan, np.inf, "much", None, [1.0, 2.0]]
    nan = x.copy()
    nan.flat[3] = np.nan
    wrong = [nan, x.astype(complex), x.astype(str), x > 0, x.astype(object), [[1.0], [2.0, 3.0]]]
    if key not in ("r", "pressure"):
        wrong.append(None)
    if key in ("mass", "density", "r"):
        negative = x.copy()
        negative.flat[3] = -1.0
        wrong.append(negative)
    return wrong


@pytest.mark.parametrize("name", calls())
def test_wrong_arguments_are_named(name: str) -> None:
    function, arguments = calls()[name]
    for key, good in arguments.items():
        wrong = spoil(key, good)
        if key in ("time_step", "speed"):
            wrong.remove(0.0)
        shaped = name in ("neighbours", "all_pairs") or "position" in arguments
        if isinstance(good, np.ndarray) and shaped:
            wrong += [good[..., None, None], np.float64(1.0)]
            if key not in ("position", "points"):
                wrong += [good[:-1], good[:0]]
            else:
                wrong.append(np.zeros((5, 4)))
        for bad in wrong:
            with pytest.raises(kolk.ArrayError, match=r"found .*; allowed: ") as error:
                function(**{**arguments, key: bad})
            message = str(error.value)
            # A position of another length shows in the first array that does not fit it.
            assert message.startswith(f"{key}: ") or bad is good[:0], (key, message)
            assert len(message) < 400


@pytest.mark.parametrize(
    ("name", "changed", "message"),
    [
        ("gradient", {"kernel": "gauss"}, 'kernel: found "gauss"; allowed: cubic, quintic'),
        ("gradient", {"kernel": 3}, "kernel: found an object of type int"),
        ("density_diffusion", {"form": "ferrari"}, "form: found"),
        ("density_diffusion", {"form": "fourtakas"}, "gravity: found None"),
        (
            "density_diffusion",
            {"form": "fourtakas", "gravity": [0, 0, -9.81]},
            r"gravity: found shape \(3,\)",
        ),
        ("density_diffusion", {"delta": -0.1}, "delta: found -0.1"),
        ("particle_shift", {"time_step": None}, "time_step: found None"),
        ("particle_shift", {"spacing": 0.31}, "spacing: found 0.31; allowed: less than"),
        ("interpolate", {"outside": "x"}, "outside: found an object of type str"),
        (
            "tait_density",
            {"pressure": -1e9},
            "found -1000000000; allowed: pressures above",
        ),
        ("neighbours", {"radius": 5e-324}, "radius: found 5e-324; allowed: a length from 1e-150"),
        ("gradient", {"h": 1e-300}, "h: found 1e-300; allowed: a length from 1e-150 to 1e150"),
        ("gradient", {"h": 1e200}, "h: found 1e200; allowed: a length"),
        ("neighbours", {"periodic": [(0, 1)]}, "periodic: found 1 axes"),
        ("neighbours", {"periodic": [(0, 0.3), None]}, r"periodic: found \(0, 0.3\) for axis 0"),
        ("neighbours", {"periodic": [(0, np.nan), None]}, "periodic: found"),
        ("neighbours", {"periodic": "xy"}, "periodic: found"),
        ("neighbours", {"periodic": 1.0}, "periodic: found an object of type float"),
    ],
)
def test_wrong_options_are_named(name: str, changed: dict[str, Any], message: str) -> None:
    function, arguments = calls()[name]
    with pytest.raises(kolk.ArrayError, match=message):
        function(**{**arguments, **changed})


@pytest.mark.parametrize(("name", "dim"), [("gauss", 2), ("cubic", 0), ("cubic", 4), (2, 2)])
def test_wrong_kernels_are_named(name: Any, dim: Any) -> None:
    with pytest.raises(kolk.ArrayError, match="allowed: "):
        kolk.kernel(name, dim)


def test_the_place_of_a_bad_number_is_named() -> None:
    position = block(2)
    position[7, 1] = np.inf
    with pytest.raises(kolk.ArrayError, match=r"position: found inf at \[7, 1\]"):
        kolk.neighbours(position, 0.1)


def test_array_errors_are_value_errors() -> None:
    assert issubclass(kolk.ArrayError, ValueError)
    assert issubclass(kolk.ArrayError, kolk.KolkError)


def test_no_particles_give_no_results() -> None:
    none, empty = np.empty((0, 3)), np.empty(0)
    assert kolk.neighbours(none, 1.0)[0].tolist() == [0]
    assert kolk.gradient(none, empty, empty, empty, 1.0).shape == (0, 3)
    assert kolk.particle_shift(none, empty, empty, 1.0, 1.0, form="lind").shape == (0, 3)
    assert [len(x) for x in kolk.free_surface(none, empty, empty, 1.0)] == [0, 0, 0]
    assert kolk.interpolate([[0.0] * 3], none, empty, empty, empty, 1.0).tolist() == [0.0]


def test_integers_and_single_precision_are_converted() -> None:
    found = kolk.neighbours(np.array([[0, 0], [1, 0]]), 1)
    np.testing.assert_array_equal(found[1], [1, 0])
    found = kolk.neighbours(np.array([[0, 0], [1, 0]], np.float32), np.float32(1))
    np.testing.assert_array_equal(found[1], [1, 0])


def test_the_interpreter_is_released() -> None:
    position = np.random.default_rng(0).uniform(0, 1, (12_000, 3))
    done = threading.Event()

    def search() -> None:
        kolk.all_pairs(position, 0.01)
        done.set()

    thread = threading.Thread(target=search)
    thread.start()
    turns = 0
    while not done.is_set():
        turns += 1
    thread.join()
    # A held interpreter would let this loop turn only before and after the search.
    assert turns > 1000
