"""One run of a study as a parcel: everything that it depends on, and the key that it is kept by."""

from __future__ import annotations

import hashlib
import os
import tempfile
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from kolk.simulation import DEFAULT_PRECISION, Precision

if TYPE_CHECKING:
    from kolk.scene import Scene

SCENE = "scene.toml"

RESULT_PARTS = ("scene", "compare", "references", "study", "output")
"""Folders of the package that a run's figures depend on, beside its single files."""


@dataclass(frozen=True)
class Job:
    """A run to measure. It can be pickled, and needs no file of this machine."""

    name: str
    spacing: float
    """m"""
    files: dict[str, bytes] = field(repr=False)
    """The complete scene as `scene.toml`, and its own particles beside it."""
    precision: Precision
    threads: int
    """Never 0: what every core is depends on the machine."""

    @property
    def key(self) -> str:
        """Content hash of the scene, the package, the precision and the threads.

        The machine counts too, because times are kept with the figures.
        """
        digest = hashlib.sha256()
        for part in (package_digest(), machine_name(), self.precision, str(self.threads)):
            digest.update(part.encode() + b"\0")
        for name in sorted(self.files):
            digest.update(name.encode() + b"\0" + self.files[name] + b"\0")
        return digest.hexdigest()[:24]

    def unpack(self, folder: Path) -> Path:
        """Writes the files into a folder and returns the scene's."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in self.files.items():
            (folder / name).write_bytes(content)
        return folder / SCENE


def make_job(scene: Scene, precision: Precision | None, threads: int) -> Job:
    """The job of a scene. Raises `SceneError` where the scene cannot be filled or written."""
    with tempfile.TemporaryDirectory(prefix="kolk-job-") as folder:
        scene.save(Path(folder) / SCENE)
        files = {p.name: p.read_bytes() for p in sorted(Path(folder).iterdir())}
    return Job(
        name=scene.name,
        spacing=scene.spacing,
        files=files,
        precision=precision or DEFAULT_PRECISION,
        threads=threads or cores(),
    )


def cores() -> int:
    """Cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


@cache
def package_digest() -> str:
    """Hash of the version, the engine and the sources: another kolk may have other figures."""
    from kolk import _core
    from kolk.output.summary import version

    digest = hashlib.sha256(version().encode())
    package = Path(__file__).parents[1]
    sources = sorted(package.glob("*.py"))
    for folder in RESULT_PARTS:
        sources += sorted((package / folder).glob("**/*.py"))
    if _core.__file__ is not None:
        sources.append(Path(_core.__file__))
    for source in sources:
        # In pieces: the engine may be large, and the peak of memory is measured.
        with source.open("rb") as file:
            content = hashlib.sha256()
            while piece := file.read(1 << 16):
                content.update(piece)
        digest.update(content.digest())
    return digest.hexdigest()


@cache
def machine_name() -> str:
    """The processor and its cores."""
    from kolk.output.summary import machine

    about = machine()
    return f"{about['processor']}, {cores()} cores"
