"""One look for every picture: colours, letters, scales of colour, and how a picture is saved.

Figures are built through Matplotlib's objects on the Agg canvas, never through pyplot, so that the
windows and settings of a user's session stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Colormap, ListedColormap
from matplotlib.figure import Figure

from kolk.output.atomic import replacing

INK = "#1d2b3a"
"""Text and axes."""
QUIET = "#66727f"
"""Secondary text, ticks."""
GRID = "#e3e7eb"
WALL = "#8d97a2"
RUN = "#0b5fa5"
"""The run's own curve."""
REFERENCE = "#d1495b"
"""The experiment's or the exact curve."""
BAND = "#f3c9ce"
SECOND = "#7a5195"
"""A further reference, such as another code's curve."""

DPI = 150

_LOOK: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "text.color": INK,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "grid.color": GRID,
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.4,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "mathtext.fontset": "dejavusans",
}


@contextmanager
def look() -> Iterator[None]:
    """Matplotlib's defaults with this style on top, whatever the session has set; undone after."""
    # backend settings stay: touching them could open or close the session's windows
    keep = ("backend", "interactive", "toolbar")
    settings: Any = {k: v for k, v in mpl.rcParamsDefault.items() if not k.startswith(keep)}
    settings |= _LOOK
    with mpl.rc_context(settings):
        yield


def figure(width: float, height: float, dpi: float = DPI) -> Figure:
    """An empty figure (inches) with its own Agg canvas. Call inside :func:`look`."""
    made = Figure(figsize=(width, height), dpi=dpi)
    FigureCanvasAgg(made)
    return made


def save(made: Figure, path: Path) -> Path:
    """Writes a PNG whole or not at all, and returns its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as part:
        made.savefig(part, format="png", dpi=made.dpi)
    return path


def bare(axes: Axes) -> None:
    """Axes for a picture of particles: no frame, quiet ticks, equal scales."""
    axes.set_aspect("equal")
    for spine in axes.spines.values():
        spine.set_visible(False)
    axes.tick_params(length=2.5, pad=2)


def plot_axes(axes: Axes) -> None:
    """Axes for curves: a quiet horizontal and vertical grid."""
    axes.grid(True)
    axes.tick_params(length=0)


def colours(field: str) -> Colormap:
    """Colour map of a field: perceptually uniform, lightness rising with the value."""
    return _depths() if field == "speed" else mpl.colormaps["viridis"]


@cache
def _depths() -> ListedColormap:
    """Night blue to pale green: equal steps in OKLab, so equal steps to the eye."""
    corners = np.array(
        [
            # lightness, green-red, blue-yellow
            [0.27, -0.012, -0.085],
            [0.43, -0.038, -0.122],
            [0.60, -0.076, -0.085],
            [0.77, -0.100, -0.020],
            [0.94, -0.055, 0.055],
        ]
    )
    steps = np.linspace(0.0, 1.0, 256)
    knots = np.linspace(0.0, 1.0, len(corners))
    from scipy.interpolate import PchipInterpolator

    return ListedColormap(_oklab_to_srgb(PchipInterpolator(knots, corners)(steps)), name="depths")


def _oklab_to_srgb(lab: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """OKLab (n, 3) to sRGB (n, 3) in 0..1. Source: B. Ottosson, A perceptual color space (2020)."""
    to_lms = np.array(
        [
            [1.0, 0.3963377774, 0.2158037573],
            [1.0, -0.1055613458, -0.0638541728],
            [1.0, -0.0894841775, -1.2914855480],
        ]
    )
    to_rgb = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    linear = np.clip((lab @ to_lms.T) ** 3 @ to_rgb.T, 0.0, 1.0)
    curved = (
        1.055 * np.power(linear, 1.0 / 2.4, where=linear > 0, out=np.zeros_like(linear)) - 0.055
    )
    return np.asarray(np.clip(np.where(linear <= 0.0031308, 12.92 * linear, curved), 0.0, 1.0))
