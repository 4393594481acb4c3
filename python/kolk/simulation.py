"""A scene in motion: the engine behind a small Python class whose loop belongs to the user."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kolk.errors import KolkError

if TYPE_CHECKING:
    from kolk import _core
    from kolk.scene import Body, Scene

Floats = NDArray[np.float64]
Precision = Literal["f64", "mixed"]

DEFAULT_PRECISION: Precision = "mixed"
"""Precision where none is asked for. "mixed" keeps positions in f64 and computes pairs in f32."""

PRECISIONS: tuple[Precision, ...] = ("f64", "mixed")


@dataclass(frozen=True)
class Energy:
    """The energy budget of the fluid at one time, J (in 2D per metre of depth).

    kinetic, potential (of gravity), compression (elastic). dissipated: what each effect has turned
    into heat since the start, by its name.
    """

    kinetic: float
    potential: float
    compression: float
    dissipated: Mapping[str, float] = field(default_factory=dict)

    @property
    def total(self) -> float:
        """Kinetic, potential and compression energy together, J."""
        return self.kinetic + self.potential + self.compression


class BodyView:
    """A body of a running simulation; its attributes are NumPy arrays of the present time.

    The order of the particles is stable: row i is the same particle at every time (`id`). Each
    access gives a copy of its own: writing to it changes nothing in the simulation.
    """

    def __init__(self, simulation: Simulation, name: str, kind: str) -> None:
        self._simulation = simulation
        self.name = name
        self.kind = kind
        """ "fluid" or "wall"."""
        self._kept: Mapping[str, NDArray[Any]] = {}
        self._at = (-1, -1.0)

    @property
    def position(self) -> Floats:
        """(n, D), m."""
        return self._array("position")

    @property
    def velocity(self) -> Floats:
        """(n, D), m/s."""
        return self._array("velocity")

    @property
    def density(self) -> Floats:
        """(n,), kg/m³."""
        return self._array("density")

    @property
    def pressure(self) -> Floats:
        """(n,), Pa; on a wall the pressure extrapolated from the fluid."""
        return self._array("pressure")

    @property
    def mass(self) -> Floats:
        """(n,), kg (in 2D per metre of depth)."""
        return self._array("mass")

    @property
    def id(self) -> NDArray[np.int64]:
        """(n,), the order in which the particles were given."""
        return self._array("id")

    def arrays(self) -> Mapping[str, NDArray[Any]]:
        """All arrays by name, read at once."""
        return dict(self._simulation._engine.body(self.name))

    def __len__(self) -> int:
        return len(self._simulation.initial[self.name].mass)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name!r}: {len(self)} particles>"

    def _array(self, name: str) -> NDArray[Any]:
        # The engine gathers all columns at once: keep them for the next one of the same moment.
        engine = self._simulation._engine
        now = (int(engine.step_count), float(engine.time))
        if self._at != now:
            self._kept, self._at = self.arrays(), now
        return self._kept[name].copy()


def make_engine(
    config: Mapping[str, Any], bodies: Sequence[Body], precision: Precision, threads: int
) -> _core.Simulation:
    """The engine for a configuration (`kolk.scene.engine`) and its bodies."""
    from kolk import _core

    arrays = [(b.name, b.kind, b.position, b.velocity, b.density, b.mass) for b in bodies]
    surfaces = [(b.name, b.surface) for b in bodies if b.surface is not None]
    return _core.Simulation(json.dumps(config), arrays, precision, threads, surfaces)


class Bodies(Mapping[str, BodyView]):
    """The bodies of a simulation by name, in the scene's order."""

    def __init__(self, views: Sequence[BodyView]) -> None:
        self._views = {view.name: view for view in views}

    def __getitem__(self, name: str) -> BodyView:
        try:
            return self._views[name]
        except KeyError:
            known = ", ".join(map(repr, self._views))
            raise KeyError(f"there is no body {name!r}; the scene has {known}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._views)

    def __len__(self) -> int:
        return len(self._views)


class Simulation:
    """Particles of a scene, advanced by the engine.

    ```python
    sim = kolk.Simulation(kolk.load("dam-break"), precision="mixed", threads=2)
    while sim.time < 1.0:
        sim.advance(0.01)
        print(sim.time, sim.energy.kinetic, sim.bodies["water"].velocity.max())
    ```

    precision: "f64", or "mixed" (positions f64, pair arithmetic f32 relative to the cell).
    threads: 0 takes every core. The result has the same bits for every number of threads.
    Raises `SceneError` for a scene that cannot be filled, `KolkError` for an unknown precision or
    a negative number of threads.
    """

    def __init__(
        self, scene: Scene, *, precision: Precision = DEFAULT_PRECISION, threads: int = 0
    ) -> None:
        from kolk.scene.engine import engine_config

        if precision not in PRECISIONS:
            raise KolkError(f'precision: {precision!r} is not known; choose "f64" or "mixed"')
        if isinstance(threads, bool) or not isinstance(threads, int) or threads < 0:
            raise KolkError(
                f"threads: {threads!r} is not a number of threads; give 1 or more, or 0 for all"
            )
        bodies = scene.bodies()
        self.scene = scene
        self.initial = MappingProxyType({body.name: body for body in bodies})
        """The bodies as the scene filled them, by name."""
        self._engine = make_engine(engine_config(scene), bodies, precision, threads)
        self.bodies = Bodies([BodyView(self, body.name, body.kind) for body in bodies])

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return float(self._engine.time)

    @property
    def step_count(self) -> int:
        """Steps taken since the start."""
        return int(self._engine.step_count)

    @property
    def time_step(self) -> float:
        """The last time step, s (before the first: the one that will be tried)."""
        return float(self._engine.time_step)

    @property
    def limit(self) -> str:
        """What set the last time step: acoustic, viscous, force, fixed, output or guard."""
        return str(self._engine.limit)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return int(self._engine.dimension)

    @property
    def precision(self) -> str:
        """ "f64" or "mixed"."""
        return str(self._engine.precision)

    @property
    def threads(self) -> int:
        """Threads in use."""
        return int(self._engine.threads)

    @property
    def particles(self) -> dict[str, int]:
        """Number of particles by kind: "fluid" and "wall"."""
        return {str(kind): int(count) for kind, count in self._engine.particles.items()}

    def advance(self, duration: float, max_steps: int | None = None) -> int:
        """Advances by `duration` (s); returns the steps taken. See `advance_to`."""
        return self.advance_to(self.time + duration, max_steps)

    def advance_to(self, time: float, max_steps: int | None = None) -> int:
        """Advances to exactly `time` (s), or by `max_steps` steps if they end before it.

        The interpreter is released meanwhile. Ctrl-C ends it between two steps with
        KeyboardInterrupt; the state is whole and the simulation can go on. Returns the steps taken.
        Raises `InstabilityError` where the run cannot go on, `KolkError` for a time that is not
        finite.
        """
        if not np.isfinite(time):
            raise KolkError(f"time: {time!r} is not a time to advance to; give finite seconds")
        return int(self._engine.advance_to(float(time), max_steps))

    @property
    def diagnostics(self) -> dict[str, Any]:
        """Sums and extremes of the present state, as the engine reports them.

        time, kinetic_energy, potential_energy, compression_energy, momentum, angular_momentum,
        density_min, density_max, speed_max, mach, pressure_min, pressure_max, closest_pair (in
        spacings), leaks (particles brought back from behind a wall), dissipated. SI units; in 2D
        per metre of depth.
        """
        return dict(self._engine.diagnostics())

    @property
    def energy(self) -> Energy:
        """The energy budget of the fluid, J (in 2D per metre of depth)."""
        now = self._engine.diagnostics()
        return Energy(
            kinetic=float(now["kinetic_energy"]),
            potential=float(now["potential_energy"]),
            compression=float(now["compression_energy"]),
            dissipated={str(k): float(v) for k, v in dict(now["dissipated"]).items()},
        )

    @property
    def momentum(self) -> Floats:
        """(D,), momentum of the fluid, kg m/s (in 2D per metre of depth)."""
        return np.asarray(self._engine.diagnostics()["momentum"], dtype=np.float64)

    @property
    def angular_momentum(self) -> Floats:
        """(1,) in 2D, (3,) in 3D: angular momentum about the origin, kg m²/s."""
        return np.asarray(self._engine.diagnostics()["angular_momentum"], dtype=np.float64)

    @property
    def leaks(self) -> int:
        """Particles found more than a tenth of a spacing behind a wall since the start, and brought
        back: 0 in a sound run."""
        return int(self._engine.diagnostics()["leaks"])

    @property
    def timings(self) -> dict[str, dict[str, float]]:
        """Time by phase of the step: phase -> {"seconds", "calls"}."""
        return {
            str(phase): {"seconds": float(entry["seconds"]), "calls": int(entry["calls"])}
            for phase, entry in self._engine.timings().items()
        }

    @property
    def steps_by_limit(self) -> dict[str, int]:
        """How many steps each criterion has set."""
        return {str(k): int(v) for k, v in self._engine.steps_by_limit().items()}

    @property
    def retries(self) -> dict[str, Any]:
        """What the guard did (see `numerics.guard`).

        retries: how often each trouble made it go back to a state kept in memory and on with half
        the time step; passed: how often a trouble that leaves the state sound was let pass, since
        a shorter step did not help; undone: steps taken back; kept: time (s) of the state that is
        kept now, None without guard. `step_count` and `time` go back as well; a time that
        `advance_to` has reached is never taken back.
        """
        return dict(self._engine.retries())

    @property
    def effects(self) -> list[dict[str, Any]]:
        """Every effect that kolk knows, on or off, as dicts.

        name, what it does, on, why (the key that asks for it, what calls for it, or why it is left
        out), where it stands in the step, columns and bytes_per_particle that only it needs,
        dt_limit. `kolk.explain` adds what each costs.
        """
        from kolk.explain.catalogue import described

        return [described(self.scene, effect) for effect in self._engine.effects()]

    @property
    def memory(self) -> dict[str, int]:
        """Bytes that the engine holds, by group."""
        return {str(group): int(size) for group, size in self._engine.memory().items()}

    @property
    def mach_warning(self) -> bool:
        """Whether the Mach number has left the weakly compressible range (0.1)."""
        return bool(self._engine.mach_warning)

    def sample(self, points: ArrayLike, fields: Sequence[str]) -> dict[str, Floats]:
        """Fluid fields at points: (m, D) positions -> field -> (m,) or (m, D).

        fields: "pressure" (Pa, corrected hydrostatically to the point), "velocity", "density", and
        "fill" (Σ V W, not normalised: about 1 inside, 0.5 at a surface), 0 where no fluid is near;
        and "wall_fill", the same sum over the particles of walls.
        """
        place = np.ascontiguousarray(points, dtype=np.float64)
        return {name: np.asarray(v) for name, v in self._engine.sample(place, list(fields)).items()}

    def force(self, body: str) -> dict[str, Floats]:
        """Force (D,) (N) and moment (1,) or (3,) about the origin (N m) of the fluid on a wall."""
        found = self._engine.force(self.bodies[body].name)
        return {name: np.asarray(value, dtype=np.float64) for name, value in found.items()}

    def pose(self, body: str) -> tuple[Floats, Floats]:
        """Rotation (D, D) and displacement (D,) in m of a wall since the start.

        What was at X is now at rotation @ X + displacement.
        """
        found = self._engine.pose(self.bodies[body].name)
        if found is None:
            return np.eye(self.dimension), np.zeros(self.dimension)
        return np.asarray(found[0]), np.asarray(found[1])

    def state(self) -> dict[str, Any]:
        """The exact state, for `restore`: names to arrays, numbers and strings."""
        return dict(self._engine.state())

    def restore(self, state: Mapping[str, Any]) -> None:
        """Takes over a state of the same scene; what follows has the same bits."""
        self._engine.restore(dict(state))
        for view in self.bodies.values():
            view._at = (-1, -1.0)

    def __repr__(self) -> str:
        counts = " + ".join(f"{n} {kind}" for kind, n in self.particles.items() if n)
        return f"<kolk.Simulation {self.scene.name!r}: t = {self.time:g} s, {counts} particles>"
