"""Scenes and array functions under chance: an answer or one of kolk's errors, never a panic.

`pytest -m stability tests/python/test_fuzz.py` does it for `KOLK_FUZZ_EXAMPLES` examples each
(100,000 if unset).
"""

from __future__ import annotations

import os
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import kolk
from kolk.check import check
from kolk.errors import KolkError
from kolk.scene import Scene
from tanks import tank

KERNELS = ["wendland-c2", "wendland-c4", "wendland-c6", "cubic", "quintic"]

REFUSALS = (KolkError, TypeError)
"""What may be raised: kolk's own errors, and Python's for what is no array at all."""

calm = {
    "deadline": None,
    "suppress_health_check": list(HealthCheck),
    "derandomize": True,
    "database": None,
}
short = settings(max_examples=60, **calm)  # type: ignore[arg-type]
long = settings(
    max_examples=int(os.environ.get("KOLK_FUZZ_EXAMPLES", "100000")),
    **{**calm, "derandomize": False},  # type: ignore[arg-type]
)

reals = st.floats(allow_nan=True, allow_infinity=True, width=64)
tame = st.floats(-3.0, 3.0)
odd = st.sampled_from([0.0, -0.0, 1e-300, 5e-324, 1e300, -1e300, np.inf, -np.inf, np.nan, -1.0])
numbers = tame | odd | reals


def arrays(shape: Any) -> st.SearchStrategy[Any]:
    """Arrays of several types, tame and not."""
    return (
        hnp.arrays(np.float64, shape, elements=tame)
        | hnp.arrays(np.float64, shape, elements=numbers)
        | hnp.arrays(np.float32, shape, elements=st.floats(-2.0, 2.0, width=32))
        | hnp.arrays(np.int64, shape, elements=st.integers(-5, 5))
    )


@st.composite
def clouds(draw: st.DrawFn) -> dict[str, Any]:
    """Arguments of an array function: mostly fitting, sometimes not."""
    n, d = draw(st.integers(0, 40)), draw(st.sampled_from([2, 2, 2, 3, 3, 1, 4]))
    m = n if draw(st.integers(0, 9)) else draw(st.integers(0, 5))
    period = st.none() | st.tuples(numbers, numbers)
    return {
        "position": draw(arrays((n, d))),
        "value": draw(arrays((m,)) | arrays((m, d))),
        "mass": draw(arrays((m,)) | st.just(np.full(n, 1.0))),
        "density": draw(arrays((m,)) | st.just(np.full(n, 1.0))),
        "h": draw(st.floats(0.05, 2.0) | numbers),
        "kernel": draw(st.sampled_from([*KERNELS, "none"])),
        "periodic": draw(st.none() | st.lists(period, min_size=d, max_size=d)),
        "points": draw(arrays((draw(st.integers(0, 10)), d))),
    }


def call_everything(cloud: dict[str, Any]) -> None:
    """Calls every array function; what it returns has the right shape."""
    x, kernel, h = cloud["position"], cloud["kernel"], cloud["h"]
    common = {"kernel": kernel, "periodic": cloud["periodic"]}
    matter = (x, cloud["value"], cloud["mass"], cloud["density"], h)

    def attempt(function: Any, *args: Any, **keys: Any) -> Any:
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return function(*args, **keys)
        except REFUSALS:
            return None

    for search in (kolk.neighbours, kolk.all_pairs):
        found = attempt(search, x, h, periodic=cloud["periodic"])
        if found is not None:
            assert len(found[0]) == len(x) + 1 and found[0][-1] == len(found[1])
    first = attempt(kolk.neighbours, x, h, periodic=cloud["periodic"])
    second = attempt(kolk.all_pairs, x, h, periodic=cloud["periodic"])
    if first is not None and second is not None:
        assert np.array_equal(first[0], second[0]) and np.array_equal(first[1], second[1])
    for function in (kolk.gradient, kolk.divergence, kolk.laplacian):
        found = attempt(function, *matter, **common)
        assert found is None or len(found) == len(x)
    found = attempt(kolk.interpolate, cloud["points"], *matter, **common)
    assert found is None or len(found) == len(cloud["points"])
    attempt(kolk.density_diffusion, x, cloud["mass"], cloud["density"], h, 10.0, **common)
    attempt(kolk.particle_shift, x, cloud["mass"], cloud["density"], h, h, **common)
    surface = attempt(kolk.free_surface, x, cloud["mass"], cloud["density"], h, **common)
    assert surface is None or len(surface[0]) == len(x)
    attempt(kolk.tait_pressure, cloud["density"], h, h)
    attempt(kolk.tait_density, cloud["density"], h, h)
    made = attempt(kolk.kernel, kernel, x.shape[1])
    if made is not None:
        attempt(made.value, cloud["density"], h)
        attempt(made.gradient, cloud["density"], h)


@short
@given(clouds())
def test_array_functions(cloud: dict[str, Any]) -> None:
    call_everything(cloud)


@pytest.mark.stability
@long
@given(clouds())
def test_array_functions_for_long(cloud: dict[str, Any]) -> None:
    call_everything(cloud)


small = st.sampled_from([0.0, 1e-9, 0.01, 0.05, 0.1, 0.3, 0.6, 1.0, 1e9, -0.1, np.nan, np.inf])
vectors = st.lists(small | tame, min_size=1, max_size=4)
shapes = st.one_of(
    st.fixed_dictionaries({"box": st.fixed_dictionaries({"from": vectors, "to": vectors})}),
    st.fixed_dictionaries({"disc": st.fixed_dictionaries({"centre": vectors, "radius": small})}),
    st.fixed_dictionaries(
        {"polygon": st.fixed_dictionaries({"points": st.lists(vectors, max_size=6)})}
    ),
    st.fixed_dictionaries({"box": st.just({"from": [0.1, 0.0], "to": [0.4, 0.2]})}),
)
anything = st.one_of(small, vectors, st.none(), st.booleans(), st.text(max_size=5), st.integers())
KEYS: dict[str, Any] = {
    "spacing": small,
    "until": small,
    "gravity": vectors,
    "kernel": st.sampled_from(KERNELS),
    "smoothing_ratio": small,
    "fluid.water.shape": shapes,
    "fluid.water.density": small | st.just(1000.0),
    "fluid.water.sound_speed": small | st.just("auto"),
    "fluid.water.velocity": vectors | st.just(["-y", "x*x"]),
    "fluid.water.pressure": st.sampled_from(["zero", "hydrostatic", "1e3*x", "1/x", "sqrt(-x)"]),
    "fluid.water.viscosity": st.fixed_dictionaries({"laminar": small}),
    "fluid.water.surface_tension": small,
    "fluid.water.jitter": small,
    "wall.tank.shape": shapes,
    "wall.tank.slip": st.sampled_from(["no", "free"]),
    "numerics.courant": small,
    "numerics.time_step": small,
    "numerics.delta": small,
    "numerics.shifting": st.sampled_from(["none", "sun", "gentle", "lind"]),
    "numerics.tensile_control": st.sampled_from(["auto", "none", "sun", "monaghan"]),
    "numerics.scheme": st.sampled_from(["auto", "delta-sph", "edac"]),
    "numerics.density_diffusion": st.sampled_from(["none", "molteni", "antuono", "fourtakas"]),
    "numerics.wall": st.sampled_from(["adami", "dynamic"]),
    "numerics.background_pressure": small,
    "numerics.free_surface": st.booleans(),
    "periodic.x": vectors,
    "output.every": small,
}


@st.composite
def changes(draw: st.DrawFn) -> dict[str, Any]:
    """Some keys of a scene with values that may or may not make sense."""
    chosen = draw(st.lists(st.sampled_from(sorted(KEYS)), max_size=4, unique=True))
    sane = {key: draw(KEYS[key]) for key in chosen}
    if not draw(st.integers(0, 4)):
        sane[draw(st.sampled_from(sorted(KEYS)))] = draw(anything)
    return sane


def run_a_little(changed: dict[str, Any]) -> None:
    """Makes the scene, checks it and takes some steps; all of it may be refused."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            scene: Scene = tank(spacing=0.05).replace(changed)
            if sum(len(body) for body in scene.bodies()) > 3000:
                return
            assert str(check(scene))
            sim = kolk.Simulation(scene, threads=1)
            sim.advance_to(min(scene.until, 1e3), 12)
        except KolkError as error:
            assert str(error)
            return
        for body in sim.bodies.values():
            assert np.isfinite(body.position).all() and np.isfinite(body.velocity).all()


@short
@given(changes())
def test_scenes(changed: dict[str, Any]) -> None:
    run_a_little(changed)


@pytest.mark.stability
@long
@given(changes())
def test_scenes_for_long(changed: dict[str, Any]) -> None:
    run_a_little(changed)


texts = st.text(max_size=200) | st.lists(
    st.sampled_from(
        ["name", "=", '"x"', "[", "]", "[[fluid]]", "\n", "{", "}", "spacing", "1e400", "0.1", ".",
         ",", "nan", "inf", "'", "#", "box", "from", "to", "é", "\x00", "gravity", "-"]
    ),
    max_size=40,
).map(" ".join)  # fmt: skip


@short
@given(texts)
def test_scene_files(text: str) -> None:
    try:
        kolk.scene.loads(text)
    except KolkError as error:
        assert str(error)
