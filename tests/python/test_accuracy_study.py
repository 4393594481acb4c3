"""Studies of real, small runs: measured, kept, resumed, judged, and put into words."""

from __future__ import annotations

import json
import math
import re
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import kolk
from kolk.errors import RunError, SceneError
from kolk.study import store as storing
from kolk.study.curve import ALL_PROBES, ladder
from kolk.study.job import make_job
from kolk.study.ladder import (
    DEFAULT,
    Variant,
    default_spacings,
    full_key,
    parse_vary,
    snapped,
    variants,
)
from kolk.study.pareto import pareto_front
from kolk.study.record import Costs, Record, Score, Track
from kolk.study.study import StudyInterrupted, accuracy, open_study
from tanks import tank

SMALL = {"until": 0.05, "output.every": 0.025}


def small() -> kolk.Scene:
    return tank(
        probe=[{"name": "P", "pressure": {"at": [0.0, 0.1]}}, {"name": "tip", "front": {}}],
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [0.4, 0.2]}},
                "viscosity": {"artificial": 0.1},
            }
        ],
    ).replace(SMALL)


def made_up(spacing: float, error: float, wall: float, rows: np.ndarray, **about: Any) -> Record:
    """A record as a run would have left it."""
    return Record(
        **{
            "key": f"{spacing}",
            "name": "made-up",
            "spacing": spacing,
            "precision": "f64",
            "threads": 1,
            "alone": True,
            "outcome": "done",
            "reason": "",
            "particles": {"fluid": 1, "wall": 0, "total": 1},
            "steps": 1,
            "limits": {},
            "costs": Costs(wall, wall, wall, 1, 1),
            "phases": {},
            "scores": (Score("u, L2", error, "analytic"),) if error else (),
            "machine": "",
            "version": "",
            "until": 1.0,
            "tracks": {"P": Track("P", "pressure", "Pa", ("value",), rows)},
        }
        | about
    )


def rows(spacing: float, order: float = 1.5) -> np.ndarray:
    t = np.linspace(0.0, 1.0, 41)
    return np.stack([t, 2.0 + np.sin(5.0 * t) + 20.0 * spacing**order * np.cos(t)], axis=1)


LEVELS = (0.04, 0.028, 0.02, 0.014)


def test_a_ladder_against_a_reference() -> None:
    found = ladder(
        Variant(DEFAULT), [made_up(h, 4.0 * h**1.5, 1e-5 * h**-3, rows(h)) for h in LEVELS]
    )
    curve = found.curve(found.leading)
    assert found.leading == "u, L2"
    assert curve.verdict.sound
    assert curve.order[0] == pytest.approx(1.5)
    assert curve.expected(0.01) == pytest.approx(4e-3)
    assert curve.expected(0.01) < curve.promised(0.01)
    chosen = curve.spacing_for(0.01)
    assert curve.promised(chosen) <= 0.01 < curve.promised(1.1 * chosen)
    assert math.isinf(curve.promised(0.001)), "far beyond the ladder nothing is promised"
    assert found.cost is not None and found.cost.order == pytest.approx(-3.0)


def test_a_ladder_without_a_reference_is_as_sure_of_its_probes() -> None:
    found = ladder(Variant(DEFAULT), [made_up(h, 0.0, h**-3, rows(h)) for h in LEVELS])
    assert found.leading == ALL_PROBES
    curve = found.curve("P")
    assert curve.basis == "extrapolation"
    assert curve.order[0] == pytest.approx(1.5, abs=0.01)
    truth, t = rows(0.0)[:, 1], rows(0.0)[:, 0]
    wrong = np.sqrt(np.mean((rows(0.014)[:, 1] - truth) ** 2)) / np.abs(rows(0.014)[:, 1]).max()
    assert curve.error[-1] == pytest.approx(wrong, rel=0.02)
    assert wrong < curve.promised(0.014) < 2.0 * wrong
    assert len(t) == len(found.quantities[0].time)
    mean = found.curve("P mean")
    assert mean.error[-1] < curve.error[-1]


def test_a_variant_is_judged_by_the_limit_of_the_scene_as_it_is() -> None:
    base = ladder(Variant(DEFAULT), [made_up(h, 0.0, h**-3, rows(h)) for h in LEVELS])
    wrong = []
    for h in LEVELS:
        shifted = rows(h)
        shifted[:, 1] += 0.5
        wrong.append(made_up(h, 0.0, h**-3, shifted))
    other = ladder(Variant("biased", {"kernel": "cubic"}), wrong, base)
    # Alone it would converge, to something else.
    assert other.curve("P").error[-1] > 0.1


def test_compressibility_is_part_of_every_bar() -> None:
    """No refinement removes what a weakly compressible fluid is off an incompressible one."""
    given = [ladder(Variant(DEFAULT), [made_up(h, 0.0, 1.0, rows(h)) for h in LEVELS])]
    given.append(
        ladder(Variant(DEFAULT), [made_up(h, 0.0, 1.0, rows(h), compression=0.01) for h in LEVELS])
    )
    stiff, soft = (found.quantities[0] for found in given)
    assert soft.level_bar(3) == pytest.approx(stiff.level_bar(3) + 0.02)
    assert soft.bar_at(0.01) == pytest.approx(stiff.bar_at(0.01) + 0.02)
    assert soft.statistic_bar("mean", 3) > stiff.statistic_bar("mean", 3)
    assert soft.level_error(3) == stiff.level_error(3)


def test_failed_runs_stand_apart() -> None:
    records = [made_up(h, 0.1, 1.0, rows(h)) for h in LEVELS]
    records.append(made_up(0.01, 0.1, 1.0, rows(0.01), outcome="unstable", reason="it burst"))
    found = ladder(Variant(DEFAULT), records)
    assert len(found.records) == 4
    assert [r.reason for r in found.failed] == ["it burst"]


def test_the_pareto_front() -> None:
    time = [1.0, 2.0, 3.0, 4.0, 5.0, 2.0]
    error = [5.0, 3.0, 3.5, 1.0, math.nan, 4.0]
    assert pareto_front(time, error) == [0, 1, 3]
    assert pareto_front([], []) == []


def test_words_of_the_command_line_become_variants() -> None:
    found = parse_vary(
        ["kernel=cubic,wendland-c4,wall=dynamic", "smoothing_ratio=1.5,2", "gravity=[0.0,-1.0]"]
    )
    assert found == {
        "kernel": ["cubic", "wendland-c4"],
        "wall": ["dynamic"],
        "smoothing_ratio": [1.5, 2],
        "gravity": [[0.0, -1.0]],
    }
    assert len(variants({"kernel": ["cubic"], "wall": ["dynamic"]})) == 3
    crossed = variants({"kernel": ["cubic", "quintic"], "wall": ["adami", "dynamic"]}, cross=True)
    assert [v.label for v in crossed[:2]] == [DEFAULT, "kernel=cubic, wall=adami"]
    assert len(crossed) == 5
    assert full_key("wall", "dynamic") == "numerics.wall"
    assert full_key("kernel", "cubic") == "kernel"
    scene = Variant("", {"wall": "dynamic", "precision": "f64"}).scene(small(), 0.04)
    assert scene.numerics.wall == "dynamic" and scene.spacing == 0.04
    with pytest.raises(SceneError, match="KEY=VALUE"):
        parse_vary(["kernel"])


def test_spacings_of_a_ladder_divide_the_fluid() -> None:
    scene = kolk.load("taylor-green")
    chosen = default_spacings(scene)
    assert len(chosen) == 4 and scene.spacing in chosen
    assert [round(1.0 / h) for h in chosen] == [25, 35, 50, 71]
    assert all(1.0 / h == pytest.approx(round(1.0 / h)) for h in chosen)
    assert snapped(scene, 0.0301) == pytest.approx(1.0 / 33)


def test_where_coarser_spacings_do_not_fit_a_ladder_goes_finer() -> None:
    # A period must hold two supports: of these spacings 0.2 and 0.14 m are too coarse for it.
    scene = kolk.load("taylor-green").replace(spacing=0.1)
    assert [round(1.0 / h) for h in default_spacings(scene)] == [10, 14, 20, 28]


def test_a_key_depends_on_everything_that_changes_a_run() -> None:
    scene = small()
    keys = {
        make_job(scene, "mixed", 1).key,
        make_job(scene, "f64", 1).key,
        make_job(scene, "mixed", 2).key,
        make_job(scene.replace(spacing=0.04), "mixed", 1).key,
        make_job(scene.replace({"fluid.water.viscosity.artificial": 0.2}), "mixed", 1).key,
    }
    assert len(keys) == 5
    assert make_job(scene, "mixed", 1).key == make_job(small(), "mixed", 1).key


def test_own_particles_are_part_of_a_job() -> None:
    rest = small()
    moved = rest.replace({"fluid.water.velocity": lambda x: 0.1 * x})
    job = make_job(moved, None, 1)
    assert sorted(job.files) == ["scene.toml", "water.npz"]
    assert job.key != make_job(rest, None, 1).key


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> kolk.Study:
    """A study of four levels, and one alternative, of a scene of one's own."""
    folder = tmp_path_factory.mktemp("study")
    return accuracy(
        small(),
        [0.05, 0.04, 0.03333, 0.025],
        vary={"kernel": ["cubic"]},
        threads=1,
        out=folder / "out",
        store=folder / "runs",
        quiet=True,
    )


def test_a_scene_without_a_reference_gets_order_bar_and_cost_curve(study: kolk.Study) -> None:
    assert len(study.base.records) == 4
    for quantity in study.base.quantities:
        assert quantity.expansion is not None
        assert all(np.isfinite(quantity.level_bar(i)) for i in range(4))
    assert {q.name for q in study.base.quantities} == {"P", "tip"}
    costs = [record.costs for record in study.base.records]
    assert all(c.wall > 0.0 and c.cpu > 0.0 and c.peak_memory > 30e6 for c in costs)
    assert study.base.cost is not None
    text = " ".join(study.sentences)
    assert "order" in text and "kernel=cubic" in text and "±" in text
    assert study.front


def test_a_study_leaves_picture_tables_and_sentences(study: kolk.Study) -> None:
    names = {path.name for path in study.folder.iterdir()}
    assert {
        "accuracy.png",
        "runs.csv",
        "runs.json",
        "tables.md",
        "probes.csv",
        "study.json",
    } <= names
    assert (study.folder / "accuracy.png").read_bytes()[:4] == b"\x89PNG"
    assert len(study.table) == 8
    assert json.loads((study.folder / "runs.json").read_text())[0]["settings"] == DEFAULT
    again = open_study(study.folder)
    assert again.sentences == study.sentences


def test_what_was_run_is_not_run_again(study: kolk.Study, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*arguments: str) -> None:
        raise AssertionError("a finished run was repeated")

    monkeypatch.setattr(storing, "run_alone", never)
    again = accuracy(
        small(),
        [0.05, 0.04, 0.03333, 0.025],
        threads=1,
        out=study.folder.parent / "again",
        store=study.folder.parent / "runs",
        quiet=True,
    )
    assert [r.key for r in again.base.records] == [r.key for r in study.base.records]


def test_an_interrupted_study_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, calls = storing.run_alone, []

    def second_is_interrupted(*arguments: str) -> None:
        calls.append(arguments)
        if len(calls) == 2:
            raise KeyboardInterrupt
        real(*arguments)

    monkeypatch.setattr(storing, "run_alone", second_is_interrupted)
    given: dict[str, Any] = {"threads": 1, "store": tmp_path / "runs", "quiet": True}
    with pytest.raises(StudyInterrupted, match="1 of 2"):
        accuracy(small(), [0.05, 0.04], out=tmp_path / "out", **given)
    found = accuracy(small(), [0.05, 0.04], out=tmp_path / "out", **given)
    assert len(calls) == 3, "the first run was kept"
    assert len(found.base.records) == 2
    assert "2 levels" in " ".join(found.sentences)
    assert not [p for p in (tmp_path / "runs").iterdir() if p.name.startswith(".new")]


def test_runs_over_an_executor_are_marked(tmp_path: Path) -> None:
    class Here(ThreadPoolExecutor):
        def submit(self, *args: Any, **kwargs: Any) -> Future[Any]:
            done: Future[Any] = Future()
            done.set_result(args[0](*args[1:], **kwargs))
            return done

    found = accuracy(
        small(),
        [0.05],
        threads=1,
        executor=Here(),
        out=tmp_path / "out",
        store=tmp_path / "runs",
        quiet=True,
    )
    assert [record.alone for record in found.base.records] == [False]
    assert "no measure of speed" in " ".join(found.sentences)


def test_a_run_that_fails_is_said(tmp_path: Path) -> None:
    # Far too long a fixed step, and nobody to shorten it: the engine stops with a cause.
    scene = small().replace({"numerics.time_step": 0.02, "numerics.guard": "off", "until": 1.0})
    found = accuracy(
        scene, [0.04], threads=1, out=tmp_path / "out", store=tmp_path / "runs", quiet=True
    )
    assert not found.base.records
    assert "ended early" in " ".join(found.sentences)


def test_bad_words_are_refused_before_anything_runs(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="spacings"):
        accuracy(small(), [-1.0], out=tmp_path, store=tmp_path)
    with pytest.raises(SceneError, match="kernel"):
        accuracy(small(), [0.05], vary={"kernel": ["cubik"]}, out=tmp_path, store=tmp_path / "r")
    with pytest.raises(RunError, match="not the folder of a study"):
        open_study(tmp_path)


def test_an_unknown_quantity_is_named_with_those_there_are(study: kolk.Study) -> None:
    with pytest.raises(RunError, match="tip"):
        study.curve("Q")


def test_the_command(tank: Path) -> None:
    from kolk.cli.app import app

    words = ["accuracy", str(tank), "--spacings", "0.06,0.05", "--threads", "1", "--until", "0.04"]
    found = CliRunner().invoke(app, words)
    assert found.exit_code == 0, found.output
    assert "2 levels" in found.output and "| settings |" in found.output
    assert Path("studies/tank/accuracy.png").is_file()
    bad = CliRunner().invoke(app, ["accuracy", str(tank), "--spacings", "a"])
    assert bad.exit_code == 2


def only_inside(path: Path) -> str:
    """The text of a report, which must need nothing outside of itself."""
    text = path.read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>") and text.rstrip().endswith("</html>")
    for source in re.findall(r'(?:src|href)="([^"]{0,40})', text):
        assert source.startswith("data:"), source
    assert "http://" not in text and "https://" not in text and "<script" not in text
    return text


def test_the_report_of_a_study_is_one_file(study: kolk.Study) -> None:
    from kolk.report import report

    text = only_inside(report(study.folder))
    assert "data:image/png;base64," in text
    for part in ("kernel=cubic", "Error against time", "kolk accuracy scene.toml", "extrapolat"):
        assert part in text


def test_the_report_of_a_run_is_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from kolk.report import report

    monkeypatch.chdir(tmp_path)
    scene = small().replace({"title": "A <tank> & more"})
    accuracy(scene, [0.05, 0.04, 0.03333], threads=1, quiet=True)
    run = kolk.run(scene.replace(spacing=0.04), threads=1, quiet=True, pictures=False)
    (run.folder / "pictures").mkdir(exist_ok=True)
    text = only_inside(report(run.folder))
    assert "A &lt;tank&gt; &amp; more" in text
    for part in ("Costs by phase", "Stability", "error bar", "kolk run scene.toml", "scene.toml"):
        assert part in text
    killed = tmp_path / "killed"
    killed.mkdir()
    scene.save(killed / "scene.toml")
    (killed / "probes").mkdir()
    assert "unfinished" in only_inside(report(killed))
    with pytest.raises(RunError, match="neither"):
        report(tmp_path)
