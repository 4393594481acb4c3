"""The energy budget closes: what the motion loses is what the effects say they have taken."""

from __future__ import annotations

import kolk


def budget(sim: kolk.Simulation) -> tuple[float, dict[str, float]]:
    energy = sim.energy
    return energy.total, dict(energy.dissipated)


def test_a_decaying_vortex_loses_what_viscosity_takes() -> None:
    scene = kolk.load("taylor-green").replace(spacing=0.02)
    sim = kolk.Simulation(scene, precision="f64", threads=1)
    sim.advance(1e-9)
    start, _ = budget(sim)
    sim.advance(0.5)
    end, taken = budget(sim)
    assert taken["laminar viscosity"] > 0.8 * (start - end) > 0.0
    assert abs(start - end - sum(taken.values())) < 0.02 * (start - end)


def test_what_is_absent_takes_nothing() -> None:
    scene = kolk.load("taylor-green").replace(spacing=0.05)
    sim = kolk.Simulation(scene, threads=1)
    sim.advance(0.05)
    assert not {"artificial viscosity", "acoustic damper", "walls"} & sim.energy.dissipated.keys()


def test_restart_goes_on_with_the_same_budget() -> None:
    scene = kolk.load("dam-break").replace(spacing=0.02)
    straight = kolk.Simulation(scene, threads=1)
    straight.advance(0.1)
    broken = kolk.Simulation(scene, threads=1)
    broken.restore(straight.state())
    straight.advance(0.1)
    broken.advance(0.1)
    assert straight.energy == broken.energy
