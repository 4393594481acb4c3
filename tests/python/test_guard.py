"""What the guard makes of trouble, as a user sees it."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kolk
from kolk.cli import main
from kolk.errors import InstabilityError
from kolk.scene import Scene
from kolk.simulation import Simulation
from tanks import tank

LIMITS = {"acoustic", "viscous", "force", "fixed", "output", "guard", "capillary"}


def hasty(guard: str = "on", **changes: Any) -> Scene:
    """A dam break with a fixed time step four times what sound allows, and probes at every step."""
    scene = tank(spacing=0.05, until=0.2).replace({"fluid.water.viscosity.artificial": 0.02})
    return scene.replace(
        {
            "numerics.time_step": 4e-3,
            "numerics.guard": guard,
            "output.every": 0.02,
            "probe": [
                {"name": "P", "pressure": {"at": [0.0, 0.1]}, "every": 1e-3},
                {"name": "front", "front": {"axis": "x"}, "every": 1e-4},
            ],
            **changes,
        }
    )


def files(folder: Path) -> dict[str, bytes]:
    names = ["fields.vtkhdf", "history.csv", "probes/P.csv", "probes/front.csv"]
    return {name: (folder / name).read_bytes() for name in names}


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_a_run_that_is_too_hasty_is_mended_and_says_so(capfd: pytest.CaptureFixture[str]) -> None:
    Path("hasty.toml").write_text(hasty().to_toml(), encoding="utf-8")
    with pytest.raises(SystemExit) as end:
        main(["run", "hasty.toml", "--no-pictures", "--out", "run"])
    assert not end.value.code
    run = kolk.open_run("run")
    report = run.summary["stability"]
    assert run.outcome == "done"
    assert report["retries"] >= 1 and report["undone"] >= 1
    assert sum(report["retries_by_trouble"].values()) == report["retries"]
    assert report["limits"]["guard"] > 0
    assert "Stability: no leaks" in capfd.readouterr().out
    # Rows of steps that were taken back are gone.
    for name in ("P", "front"):
        time = run.probes[name]["time"].to_numpy()
        assert (np.diff(time) > 0.0).all() and len(time) > 10
    assert (np.diff(run.history["step"]) > 0).all()
    assert set(report["limits"]) == LIMITS
    assert run.history["steps_guard"].iloc[-1] == report["limits"]["guard"]


def test_what_is_taken_back_is_the_same_over_restart(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = kolk.run(hasty(), out="whole", quiet=True, pictures=False)
    assert whole.summary["stability"]["retries"] >= 1
    advance, left = Simulation.advance_to, [0]

    def watched(self: Simulation, time: float, max_steps: int | None = None) -> int:
        taken = advance(self, time, max_steps)
        left[0] -= taken
        if left[0] == 0:
            os.kill(os.getpid(), signal.SIGINT)
        return taken

    monkeypatch.setattr(Simulation, "advance_to", watched)
    for steps in (3, 13, 17, 19, 22, 26):
        left[0] = steps
        with pytest.raises(KeyboardInterrupt):
            kolk.run(hasty(), out=f"cut-{steps}", quiet=True, pictures=False)
        left[0] = -1
        cut = kolk.run(hasty(), out=f"cut-{steps}", resume=True, quiet=True, pictures=False)
        assert files(cut.folder) == files(whole.folder), steps
        assert cut.summary["stability"] == whole.summary["stability"]


def test_an_unstable_run_ends_with_a_reason_and_goes_on_with_other_settings(
    capfd: pytest.CaptureFixture[str],
) -> None:
    scene = hasty("off")
    Path("hasty.toml").write_text(scene.to_toml(), encoding="utf-8")
    with pytest.raises(SystemExit) as end:
        main(["run", "hasty.toml", "--no-pictures", "--quiet", "--out", "run"])
    assert end.value.code == 1
    said = capfd.readouterr().err
    for word in (
        "unstable at t = ",
        "(step ",
        "particle ",
        "density",
        "Probable cause",
        "What to do",
    ):
        assert word in said
    assert "fixed time step is longer than sound allows" in said and "--resume" in said
    run = kolk.open_run("run")
    assert run.outcome == "unstable" and run.summary["time"]["reached"] < 0.2
    for frame in run.frames:
        for name in frame.fields:
            assert np.isfinite(frame.field(name)).all()
    better = scene.replace({"numerics.time_step": None, "numerics.guard": "on"})
    done = kolk.run(better, out="run", resume=True, quiet=True, pictures=False)
    assert done.outcome == "done" and done.summary["time"]["reached"] == 0.2


def test_what_cannot_be_mended_leaves_its_last_good_state() -> None:
    # Fast water meets a wall at many times the speed of sound.
    scene = tank(spacing=0.05, until=0.5).replace(
        {
            "fluid.water.viscosity.artificial": 0.02,
            "fluid.water.sound_speed": 4.0,
            "fluid.water.velocity": [40.0, 0.0],
            "output.every": 0.005,
        }
    )
    with pytest.raises(InstabilityError, match="again after 6 attempts") as caught:
        kolk.run(scene, out="run", quiet=True, pictures=False)
    error = caught.value
    assert error.quantity == "density" and error.particle is not None
    assert error.position is not None and len(error.position) == 2
    assert error.value is not None and not 500.0 < error.value < 1500.0
    assert "sound speed" in str(error.cause) and "sound_speed" in str(error.remedy)
    run = kolk.open_run("run")
    assert run.outcome == "unstable"
    assert run.summary["time"]["reached"] <= (error.time or 0.0)
    assert run.frames[-1].time == run.summary["time"]["reached"]
    assert np.isfinite(run.frames[-1].position).all()
    low, high = run.summary["stability"]["density_min"], run.summary["stability"]["density_max"]
    assert low > 500.0 and high < 1500.0
    with pytest.raises(InstabilityError):
        kolk.run(scene, out="run", resume=True, quiet=True, pictures=False)


def test_leaks_and_voids_are_counted() -> None:
    from kolk.output.stability import leaks, voids

    sim = Simulation(tank().replace({"fluid.water.viscosity.artificial": 0.02}), threads=1)
    sim.advance_to(1e9, 2)
    assert leaks(sim) == 0 and voids(sim) == 0
    state = sim.state()
    where = np.stack([state["position_0"], state["position_1"]], axis=1)
    # Three through the bottom and one past the rim; and a hole two spacings wide in the middle.
    deep = np.argsort(where[:, 1])[:3]
    state["position_1"][deep] = -0.1 * 0.02 - 1e-4
    near = np.argsort(np.linalg.norm(where - [0.3, 0.15], axis=1))[:13]
    state["position_0"][near] += 5.0
    sim.restore(state)
    assert leaks(sim) == 3 + len(near)
    assert voids(sim) >= 1


@pytest.mark.parametrize("steps", [0, 40])
def test_fill_is_the_kernel_sum(steps: int) -> None:
    # Before the first step particles are not sorted into cells yet.
    scene = tank().replace({"fluid.water.viscosity.artificial": 0.02, "fluid.water.jitter": 0.2})
    sim = Simulation(scene, precision="f64", threads=1)
    if steps:
        sim.advance_to(1e9, steps)
    points = np.random.default_rng(7).uniform([-0.05, -0.05], [0.6, 0.4], (60, 2))
    found = sim.sample(points, ["fill", "wall_fill"])
    kernel = kolk.kernel(scene.kernel, 2)
    wanted = {"fluid": np.zeros(len(points)), "wall": np.zeros(len(points))}
    for body in sim.bodies.values():
        volume = body.mass / (body.density if body.kind == "fluid" else 1000.0)
        apart = np.linalg.norm(points[:, None] - body.position[None], axis=2)
        weight = kernel.value(apart.ravel(), scene.smoothing_length).reshape(apart.shape)
        wanted[body.kind] += weight @ volume
    np.testing.assert_allclose(found["fill"], wanted["fluid"], rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(found["wall_fill"], wanted["wall"], rtol=1e-6, atol=1e-7)
    assert np.ptp(found["fill"]) > 0.5 and np.ptp(found["wall_fill"]) > 0.2


def test_leaks_of_a_wall_that_moves() -> None:
    from kolk.output.stability import leaks

    motion = {"rotate": {"centre": [0.5, 0.3], "rate": 0.3}, "translate": {"velocity": [0.4, 0.1]}}
    scene = tank(gravity=[0.0, 0.0]).replace(
        {"fluid.water.sound_speed": 10.0, "wall.tank.motion": motion}
    )
    sim = Simulation(scene, threads=1)
    sim.advance_to(0.05)
    # The water stays behind, and the tank takes some of it along: none is outside.
    assert leaks(sim) == 0
