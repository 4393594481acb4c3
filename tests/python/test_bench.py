"""`kolk bench`: figures that agree with each other and with the flow that was measured."""

from __future__ import annotations

import json

import numpy as np
import pytest

from kolk import _core
from kolk.bench import measure
from kolk.bench.measure import mean_neighbours
from kolk.bench.settled import FLOWS, scene
from kolk.cli.gate import main
from kolk.errors import KolkError
from kolk.simulation import Simulation


@pytest.fixture(scope="module")
def found():
    return measure(seconds=3.0, threads=1)


def test_every_flow_is_measured_in_both_precisions(found):
    measured = {(f.flow, f.precision) for f in found.flows}
    assert measured == {(flow.name, p) for flow in FLOWS for p in ("f64", "mixed")}
    assert len(found.flows) == len(measured)
    assert found.threads == 1


def test_rates_agree_with_times_by_phase(found):
    for f in found.flows:
        assert f.particle_steps.low <= f.particle_steps.median <= f.particle_steps.high
        # The phases are parts of the same windows: they cannot say more than the slowest of them,
        # and what they leave out is the call itself.
        total = sum(f.phases.values())
        assert total <= 1.01e9 / f.particle_steps.low
        assert total >= 0.8e9 / f.particle_steps.high
        assert f.pairs == pytest.approx(f.particle_steps.median * f.neighbours)
        assert f.pairs_in_sweeps > f.pairs * 0.8
        assert 0.0 < f.share_of_peak < 1.0


def test_neighbours_are_those_of_the_flow_named(found):
    for f in found.flows:
        named = int(f.flow.split(", ")[1].split()[0])
        # Next to the free surface particles have fewer.
        assert 0.85 * named < f.neighbours <= 1.03 * named


def test_mean_neighbours_of_a_lattice_are_counted_by_hand():
    flow = FLOWS[-1]
    lattice = scene(flow, 800).replace({"fluid.water.jitter": 0.0})
    simulation = Simulation(lattice, precision="f64", threads=1)
    bodies = simulation.bodies
    everything = np.concatenate([bodies["water"].position, bodies["tank"].position])
    reach = lattice.support
    expected = [
        np.count_nonzero(np.linalg.norm(everything - x, axis=1) < reach) - 1
        for x in bodies["water"].position
    ]
    assert mean_neighbours(simulation) == pytest.approx(np.mean(expected))


def test_peak_is_measured_and_refuses_what_it_does_not_know():
    assert _core.peak_flops("mixed", 1, 0.02) > 1e8
    assert _core.simd_level() in ("baseline", "avx2", "avx512")
    with pytest.raises(KolkError, match=r"precision: found 'f32'|precision: found \"f32\""):
        _core.peak_flops("f32")
    with pytest.raises(KolkError, match="seconds"):
        _core.peak_flops("f64", 1, -1.0)


def test_the_command_prints_json(capsys, monkeypatch, found):
    import kolk.bench

    monkeypatch.setattr(kolk.bench, "measure", lambda **_: found)
    with pytest.raises(SystemExit) as ended:
        main(["bench", "--json"])
    assert ended.value.code == 0
    printed = json.loads(capsys.readouterr().out)
    assert len(printed["flows"]) == len(found.flows)
    assert printed["flows"][0]["particle_steps"]["median"] > 0.0


def test_the_command_prints_a_table(capsys, monkeypatch, found):
    import kolk.bench

    monkeypatch.setattr(kolk.bench, "measure", lambda **_: found)
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        main(["bench"])
    printed = capsys.readouterr().out
    assert "M particle-steps/s" in printed
    assert "…" not in printed
    for phase in found.flows[0].phases:
        assert phase in printed
