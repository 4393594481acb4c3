"""Packed particles: the shape's mass, an even concentration up to its surface, and quiet water."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import kolk
from kolk.scene import Scene, load, material, packing
from kolk.scene.shapes import Cylinder, Disc, Polygon, Shape, Sphere
from tanks import GRAVITY, body, tank

FloatArray = npt.NDArray[np.float64]

SPACING = 0.05
DISC = Disc(centre=(0.1, 0.2), radius=1.0)
RAMP = Polygon(points=((0.0, 0.0), (2.0, 0.7), (2.0, 1.5), (0.0, 1.5)))
WIDTH, DEPTH, SLOPE = 1.0, 0.5, 0.2137


def free(shape: Shape, arrangement: str, spacing: float = SPACING) -> Scene:
    """A body of fluid alone."""
    return Scene(
        name="free",
        dimension=max(shape.dimensions()),
        spacing=spacing,
        until=1.0,
        fluid=[{"name": "drop", "shape": shape, "arrangement": arrangement, "sound_speed": 10.0}],
    )


def basin(arrangement: str, spacing: float = 0.025) -> Scene:
    """Still water over a slanted bottom, whose lattice is not that of the water."""
    corners = [[0.0, 0.0], [WIDTH, SLOPE], [WIDTH, DEPTH]]
    room = {"polygon": {"points": [*corners[:2], [WIDTH, 0.9], [0.0, 0.9]]}}
    around = {"box": {"from": [-0.297, -0.293], "to": [1.3, 0.8]}}
    return Scene(
        name="basin",
        dimension=2,
        spacing=spacing,
        gravity=[0.0, -GRAVITY],
        until=1.0,
        fluid=[
            {
                "name": "water",
                "shape": {"polygon": {"points": [*corners, [0.0, DEPTH]]}},
                "arrangement": arrangement,
                "viscosity": {"artificial": 0.02},
            }
        ],
        wall=[{"name": "basin", "shape": {"difference": {"of": around, "minus": [room]}}}],
    )


def kernel_sum(scene: Scene, points: FloatArray, *, filled: Shape | None = None) -> FloatArray:
    """Sum of V W over the fluid at ``points``; with ``filled`` also over what is outside of it."""
    fluid = scene.bodies()[0]
    position, volume = fluid.position, fluid.mass / 1000.0
    if filled is not None:
        around = packing.cells(
            filled.distance, *filled.bounds(), scene.spacing, 2 * scene.smoothing_length
        )
        cell = scene.spacing**scene.dimension
        position = np.concatenate([position, around.outer])
        volume = np.concatenate([volume, (1.0 - around.inside) * cell])
    one = np.ones(len(position))
    return kolk.interpolate(
        points, position, one, volume, one, scene.smoothing_length, normalise=False
    )


def along(shape: Shape) -> FloatArray:
    """Points of the surface, away from corners."""
    if isinstance(shape, Disc):
        angle = np.linspace(0.0, 2.0 * np.pi, 700, endpoint=False)
        return np.array(shape.centre) + shape.radius * np.stack([np.cos(angle), np.sin(angle)], 1)
    assert isinstance(shape, Polygon)
    a, b = np.array(shape.points[0]), np.array(shape.points[1])
    share = np.linspace(0.15, 0.85, 500)[:, None]
    return np.asarray(a + share * (b - a))


# How the particles lie


@pytest.mark.parametrize(
    ("shape", "spacing", "size"),
    [
        (DISC, 0.05, np.pi),
        (RAMP, 0.05, 2.3),
        (Sphere(centre=(0.0, 0.0, 0.0), radius=1.0), 0.2, 4.0 / 3.0 * np.pi),
        (Cylinder(from_=(0.0, 0.0, 0.0), to=(0.6, 0.0, 0.8), radius=0.5), 0.2, 0.25 * np.pi),
    ],
)
def test_the_mass_is_that_of_the_shape(shape: Shape, spacing: float, size: float) -> None:
    fluid = free(shape, "packed", spacing).bodies()[0]
    assert fluid.mass.sum() == pytest.approx(1000.0 * size, rel=1e-12)
    assert np.ptp(fluid.mass) == 0.0
    assert len(fluid) == round(size / spacing ** shape.bounds()[0].size)
    assert shape.distance(fluid.position).max() < -0.2 * spacing


def test_what_has_no_exact_size_is_measured() -> None:
    """An ellipse given by a function that is no distance; a box without a disc."""
    ellipse = {"from": [-1.1, -0.6], "to": [1.1, 0.6], "value": "x**2 + 4*y**2 - 1"}
    cut = {
        "of": {"box": {"from": [0.0, 0.0], "to": [2.0, 1.0]}},
        "minus": [{"disc": {"centre": [1.0, 0.5], "radius": 0.3}}],
    }
    for table, area in (
        ({"function": ellipse}, 0.5 * np.pi),
        ({"difference": cut}, 2.0 - 0.09 * np.pi),
    ):
        scene = free(DISC, "packed").replace({"fluid.drop.shape": table})
        assert scene.bodies()[0].mass.sum() == pytest.approx(1000.0 * area, rel=2e-4)


@pytest.mark.parametrize("shape", [DISC, RAMP], ids=["disc", "ramp"])
def test_the_concentration_is_even_up_to_the_surface(shape: Shape) -> None:
    """The kernel's sum over particles and what surrounds the shape, and over particles alone on the
    surface, where a plane has 1/2."""
    inside, surface = {}, {}
    for arrangement in ("lattice", "packed"):
        scene = free(shape, arrangement)
        at = scene.bodies()[0].position
        inside[arrangement] = float(np.std(kernel_sum(scene, at, filled=shape)))
        surface[arrangement] = float(np.std(kernel_sum(scene, along(shape))))
    assert inside["packed"] < 1.5e-3
    assert inside["packed"] < inside["lattice"] / 6.0
    assert surface["packed"] < surface["lattice"] / 5.0


def test_the_same_bits_each_time_and_from_a_file(tmp_path: Path) -> None:
    scene = basin("packed")
    scene.save(tmp_path / "basin.toml")
    for other in (basin("packed"), load(tmp_path / "basin.toml")):
        for a, b in zip(scene.bodies(), other.bodies(), strict=True):
            np.testing.assert_array_equal(a.position, b.position)
            np.testing.assert_array_equal(a.mass, b.mass)


def test_a_box_keeps_its_lattice() -> None:
    packed = tank().replace({"fluid.water.arrangement": "packed"})
    for a, b in zip(tank().bodies(), packed.bodies(), strict=True):
        np.testing.assert_array_equal(a.position, b.position)


# How the flow starts


def test_water_at_rest_starts_under_its_own_weight() -> None:
    """Its surface is the shape's, to which particles are nearer than half a spacing."""
    scene = basin("packed")
    water = body(scene, "water")
    c0 = scene.sound_speed
    pressure = material.pressure_at(water.density, reference_density=1000.0, sound_speed=c0)
    weight = material.hydrostatic_pressure(
        water.position[:, 1], DEPTH, gravity=GRAVITY, reference_density=1000.0, sound_speed=c0
    )
    np.testing.assert_allclose(pressure, weight, atol=1e-9 * 1000.0 * c0**2)


def start(scene: Scene, time: float) -> tuple[float, float, float]:
    """Kinetic energy at ``time`` over m g H, and how far pressure goes from its start on the way,
    in the first step and at ``time``, over rho g H."""
    sim = kolk.Simulation(scene, precision="f64", threads=1)
    water = body(scene, "water")
    before = sim.bodies["water"].pressure.copy()

    def jump() -> float:
        now = sim.bodies["water"].pressure
        return float(np.abs(now - before).max()) / (1000.0 * GRAVITY * DEPTH)

    sim.advance(time, max_steps=1)
    first = jump()
    sim.advance(time - sim.time)
    energy = 0.5 * float(np.sum(water.mass * np.sum(sim.bodies["water"].velocity ** 2, axis=1)))
    return energy / (float(water.mass.sum()) * GRAVITY * DEPTH), first, jump()


def test_water_over_a_slanted_bottom_stays_quiet() -> None:
    """Nearly as quiet as over a flat bottom, where lattices fit: what is left is the free surface's
    own. A lattice that does not fit is no start at all."""
    flat = basin("lattice").replace(
        {
            "fluid.water.shape": {"box": {"from": [0.0, 0.0], "to": [WIDTH, DEPTH]}},
            "wall": [
                {
                    "name": "basin",
                    "shape": {"tank": {"from": [0.0, 0.0], "to": [WIDTH, 0.9], "open": ["top"]}},
                }
            ],
        }
    )
    even = start(flat, 0.05)
    lattice, packed = start(basin("lattice"), 0.05), start(basin("packed"), 0.05)
    assert packed[0] < 3.0 * even[0]
    assert packed[1] < 1.5 * even[1]
    assert packed[2] < 1.5 * even[2]
    for left, there in zip(packed, lattice, strict=True):
        assert left < there / 20.0
    assert packed[0] < lattice[0] / 1000.0


def test_a_disc_under_pressure_stays_at_rest_in_its_vessel() -> None:
    """Even pressure without gravity: what moves it is the disorder of fluid and wall alone."""
    room = {"disc": {"centre": [0.013, 0.007], "radius": 0.5}}
    around = {"box": {"from": [-0.8, -0.8], "to": [0.83, 0.82]}}
    energy = {}
    for arrangement in ("lattice", "packed"):
        scene = free(DISC, arrangement).replace(
            {
                "fluid.drop.shape": room,
                "fluid.drop.pressure": "5000",
                "fluid.drop.viscosity": {"artificial": 0.02},
                "wall": [{"name": "w", "shape": {"difference": {"of": around, "minus": [room]}}}],
            }
        )
        sim = kolk.Simulation(scene, precision="f64", threads=1)
        sim.advance(0.03)
        energy[arrangement] = float(np.mean(np.sum(sim.bodies["drop"].velocity ** 2, axis=1)))
    # In units of p / rho.
    assert energy["packed"] < 2e-5
    assert energy["packed"] < energy["lattice"] / 1000.0


# What cannot be


def test_particles_that_do_not_settle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packing, "MOST_STEPS", 2)
    with pytest.raises(kolk.SceneError, match=r"fluid\.drop\.arrangement: found \"packed\".*2 st"):
        free(DISC, "packed").bodies()


def test_an_overlap_is_named_as_such() -> None:
    scene = basin("packed")
    points = [[0.0, -0.1], [WIDTH, SLOPE - 0.1], [WIDTH, DEPTH], [0.0, DEPTH]]
    with pytest.raises(kolk.SceneError, match="inside wall 'basin'"):
        scene.replace({"fluid.water.shape": {"polygon": {"points": points}}}).bodies()


def test_own_particles_cannot_be_packed() -> None:
    own: dict[str, Any] = {"position": np.zeros((1, 2)), "arrangement": "packed"}
    with pytest.raises(kolk.SceneError, match="own particles stay where they are"):
        kolk.Fluid.from_arrays(**own)


def test_progress_is_shown_where_it_takes_long_but_not_when_quiet(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from kolk import progress

    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with progress.silence():
        free(DISC, "packed").bodies()
    assert capsys.readouterr().err == ""
    free(DISC, "packed").bodies()
    assert "packing 'drop', 1,257 particles" in capsys.readouterr().err
