"""The energy budget closes: what the motion loses is what the effects say they have taken."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import kolk
from tanks import tank


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


def work_and_books(
    sim: kolk.Simulation, until: float, rows: int, power: Callable[[], float]
) -> tuple[float, float, float]:
    """What moving walls do up to a time by the forces on them, what the budget says that walls hand
    over, and what it does not account for, J. ``power``: that of the fluid on the walls, W."""
    sim.advance(1e-9)
    start, before = budget(sim)
    step, first, work = (until - sim.time) / rows, sim.time, 0.0
    last = power()
    for row in range(1, rows + 1):
        sim.advance_to(first + row * step)
        now = power()
        work -= 0.5 * step * (last + now)
        last = now
    end, taken = budget(sim)
    left = end - start + sum(taken.values()) - sum(before.values())
    return work, before.get("walls", 0.0) - taken["walls"], left


def test_a_piston_does_the_work_that_the_water_gets() -> None:
    piston = {
        "name": "piston",
        "shape": {"box": {"from": [-0.1, 0.0], "to": [0.0, 0.7]}},
        "motion": {"sinus": {"amplitude": [0.05, 0.0], "frequency": 1.0, "phase": -1.5708}},
    }
    basin = {"tank": {"from": [-0.2, 0.0], "to": [1.0, 0.8], "open": ["top"]}}
    water = {
        "name": "water",
        "shape": {"box": {"from": [0.0, 0.0], "to": [1.0, 0.3]}},
        "viscosity": {"artificial": 0.02},
    }
    scene = tank(fluid=[water], wall=[{"name": "tank", "shape": basin}, piston])
    sim = kolk.Simulation(scene, threads=1)

    def power() -> float:
        return float(sim.force("piston")["force"][0] * sim.bodies["piston"].velocity[0, 0])

    work, handed, left = work_and_books(sim, 0.5, 200, power)
    # It takes 0.1 m of the basin's 1 m away: slowly, that would lift the water to 0.3 / 0.9 m.
    assert work > 0.5 * 1000.0 * 9.81 * 0.3**2 * (1.0 / 0.9 - 1.0)
    assert abs(left) < 0.01 * work
    # The paddle alone does work, but pressure also hands energy to and fro along the other walls.
    assert handed == pytest.approx(work, rel=0.06)


def test_a_turning_shaft_does_the_work_that_the_oil_gets() -> None:
    inner, outer, rate = 0.5, 1.0, 1.0

    def disc(radius: float) -> dict[str, object]:
        return {"disc": {"centre": [0.0, 0.0], "radius": radius}}

    def ring(radius: float, hole: float) -> dict[str, object]:
        return {"difference": {"of": disc(radius), "minus": [disc(hole)]}}

    turning = {"rotate": {"centre": [0.0, 0.0], "rate": rate}}
    scene = kolk.Scene(
        name="couette",
        dimension=2,
        spacing=0.05,
        until=1.0,
        fluid=[{"name": "oil", "shape": ring(outer, inner), "viscosity": {"laminar": 0.02}}],
        wall=[
            {"name": "shaft", "shape": disc(inner), "slip": "no", "motion": turning},
            {"name": "housing", "shape": ring(outer + 0.25, outer), "slip": "no"},
        ],
        numerics={"expected_speed": rate * inner},
    )
    sim = kolk.Simulation(scene, threads=1)
    # It starts with a jerk, that no row of forces resolves.
    sim.advance_to(0.5)
    work, handed, left = work_and_books(
        sim, 1.0, 100, lambda: float(sim.force("shaft")["moment"][0]) * rate
    )
    assert work > 0.0
    assert abs(left) < 0.01 * work
    assert handed == pytest.approx(work, rel=0.04)


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
