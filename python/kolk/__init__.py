"""Smoothed particle hydrodynamics: a fast Rust engine driven from Python.

```python
import kolk

run = kolk.run("dam-break")                  # what `kolk run dam-break` does
run.probes["P2"]                             # pandas: time, value

sim = kolk.Simulation(kolk.load("dam-break"), threads=2)
while sim.time < 1.0:                        # or keep the loop to yourself
    sim.advance(0.01)
    sim.bodies["water"].pressure             # NumPy
```

Importing this package imports nothing else: every name below is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kolk._core import all_pairs as all_pairs
    from kolk._core import density_diffusion as density_diffusion
    from kolk._core import divergence as divergence
    from kolk._core import free_surface as free_surface
    from kolk._core import gradient as gradient
    from kolk._core import interpolate as interpolate
    from kolk._core import kernel as kernel
    from kolk._core import laplacian as laplacian
    from kolk._core import neighbours as neighbours
    from kolk._core import particle_shift as particle_shift
    from kolk._core import tait_density as tait_density
    from kolk._core import tait_pressure as tait_pressure
    from kolk.errors import ArrayError as ArrayError
    from kolk.errors import InstabilityError as InstabilityError
    from kolk.errors import KolkError as KolkError
    from kolk.errors import RunError as RunError
    from kolk.errors import SceneError as SceneError
    from kolk.execution import RunInterrupted as RunInterrupted
    from kolk.execution import RunStopped as RunStopped
    from kolk.results import Run as Run
    from kolk.results import open_run as open_run
    from kolk.runner import run as run
    from kolk.scene import Fluid as Fluid
    from kolk.scene import Probe as Probe
    from kolk.scene import Scene as Scene
    from kolk.scene import Wall as Wall
    from kolk.scene.load import load as load
    from kolk.simulation import Simulation as Simulation
    from kolk.study.estimate import Estimate as Estimate
    from kolk.study.estimate import estimate as estimate
    from kolk.study.study import Study as Study
    from kolk.study.study import accuracy as accuracy
    from kolk.study.study import open_study as open_study

_HOMES = {
    "kolk._core": (
        "all_pairs",
        "density_diffusion",
        "divergence",
        "free_surface",
        "gradient",
        "interpolate",
        "kernel",
        "laplacian",
        "neighbours",
        "particle_shift",
        "tait_density",
        "tait_pressure",
    ),
    "kolk.errors": ("ArrayError", "InstabilityError", "KolkError", "RunError", "SceneError"),
    "kolk.results": ("Run", "open_run"),
    "kolk.execution": ("RunInterrupted", "RunStopped"),
    "kolk.runner": ("run",),
    "kolk.scene": ("Fluid", "Probe", "Scene", "Wall", "load"),
    "kolk.simulation": ("Simulation",),
    "kolk.study.estimate": ("Estimate", "estimate"),
    "kolk.study.study": ("Study", "accuracy", "open_study"),
}
_HOME = {name: module for module, names in _HOMES.items() for name in names}

__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from kolk.output.summary import version

        value: Any = version()
    elif name in _HOME:
        value = getattr(import_module(_HOME[name]), name)
    else:
        raise AttributeError(f"module 'kolk' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
