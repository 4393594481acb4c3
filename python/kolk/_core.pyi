"""The compiled engine: the simulation, and SPH's building blocks on NumPy arrays."""

from collections.abc import Sequence
from typing import Any, Literal, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Kernel",
    "Simulation",
    "__version__",
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
    "peak_flops",
    "simd_level",
    "tait_density",
    "tait_pressure",
]

__version__: str

_Floats: TypeAlias = NDArray[np.float64]
_Periods: TypeAlias = Sequence[Sequence[float] | None] | None
_KernelName: TypeAlias = Literal["wendland-c2", "wendland-c4", "wendland-c6", "cubic", "quintic"]
_Body: TypeAlias = tuple[str, Literal["fluid", "wall"], _Floats, _Floats, _Floats, _Floats]

@final
class Kernel:
    @property
    def name(self) -> str: ...
    @property
    def dim(self) -> int: ...
    @property
    def support(self) -> float: ...
    @overload
    def value(self, r: float, h: float) -> float: ...
    @overload
    def value(self, r: ArrayLike, h: float) -> _Floats: ...
    @overload
    def gradient(self, r: float, h: float) -> float: ...
    @overload
    def gradient(self, r: ArrayLike, h: float) -> _Floats: ...

def peak_flops(precision: str, threads: int = 0, seconds: float = 0.3) -> float: ...
def simd_level() -> str: ...
def kernel(name: _KernelName | str, dim: int) -> Kernel: ...
def neighbours(
    position: ArrayLike, radius: float, periodic: _Periods = None
) -> tuple[NDArray[np.int64], NDArray[np.uint32]]: ...
def all_pairs(
    position: ArrayLike, radius: float, periodic: _Periods = None
) -> tuple[NDArray[np.int64], NDArray[np.uint32]]: ...
@overload
def tait_pressure(
    density: float, reference_density: float, sound_speed: float, gamma: float = 7.0
) -> float: ...
@overload
def tait_pressure(
    density: ArrayLike, reference_density: float, sound_speed: float, gamma: float = 7.0
) -> _Floats: ...
@overload
def tait_density(
    pressure: float, reference_density: float, sound_speed: float, gamma: float = 7.0
) -> float: ...
@overload
def tait_density(
    pressure: ArrayLike, reference_density: float, sound_speed: float, gamma: float = 7.0
) -> _Floats: ...
def interpolate(
    points: ArrayLike,
    position: ArrayLike,
    value: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    normalise: bool = True,
    outside: float = 0.0,
    periodic: _Periods = None,
) -> _Floats: ...
def gradient(
    position: ArrayLike,
    value: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    correct: bool = True,
    periodic: _Periods = None,
) -> _Floats: ...
def divergence(
    position: ArrayLike,
    value: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    correct: bool = True,
    periodic: _Periods = None,
) -> _Floats: ...
def laplacian(
    position: ArrayLike,
    value: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    correct: bool = True,
    periodic: _Periods = None,
) -> _Floats: ...
def density_diffusion(
    position: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    sound_speed: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    form: Literal["antuono", "molteni", "fourtakas"] = "antuono",
    delta: float = 0.1,
    gravity: ArrayLike | None = None,
    reference_density: float | None = None,
    gamma: float = 7.0,
    periodic: _Periods = None,
) -> _Floats: ...
def particle_shift(
    position: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    spacing: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    form: Literal["sun", "lind"] = "sun",
    time_step: float | None = None,
    speed: float | None = None,
    free_surface: bool = True,
    periodic: _Periods = None,
) -> _Floats: ...
def free_surface(
    position: ArrayLike,
    mass: ArrayLike,
    density: ArrayLike,
    h: float,
    kernel: _KernelName | str = "wendland-c2",
    *,
    periodic: _Periods = None,
) -> tuple[NDArray[np.bool_], _Floats, _Floats]: ...

@final
class Simulation:
    def __new__(
        cls,
        config_json: str,
        bodies: Sequence[_Body],
        precision: str,
        threads: int,
        surfaces: Sequence[tuple[str, _Floats]] = ...,
    ) -> Simulation: ...
    @property
    def time(self) -> float: ...
    @property
    def step_count(self) -> int: ...
    @property
    def time_step(self) -> float: ...
    @property
    def limit(self) -> str: ...
    @property
    def dimension(self) -> int: ...
    @property
    def particles(self) -> dict[str, int]: ...
    @property
    def threads(self) -> int: ...
    @property
    def precision(self) -> str: ...
    @property
    def mach_warning(self) -> bool: ...
    def advance_to(self, time: float, max_steps: int | None = None) -> int: ...
    def body(self, name: str) -> dict[str, NDArray[Any]]: ...
    def state(self) -> dict[str, Any]: ...
    def restore(self, state: dict[str, Any]) -> None: ...
    def diagnostics(self) -> dict[str, Any]: ...
    def timings(self) -> dict[str, dict[str, float | int]]: ...
    def steps_by_limit(self) -> dict[str, int]: ...
    def retries(self) -> dict[str, Any]: ...
    def sample(self, points: ArrayLike, fields: Sequence[str]) -> dict[str, _Floats]: ...
    def force(self, body: str) -> dict[str, _Floats]: ...
    def pose(self, body: str) -> tuple[_Floats, _Floats] | None: ...
    def memory(self) -> dict[str, int]: ...
    def effects(self) -> list[dict[str, Any]]: ...
