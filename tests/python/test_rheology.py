"""Liquids whose viscosity depends on the flow, as scenes have them."""

from __future__ import annotations

import numpy as np
import pytest

import kolk
from kolk import cases, references
from kolk.compare.profiles import compare_slump, compare_yielding_channel
from kolk.errors import SceneError
from kolk.scene import Scene, loads
from tanks import tank


@pytest.mark.parametrize(
    ("viscosity", "message"),
    [
        ({}, "is empty"),
        ({"laminar": 1e-3, "herschel_bulkley": {"consistency": 1.0}}, "beside 'laminar'"),
        ({"turbulence": 0.1, "herschel_bulkley": {"consistency": 1.0}}, "beside 'turbulence'"),
        ({"herschel_bulkley": {"yield_stress": 1.0}}, "consistency: is missing"),
        ({"herschel_bulkley": {"consistency": 1.0, "index": 0.0}}, "index: found"),
        ({"turbulence": 0.0}, "greater than 0"),
    ],
)
def test_a_wrong_viscosity_is_named(viscosity: dict[str, object], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        tank().replace({"fluid.water.viscosity": viscosity})


def test_a_scene_file_keeps_a_mud() -> None:
    mud = {"herschel_bulkley": {"yield_stress": 30.0, "consistency": 2.0, "index": 0.7}}
    scene = tank().replace({"fluid.water.viscosity": mud})
    assert loads(scene.to_toml()).engine_config() == scene.engine_config()


def test_the_exact_profile_has_the_law_s_stress() -> None:
    flow = {"width": 0.1, "density": 1000.0, "acceleration": 0.4, "yield_stress": 5.0}
    y = np.linspace(0.0, 0.05, 2001)
    u = references.herschel_bulkley(y, **flow, consistency=2.0, index=0.8)
    rate = np.maximum(np.gradient(u, y), 0.0)
    stress = 1000.0 * 0.4 * (0.05 - y)
    sheared = stress > 5.5
    np.testing.assert_allclose((5.0 + 2.0 * rate**0.8)[sheared], stress[sheared], rtol=2e-3)
    assert np.ptp(u[stress < 5.0]) == 0.0, "the plug is rigid"
    newton = references.herschel_bulkley(
        y, **(flow | {"yield_stress": 0.0}), consistency=2.0, index=1.0
    )
    parabola = references.poiseuille(y, np.inf, width=0.1, viscosity=2e-3, acceleration=0.4)
    np.testing.assert_allclose(newton, parabola, atol=1e-5 * parabola.max())


@pytest.mark.parametrize("index", [1.0, 0.8])
def test_the_profile_of_a_channel(index: float) -> None:
    """Bingham's and a thinning liquid keep it for 1 s, within 2 % of the plug's velocity."""
    flow = dict(cases.get("herschel-bulkley-channel").comparisons[0].parameters) | {"index": index}
    scene = cases.get("herschel-bulkley-channel").scene.replace(
        {
            "fluid.paste.viscosity.herschel_bulkley.index": index,
            "fluid.paste.velocity": lambda x: np.stack(
                [references.herschel_bulkley(x[:, 1], **flow), 0.0 * x[:, 0]], axis=1
            ),
        }
    )
    simulation = kolk.Simulation(scene)
    simulation.advance_to(1.0)
    paste = simulation.bodies["paste"]
    exact = references.herschel_bulkley(paste.position[:, 1], **flow)
    error = np.abs(paste.velocity[:, 0] - exact)
    assert np.sqrt(np.mean(error**2)) < 0.02 * exact.max()
    drag = simulation.force("plates")["force"][0]
    assert drag == pytest.approx(0.1 * 0.06 * flow["density"] * flow["acceleration"], rel=0.05)


def test_mud_under_its_yield_stress_stays_where_it_is() -> None:
    """A layer on a slope of 0.05 whose floor bears less than the yield stress creeps."""

    def speed(viscosity: dict[str, object]) -> float:
        scene = Scene(
            name="slope",
            dimension=2,
            spacing=0.005,
            gravity=[9.81 * 0.05, -9.81],
            until=1.0,
            periodic={"x": [0.0, 0.05]},
            fluid=[
                {
                    "name": "mud",
                    "shape": {"box": {"from": [0.0, 0.0], "to": [0.05, 0.05]}},
                    "viscosity": viscosity,
                }
            ],
            wall=[
                {
                    "name": "floor",
                    "shape": {"box": {"from": [0.0, -0.05], "to": [0.05, 0.0]}},
                    "slip": "no",
                }
            ],
        )
        simulation = kolk.Simulation(scene)
        simulation.advance_to(0.3)
        return float(np.mean(simulation.bodies["mud"].velocity[:, 0]))

    # The floor bears rho g sin h = 24.5 Pa.
    mud = {"herschel_bulkley": {"yield_stress": 40.0, "consistency": 1.0, "max_viscosity": 200.0}}
    creep = 9.81 * 0.05 * 1000.0 * 0.05**2 / (3.0 * 200.0)
    assert speed(mud) == pytest.approx(creep, rel=0.1), "as a liquid of the bounding viscosity"
    assert speed({"laminar": 1e-4}) > 50.0 * creep


class Frame:
    """A frame with a fluid."""

    time = 1.0

    def __init__(self, position: np.ndarray, velocity: np.ndarray) -> None:
        self.position, self._velocity = position, velocity

    def rows(self, kind: str) -> np.ndarray:
        return np.full(len(self.position), kind == "fluid")

    def field(self, name: str) -> np.ndarray:
        return self._velocity


def test_comparisons_of_yielding_liquids() -> None:
    flow = dict(cases.get("herschel-bulkley-channel").comparisons[0].parameters)
    position = np.stack([np.zeros(50), np.linspace(0.0, 0.1, 50)], axis=1)
    exact = references.herschel_bulkley(position[:, 1], **flow)
    velocity = np.stack([1.01 * exact, 0.0 * exact], axis=1)
    (found,) = compare_yielding_channel(Frame(position, velocity), **flow)
    assert 0.0 < found.value < 0.011
    mud = dict(cases.get("mud").comparisons[0].parameters)
    reach = references.slump(**mud)
    (run,) = compare_slump(Frame(np.array([[0.1, 0.0], [1.1 * reach, 0.0]]), velocity), 0.0, **mud)
    assert run.details["relative_error"] == pytest.approx(0.1)
    # The slope's shape holds the whole heap: its area is that of the start.
    x = np.linspace(0.0, reach, 20001)
    height = np.sqrt(2.0 * mud["yield_stress"] * (reach - x) / (mud["density"] * mud["gravity"]))
    assert reach * np.mean(height) == pytest.approx(mud["volume"], rel=1e-4)
