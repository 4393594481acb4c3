"""The case `gearbox` from start to end: leaks, torques, energy, and the pictures of the docs.

    python benches/gearbox.py [FOLDER]

runs it into FOLDER (a temporary one if absent; a finished run there is looked at again), prints
what either gear does against the energy budget, and writes docs/pictures/gearbox.png and
gearbox-torque.png. Takes a minute or two.
"""

from __future__ import annotations

import math
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd

import kolk
from kolk.cases import gearbox
from kolk.cases.gears import TEETH
from kolk.render import style

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"
FloatArray = npt.NDArray[np.float64]


def speed(name: str, time: FloatArray) -> FloatArray:
    """Of a gear in rad/s."""
    return gearbox.rate(name) * np.minimum(time / gearbox.RUN_UP, 1.0)


def smooth(time: FloatArray, value: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean over the time that one tooth takes, at even times."""
    tooth = 2.0 * math.pi / (TEETH["driver"] * abs(gearbox.RATE))
    taken = np.concatenate([[0.0], np.cumsum(np.diff(time) * (value[1:] + value[:-1]) / 2)])
    at = np.arange(0.5 * tooth, time[-1] - 0.5 * tooth, 0.1 * tooth)
    early, late = (np.interp(at + s * tooth, time, taken) for s in (-0.5, 0.5))
    return at, (late - early) / tooth


def draw(tables: dict[str, pd.DataFrame], path: Path) -> None:
    """The torque of the oil on either gear over time."""
    with style.look():
        made = style.figure(7.0, 3.6)
        axes = made.add_axes((0.1, 0.14, 0.87, 0.76))
        style.plot_axes(axes)
        for (name, table), ink in zip(tables.items(), (style.RUN, style.REFERENCE), strict=True):
            time, torque = table["time"].to_numpy(), table["moment"].to_numpy()
            axes.plot(time, torque, color=ink, lw=0.5, alpha=0.35)
            axes.plot(*smooth(time, torque), color=ink, label=f"{name}, {TEETH[name]} teeth")
        axes.axvline(gearbox.RUN_UP, color=style.QUIET, lw=0.7, ls=(0, (4, 3)))
        axes.set_xlabel("t [s]")
        axes.set_ylabel("torque of the oil [N m per m]")
        axes.set_title("Torque on either gear, and its mean over a tooth")
        axes.legend(loc="lower center", ncols=2)
        style.save(made, path)


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="kolk-gearbox-") as name:
        folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(name) / "run"
        done = (folder / "summary.json").exists()
        run = kolk.open_run(folder) if done else kolk.run(gearbox.case.scene, out=folder)
        summary, history = run.summary, pd.read_csv(folder / "history.csv")
        tables = {gear: run.probes[f"torque-{gear}"] for gear in TEETH}
        shutil.copy(folder / "pictures" / "field-speed.png", PICTURES / "gearbox.png")
    draw(tables, PICTURES / "gearbox-torque.png")
    print(f"{summary['steps']['total']} steps, leaks: {history['leaks'].max():.0f}")
    work = 0.0
    for gear, table in tables.items():
        time, torque = table["time"].to_numpy(), table["moment"].to_numpy()
        by_gear = -float(np.trapezoid(torque * speed(gear, time), time))
        work += by_gear
        late = time > 2.0 * gearbox.RUN_UP
        mean = np.trapezoid(torque[late], time[late]) / np.ptp(time[late])
        print(f"{gear}: mean torque {mean:+.3f} N m/m, work {by_gear:.3f} J/m")
    energy = summary["energy"]
    handed = -energy["dissipated"]["walls"]
    print(f"work {work:.3f}, handed over by walls {handed:.3f} J/m: {handed / work - 1.0:+.2%}")
    print(f"unaccounted {energy['unaccounted']:.3f} J/m: {energy['unaccounted'] / work:.2%} of it")


if __name__ == "__main__":
    main()
