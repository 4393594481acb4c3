"""`kolk explain`: every effect accounted for, costs that add up, advice that mends."""

from __future__ import annotations

import json
import random
import statistics

import pytest

from kolk import cases
from kolk.cli.gate import main
from kolk.explain import explain
from kolk.explain.advice import RULES, advise, diffusion_length, equivalent_viscosity
from kolk.explain.catalogue import BY_NAME, CATALOGUE
from kolk.explain.pilot import MOST, Interval, coarsened
from kolk.scene.engine import engine_config
from kolk.simulation import Simulation, make_engine
from tanks import tank, vortex

FULL = tank(numerics={"acoustic_damper": 0.3}).replace(
    {"fluid.water.viscosity": {"artificial": 0.02, "laminar": 1e-3}}
)
"""A scene with many effects."""


def on(effects) -> set[str]:
    return {effect["name"] for effect in effects if effect["on"]}


def test_every_effect_of_the_engine_is_in_the_catalogue():
    names = [effect["name"] for effect in Simulation(tank(), threads=1).effects]
    assert set(names) <= set(BY_NAME)
    assert len(names) == len(set(names))


def test_effects_say_what_they_are_and_why():
    for scene in (tank(), vortex(), FULL):
        for effect in Simulation(scene, threads=1).effects:
            assert effect["what"]
            assert effect["where"]
            assert effect["why"].startswith("left out") == (not effect["on"]), effect


def test_why_names_the_key_that_asked():
    why = {e["name"]: e["why"] for e in Simulation(FULL, threads=1).effects}
    assert "fluid.water.viscosity.artificial = 0.02" in why["artificial viscosity"]
    assert "fluid.water.viscosity.laminar = 0.001" in why["laminar viscosity"]
    assert "gravity = [0.0, -9.81]" in why["gravity"]
    assert "numerics.acoustic_damper = 0.3" in why["acoustic damper"]
    assert "chosen (antuono)" in why["density diffusion"]


@pytest.mark.parametrize("entry", [e for e in CATALOGUE if e.without], ids=lambda e: e.name)
def test_taking_an_effect_away_takes_that_one_away(entry):
    config = engine_config(FULL)
    assert entry.without is not None
    bodies = FULL.bodies()
    before = on(make_engine(config, bodies, "mixed", 1).effects())
    if entry.name not in before:
        pytest.skip("not in this scene")
    reduced = config | {k: v for k, v in entry.without.items() if k in config}
    kept = [b for b in bodies if b.kind == "fluid" or not entry.walls]
    after = on(make_engine(reduced, kept, "mixed", 1).effects())
    assert before - after == {entry.name}
    assert after <= before


BARE = tank(numerics={"density_diffusion": "none", "shifting": "none", "acoustic_damper": 0.0})
"""A scene without an effect that could be left out, but for gravity and walls."""

CALLED_FOR = {
    "artificial viscosity": {"fluid.water.viscosity": {"artificial": 0.1}},
    "laminar viscosity": {"fluid.water.viscosity": {"laminar": 0.01}},
    "acoustic damper": {"numerics.acoustic_damper": 0.3},
    "turbulence": {"fluid.water.viscosity": {"turbulence": 0.12}},
    "Herschel-Bulkley": {
        "fluid.water.viscosity": {"herschel_bulkley": {"yield_stress": 1.0, "consistency": 1.0}}
    },
    "density diffusion": {"numerics.density_diffusion": "antuono"},
    "particle shifting": {"numerics.shifting": "sun"},
    "tensile control": {"numerics.tensile_control": "sun"},
    "linear drag": {"fluid.water.drag": 2.0},
    "moving walls": {"wall.tank.motion": {"translate": {"velocity": [0.1, 0.0]}}},
}
"""What calls for an effect."""


def test_an_effect_that_is_off_holds_no_byte():
    memory = Simulation(BARE, threads=1).memory
    # Acceleration and rate of density are D + 1 columns of pair precision; velocity, volume,
    # pressure and condensation D + 3: no other column is there.
    assert memory["fluid pair columns"] / memory["fluid rates"] == (2 + 3) / (2 + 1)
    assert not {"stages", "integrator"} & memory.keys()


@pytest.mark.parametrize("name", CALLED_FOR)
def test_an_effect_holds_what_it_says(name):
    without, having = (
        Simulation(scene, threads=1) for scene in (BARE, BARE.replace(CALLED_FOR[name]))
    )
    effects = {e["name"]: e for e in having.effects}
    assert on(having.effects) - on(without.effects) == {name}
    held = sum(having.memory.values()) - sum(without.memory.values())
    said = effects[name]["bytes_per_particle"]
    assert held >= said * having.particles["wall" if name == "moving walls" else "fluid"]
    assert (held > 0) == (said > 0)


def test_parts_add_up_to_the_whole():
    found = explain(FULL, seconds=3.0)
    assert found.pilot is not None
    whole = found.pilot.whole
    noise = (whole.high - whole.low) / whole.value
    assert abs(found.pilot.sum_over_whole - 1.0) < 0.1 + noise
    names = {effect.name for effect in found.effects if effect.cost is not None}
    assert {"pressure", "artificial viscosity", "density diffusion", "walls"} <= names
    for effect in found.effects:
        assert effect.on or effect.cost is None
        if effect.cost is not None:
            interval = effect.cost.nanoseconds
            assert interval.low <= interval.value <= interval.high


def test_an_effect_that_shortens_steps_is_charged_for_it():
    # The viscous limit of this one is far below the acoustic one.
    thick = vortex().replace({"fluid.fluid.viscosity.laminar": 2.0})
    found = explain(thick, seconds=0.0)
    cost = {e.name: e.cost for e in found.effects}["laminar viscosity"]
    assert cost is not None
    assert found.limit == "viscous"
    assert cost.longer_steps > 2.0


@pytest.mark.parametrize("name", cases.names())
def test_every_case_is_explained(name, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit) as ended:
        main(["explain", name, "--seconds", "0"])
    assert ended.value.code == 0
    printed = capsys.readouterr().out
    assert "sum of the parts" in printed
    assert "whole step" in printed
    assert "…" not in printed
    for effect in CATALOGUE[:2]:
        assert effect.name in printed


def test_the_command_prints_json(capsys):
    with pytest.raises(SystemExit):
        main(["explain", "still-water", "--no-measure", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert found["pilot"] is None
    assert {e["name"] for e in found["effects"]} >= {"pressure", "gravity", "walls"}
    assert any(c["automatic"] and c["reason"] for c in found["choices"])


def test_a_large_scene_is_piloted_at_a_coarser_spacing():
    scene = cases.get("dam-break").scene.replace(spacing=0.002)
    assert sum(len(b) for b in scene.bodies()) > MOST
    pilot = coarsened(scene)
    assert 0.5 * MOST < sum(len(b) for b in pilot.bodies()) < 1.5 * MOST
    assert coarsened(tank()) == tank()


FAULTS = {
    "laminar viscosity": FULL.replace(
        {"fluid.water.viscosity": {"artificial": 0.02, "laminar": 1e-9}}
    ),
    "laminar viscosity alone": tank().replace({"fluid.water.viscosity": {"laminar": 1e-9}}),
    "laminar viscosity beside turbulence": tank().replace(
        {"fluid.water.viscosity": {"laminar": 1e-9, "turbulence": 0.12}}
    ),
    "laminar viscosity swamped": vortex().replace(
        {"fluid.fluid.viscosity": {"laminar": 1e-3, "artificial": 0.5}}
    ),
    "artificial viscosity": vortex().replace(
        {"fluid.fluid.viscosity": {"laminar": 1e-2, "artificial": 0.02}}
    ),
    "artificial viscosity, quadratic": FULL.replace({"fluid.water.viscosity.beta": 0.1}),
    "artificial viscosity, missing": tank(),
    "density diffusion": FULL.replace({"numerics.density_diffusion": "none"}),
    "density diffusion that lifts": FULL.replace({"numerics.density_diffusion": "molteni"}),
    "pressure under a surface": FULL.replace({"numerics.background_pressure": 1000.0}),
    "pressure beside shifting": vortex().replace({"numerics.background_pressure": 10.0}),
    "particle shifting": vortex().replace({"numerics.shifting": "none"}),
    "acoustic damper": FULL.replace({"numerics.acoustic_damper": 0.0}),
    "pressure, too stiff": FULL.replace({"fluid.water.sound_speed": 100.0}),
    "walls": FULL.replace({"wall.tank.slip": "no", "fluid.water.viscosity": {"artificial": 0.02}}),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_advice_mends_what_it_names(fault):
    scene = FAULTS[fault]
    found = advise(scene)
    assert len(found) == 1, [a.text for a in found]
    (advice,) = found
    assert advice.effect == fault.split(",")[0] or fault.startswith(advice.effect)
    assert advice.effect in BY_NAME
    assert advice.setting
    mended = advise(scene.replace(advice.changes))
    assert advice.text not in [a.text for a in mended]


def test_leaving_out_one_viscosity_keeps_the_others():
    (advice,) = advise(FAULTS["laminar viscosity beside turbulence"])
    assert advice.changes == {"fluid.water.viscosity.laminar": None}


def test_a_scene_in_order_gets_no_advice():
    assert advise(FULL) == ()
    assert advise(vortex()) == ()
    # This scheme brings a dissipation of its own.
    assert advise(tank(numerics={"scheme": "riemann"})) == ()


def test_every_rule_has_a_fault_that_it_finds():
    caught = {rule.__name__ for rule in RULES for scene in FAULTS.values() if rule(scene)}
    assert caught == {rule.__name__ for rule in RULES}


def test_equivalent_viscosity_and_diffusion_length_are_those_of_the_books():
    # Monaghan 2005: alpha h c / 8 in two dimensions.
    expected = 0.02 * FULL.smoothing_length * FULL.sound_speed / 8.0
    assert equivalent_viscosity(FULL) == pytest.approx(expected)
    # Half a millimetre in a sixteenth of a second in water.
    assert diffusion_length(1e-6, 0.0625) == pytest.approx(5e-4)


def test_intervals_hold_the_median_as_often_as_they_say():
    chance = random.Random(3)
    for n in (9, 15, 45):
        hits = 0
        for _ in range(1000):
            # Skewed, as times are: the median of an exponential distribution is ln 2.
            interval = Interval.of([chance.expovariate(1.0) for _ in range(n)])
            hits += interval.low <= 0.6931471805599453 <= interval.high
        # 95 % less three standard deviations of such a count.
        assert hits > 929
    few = [3.0, 1.0, 2.0]
    assert Interval.of(few) == Interval(statistics.median(few), 1.0, 3.0)
