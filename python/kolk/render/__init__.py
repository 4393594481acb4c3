"""Pictures and films of a finished run, from what the run left behind.

:func:`render_run` draws everything that suits a run; :func:`missing` says what this machine lacks.
Nothing here opens a window or changes Matplotlib's settings.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kolk.compare.records import RunLike

_LIBRARIES = {"imageio_ffmpeg": "films as mp4 (without it: gif)"}
_LIBRARIES_3D = {
    "pyvista": "free surfaces of three-dimensional runs (without it: particles)",
    "pysplashsurf": "free surfaces of three-dimensional runs (without it: particles)",
}


def missing(dimension: int = 3) -> list[str]:
    """One line per picture library that a run of this dimension would use and that is not
    installed: what it draws and how to install it."""
    wanted = {**_LIBRARIES, **(_LIBRARIES_3D if dimension == 3 else {})}
    return [
        f"{name.replace('_', '-')} is not installed: it draws {what}; "
        "install it with  pip install 'kolk[pictures]'"
        for name, what in wanted.items()
        if find_spec(name) is None
    ]


def render_run(run: RunLike, film: bool = True, *, quiet: bool = False) -> list[Path]:
    """Draws a run into ``run.folder / "pictures"`` and returns the files made.

    ``flow.png`` (the flow at four times), ``pressure.png`` (pressures against their references,
    where the case has some), ``probe-NAME.png`` each, the fields of the last frame, and
    ``film.mp4`` or ``film.gif``. A bar on standard error shows progress after two seconds unless
    ``quiet``.
    """
    from .studio import Studio

    return Studio(run, quiet=quiet).draw(film=film)


__all__ = ["missing", "render_run"]
