"""What a scene leaves to kolk: one resolution for the engine, the summary and the user."""

from __future__ import annotations

import json

import numpy as np
import pytest

import kolk
from kolk import cases
from kolk.cli.closing import closing
from kolk.scene import automatic
from kolk.scene.automatic import CHOICES, choices
from tanks import tank, vortex

GIVEN = {
    "kernel": "cubic",
    "smoothing_ratio": 1.5,
    "numerics": {
        "density_diffusion": "fourtakas",
        "scheme": "delta-sph",
        "shifting": "none",
        "tensile_control": "none",
        "acoustic_damper": 0.1,
        "free_surface": True,
        "wall": "dynamic",
        "integrator": "rk4",
        "courant": 0.3,
    },
}


def test_what_the_scene_says_is_not_chosen():
    scene = tank(**GIVEN).replace({"fluid.water.sound_speed": 40.0})
    found = {choice.key: choice for choice in choices(scene)}
    told = {
        "kernel": "cubic",
        "smoothing_ratio": 1.5,
        "fluid.water.sound_speed": 40.0,
        **{f"numerics.{key}": value for key, value in GIVEN["numerics"].items()},
    }
    for key, value in told.items():
        assert found[key].value == value
        assert not found[key].automatic
        assert found[key].reason == ""
    assert [c.key for c in found.values() if c.automatic] == ["walls may pull"]


@pytest.mark.parametrize("scene", [tank(), vortex()], ids=["tank", "vortex"])
def test_every_choice_has_a_reason(scene):
    for choice in choices(scene):
        assert choice.automatic
        assert len(choice.reason) > 10
        assert choice.reason in str(choice)
        assert choice.key in str(choice)


def test_the_engine_is_told_what_was_chosen():
    for scene in (tank(), vortex(), tank(**GIVEN)):
        config = json.loads(scene.engine_config())
        assert config["kernel"] == scene.kernel == automatic.kernel(scene).value
        diffusion = automatic.density_diffusion(scene).value
        assert config["density_diffusion"]["form"] == diffusion
        shifting = automatic.shifting(scene).value
        if shifting == "none":
            assert config["shifting"] is None
        else:
            surface = automatic.free_surface(scene).value
            every = scene.numerics.shifting_interval
            assert config["shifting"] == {
                "form": shifting,
                "free_surface": surface,
                "every": every,
            }
        assert config["acoustic_damper"] == (automatic.acoustic_damper(scene).value or None)
        form = automatic.laminar_form(scene)
        assert (form is None) == (config["laminar_viscosity"] is None)
        if form is not None:
            assert config["laminar_viscosity"]["form"] == form.value
        wall, suction = automatic.wall(scene), automatic.suction(scene)
        assert (wall is None) == (config["wall"] is None)
        if wall is not None and suction is not None:
            assert config["wall"]["method"] == wall.value
            assert config["wall"]["suction"] == suction.value
        assert config["sound_speed"] == automatic.sound_speed(scene).value


def test_free_surface_is_seen_for_what_it_is():
    assert automatic.free_surface(tank()).value is True
    assert "gravity" in automatic.free_surface(tank()).reason
    closed = tank(gravity=None, numerics={"expected_speed": 1.0})
    assert automatic.free_surface(closed).value is False
    assert "walls" in automatic.free_surface(closed).reason
    assert automatic.free_surface(vortex()).value is False
    assert "periods" in automatic.free_surface(vortex()).reason
    drop = closed.replace(wall=None)
    assert automatic.free_surface(drop).value is True
    # Gravity along a period drives a flow and makes no top.
    driven = vortex(gravity=[1.0, 0.0])
    assert automatic.free_surface(driven).value is False


def test_the_sound_speed_says_what_it_came_from():
    falling = automatic.sound_speed(tank())
    assert "H = 0.3 m" in falling.reason
    told = automatic.sound_speed(tank(numerics={"expected_speed": 50.0}))
    assert told.value == pytest.approx(500.0)
    assert "numerics.expected_speed" in told.reason
    moving = automatic.sound_speed(vortex())
    assert "starts" in moving.reason


def test_tensile_control_is_for_fluid_that_starts_under_tension():
    def stretched(**changes):
        # Half a per mille below the density at rest: a tension of 5e-4 rho0 c0^2.
        at = (np.arange(10) + 0.5) * 0.1
        position = np.stack([g.ravel() for g in np.meshgrid(at, at)], axis=1)
        fluid = kolk.Fluid.from_arrays(
            position=position,
            density=np.full(len(position), 999.5),
            reference_density=1000.0,
            sound_speed=10.0,
        )
        both = {"x": [0.0, 1.0], "y": [0.0, 1.0]}
        return kolk.Scene(
            name="stretched",
            dimension=2,
            spacing=0.1,
            until=1.0,
            fluid=[fluid],
            **{"periodic": both, **changes},
        )

    asked = automatic.tensile_control(stretched())
    assert asked.value == "sun"
    assert "49.9 Pa" in asked.reason
    config = json.loads(stretched().engine_config())
    assert config["tensile_control"] == {"form": "sun", "free_surface": False}
    # A flow of 1 m/s explains that much, a free surface gives way, and who says so is believed.
    for changes in (
        {"numerics": {"expected_speed": 1.0}},
        {"periodic": None},
        {"numerics": {"tensile_control": "none"}},
    ):
        scene = stretched(**changes)
        assert automatic.tensile_control(scene).value == "none"
        assert json.loads(scene.engine_config())["tensile_control"] is None
    for scene in (tank(), vortex()):
        assert automatic.tensile_control(scene).value == "none"


def test_a_scheme_brings_its_diffusion():
    found = {
        scheme: json.loads(vortex(numerics={"scheme": scheme}).engine_config())
        for scheme in ("delta-sph", "edac", "riemann")
    }
    assert found["delta-sph"]["density_diffusion"] == {"form": "molteni", "delta": 0.1}
    assert found["edac"]["density_diffusion"] == {"form": "molteni", "delta": 0.0625}
    heavy = json.loads(tank(numerics={"scheme": "edac"}).engine_config())
    assert heavy["density_diffusion"] == {"form": "fourtakas", "delta": 0.0625}
    assert found["riemann"]["density_diffusion"] == {"form": "riemann", "delta": 1.0}
    assert [c["riemann_viscosity"] for c in found.values()] == [False, False, True]
    with pytest.raises(kolk.SceneError, match="diffusion of its own"):
        vortex(numerics={"scheme": "edac", "density_diffusion": "antuono"})
    with pytest.raises(kolk.SceneError, match="dissipation of its own"):
        vortex(numerics={"scheme": "riemann"}).replace({"fluid.fluid.viscosity.artificial": 0.1})
    with pytest.raises(kolk.SceneError, match="walls of particles"):
        tank(numerics={"tensile_control": "sun", "wall": "penalty"})
    with pytest.raises(kolk.SceneError, match=r"transport-velocity.*free surface"):
        tank(numerics={"shifting": "transport-velocity"})
    config = json.loads(vortex(numerics={"shifting": "transport-velocity"}).engine_config())
    assert config["shifting"] == {"form": "transport-velocity", "free_surface": False, "every": 1}


def test_every_case_can_say_what_was_chosen():
    for name in cases.names():
        scene = cases.get(name).scene
        for choose in CHOICES:
            choice = choose(scene)
            assert choice is None or str(choice)


def test_the_summary_and_the_last_words_of_a_run_name_the_choices(tank, monkeypatch):
    scene = kolk.load(tank)
    run = kolk.run(scene, "runs/tank", quiet=True, threads=1)
    told = {choice["key"]: choice for choice in run.summary["choices"]}
    assert told["numerics.shifting"]["value"] == "sun"
    assert told["numerics.shifting"]["automatic"] is True
    words = closing(run)
    for choice in choices(scene):
        assert str(choice) in words


def test_the_kernel_follows_the_free_surface():
    assert tank().kernel == "wendland-c2"
    assert vortex().kernel == "wendland-c4"
    packed = tank().replace({"numerics.free_surface": False, "fluid.water.arrangement": "packed"})
    assert packed.kernel == "wendland-c2"
    assert cases.get("poiseuille").scene.kernel == "wendland-c4"
    assert cases.get("herschel-bulkley-channel").scene.kernel == "wendland-c2"
    # Left open, it stays so: a surface that is added later changes it.
    assert vortex().replace({"numerics.free_surface": True}).kernel == "wendland-c2"
    assert vortex(kernel="quintic").replace({"numerics.free_surface": True}).kernel == "quintic"
    assert "kernel" not in vortex().model_fields_set


def test_shifts_take_the_fields_along_only_between_walls_on_all_sides():
    closed = tank().replace({"numerics.free_surface": False})
    between_plates = cases.get("poiseuille").scene
    forms = [
        automatic.shifting(scene).value for scene in (closed, between_plates, vortex(), tank())
    ]
    assert forms == ["consistent", "sun", "sun", "sun"]
