"""Numbers that are none, put into any array at any step."""

from __future__ import annotations

import numpy as np

import kolk
from kolk.errors import ArrayError, InstabilityError, KolkError, SceneError

from ..suite import Case, Figure, Result
from ..watching import number, simulation


def scene() -> kolk.Scene:
    """A small dam break."""
    return kolk.load("dam-break").replace(spacing=0.03)


def injected(step: int) -> tuple[int, list[str], int]:
    """How many injections there were, which were not named, and numbers left that are none."""
    sim = simulation(scene())
    sim.advance_to(1e9, step)
    good, random = sim.state(), np.random.default_rng(step)
    tried, missed, left = 0, [], 0
    for name, column in good.items():
        if name.startswith("guard") or column.dtype.kind != "f" or len(column) < 20:
            continue
        if name == "budget":  # of no particle: not taken over in the first place
            missed += not_refused(sim, good, name)
            continue
        for value in (np.nan, np.inf, -np.inf):
            state = dict(good)
            state[name] = column.copy()
            at = int(random.integers(len(column)))
            state[name][at] = value
            tried += 1
            try:
                sim.restore(state)
                sim.advance_to(1e9, 1)
                missed.append(f"{name} = {value}")
            except InstabilityError as error:
                whose = None if name.startswith("wall") else int(good["id"][at])
                named = error.step == step and not np.isfinite(error.value or 0.0)
                if not named or (whose is not None and error.particle != whose):
                    missed.append(f"{name} = {value}: {error}")
                after = sim.state().values()
                left += sum(int((~np.isfinite(v)).sum()) for v in after if v.dtype.kind == "f")
            sim.restore(good)
    return tried, missed, left


def not_refused(sim: kolk.Simulation, good: dict[str, np.ndarray], name: str) -> list[str]:
    """The injections into a column that were taken over."""
    taken = []
    for value in (np.nan, np.inf):
        state = dict(good)
        state[name] = good[name].copy()
        state[name][-1] = value
        try:
            sim.restore(state)
            taken.append(f"{name} = {value}")
        except KolkError:
            pass
        sim.restore(good)
    return taken


def refused() -> int:
    """How many scenes that make no sense were not refused."""
    base = {"name": "bad", "dimension": 2, "spacing": 0.02, "until": 1.0}
    x = np.array([[0.0, 0.0], [0.02, 0.0], [0.0, 0.02], [0.02, 0.02]])
    accepted = 0
    for columns in (
        {"position": x, "mass": np.array([1.0, -1.0, 1.0, 1.0])},
        {"position": x, "mass": np.array([1.0, 0.0, 1.0, 1.0])},
        {"position": x, "density": np.array([1000.0, np.nan, 1000.0, 1000.0])},
        {"position": np.where(x > 0.01, np.inf, x)},
        {"position": np.zeros((0, 2))},
    ):
        try:
            fluid = kolk.Fluid.from_arrays(sound_speed=10.0, **columns)
            kolk.Simulation(kolk.Scene(**base, fluid=[fluid])).advance(0.01)
            accepted += 1
        except (SceneError, ArrayError):
            pass
    for keys in ({"spacing": 0.0}, {"spacing": -1.0}, {"until": 0.0}, {"smoothing_ratio": 0.0}):
        try:
            kolk.Scene(**(base | keys), fluid=[kolk.Fluid.from_arrays(position=x)])
            accepted += 1
        except KolkError:
            pass
    return accepted


def run(variant: str) -> Result:
    if variant == "scenes":
        return Result(variant, (Figure("scenes that should be refused", refused(), most=0),))
    tried, missed, left = injected(int(number(variant)))
    return Result(
        variant,
        (
            Figure("injections", tried, least=20),
            Figure("not named in the same step", len(missed), most=0),
            Figure("numbers left that are none", left, most=0),
        ),
    )


case = Case(
    title="Numbers that are none",
    setup="NaN and infinities in every array of the state at some step; negative masses, no "
    "spacing, empty arrays.",
    failure="they spread without a word",
    run=run,
    short=("step 0", "step 1", "step 40", "scenes"),
    full=("step 0", "step 1", "step 40", "step 100", "step 1000", "scenes"),
)
