"""Fields beside their exact solutions: profiles of channels and still water, decay of vortices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from kolk import references
from kolk.compare.drops import drop_of, strain
from kolk.compare.fields import FrameLike, fluid
from kolk.compare.waves import mode_share, wave_of

from . import style
from .quantity import spread

if TYPE_CHECKING:
    from kolk.cases import Comparison

FloatArray = npt.NDArray[np.float64]

SHOWN = 4
"""Times that a picture of profiles shows."""


def exact_picture(
    frames: Sequence[FrameLike], asked: Comparison, path: Path, title: str = ""
) -> Path:
    """The run, at least two frames, and the solution of DRAWN that ``asked`` names, as a PNG."""
    with style.look():
        made = style.figure(7.0, 4.2)
        axes = made.add_axes((0.11, 0.12, 0.86, 0.78))
        style.plot_axes(axes)
        DRAWN[asked.reference](axes, frames, asked)
        axes.set_title(title)
        axes.legend(loc="best", handlelength=1.6)
        return style.save(made, path)


def _channel(axes: Axes, frames: Sequence[FrameLike], asked: Comparison) -> None:
    given = dict(asked.parameters)
    width, viscosity = given["width"], given["viscosity"]
    drive = given["acceleration" if asked.reference == "poiseuille" else "speed"]
    y = np.linspace(0.0, width, 200)

    def series(time: float) -> FloatArray:
        if asked.reference == "poiseuille":
            return references.poiseuille(
                y, time, width=width, viscosity=viscosity, acceleration=drive
            )
        return references.couette(y, time, width=width, viscosity=viscosity, speed=drive)

    flow = [float(np.mean(series(frame.time))) for frame in frames]
    for k, i in enumerate(_even(flow)):
        frame, u = frames[i], series(frames[i].time)
        x, velocity = fluid(frame, "velocity")
        height = x[:, 1] - given.get("origin", 0.0)
        _particles(axes, velocity[:, 0], height, first=k == 0)
        label = "series (Morris et al. 1997)" if k == 0 else None
        axes.plot(u, y, color=style.REFERENCE, label=label, zorder=3)
        middle = len(y) // 2
        axes.annotate(
            f"{frame.time:.3g} s",
            (u[middle], y[middle]),
            textcoords="offset points",
            xytext=(-6, 0),
            fontsize=8,
            color=style.INK,
            ha="right",
            va="center",
        )
    axes.set_xlabel("velocity along the channel [m/s]")
    axes.set_ylabel("y [m]")
    axes.ticklabel_format(style="sci", scilimits=(-3, 4), useMathText=True)
    axes.margins(x=0.08)


def _even(flow: Sequence[float]) -> list[int]:
    """Indices where the flow has gained even shares of its last value: profiles lie apart."""
    gained = np.asarray(flow) / (flow[-1] or 1.0)
    shares = (np.arange(SHOWN) + 1.0) / SHOWN
    # the first frame that comes within 1 % of a share; a flow at rest has only its last frame
    found = {int(np.argmax(gained >= 0.99 * share)) for share in shares}
    return sorted(found - {0} or {len(flow) - 1})


def _still(axes: Axes, frames: Sequence[FrameLike], asked: Comparison) -> None:
    given = dict(asked.parameters)
    surface, bottom = given["surface"], given.get("bottom", 0.0)
    x, pressure = fluid(frames[-1], "pressure")
    _particles(axes, pressure / 1000.0, x[:, -1], first=True)
    height = np.array([bottom, surface])
    exact = references.hydrostatic_pressure(
        height, surface=surface, density=given["density"], gravity=given["gravity"]
    )
    axes.plot(exact / 1000.0, height, color=style.REFERENCE, label="hydrostatic", zorder=3)
    axes.set_xlabel(f"pressure [kPa] at t = {frames[-1].time:.3g} s")
    axes.set_ylabel("height [m]")


def _decay(axes: Axes, frames: Sequence[FrameLike], asked: Comparison) -> None:
    given = dict(asked.parameters)
    rate = references.taylor_green_decay_rate(given["viscosity"], given["length"])
    some = [frames[0], *(frames[i] for i in spread(frames, 40))]
    time = np.array([f.time for f in some])
    speed = np.array([np.sqrt(np.mean(np.sum(fluid(f, "velocity")[1] ** 2, axis=1))) for f in some])
    exact_time = np.linspace(time[0], time[-1], 200)
    axes.plot(time, speed / speed[0], "o", ms=3.5, color=style.RUN, label="kolk")
    exact = np.exp(rate * (exact_time - time[0]))
    axes.plot(exact_time, exact, color=style.REFERENCE, label=r"exact, $e^{-8\pi^2\nu t/L^2}$")
    axes.set_yscale("log")
    for which in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        which(FuncFormatter(lambda value, _: f"{value:.3g}"))
    axes.set_xlabel("t [s]")
    axes.set_ylabel("velocity (RMS) / its start")


def _wave(axes: Axes, frames: Sequence[FrameLike], asked: Comparison) -> None:
    wave = wave_of(dict(asked.parameters))
    bed = asked.parameters.get("bed", 0.0)
    time = np.array([frame.time for frame in frames])
    share = np.array([mode_share(frame, wave, bed) for frame in frames])
    axes.plot(time, share, "o", ms=3.5, color=style.RUN, label="kolk")
    exact_time = np.linspace(time[0], time[-1], 400)
    exact = np.exp(wave.damping * exact_time) * np.cos(wave.frequency * exact_time)
    axes.plot(exact_time, exact, color=style.REFERENCE, label="linear wave with viscosity")
    axes.set_xlabel("t [s]")
    axes.set_ylabel("share of the wave in the velocity")


def _drop(axes: Axes, frames: Sequence[FrameLike], asked: Comparison) -> None:
    drop = drop_of(dict(asked.parameters))
    time = np.array([frame.time for frame in frames])
    rate = np.array([strain(frame) for frame in frames])
    exact_time = np.linspace(time[0], time[-1], 400)
    exact = np.exp(-drop.damping * exact_time) * np.cos(drop.frequency * exact_time)
    axes.plot(time, rate / rate[0], "o", ms=3.5, color=style.RUN, label="kolk")
    axes.plot(exact_time, exact, color=style.REFERENCE, label="small oscillations, Rayleigh 1879")
    axes.set_xlabel("t [s]")
    axes.set_ylabel("rate of strain / its start")


def _particles(axes: Axes, value: FloatArray, height: FloatArray, *, first: bool) -> None:
    axes.plot(
        value,
        height,
        ".",
        ms=3.5,
        color=style.RUN,
        alpha=0.5,
        mew=0,
        rasterized=True,
        label="kolk, particles" if first else None,
    )


DRAWN: dict[str, Callable[[Axes, Sequence[FrameLike], Comparison], None]] = {
    "poiseuille": _channel,
    "CapillaryDrop": _drop,
    "standing_wave": _wave,
    "couette": _channel,
    "hydrostatic_pressure": _still,
    "taylor_green": _decay,
}
"""How each analytic solution is drawn, by its name in :mod:`kolk.references`."""
