"""The integrators by name, from a scene to the engine and into what a run says of itself."""

from __future__ import annotations

import numpy as np
import pytest

import kolk
from kolk import cases
from kolk.check import numbers
from kolk.scene.automatic import COURANT
from kolk.study.ladder import full_key, parse_vary
from tanks import tank, vortex

INTEGRATORS = tuple(COURANT)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_each_takes_the_courant_number_that_kolk_says(integrator):
    scene = tank(numerics={"integrator": integrator})
    simulation = kolk.Simulation(scene, precision="f64", threads=1)
    simulation.advance(scene.until, max_steps=1)
    assert simulation.limit == "acoustic"
    # Still water at first: its density, hence the speed of sound, is a little above that at rest.
    wanted = COURANT[integrator] * scene.smoothing_length / scene.sound_speed
    assert simulation.time_step == pytest.approx(wanted, rel=0.05)
    assert numbers.time_step(scene)[0] == pytest.approx(wanted, rel=1e-9)


def test_the_default_is_symplectic_and_bit_equal_to_it():
    states = []
    for numerics in ({}, {"integrator": "auto"}, {"integrator": "symplectic"}):
        simulation = kolk.Simulation(tank(numerics=numerics), threads=1)
        simulation.advance(0.01)
        assert "integrator" not in simulation.memory
        states.append(simulation.bodies["water"].position)
    assert np.array_equal(states[0], states[1])
    assert np.array_equal(states[0], states[2])


def test_a_run_says_which_one_it_used(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    scene = tank(numerics={"integrator": "rk4"}).replace(until=0.01)
    run = kolk.run(scene, "run", quiet=True, threads=1)
    told = {choice["key"]: choice["value"] for choice in run.summary["choices"]}
    assert told["numerics.integrator"] == "rk4"
    assert told["numerics.courant"] == COURANT["rk4"]
    assert run.summary["memory"]["integrator"] > 0


def test_another_name_is_refused_with_those_that_are_allowed():
    with pytest.raises(kolk.SceneError, match=r"numerics\.integrator") as caught:
        tank(numerics={"integrator": "euler"})
    for name in INTEGRATORS:
        assert name in str(caught.value)


def test_a_study_can_vary_it():
    vary = parse_vary(["integrator=rk2,rk4"])
    assert full_key("integrator", vary["integrator"][0]) == "numerics.integrator"
    scene = cases.get("taylor-green").scene.replace({"numerics.integrator": "rk2"})
    assert scene.numerics.integrator == "rk2"


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_vortex_decays_alike_with_all(integrator):
    def energy(scene):
        simulation = kolk.Simulation(scene, precision="mixed", threads=1)
        simulation.advance(0.1)
        return simulation.energy.kinetic

    default = energy(vortex())
    assert energy(vortex(numerics={"integrator": integrator})) == pytest.approx(default, rel=5e-3)
