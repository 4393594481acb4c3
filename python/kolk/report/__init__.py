"""One HTML file about a run or a study, that opens anywhere without a network.

`page` is the frame of the file, `run_page` and `study_page` are its contents, `probes` its curves.
"""

from __future__ import annotations

from pathlib import Path

from kolk.errors import RunError
from kolk.output.atomic import write_text
from kolk.output.folder import newest_folder
from kolk.study.store import STUDIES


def report(folder: str | Path, out: str | Path | None = None, *, effects: float = 0.0) -> Path:
    """Writes the report of a run or of a study, and returns its path.

    folder: of a run or a study, or its name under `runs/` or `studies/`. out: the file; without it
    `report.html` in the folder. effects: seconds to measure what each effect of a run costs on
    this machine; 0 for not. Raises `RunError` where there is neither.
    """
    place = Path(folder)
    if not place.is_dir():
        found = newest_folder(str(folder))
        named = STUDIES / str(folder)
        place = found.path if found is not None else named if named.is_dir() else place
    if (place / "study.json").is_file():
        from kolk.study.study import open_study

        from .study_page import study_page

        text = study_page(open_study(place))
    elif (place / "scene.toml").is_file():
        from kolk.results import Run

        from .run_page import run_page

        text = run_page(Run(place), effects)
    else:
        raise RunError(
            f"{folder} is neither the folder of a run nor of a study: give one such as "
            "runs/dam-break or studies/dam-break"
        )
    path = Path(out) if out is not None else place / "report.html"
    write_text(path, text, "write the report")
    return path


__all__ = ["report"]
