"""Comparisons find what was put into made-up records, and say it in a sentence."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from kolk import cases, compare, references
from kolk.compare import records
from kolk.compare.align import crossing, shift_at_arrival

TIME, PRESSURE = 0.17487, 2934.0
"""sqrt(H/g) in s and rho g H in Pa of the dam break."""


@dataclass
class MadeFrame:
    time: float
    position: np.ndarray
    fields_: dict[str, np.ndarray]

    def rows(self, kind: str) -> np.ndarray:
        return np.full(len(self.position), kind == "fluid")

    def field(self, name: str) -> np.ndarray:
        return self.fields_[name]


@dataclass
class MadeRun:
    scene: Any
    probes: dict[str, pd.DataFrame] = field(default_factory=dict)
    frames: list[MadeFrame] = field(default_factory=list)
    folder: Path = Path("unused")


def median(late: float, factor: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """The experiment's median in SI, ``late`` sqrt(H/g) too late, times ``factor``."""
    band = references.load("lobovsky-sensor2-band")
    t = np.arange(0.0, 7.5, 0.004)
    return t * TIME, factor * np.interp(t - late, band.time, band.values("median")) * PRESSURE


def by_name(results: list[compare.ComparisonResult]) -> dict[str, compare.ComparisonResult]:
    return {result.name: result for result in results}


def band_of(late: float, factor: float = 1.0) -> dict[str, compare.ComparisonResult]:
    time, value = median(late, factor)
    band = references.load("lobovsky-sensor2-band")
    return by_name(compare.compare_band("P2", time, value, band, TIME, PRESSURE))


def test_the_median_itself_is_inside_its_band_after_one_shift() -> None:
    got = band_of(late=-0.2)
    assert got["arrival"].details["shift"] == pytest.approx(0.2, abs=0.005)
    assert got["share of time inside the band"].value > 0.99
    assert got["first peak"].value == pytest.approx(1.867, rel=0.01)
    assert got["time of the first peak"].value == pytest.approx(2.595, abs=0.02)
    assert got["time of the first peak"].details["unshifted"] == pytest.approx(2.395, abs=0.02)
    assert "0.20 before the experiment" in got["arrival"].sentence


def test_the_shift_is_bounded_and_what_is_left_is_said() -> None:
    got = band_of(late=0.7)
    assert got["arrival"].details["shift"] == pytest.approx(-0.4)
    assert "0.30 remain" in got["arrival"].sentence
    assert got["share of time inside the band"].value < 0.9


def test_a_pressure_too_high_leaves_the_band() -> None:
    got = band_of(late=0.0, factor=1.5)
    assert got["share of time inside the band"].value < 0.2
    assert got["first peak"].details["relative_to_median"] == pytest.approx(0.5, abs=0.01)
    assert "above the experiment's 1.76 to 1.99" in got["first peak"].sentence


def test_a_run_that_ends_too_early_says_so() -> None:
    time, value = median(0.0)
    band = references.load("lobovsky-sensor2-band")
    early = time < 1.5 * TIME
    (only,) = compare.compare_band("P2", time[early], value[early], band, TIME, PRESSURE)
    assert math.isnan(only.value) and "does not reach the sensor" in only.sentence
    assert only.as_dict()["value"] is None
    json.dumps(only.as_dict(), allow_nan=False)


def test_crossing_interpolates() -> None:
    t = np.array([0.0, 1.0, 2.0])
    assert crossing(t, np.array([0.0, 2.0, 3.0]), 1.0) == pytest.approx(0.5)
    assert crossing(t, np.array([5.0, 2.0, 3.0]), 1.0) == 0.0
    assert math.isnan(crossing(t, np.zeros(3), 1.0))
    shift, _, _ = shift_at_arrival(t, np.zeros(3), t, np.array([0.0, 2.0, 3.0]))
    assert math.isnan(shift)


def test_front_is_aligned_and_measured() -> None:
    record = references.load("martin-moyce-2.25in")
    width, unit = 0.05715, math.sqrt(0.05715 / 19.62)
    t = np.linspace(record.time[0], record.time[-1], 400)
    z = np.interp(t, record.time, record.values()) + 0.1 * (t > 4.0)
    front = z * width
    (got,) = compare.compare_front("front", (t - 0.5) * unit, front, record, unit, width)
    assert got.details["shift"] == pytest.approx(0.5, abs=0.01)
    assert 0.05 < got.value < 0.1
    (got,) = compare.compare_front(
        "front", t * unit, front, record, unit, width, until=float(z[t > 4.0][0])
    )
    assert got.value < 0.01 and got.details["front_to"] < 5.0
    (got,) = compare.compare_front("front", t * unit, 0.1 * front, record, unit, width)
    assert math.isnan(got.value) and "must pass 1.44" in got.sentence


def test_series_gives_rms_and_peak() -> None:
    record = references.load("yeh-petroff-force")
    t = np.arange(0.0, 0.8, 0.001)
    force = 1.1 * np.interp(t, record.time, record.values())
    got = by_name(compare.compare_series("load", t, force, record, "force"))
    assert got["RMS"].value == pytest.approx(0.1 * 17.0, rel=0.3)
    assert got["peak"].reference == 33.1
    assert got["peak"].details["reference_time"] == 0.396
    (short,) = compare.compare_series("load", t[:5], force[:5], record, "force")
    assert "run longer" in short.sentence


def test_norms_of_a_known_error() -> None:
    exact = np.array([[3.0, 4.0], [0.0, 5.0]])
    got = compare.norms(exact + np.array([[0.3, 0.4], [0.0, 0.0]]), exact)
    assert got.l1 == pytest.approx(0.05)
    assert got.largest == pytest.approx(0.1)
    assert compare.norms(np.array([1.0, 2.0]), np.zeros(2), scale=2.0).largest == 1.0


def vortex_frame(time: float, factor: float) -> MadeFrame:
    x = np.random.default_rng(3).random((500, 2))
    u, _ = references.taylor_green(x, time, viscosity=0.01)
    return MadeFrame(time, x, {"velocity": factor * u})


def test_compare_follows_the_case_of_the_run() -> None:
    scene = cases.get("taylor-green").scene
    run = MadeRun(scene, frames=[vortex_frame(0.0, 1.0), vortex_frame(2.0, 1.04)])
    got = by_name(compare.compare(run))
    assert got["decay of the velocity"].details["relative_error"] == pytest.approx(0.04, abs=1e-6)
    assert got["velocity, L2"].value == pytest.approx(0.04, abs=1e-6)


def test_channel_and_still_water() -> None:
    given = cases.get("poiseuille").comparisons[0].parameters
    y = np.linspace(0.0, given["width"], 50)
    u = references.poiseuille(y, 0.1, **given)
    x = np.stack([np.zeros(50), y], -1)
    frame = MadeFrame(0.1, x, {"velocity": np.stack([u + 0.01 * u.max(), 0 * u], -1)})
    (got,) = compare.compare(MadeRun(cases.get("poiseuille").scene, frames=[frame, frame]))
    assert got.value == pytest.approx(0.01)

    given = cases.get("still-water").comparisons[0].parameters
    height = np.linspace(0.0, given["surface"], 50)
    p = references.hydrostatic_pressure(height, **given)
    x = np.stack([np.zeros(50), height], -1)
    frame = MadeFrame(2.0, x, {"pressure": p, "velocity": np.zeros((50, 2))})
    got = by_name(compare.compare(MadeRun(cases.get("still-water").scene, frames=[frame, frame])))
    assert got["pressure, L2"].value == pytest.approx(0.0, abs=1e-12)
    assert got["kinetic energy"].value == 0.0


def test_sensors_of_one_experiment_share_its_shift() -> None:
    time, value = median(-0.2)
    table = pd.DataFrame({"time": time, "value": value})
    run = MadeRun(cases.get("dam-break").scene, probes={"P2": table, "P3": table})
    shifts = [r.details["shift"] for r in compare.compare(run) if r.name in {"arrival", "peak"}]
    assert len(shifts) == 2 and shifts[0] == shifts[1] != 0.0


def test_a_changed_tank_is_not_set_beside_the_experiment() -> None:
    scene = cases.get("dam-break").scene
    assert records.case_of(MadeRun(scene.replace(spacing=0.02))) is not None
    assert records.case_of(MadeRun(scene.replace(gravity=[0.0, -1.62]))) is None
    assert records.case_of(MadeRun(scene.replace(name="my-own"))) is None


@pytest.mark.parametrize("name", cases.names())
def test_every_comparison_of_a_case_can_be_resolved(name: str) -> None:
    case = cases.get(name)
    probes = {probe.name for probe in case.scene.probe}
    for asked in case.comparisons:
        if asked.kind == "analytic":
            assert callable(getattr(references, asked.reference))
            continue
        assert asked.probe in probes
        reference = records.reference_of(asked)
        assert records.reference_column(asked) in reference.columns
        if asked.kind == "band":
            assert {"low", "median", "high"} <= set(reference.columns)
