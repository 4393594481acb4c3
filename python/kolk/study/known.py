"""What earlier studies say of a scene: its error at a spacing."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

from kolk.errors import KolkError

from .job import machine_name, package_digest
from .store import STUDIES

if TYPE_CHECKING:
    from kolk.scene import Scene

    from .estimate import Interval
    from .study import Study


def study_of(scene: Scene, root: Path | None = None) -> Study | None:
    """The best study of this very scene (its spacing apart) under `studies/`, or None."""
    from .study import open_study

    place = root or STUDIES
    if not place.is_dir():
        return None
    newest = sorted(place.glob("*/study.json"), key=lambda path: path.stat().st_mtime, reverse=True)
    found: list[Study] = []
    for path in newest:
        try:
            # Of another version or another machine it would promise what is no longer true.
            about = json.loads(path.read_text(encoding="utf-8"))
            if (about.get("machine"), about.get("package")) != (machine_name(), package_digest()):
                continue
            study = open_study(path.parent)
            if same_scene(study.scene, scene) and study.base.records:
                found.append(study)
        except (KolkError, OSError, ValueError):
            continue  # broken, or without its runs: as good as none
    # The one that knows most about settings; among equals the newest.
    return max(found, key=lambda study: len(study.variants), default=None)


def same_scene(one: Scene, other: Scene) -> bool:
    """Whether two scenes differ in their spacing and their output at most."""
    spacing = one.spacing
    try:
        changed = other.replace(spacing=spacing)
        return _complete(one) == _complete(changed)
    except KolkError:
        return False


def _complete(scene: Scene) -> object:
    data = scene.model_dump(exclude_none=True)
    data.pop("output", None)
    return repr(data)


def expected_error(scene: Scene, spacing: float) -> tuple[Interval | None, str]:
    """The error to expect with its interval, and what it is of; None without a study."""
    from .estimate import Interval

    study = study_of(scene)
    if study is None:
        return None, ""
    curve = study.curve()
    value, most = curve.expected(spacing), curve.promised(spacing)
    if not (math.isfinite(value) and math.isfinite(most)):
        return None, ""
    least = curve.law.interval(spacing)[0] if curve.basis != "extrapolation" and curve.law else 0.0
    return Interval(value, least, most), curve.name
