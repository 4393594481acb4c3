"""The command: verbs, exit statuses, what goes to which stream."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

import kolk
from kolk import cases
from kolk.cli import main
from kolk.cli.scenes import parse_setting
from kolk.errors import InstabilityError, SceneError
from kolk.simulation import Simulation


class Ended(NamedTuple):
    status: int
    out: str
    err: str


Command = Callable[..., Ended]


@pytest.fixture
def command(capfd: pytest.CaptureFixture[str]) -> Command:
    """Runs the command in this process."""

    def run(*words: str) -> Ended:
        with pytest.raises(SystemExit) as end:
            main(words)
        captured = capfd.readouterr()
        return Ended(int(end.value.code or 0), captured.out, captured.err)

    return run


def test_run_ends_with_its_summary(tank: Path, command: Command) -> None:
    ended = command("run", "tank.toml")
    assert ended.status == 0
    assert ended.err == ""
    assert "tank: done at t = 0.1 s" in ended.out
    assert "Time by phase:" in ended.out
    assert "Results: runs/tank" in ended.out


def test_quiet_says_nothing(tank: Path, command: Command) -> None:
    assert command("run", "tank.toml", "--quiet") == (0, "", "")


def test_options_reach_the_run(tank: Path, command: Command) -> None:
    words = "run tank.toml --spacing 0.06 --until 0.04 --out here --threads 1 --precision mixed"
    setting = "fluid.water.viscosity.artificial=0.05"
    assert command(*words.split(), "--set", setting, "--set", "kernel=cubic").status == 0
    run = kolk.open_run("here")
    assert run.scene.spacing == 0.06
    assert run.scene.kernel == "cubic"
    assert run.scene.fluid[0].viscosity is not None
    assert run.scene.fluid[0].viscosity.artificial == 0.05
    assert run.summary["time"]["reached"] == 0.04
    assert run.summary["scene"]["precision"] == "mixed"
    assert run.summary["scene"]["threads"] == 1


def test_resume_goes_on_in_the_newest_folder(tank: Path, command: Command) -> None:
    assert command("run", "tank.toml", "--quiet").status == 0
    assert command("run", "tank.toml", "--until", "0.14", "--resume", "--quiet").status == 0
    assert kolk.open_run("runs/tank").summary["time"]["reached"] == 0.14
    # The folder of a run stands for its scene.
    assert command("run", "runs/tank", "--resume", "--until", "0.16", "--quiet").status == 0
    assert kolk.open_run("runs/tank").summary["time"]["reached"] == 0.16
    assert command("run", "runs/tank", "--out", "fresh", "--quiet").status == 0
    assert not Path("runs/tank-2").exists()


def test_force_starts_over(tank: Path, command: Command) -> None:
    for extra, status in (([], 0), ([], 2), (["--force"], 0)):
        assert command("run", "tank.toml", "--out", "here", "--quiet", *extra).status == status


def test_cases_lists_every_scene(command: Command) -> None:
    ended = command("cases")
    assert ended.status == 0
    for name in cases.names():
        assert f"{name}: " in ended.out


def test_check_describes_without_running(tank: Path, command: Command) -> None:
    ended = command("check", "tank.toml")
    assert ended.status == 0
    assert "particles" in ended.out
    assert not Path("runs").exists()


def test_check_draws_the_set_up(tank: Path, command: Command) -> None:
    assert command("check", "tank.toml", "--picture").status == 0
    assert Path("tank-set-up.png").read_bytes().startswith(b"\x89PNG")
    assert command("check", "tank.toml", "--out", "other.png").status == 0
    assert Path("other.png").is_file()


def test_new_writes_a_scene_that_checks(tank: Path, command: Command) -> None:
    assert command("new", "my scene.v2.toml").status == 0
    assert command("check", "my scene.v2.toml").status == 0
    again = command("new", "my scene.v2.toml")
    assert again.status == 2
    assert "--force" in again.err
    assert command("new", "my scene.v2.toml", "--force").status == 0


def test_render_takes_a_folder_or_a_name(
    tank: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import kolk.render

    seen = []

    def draw(run: kolk.Run, film: bool = True, **_: object) -> list[Path]:
        seen.append((str(run.folder), film))
        return [run.folder / "pictures" / "flow.png"]

    monkeypatch.setattr(kolk.render, "render_run", draw)
    command("run", "tank.toml", "--quiet")
    assert command("render", "runs/tank", "--no-film").out == "runs/tank/pictures/flow.png\n"
    assert command("render", "tank").status == 0
    assert seen == [("runs/tank", False), ("runs/tank", True)]
    nothing = command("render", "nothing")
    assert nothing.status == 2
    assert "not the folder of a kolk run" in nothing.err


def test_an_unstable_run_ends_with_1(
    tank: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def unstable(*_: object) -> int:
        raise InstabilityError("particle 7 left the range at t = 0.01 s; use a smaller courant")

    monkeypatch.setattr(Simulation, "advance_to", unstable)
    ended = command("run", "tank.toml")
    assert ended.status == 1
    assert ended.err.startswith("kolk: particle 7 left the range")
    assert "Traceback" not in ended.err


def test_debug_shows_the_traceback(tank: Path, command: Command) -> None:
    plain = command("run", "missing.toml")
    debug = command("run", "missing.toml", "--debug")
    assert (plain.status, debug.status) == (2, 2)
    assert "Traceback" not in plain.err
    assert "Traceback" in debug.err
    assert plain.err in debug.err


def test_version(command: Command) -> None:
    assert command("--version") == (0, f"kolk {kolk.__version__}\n", "")


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("spacing=0.01", ("spacing", 0.01)),
        ("kernel=cubic", ("kernel", "cubic")),
        ("kernel = 'cubic'", ("kernel", "cubic")),
        ("gravity=[0, -9.81]", ("gravity", [0, -9.81])),
        ("output.pictures=false", ("output.pictures", False)),
    ],
)
def test_settings_are_toml_or_words(setting: str, expected: tuple[str, object]) -> None:
    assert parse_setting(setting) == expected


@pytest.mark.parametrize("setting", ["spacing", "=3", "spacing="])
def test_a_setting_needs_a_key_and_a_value(setting: str) -> None:
    with pytest.raises(SceneError, match="KEY=VALUE"):
        parse_setting(setting)


@pytest.mark.skipif(sys.platform == "win32", reason="signals differ on Windows")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_saves_and_says_how_to_go_on(tank: Path, number: signal.Signals) -> None:
    words = [sys.executable, "-m", "kolk.cli", "run", "tank.toml", "--until", "1000"]
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True, cwd=tank.parent) as process:
        history = tank.parent / "runs" / "tank" / "history.csv"
        deadline = time.monotonic() + 60
        while not (history.is_file() and history.read_text().count("\n") > 3):
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.02)
        os.kill(process.pid, number)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted at t = " in errors
    assert "kolk run runs/tank --resume" in errors
    assert "Traceback" not in errors
    folder = tank.parent / "runs" / "tank"
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"] == "interrupted"
    # And so it goes on, to an end that has meanwhile moved closer.
    end = str(summary["time"]["reached"] + 0.01)
    resumed = [*words[:4], "runs/tank", "--resume", "--quiet", "--until", end]
    assert subprocess.run(resumed, cwd=tank.parent, check=False).returncode == 0


def test_the_command_starts_fast_enough_to_answer() -> None:
    """Heavy libraries stay out of the way of `kolk --version`."""
    code = (
        "import sys; from kolk.cli import main\n"
        "try: main(['--version'])\n"
        "except SystemExit: print(*(m for m in sys.modules if '.' not in m))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(found.stdout.split())
    assert not loaded & {"pandas", "matplotlib", "pyvista", "scipy", "h5py", "pydantic"}


def test_ctrl_c_while_pictures_are_made_keeps_the_run(
    tank: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import kolk.render

    def pressed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(kolk.render, "render_run", pressed)
    ended = command("run", "tank.toml", "--pictures")
    assert ended.status == 130
    assert "the run is done" in ended.err
    assert "kolk render runs/tank" in ended.err
    assert kolk.open_run("runs/tank").outcome == "done"


def test_a_resumed_run_keeps_its_precision(tank: Path, command: Command) -> None:
    assert command("run", "tank.toml", "--precision", "mixed", "--quiet").status == 0
    assert command("run", "runs/tank", "--resume", "--until", "0.12", "--quiet").status == 0
    assert kolk.open_run("runs/tank").summary["scene"]["precision"] == "mixed"
