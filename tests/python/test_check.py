"""`kolk check`: what can be seen before a run."""

from __future__ import annotations

import re

import numpy as np
import pytest

from kolk.check import check
from kolk.check.walls import find_gap
from kolk.scene import Scene
from tanks import tank

SPACING = 0.02


def walls(gap: float) -> list[dict[str, object]]:
    """A floor and two sides, the right one a gap (m) above the floor."""
    corners = {
        "floor": ([-0.2, -0.2], [1.0, 0.0]),
        "left": ([-0.2, 0.0], [0.0, 1.0]),
        "right": ([0.8, gap], [1.0, 1.0]),
    }
    return [
        {"name": name, "shape": {"box": {"from": low, "to": high}}}
        for name, (low, high) in corners.items()
    ]


def found(scene: Scene, pattern: str) -> bool:
    return any(re.search(pattern, warning) for warning in check(scene).warnings)


def calm(**changes: object) -> Scene:
    """A tank with nothing to warn of."""
    return tank(**changes).replace({"fluid.water.viscosity.artificial": 0.02})


def test_nothing_is_told_of_a_good_scene() -> None:
    assert check(calm()).warnings == ()
    assert check(tank(numerics={"scheme": "riemann"})).warnings == ()
    assert check(calm(wall=walls(0.0))).warnings == ()


def test_what_kolk_chose_is_told_with_its_reason() -> None:
    words = str(check(calm(numerics={"shifting": "none"})))
    chosen = words.partition("chosen by kolk:\n")[2]
    assert re.search(r"numerics\.density_diffusion = antuono: keeps pressure free of noise", chosen)
    assert re.search(r"fluid\.water\.sound_speed = [\d.]+: ten times", chosen)
    # What the scene says itself is no choice of kolk's.
    assert "numerics.shifting" not in chosen


@pytest.mark.parametrize("spacings", [1.0, 1.5, 3.0, 5.0])
def test_a_gap_is_found_with_its_place_and_width(spacings: float) -> None:
    gap = spacings * SPACING
    scene = calm(wall=walls(gap))
    bodies = scene.bodies()
    wall = np.concatenate([b.position for b in bodies if b.kind == "wall"])
    way = find_gap(scene, wall, [b for b in bodies if b.kind == "fluid"])
    assert way is not None
    where, width = way
    # Lattices leave their own roughness of up to half a spacing.
    assert abs(width - gap) < 0.5 * SPACING
    assert 0.8 < where[0] < 1.0 and 0.0 < where[1] < gap
    assert found(scene, "can flow out")


def test_a_gap_above_the_water_is_no_gap() -> None:
    scene = calm(wall=walls(0.0))
    high = scene.replace({"wall.right.shape.box.to": [1.0, 0.32]})
    assert not found(high, "can flow out")
    assert found(scene.replace({"wall.right.shape.box.to": [1.0, 0.2]}), "can flow out")


def test_a_side_that_is_open_lets_the_water_out() -> None:
    scene = calm().replace({"wall.tank.shape.tank.open": ["top", "right"]})
    assert found(scene, "can flow out")


def test_a_period_is_no_way_out() -> None:
    scene = calm().replace({"wall.tank.shape.tank.open": ["top", "right", "left"]})
    assert not found(scene.replace({"periodic.x": [0.0, 1.0]}), "can flow out")


def test_fluid_that_touches_nothing() -> None:
    scene = calm(wall=walls(0.0))
    lifted = scene.replace(
        {"fluid.water.shape.box.from": [0.2, 0.3], "fluid.water.shape.box.to": [0.6, 0.6]}
    )
    assert found(lifted, "touches no wall")
    assert not found(scene, "touches no wall")


def test_a_thin_part_of_a_thick_fluid() -> None:
    corners = [[0.0, 0.0], [0.7, 0.0], [0.7, 0.04], [0.2, 0.04], [0.2, 0.5], [0.0, 0.5]]
    scene = calm().replace({"fluid.water.shape": {"polygon": {"points": corners}}})
    assert found(scene, "less than 4 particles thick")
    assert not found(scene.replace(spacing=0.005), "less than 4 particles thick")


def wedge(numerics: dict[str, object], **fluid: object) -> Scene:
    """Water around a wedge whose faces, at 45 degrees, run through points of the lattice."""
    solid = {"polygon": {"points": [[0.25, 0.0], [0.75, 0.0], [0.5, 0.25]]}}
    box = {"box": {"from": [0.0, 0.0], "to": [1.0, 0.5]}}
    shape = {"difference": {"of": box, "minus": [solid]}}
    water = {"name": "water", "shape": shape, "viscosity": {"artificial": 0.02}, **fluid}
    basin = {"tank": {"from": [0.0, 0.0], "to": [1.0, 0.6], "open": ["top"]}}
    return Scene(
        name="wedge",
        dimension=2,
        spacing=0.05,
        until=1.0,
        gravity=[0.0, -9.81],
        fluid=[water],
        wall=[{"name": "tank", "shape": basin}, {"name": "wedge", "shape": solid}],
        numerics=numerics,
    )


def test_a_point_of_the_lattice_on_a_surface_is_the_wall_s() -> None:
    scene = wedge({})
    water, solid = (b.position for b in scene.filling.bodies if b.name in ("water", "wedge"))
    mirrored = np.stack([1.0 - water[:, 0], water[:, 1]], axis=1)
    assert len(np.unique(np.round(np.concatenate([water, mirrored]), 9), axis=0)) == len(water)
    between = np.linalg.norm(water[:, None] - solid[None], axis=2).min()
    assert between == pytest.approx(scene.spacing)
    assert check(scene).warnings == ()


def test_walls_of_facets_beside_a_lattice_that_does_not_fit_them() -> None:
    (warning,) = check(wedge({"wall": "semi-analytical"})).warnings
    assert "'wedge'" in warning and '"packed"' in warning
    assert check(wedge({"wall": "semi-analytical"}, arrangement="packed")).warnings == ()


def test_particles_on_top_of_each_other() -> None:
    import kolk

    position = np.stack([g.ravel() for g in np.meshgrid(*[0.01 + 0.02 * np.arange(10)] * 2)], 1)
    doubled = np.concatenate([position, position[:3] + 1e-3])
    water = kolk.Fluid.from_arrays(position=doubled, name="water", density=1000.0)
    scene = Scene(
        name="own", dimension=2, spacing=0.02, until=1.0, fluid=[water],
        numerics={"expected_speed": 1.0},
    )  # fmt: skip
    assert found(scene, "6 particles are nearer than half a spacing.*'water'")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"numerics.time_step": 0.01}, "longer than sound allows"),
        ({"numerics.courant": 1.4}, "courant of 1.4 is above"),
        ({"fluid.water.sound_speed": 1.0}, "sound speed of 1 m/s is below"),
        ({"fluid.water.sound_speed": 1e5}, "far above"),
        ({"fluid.water.sound_speed": 1e7}, "steps.*set by sound.*more than a run can take"),
        ({"fluid.water.viscosity.laminar": 1e5}, "set by viscosity.*goes with its square"),
        ({"until": 1e7}, "end it earlier"),
    ],
)
def test_numbers_that_lead_nowhere(changes: dict[str, object], message: str) -> None:
    assert found(calm().replace(changes), message)
