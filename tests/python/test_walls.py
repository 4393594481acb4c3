"""Walls: the surface that shapes make, and what passes it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import kolk
from kolk.scene import facets

FloatArray = npt.NDArray[np.float64]
SPACING = 0.02


def scene(*walls: Any, dimension: int = 2, spacing: float = SPACING, **keys: Any) -> kolk.Scene:
    """Still water in the low corner of whatever walls there are."""
    down = [0.0] * dimension
    down[-1] = -9.81
    return kolk.Scene(
        **{
            "name": "walls",
            "dimension": dimension,
            "spacing": spacing,
            "gravity": down,
            "until": 0.1,
            "fluid": [
                {
                    "name": "water",
                    "shape": {"box": {"from": [0.0] * dimension, "to": [0.3] * dimension}},
                }
            ],
            "wall": list(walls),
        }
        | keys
    )


def tank(dimension: int = 2) -> dict[str, Any]:
    to = [1.0] * dimension
    to[-1] = 0.6
    return {
        "name": "tank",
        "shape": {"tank": {"from": [0.0] * dimension, "to": to, "open": ["top"]}},
    }


def surface(of: kolk.Scene, name: str) -> FloatArray:
    found = next(b.surface for b in of.bodies() if b.name == name)
    assert found is not None
    return found


def extent(of: FloatArray) -> float:
    """Length or area of facets."""
    edge = of[:, 1] - of[:, 0]
    if of.shape[1] == 2:
        return float(np.linalg.norm(edge, axis=1).sum())
    return float(0.5 * np.linalg.norm(np.cross(edge, of[:, 2] - of[:, 0]), axis=1).sum())


def inflow(of: FloatArray) -> FloatArray:
    """Sum of normals times extent: zero for a closed surface."""
    length = np.array([extent(f[None]) for f in of])
    return np.asarray((facets.normals(of) * length[:, None]).sum(axis=0))


def test_a_tank_has_the_faces_that_are_closed() -> None:
    for dimension, area in ((2, 1.0 + 2 * 0.6), (3, 1.0 + 4 * 0.6)):
        found = surface(scene(tank(dimension), dimension=dimension, spacing=0.05), "tank")
        assert extent(found) == pytest.approx(area, rel=1e-12)
        # The open face is missing: that much of the normals' sum is left.
        assert inflow(found)[-1] == pytest.approx(1.0, rel=1e-12)
        centre = found.mean(axis=1)
        assert ((0.45 - centre) * facets.normals(found)).sum(axis=1).min() > 0.0


@pytest.mark.parametrize(
    ("shape", "extent_exact", "rel"),
    [
        ({"box": {"from": [0.5, 0.1], "to": [0.7, 0.4]}}, 1.0, 1e-12),
        ({"polygon": {"points": [[0.5, 0.1], [0.5, 0.4], [0.9, 0.1]]}}, 1.2, 1e-12),
        ({"disc": {"centre": [0.6, 0.3], "radius": 0.15}}, 2 * math.pi * 0.15, 1e-2),
        (
            {
                "difference": {
                    "of": {"box": {"from": [0.5, 0.1], "to": [0.8, 0.4]}},
                    "minus": [{"box": {"from": [0.6, 0.2], "to": [0.7, 0.5]}}],
                }
            },
            1.2 + 2 * 0.2,
            1e-6,
        ),
        (
            {
                "union": [
                    {"box": {"from": [0.5, 0.1], "to": [0.7, 0.3]}},
                    {"box": {"from": [0.6, 0.2], "to": [0.8, 0.4]}},
                ]
            },
            1.2,
            1e-6,
        ),
        (
            {
                "function": {
                    "value": "hypot(x - 0.7, y - 0.3) - 0.1",
                    "from": [0.5, 0.1],
                    "to": [0.9, 0.5],
                }
            },
            2 * math.pi * 0.1,
            1e-2,
        ),
    ],
)
def test_shapes_have_closed_surfaces(
    shape: dict[str, Any], extent_exact: float, rel: float
) -> None:
    found = surface(scene(tank(), {"name": "thing", "shape": shape}), "thing")
    assert extent(found) == pytest.approx(extent_exact, rel=rel)
    assert np.abs(inflow(found)).max() < 1e-6
    # Every normal leaves the solid.
    body = kolk.Wall(name="thing", shape=shape)
    assert body.shape is not None
    ahead = found.mean(axis=1) + 5e-4 * facets.normals(found)
    assert (body.shape.shape.distance(ahead) > 0.0).all()


@pytest.mark.parametrize(
    ("shape", "area", "rel"),
    [
        ({"box": {"from": [0.4, 0.4, 0.2], "to": [0.6, 0.7, 0.3]}}, 2 * (0.06 + 0.02 + 0.03), 1e-9),
        ({"sphere": {"centre": [0.6, 0.6, 0.3], "radius": 0.2}}, 4 * math.pi * 0.04, 2e-2),
        (
            {"cylinder": {"from": [0.6, 0.6, 0.1], "to": [0.6, 0.6, 0.5], "radius": 0.2}},
            2 * math.pi * 0.2 * 0.6,
            2e-2,
        ),
        (
            {"polygon": {"points": [[0.5, 0.5], [0.9, 0.5], [0.5, 0.8]], "from": 0.1, "to": 0.3}},
            0.12 + 1.2 * 0.2,
            1e-9,
        ),
    ],
)
def test_solids_have_closed_surfaces(shape: dict[str, Any], area: float, rel: float) -> None:
    whole = scene(tank(3), {"name": "thing", "shape": shape}, dimension=3, spacing=0.05)
    found = surface(whole, "thing")
    assert extent(found) == pytest.approx(area, rel=rel)
    assert np.abs(inflow(found)).max() < 1e-9


def test_where_walls_touch_neither_has_a_surface() -> None:
    wedge = {"polygon": {"points": [[0.5, 0.0], [0.9, 0.0], [0.7, 0.2]]}}
    whole = scene(tank(), {"name": "wedge", "shape": wedge})
    assert extent(surface(whole, "tank")) == pytest.approx(2.2 - 0.4, abs=1e-7)
    assert extent(surface(whole, "wedge")) == pytest.approx(2 * math.hypot(0.2, 0.2), abs=1e-7)
    # Two boxes side by side on the floor are one.
    left = {"name": "left", "shape": {"box": {"from": [0.5, 0.0], "to": [0.7, 0.2]}}}
    right = {"name": "right", "shape": {"box": {"from": [0.7, 0.0], "to": [0.8, 0.2]}}}
    both = scene(tank(), left, right)
    assert extent(surface(both, "left")) == pytest.approx(0.4, abs=1e-7)
    assert extent(surface(both, "right")) == pytest.approx(0.3, abs=1e-7)


def test_a_wall_that_repeats_has_no_ends() -> None:
    channel = scene(
        {"name": "low", "shape": {"box": {"from": [0.0, -0.1], "to": [0.4, 0.0]}}},
        periodic={"x": [0.0, 0.4]},
    )
    found = surface(channel, "low")
    assert extent(found) == pytest.approx(0.8, abs=1e-9)
    assert np.abs(facets.normals(found)[:, 0]).max() == 0.0


def test_own_particles_get_a_surface_half_a_spacing_in_front() -> None:
    x, y = np.meshgrid(0.6 + SPACING * (np.arange(8) + 0.5), SPACING * (np.arange(6) + 0.5))
    own = kolk.Wall.from_arrays(np.stack([x.ravel(), y.ravel()], axis=1), name="own")
    found = surface(scene(own), "own").reshape(-1, 2)
    assert found.min(axis=0) == pytest.approx([0.6, 0.0], abs=0.1 * SPACING)
    assert found.max(axis=0) == pytest.approx([0.76, 0.12], abs=0.1 * SPACING)


def falling(wall: str, **numerics: Any) -> kolk.Simulation:
    """Water that falls into the acute corner between a tank and a wedge."""
    wedge = {"polygon": {"points": [[0.2, 0.0], [0.6, 0.0], [0.6, 0.4]]}}
    whole = scene(
        {"name": "tank", "shape": {"tank": {"from": [0, 0], "to": [0.6, 0.6], "open": ["top"]}}},
        {"name": "wedge", "shape": wedge},
        fluid=[{"name": "water", "shape": {"box": {"from": [0.02, 0.3], "to": [0.2, 0.5]}}}],
        until=0.6,
        numerics={"wall": wall} | numerics,
    )
    return kolk.Simulation(whole, threads=1)


@pytest.mark.parametrize("wall", ["adami", "modified-dynamic", "semi-analytical", "penalty"])
def test_nothing_is_lost_behind_a_wall(wall: str) -> None:
    sim = falling(wall)
    sim.advance_to(0.6)
    assert sim.leaks <= 2
    assert sim.diagnostics["leaks"] == sim.leaks
    solid = sim.scene.wall[1].shape
    assert solid is not None
    position = sim.bodies["water"].position
    assert solid.shape.distance(position).min() > -0.2 * SPACING
    assert position.min() > -0.2 * SPACING


def test_still_water_stays_still_at_every_wall() -> None:
    still = kolk.load("still-water").replace({"spacing": 0.5 / 15})
    energies, errors = {}, {}
    for wall in ("adami", "dynamic", "modified-dynamic", "semi-analytical", "mirror"):
        sim = kolk.Simulation(still.replace({"numerics.wall": wall}), threads=1)
        sim.advance_to(5 * math.sqrt(0.5 / 9.81))
        water = sim.bodies["water"]
        exact = 1000 * 9.81 * (0.5 - water.position[:, 1])
        errors[wall] = float(np.sqrt(np.mean((water.pressure - exact) ** 2)) / (1000 * 9.81 * 0.5))
        energies[wall] = sim.energy.kinetic / (water.mass.sum() * 9.81 * 0.5)
        assert sim.leaks == 0
        force = sim.force("tank")["force"]
        # On facets it is the sum of pressures there, not the reaction to forces between particles;
        # dynamic walls are noisy.
        rel = {"semi-analytical": 0.02, "mirror": 0.02, "dynamic": 0.01}.get(wall, 1e-3)
        assert force[1] == pytest.approx(-water.mass.sum() * 9.81, rel=rel)
    assert max(errors.values()) < 0.012
    # On facets the noise is the largest: there are no wall particles among those that the
    # density follows.
    noisy = energies.pop("semi-analytical")
    assert noisy < 5e-6
    assert max(energies.values()) < 2e-6


@pytest.mark.parametrize("dimension", [2, 3])
def test_mirrors_hold_a_splash_against_a_block(dimension: int) -> None:
    # Water falls on a block in a tank: inner and outer edges, and corners where planes meet.
    spacing, until = (0.02, 0.6) if dimension == 2 else (0.04, 0.12)
    wide = [0.6] if dimension == 2 else [0.6, 0.32]
    block = {"box": {"from": [0.3, *[0.0] * (dimension - 1)], "to": [0.46, *wide[1:], 0.16]}}
    whole = scene(
        {
            "name": "tank",
            "shape": {"tank": {"from": [0.0] * dimension, "to": [*wide, 0.8], "open": ["top"]}},
        },
        {"name": "block", "shape": block},
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0] * dimension, "to": [0.28, *wide[1:], 0.4]}},
                "viscosity": {"artificial": 0.05},
            }
        ],
        dimension=dimension,
        spacing=spacing,
        until=until,
        numerics={"wall": "mirror"},
    )
    sim = kolk.Simulation(whole, threads=1)
    sim.advance_to(until)
    water = sim.bodies["water"]
    assert sim.leaks == 0
    solid = sim.scene.wall[1].shape
    assert solid is not None
    assert solid.shape.distance(water.position).min() > -0.1 * spacing
    # The water has come to the block, and in 2D over it.
    assert water.position[:, 0].max() > (0.46 if dimension == 2 else 0.29)


def test_mirrors_refuse_what_they_cannot_do() -> None:
    with pytest.raises(kolk.SceneError, match=r"right angle.*adami"):
        falling("mirror")
    disc = {"disc": {"centre": [0.6, 0.3], "radius": 0.1}}
    for shape, why in (
        (disc, "curved"),
        ({"box": {"from": [0.5, 0.1], "to": [0.52, 0.4]}}, "plate"),
        ({"box": {"from": [0.96, 0.1], "to": [0.98, 0.4]}}, "gap|plate"),
    ):
        whole = scene(tank(), {"name": "thing", "shape": shape}, numerics={"wall": "mirror"})
        with pytest.raises(kolk.SceneError, match=why):
            kolk.Simulation(whole, threads=1)


def test_walls_of_facets_refuse_what_they_cannot_do() -> None:
    sticky = kolk.load("still-water").replace({"numerics.wall": "penalty", "wall.tank.slip": "no"})
    with pytest.raises(kolk.SceneError, match="slip"):
        kolk.Simulation(sticky)
