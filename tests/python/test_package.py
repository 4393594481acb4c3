"""The package as installed: one version, a light import, types shipped."""

import importlib.metadata
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import kolk

ROOT = Path(__file__).parents[2]

HEAVY = {
    "PIL",
    "h5py",
    "imageio",
    "matplotlib",
    "pandas",
    "pydantic",
    "pysplashsurf",
    "pyvista",
    "rich",
    "scipy",
    "shapely",
    "tomlkit",
    "typer",
    "vtk",
    "vtkmodules",
}


def modules_after(statement: str) -> set[str]:
    """Names of all modules that a fresh interpreter has loaded after ``statement``."""
    code = f"{statement}\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))"
    # -I: neither the folder of the sources nor the user's environment decides what is imported.
    run = subprocess.run([sys.executable, "-I", "-c", code], capture_output=True, check=True)
    return set(json.loads(run.stdout))


def test_the_version_comes_from_cargo_toml_alone() -> None:
    manifest = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    package = manifest.split("[package]", 1)[1].split("\n[", 1)[0]
    declared = re.search(r'^version\s*=\s*"([^"]+)"', package, flags=re.MULTILINE)
    assert declared is not None
    assert kolk.__version__ == declared[1]
    assert importlib.metadata.version("kolk") == declared[1]
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert 'dynamic = ["version"]' in project


def test_import_loads_nothing_heavy() -> None:
    loaded = {name.partition(".")[0] for name in modules_after("import kolk")}
    assert not loaded & HEAVY


def test_import_is_small() -> None:
    extra = modules_after("import kolk, kolk._core") - modules_after("pass")
    own = {name for name in extra if not name.startswith("numpy")}
    assert len(own) < 250, sorted(own)


@pytest.mark.parametrize("name", sorted(kolk.__all__))
def test_every_public_name_resolves(name: str) -> None:
    assert getattr(kolk, name) is not None
    assert name in dir(kolk)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no_such_thing"):
        _ = kolk.no_such_thing


def test_types_are_shipped() -> None:
    package = Path(kolk.__file__).parent
    assert (package / "py.typed").is_file()
    assert (package / "_core.pyi").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows file names do not show the ABI")
def test_one_binary_serves_every_python() -> None:
    from kolk import _core

    assert _core.__file__ is not None
    assert ".abi3." in Path(_core.__file__).name


def test_the_command_is_installed() -> None:
    scripts = importlib.metadata.entry_points(group="console_scripts", name="kolk")
    assert [script.value for script in scripts] == ["kolk.cli:main"]


def test_the_licences_travel_with_the_package() -> None:
    metadata = importlib.metadata.metadata("kolk")
    assert metadata["License-Expression"] == "MIT OR Apache-2.0"
    assert metadata.get_all("License-File") == ["LICENSE-MIT", "LICENSE-APACHE"]
