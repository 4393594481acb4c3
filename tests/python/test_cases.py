"""The built-in scenes: complete, as their sources say, and honest about their cost."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from kolk import cases, references
from kolk.check import check
from kolk.scene import load, loads

NAMES = (
    "dam-break",
    "dam-break-box",
    "dam-break-column",
    "dam-break-decourcy",
    "dam-break-turbulent",
    "gearbox",
    "herschel-bulkley-channel",
    "mud",
    "oscillating-drop",
    "poiseuille",
    "sloshing",
    "standing-wave",
    "still-water",
    "surge-front",
    "taylor-green",
)


def test_the_list() -> None:
    assert cases.names() == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_case_says_what_it_is(name: str) -> None:
    case = cases.get(name)
    assert case.name == case.scene.name == name
    for text in (case.title, case.shows, case.source, case.reference, case.cost):
        assert len(text) > 5
    assert load(name) is case.scene
    assert loads(case.scene.to_toml()).plain().keys() >= case.scene.plain().keys()


@pytest.mark.parametrize("name", NAMES)
def test_the_stated_particles_are_there_and_nothing_warns(name: str) -> None:
    case = cases.get(name)
    report = check(case.scene)
    assert report.warnings == ()
    for kind in ("fluid", "wall"):
        stated = re.search(rf"([\d,]+)(?: fluid and [\d,]+)? {kind}", case.cost)
        if kind == "wall":
            stated = re.search(r"([\d,]+) wall", case.cost)
        there = sum(b.particles for b in report.bodies if b.kind == kind)
        assert there == pytest.approx(float(stated[1].replace(",", "")) if stated else 0, rel=0.01)
    steps = re.search(r"about ([\d,]+) steps: [\d]+ (?:seconds|minutes) on two cores", case.cost)
    assert steps is not None
    # The estimate of the start; a flow that grows faster takes more of them.
    smallest = case.scene.until / report.time_step
    assert 0.95 * smallest < float(steps[1].replace(",", "")) < 1.25 * smallest


@pytest.mark.parametrize("name", NAMES)
def test_a_case_at_another_spacing(name: str) -> None:
    scene = cases.get(name).scene
    coarse = scene.replace(spacing=1.25 * scene.spacing)
    fine = sum(len(b) for b in scene.bodies() if b.kind == "fluid")
    assert sum(len(b) for b in coarse.bodies() if b.kind == "fluid") < fine


@pytest.mark.parametrize("name", NAMES)
def test_comparisons_point_at_what_exists(name: str) -> None:
    case = cases.get(name)
    assert case.comparisons or case.reference.startswith("none")
    probes = {p.name for p in case.scene.probe}
    for item in case.comparisons:
        assert item.probe is None or item.probe in probes
        assert item.scale_time > 0.0 and item.scale_value > 0.0
        if item.kind == "analytic":
            assert callable(getattr(references, item.reference))
        else:
            table = references.load(item.reference)
            assert not item.column or item.column in table.columns


def test_dam_break_is_that_of_lobovsky() -> None:
    scene = cases.get("dam-break").scene
    assert scene.spacing == 0.3 / 60
    assert scene.until == pytest.approx(7 * math.sqrt(0.3 / 9.81))
    at = {p.name: p.pressure for p in scene.probe if p.pressure is not None}
    heights = [at[f"P{i}"].at[1] for i in (1, 2, 3, 4)]  # type: ignore[union-attr]
    assert heights == [0.003, 0.015, 0.03, 0.08]
    assert len(scene.bodies()[0]) == 120 * 60


def test_the_box_has_its_sensors_on_its_surface() -> None:
    scene = cases.get("dam-break-box").scene
    box = scene.wall[1].shape
    assert box is not None
    points = np.array([p.pressure.at for p in scene.probe if p.pressure is not None])
    assert len(points) == 8
    np.testing.assert_allclose(box.shape.distance(points), 0.0, atol=1e-12)


def test_the_column_scene_has_about_the_stated_particles() -> None:
    scene = cases.get("dam-break-column").scene
    assert len(scene.bodies()[0]) == pytest.approx(192_600, rel=0.01)


def test_taylor_green_starts_from_the_exact_solution() -> None:
    scene = cases.get("taylor-green").scene
    body = scene.bodies()[0]
    velocity, pressure = references.taylor_green(body.position, 0.0, viscosity=0.01, density=1000.0)
    np.testing.assert_allclose(body.velocity, velocity, atol=1e-12)
    started = 1000.0 * scene.sound_speed**2 / 7.0 * ((body.density / 1000.0) ** 7 - 1.0)
    np.testing.assert_allclose(started, pressure, atol=1e-6 * 250.0)
    assert len(body) == 50 * 50
