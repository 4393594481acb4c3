"""The energy budget closes: what the motion loses is what the effects say they have taken."""

from __future__ import annotations

import pytest

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


def lost_and_taken(sim: kolk.Simulation, until: float) -> tuple[float, float]:
    sim.advance(1e-9)
    start, before = budget(sim)
    sim.advance_to(until)
    end, taken = budget(sim)
    return start - end, sum(taken.values()) - sum(before.values())


@pytest.mark.parametrize("precision", ["mixed", "f64"])
def test_a_collapse_loses_what_its_effects_take(precision: str) -> None:
    # With shifting, density that follows it, walls, contacts, diffusion, damper and viscosity. The
    # powers are sampled, and those of walls flicker: hence the bound.
    scene = kolk.load("dam-break").replace(spacing=0.01)
    lost, taken = lost_and_taken(kolk.Simulation(scene, precision=precision, threads=1), 0.7)
    assert lost > 0.0
    assert taken == pytest.approx(lost, rel=0.1)


def test_a_liquid_with_a_yield_stress_loses_what_it_takes() -> None:
    scene = kolk.load("mud").replace(spacing=0.01)
    sim = kolk.Simulation(scene, threads=1)
    lost, taken = lost_and_taken(sim, 0.2)
    assert sim.energy.dissipated["Herschel-Bulkley"] > 0.5 * lost > 0.0
    assert taken == pytest.approx(lost, rel=0.02)


def test_still_water_keeps_its_books() -> None:
    scene = kolk.load("still-water").replace(spacing=0.04)
    sim = kolk.Simulation(scene, threads=1)
    lost, taken = lost_and_taken(sim, 2.0)
    # Settling moves little: what is not accounted for is a small share of what moves.
    moved = sum(abs(e) for e in sim.energy.dissipated.values())
    assert abs(lost - taken) < 0.05 * moved


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
