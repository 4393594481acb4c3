"""The gearbox: gears that mesh without touching, from files, and oil that stays outside of them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
import shapely

import solids
from kolk.cases import gearbox, gears
from kolk.cases.gearbox import CENTRES, case, rate
from kolk.cases.gears import FOLDER, MODULE, TEETH, outlines, prism, turned
from kolk.scene import Mesh, Outline, Scene
from kolk.simulation import Simulation


def test_the_outlines_are_those_that_the_case_makes(tmp_path):
    gears.write(tmp_path)
    for name in TEETH:
        made = (tmp_path / f"{name}.csv").read_text(encoding="utf-8")
        assert made == (FOLDER / f"{name}.csv").read_text(encoding="utf-8")


def test_a_flank_is_the_path_of_a_string_unrolled_from_the_base_circle():
    base, radius = 0.05, np.linspace(0.05, 0.07, 9)
    angle = gears.involute(radius, base)
    point = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    unrolled = angle + np.arccos(base / radius)
    touch = base * np.stack([np.cos(unrolled), np.sin(unrolled)], axis=1)
    # The free string is as long as the arc that it left.
    np.testing.assert_allclose(np.linalg.norm(point - touch, axis=1), base * unrolled, atol=1e-12)


def test_gears_mesh_without_touching_and_leave_room_for_oil():
    shapes = outlines()
    pitch = 2.0 * math.pi / TEETH["driver"]
    for angle in np.linspace(0.0, pitch, 25):
        time = angle / abs(rate("driver"))
        driver, wheel = (
            shapely.Polygon(turned(shapes[name], rate(name) * time) + CENTRES[name])
            for name in TEETH
        )
        assert driver.distance(wheel) > 1.2 * gearbox.SPACING
    # Teeth reach into the gaps of the other: the tips' circles cross.
    reach = sum(np.linalg.norm(shapes[name], axis=1).max() for name in TEETH)
    apart = CENTRES["wheel"][0] - CENTRES["driver"][0]
    assert reach - apart > 1.2 * MODULE


def test_a_gear_as_a_mesh_is_the_gear_as_an_outline(tmp_path):
    outline = outlines()["driver"]
    file = solids.write_stl(tmp_path / "driver.stl", prism(outline, -0.05, 0.05))
    mesh = Mesh(file=str(file))
    area = shapely.Polygon(outline).area
    assert mesh.size() == pytest.approx(0.1 * area, rel=1e-6)
    flat = np.random.default_rng(2).uniform(-0.08, 0.08, (500, 2))
    middle = np.column_stack([flat, np.zeros(len(flat))])
    expected = Outline(file=str(FOLDER / "driver.csv")).distance(flat)
    # Away from the end faces the prism is as far as its outline.
    near = np.abs(expected) < 0.05
    np.testing.assert_allclose(mesh.distance(middle)[near], expected[near], atol=1e-7)


def oil_in_gears(simulation: Simulation, housing: Sequence[float]) -> float:
    """How deep in m the oil's worst particle lies in a gear or beyond the housing, if positive."""
    oil = simulation.bodies["oil"].position
    deepest = max(float(np.max(-oil)), float(np.max(oil - np.array(housing))))
    for wall in simulation.scene.wall[1:]:
        turn, offset = simulation.pose(wall.name)
        assert wall.shape is not None
        # Back to where the wall was at the start.
        home = (oil - offset) @ turn
        deepest = max(deepest, float(-wall.shape.shape.distance(home).min()))
    return deepest


def test_oil_stays_out_of_the_gears_and_holds_them_back():
    spacing = gearbox.SPACING
    simulation = Simulation(case.scene, threads=0)
    simulation.advance(1.2 * gearbox.RUN_UP)
    torques = {name: [] for name in TEETH}
    before, time = simulation.energy, 0.02
    for row in range(40):
        simulation.advance(time / 40)
        if row % 4 == 0:
            assert oil_in_gears(simulation, gearbox.HOUSING) < 0.1 * spacing
        for name in TEETH:
            found = simulation.force(name)
            lever = np.array(CENTRES[name])
            x, y = found["force"]
            torques[name].append(float(found["moment"][0]) - (lever[0] * y - lever[1] * x))
    powers = {name: -float(np.mean(torques[name])) * rate(name) for name in TEETH}
    assert min(powers.values()) > 0.0
    assert simulation.leaks == 0
    # Torque times speed is what walls hand over by the energy budget, and nothing gets lost.
    after, work = simulation.energy, time * sum(powers.values())
    taken = {k: e - before.dissipated[k] for k, e in after.dissipated.items()}
    assert -taken["walls"] == pytest.approx(work, rel=0.15)
    assert after.total - before.total + sum(taken.values()) == pytest.approx(0.0, abs=0.1 * work)
    assert not simulation.mach_warning


def test_the_gearbox_in_3d_is_made_of_meshes(tmp_path):
    width = 0.04
    shapes = {}
    for name, outline in outlines().items():
        solid = prism(outline + CENTRES[name], 0.0, width)
        file = solids.write_obj(tmp_path / f"{name}.obj", solid)
        shapes[name] = {"mesh": {"file": str(file)}}
    spacing = 0.005
    flat = gearbox.bodies(
        shapes, [{"mesh": shapes[n]["mesh"] | {"offset": 0.0025}} for n in shapes]
    )
    housing = [*gearbox.HOUSING, width]
    flat["fluid"][0]["shape"]["difference"]["of"] = {
        "box": {"from": [0.0, 0.0, 0.0], "to": [housing[0], gearbox.LEVEL, width]}
    }
    flat["wall"][0]["shape"] = {"tank": {"from": [0.0, 0.0, 0.0], "to": housing}}
    for wall in flat["wall"][1:]:
        centre = [*CENTRES[wall["name"]], 0.0]
        turn = {"centre": centre, "axis": [0.0, 0.0, 1.0], "rate": rate(wall["name"])}
        wall["motion"] = {"rotate": turn}
    for probe in flat["probe"]:
        probe["force"]["about"] = [*probe["force"]["about"], 0.0]
    scene = Scene(
        name="gearbox-3d",
        dimension=3,
        spacing=spacing,
        gravity=[0.0, -9.81, 0.0],
        until=0.1,
        **flat,
    )
    simulation = Simulation(scene, threads=1)
    simulation.advance(1.0, max_steps=10)
    assert simulation.particles["fluid"] > 1000
    assert np.isfinite(simulation.bodies["oil"].velocity).all()
    assert oil_in_gears(simulation, housing) < 0.1 * spacing
