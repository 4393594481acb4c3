"""Estimates before a run, and runs chosen for a tolerance or a budget."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import kolk
from kolk.cli.promises import share, time
from kolk.errors import SceneError
from kolk.study import budget as budgeting
from kolk.study import estimate as estimating
from kolk.study import tolerance as tolerating
from kolk.study.estimate import CostModel, Interval, coarse_scene, estimate
from kolk.study.job import make_job
from kolk.study.ladder import DEFAULT, Variant, snapped_finer
from kolk.study.pilot import Pilot
from kolk.study.promise import Promise, PromiseError, choose, outcome
from kolk.study.store import Store
from kolk.study.study import Study
from tanks import tank
from test_accuracy_study import made_up, rows, small


def pilot(scene: kolk.Scene, spacing: float, limit: str = "acoustic") -> Pilot:
    """A pilot of a machine that takes 1 µs for a step of one fluid particle, a twentieth for one of
    a wall, a little less for one of many, and 100 (or 5e3 h²) steps."""
    bodies = scene.replace(spacing=spacing).bodies()
    counted = sum(len(b) for b in bodies)
    fluid = sum(len(b) for b in bodies if b.kind == "fluid")
    power = {"acoustic": 1.0, "viscous": 2.0}[limit]
    steps = 200.0 * (0.02 / spacing) ** power
    each = 1e-6 * (fluid + 0.05 * (counted - fluid)) ** 0.9
    t = np.linspace(0.0, 1.0, 50)
    return Pilot(
        spacing=spacing,
        particles={"fluid": fluid, "wall": counted - fluid, "total": counted},
        threads=1,
        until=scene.until,
        frames=11,
        set_up=1e-7 * counted,
        begin=0.01,
        frame=1e-8 * counted,
        checkpoint=1e-8 * counted,
        wall=1.0,
        peak_memory=int(1e8 + 500 * counted),
        engine_memory=200 * counted,
        stations=[[scene.until * x, steps * x, steps * x * each, 0.0] for x in t],
        limits=[limit] * len(t),
    )


@pytest.mark.parametrize("limit", ["acoustic", "viscous"])
def test_costs_at_another_spacing_follow_the_limit_of_the_time_step(limit: str) -> None:
    scene = tank()
    model = CostModel(scene, pilot(scene, 0.02, limit), pilot(scene, 0.02, limit))
    truth = pilot(scene, 0.01, limit)
    found = model.at(0.01)
    assert found.particles.value == truth.total and found.particles.low == found.particles.high
    steps = truth.stations[-1][1] + 0.5 * truth.frames
    assert found.steps.value == pytest.approx(steps, rel=1e-9)
    assert found.steps.holds(steps)
    assert found.wall.value == pytest.approx(truth.stations[-1][2], rel=0.15)
    assert found.memory.value == pytest.approx(truth.peak_memory, rel=0.05)


def test_a_pilot_that_did_not_reach_the_end_widens_the_interval() -> None:
    scene = tank()
    whole = pilot(scene, 0.02)
    half = Pilot(**{**whole.__dict__, "stations": whole.stations[:25], "limits": whole.limits[:25]})
    sure, unsure = CostModel(scene, whole, whole).at(0.02), CostModel(scene, half, half).at(0.02)
    assert unsure.steps.value == pytest.approx(sure.steps.value, rel=0.02)
    assert unsure.steps.high / unsure.steps.low > sure.steps.high / sure.steps.low


def test_intervals() -> None:
    found = Interval.around(10.0, 0.25)
    assert (found.low, found.high) == (8.0, 12.5)
    assert found.holds(12.0) and not found.holds(13.0)


def test_an_estimate_holds(tmp_path: Path) -> None:
    """Particles exactly, steps and memory within a tenth; seconds are not for a test to judge."""
    scene = small().replace({"until": 0.3, "spacing": 0.02})
    found = estimate(scene, threads=1, seconds=0.5)
    truth = Store(tmp_path).measure(make_job(scene, None, 1))
    assert found.particles.value == truth.particles["total"]
    assert found.steps.value == pytest.approx(truth.steps, rel=0.1)
    assert found.memory.value == pytest.approx(truth.costs.peak_memory, rel=0.1)
    assert 0.0 < found.wall.low < found.wall.value < found.wall.high
    assert sum(found.parts.values()) == pytest.approx(found.wall.value)
    text = str(found)
    assert "no study of this scene" in text and "threads" in text


def test_the_coarse_pilot_is_still_a_flow() -> None:
    scene = kolk.load("dam-break")
    coarse = coarse_scene(scene)
    assert coarse.spacing > 2.0 * scene.spacing
    assert 0.3 / coarse.spacing >= 8.0 - 1e-9
    least = scene.replace(spacing=0.3 / 8)
    assert coarse_scene(least) is least


def study_of_law(scene: kolk.Scene, spacings: list[float], **law: float) -> Study:
    """A study whose errors are floor + constant h^order and whose runs take 1e-5 h^-3 seconds."""
    records = []
    for h in spacings:
        error = law.get("floor", 0.0) + law.get("constant", 4.0) * h ** law.get("order", 1.5)
        records.append(made_up(h, error, 1e-5 * h**-3, rows(h)))
    return Study(
        scene, (Variant(DEFAULT),), {DEFAULT: tuple(records)}, Path("studies/x"), Path("studies/r")
    )


@pytest.fixture
def studied(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Studies are made up from the law that the test puts in here; `asked` are their spacings."""
    law: dict[str, Any] = {"asked": []}

    def made(scene: kolk.Scene, spacings: list[float], **_: Any) -> Study:
        law["asked"].append(spacings)
        return study_of_law(scene, spacings, **{k: v for k, v in law.items() if k != "asked"})

    monkeypatch.setattr(tolerating, "accuracy", made)
    monkeypatch.setattr(tolerating, "study_of", lambda scene: None)
    return law


def truth(law: dict[str, Any], spacing: float) -> float:
    return float(
        law.get("floor", 0.0) + law.get("constant", 4.0) * spacing ** law.get("order", 1.5)
    )


@pytest.mark.parametrize("tolerance", [0.05, 0.02, 0.01, 0.005])
@pytest.mark.parametrize("order", [1.0, 1.5, 2.0])
def test_a_tolerance_is_met_at_the_least_cost(
    studied: dict[str, Any], tolerance: float, order: float
) -> None:
    studied |= {"order": order, "constant": {1.0: 0.8, 1.5: 4.0, 2.0: 40.0}[order]}
    found = choose(tank(), tolerance=tolerance, quiet=True)
    wrong = truth(studied, found.scene.spacing)
    assert wrong <= tolerance
    assert found.error is not None and wrong <= found.error <= tolerance * 1.0001
    coarsest = max(studied["asked"][0])
    assert found.scene.spacing >= coarsest * 0.99 or wrong > 0.25 * tolerance, "needlessly fine"
    assert "Why" in str(found)


def test_a_tolerance_below_the_floor_is_refused_with_the_nearest(studied: dict[str, Any]) -> None:
    studied |= {"floor": 0.03, "constant": 4.0}
    with pytest.raises(PromiseError, match=r"1 % cannot be promised.*What can be promised is"):
        choose(tank(), tolerance=0.01, quiet=True)


def test_an_error_that_does_not_fall_is_refused(studied: dict[str, Any]) -> None:
    studied |= {"floor": 0.05, "constant": -1.0, "order": 1.0}
    with pytest.raises(PromiseError, match="does not fall"):
        choose(tank(), tolerance=0.01, quiet=True)


def test_a_tolerance_that_the_budget_does_not_hold_is_refused(studied: dict[str, Any]) -> None:
    studied |= {"constant": 8.0}
    with pytest.raises(PromiseError, match="cannot be promised"):
        choose(tank(), tolerance=0.0005, budget=60.0, quiet=True)


def test_what_is_far_out_of_reach_is_refused_before_more_is_run(studied: dict[str, Any]) -> None:
    with pytest.raises(PromiseError, match=r"finest level that the study needs would take"):
        choose(tank(), tolerance=1e-6, quiet=True)
    assert len(studied["asked"]) == 1


def test_nonsense_is_refused() -> None:
    with pytest.raises(PromiseError, match="tolerance"):
        choose(tank(), tolerance=3.0)
    with pytest.raises(PromiseError, match="budget"):
        choose(tank(), budget=0.0)
    assert (share("2%"), share("0.02"), share(" 1.5 % ")) == (0.02, 0.02, 0.015)
    assert (time("10min"), time("90"), time("1.5 h")) == (600.0, 90.0, 5400.0)
    for wrong in ("2 percent", "", "1.2.3%"):
        with pytest.raises(SceneError, match="--tolerance"):
            share(wrong)
    with pytest.raises(SceneError, match="--budget"):
        time("ten")


def slower_later(time: Any) -> Any:
    """Seconds of steps until a share of the scene's time, over those at the time step's end, of a
    flow that begins quietly: each of its steps takes 1 + 2 t of the first."""
    return (time + time**2) / 2.0


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> list[Pilot]:
    """Pilots are of a made-up machine whose steps take ever longer; those flown are in here."""
    flown: list[Pilot] = []

    def flying(job: Any, seconds: float) -> Pilot:
        whole = pilot(tank(), job.spacing)
        table = np.array(whole.stations)
        table[:, 2] = table[-1, 2] * slower_later(table[:, 0] / whole.until)
        kept = max(2, int(np.searchsorted(table[:, 2], seconds)) + 1)
        shown = {"stations": table[:kept].tolist(), "limits": whole.limits[:kept]}
        flown.append(Pilot(**{**whole.__dict__, **shown}))
        return flown[-1]

    monkeypatch.setattr(budgeting, "fly", flying)
    monkeypatch.setattr(estimating, "fly", flying)
    monkeypatch.setattr(budgeting, "study_of", lambda scene: None)
    return flown


def taken(scene: kolk.Scene, spacing: float) -> float:
    """Seconds of a run on that machine, but for a few for frames and checkpoints."""
    return float(pilot(scene, spacing).stations[-1][2])


@pytest.mark.parametrize("seconds", [20.0, 60.0, 600.0])
def test_a_budget_is_used_and_kept(machine: list[Pilot], seconds: float) -> None:
    """Though the pilot at the chosen spacing sees the beginning alone, where a step takes half."""
    scene = tank()
    found = choose(scene, budget=seconds, quiet=True)
    assert not machine[-1].whole and machine[-1].stations[-1][0] < 0.3 * scene.until
    assert 0.85 * seconds <= taken(scene, found.scene.spacing) <= seconds


def test_what_pilots_take_is_a_small_share_of_the_budget(machine: list[Pilot]) -> None:
    choose(tank(), budget=600.0, quiet=True)
    assert sum(found.stations[-1][2] for found in machine) < 0.2 * 600.0
    assert any(found.whole for found in machine), "none has seen the whole scene"


def test_the_profile_carries_the_cost_of_a_step_over_to_where_no_pilot_has_been(
    machine: list[Pilot],
) -> None:
    scene = tank()
    coarse = estimating.fly(make_job(scene.replace(spacing=0.04), None, 1), 100.0)
    fine = estimating.fly(make_job(scene.replace(spacing=0.01), None, 1), 0.1 * taken(scene, 0.01))
    assert coarse.whole and fine.stations[-1][0] < 0.3 * scene.until
    found = CostModel(scene, coarse, fine).at(0.01).parts["steps"]
    assert found == pytest.approx(taken(scene, 0.01), rel=0.05)
    blind = CostModel(scene, fine, fine).at(0.01).parts["steps"]
    assert blind < 0.8 * taken(scene, 0.01), "the start tells as much as the whole"


def test_a_pilot_that_something_hindered_is_told_and_holds_less(machine: list[Pilot]) -> None:
    scene = tank()
    coarse = estimating.fly(make_job(scene.replace(spacing=0.04), None, 1), 100.0)
    fine = estimating.fly(make_job(scene.replace(spacing=0.01), None, 1), 0.1 * taken(scene, 0.01))
    # Something else had the machine while the fine one flew.
    slow = [[t, n, 2.0 * s, p] for t, n, s, p in fine.stations]
    quiet, busy = (
        CostModel(scene, coarse, fine),
        CostModel(scene, coarse, Pilot(**{**fine.__dict__, "stations": slow})),
    )
    assert quiet.hindrance < 1.0 and busy.hindrance > 2.0
    ratio = busy.at(0.01).parts["steps"] / quiet.at(0.01).parts["steps"]
    assert 1.2 < ratio < 1.9, "neither ignored nor believed alone"


@pytest.fixture
def disturbed(machine: list[Pilot], monkeypatch: pytest.MonkeyPatch) -> list[Pilot]:
    """The same, but something else has the machine during the first flight where the run will be;
    the flights there."""
    undisturbed, flights = budgeting.fly, []

    def flying(job: Any, seconds: float) -> Pilot:
        found = undisturbed(job, seconds)
        if found.whole:
            return found
        flights.append(found)
        slow = 2.5 if len(flights) == 1 else 1.0
        stations = [[t, n, slow * s, p] for t, n, s, p in found.stations]
        return Pilot(**{**found.__dict__, "stations": stations})

    monkeypatch.setattr(budgeting, "fly", flying)
    monkeypatch.setattr(estimating, "fly", flying)
    return flights


def test_a_budget_flies_a_disturbed_pilot_again(disturbed: list[Pilot]) -> None:
    scene = tank()
    found = choose(scene, budget=200.0, quiet=True)
    assert len(disturbed) > 1
    assert 0.85 * 200.0 <= taken(scene, found.scene.spacing) <= 200.0


def test_an_estimate_flies_a_disturbed_pilot_again(disturbed: list[Pilot]) -> None:
    scene = tank().replace({"spacing": 0.01})
    found = estimate(scene, threads=1, seconds=0.2 * taken(scene, 0.01))
    assert len(disturbed) == 2
    assert found.parts["steps"] == pytest.approx(taken(scene, 0.01), rel=0.1)


def test_too_small_a_budget_is_refused_with_what_would_do(machine: list[Pilot]) -> None:
    with pytest.raises(PromiseError, match="give it"):
        choose(tank(), budget=0.001, quiet=True)


def test_a_missed_estimate_says_whether_steps_or_their_time_were_wrong(tmp_path: Path) -> None:
    scene = small().replace({"until": 0.02})
    run = kolk.run(scene, tmp_path / "run", threads=1, quiet=True, pictures=False)
    steps, seconds = run.summary["steps"]["total"], run.summary["seconds"]
    took = seconds["total"] - seconds["phases"]["comparison"]["seconds"]

    def said(wall: float) -> str:
        promise = Promise(
            scene=scene,
            precision=None,
            tolerance=None,
            budget=60.0,
            error=None,
            expected=None,
            of="",
            wall=Interval.around(wall, 0.1),
            reasons=(),
            steps=0.5 * steps,
        )
        return "\n".join(outcome(promise, run))

    assert f"Steps: {steps:,}, {0.5 * steps:,.0f} were expected" in said(0.25 * took)
    assert "2.00 times as long" in said(0.25 * took)
    assert "Steps" not in said(took)


def test_a_finer_snap_is_never_coarser() -> None:
    scene = kolk.load("taylor-green")
    for spacing in (0.03, 0.0201, 0.0123):
        found = snapped_finer(scene, spacing)
        assert found <= spacing * (1 + 1e-9)
        assert 1.0 / found == pytest.approx(math.ceil(1.0 / spacing - 1e-9))


def test_the_command_line_promises_and_settles(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from kolk.cli.app import app

    monkeypatch.chdir(tmp_path)
    small().replace({"until": 0.02}).save(tmp_path / "small.toml")
    words = ["run", "small.toml", "--tolerance", "60%", "--quantity", "tip", "--no-pictures"]
    found = CliRunner().invoke(app, [*words, "--threads", "1"])
    assert found.exit_code == 0, found.output
    assert "The promise:" in found.output and "Promised: tip within 60 %" in found.output
    assert (tmp_path / "runs" / "tank" / "promise.json").is_file()
    refused = CliRunner().invoke(
        app, ["run", "small.toml", "--tolerance", "2%", "--spacing", "0.1"]
    )
    assert refused.exit_code == 2
