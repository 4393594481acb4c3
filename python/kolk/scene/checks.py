"""What must hold between the parts of a scene: all that needs no particles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from kolk.errors import Problem, SceneError

from .automatic import FACETS
from .base import nearest, shown
from .expression import Expression
from .model import Scene
from .motion import Gravity
from .parts import Fluid, ForceProbe, FrontProbe, LevelProbe, Numerics, PressureProbe, Wall

MATERIAL = ("density", "sound_speed", "viscosity", "surface_tension", "drag", "eos", "gamma")


def check_consistency(scene: Scene) -> None:
    """Raise one SceneError with everything in which the parts of ``scene`` disagree."""
    # The later checks calculate with vectors: their lengths must be right.
    for checks in ((_names, _lengths), (_materials, _probes, _periods, _numerics)):
        problems = [problem for find in checks for problem in find(scene)]
        if problems:
            raise SceneError(problems=problems)


def _bodies(scene: Scene) -> Iterator[tuple[str, Fluid | Wall]]:
    for fluid in scene.fluid:
        yield "fluid", fluid
    for wall in scene.wall:
        yield "wall", wall


def _names(scene: Scene) -> Iterator[Problem]:
    groups: list[tuple[str, list[tuple[str, str]]]] = [
        ("body", [(table, body.name) for table, body in _bodies(scene)]),
        ("probe", [("probe", probe.name) for probe in scene.probe]),
    ]
    for what, entries in groups:
        seen: set[str] = set()
        for table, name in entries:
            if name.lower() in seen:
                yield Problem(
                    (table, name, "name"), f'found a second {what} "{name}": give each its own name'
                )
            seen.add(name.lower())


def _lengths(scene: Scene) -> Iterator[Problem]:
    d = scene.dimension

    def vector(path: tuple[str | int, ...], value: Sequence[Any] | None) -> Iterator[Problem]:
        if value is not None and len(value) != d:
            found = shown([v.text if isinstance(v, Expression) else v for v in value])
            yield Problem(path, f"found {found}, must have {d} numbers: the dimension is {d}")

    def expression(path: tuple[str | int, ...], value: Any) -> Iterator[Problem]:
        if isinstance(value, Expression) and d == 2 and "z" in value.names:
            yield Problem(path, f"found {value}: there is no z in 2D")

    if isinstance(scene.gravity, Gravity):
        for path, value in scene.gravity.vectors():
            yield from vector(("gravity", *path), value)
    else:
        yield from vector(("gravity",), scene.gravity)
    for wall in scene.wall:
        for path, value in [] if wall.motion is None else wall.motion.vectors():
            yield from vector(("wall", wall.name, "motion", *path), value)
    for table, body in _bodies(scene):
        here: tuple[str | int, ...] = (table, body.name)
        if body.shape is not None and d not in body.shape.shape.dimensions():
            own = " or ".join(f"{n}D" for n in sorted(body.shape.shape.dimensions()))
            yield Problem(
                (*here, "shape", body.shape.kind),
                f"is a shape in {own or 'no one dimension: its parts disagree'}, "
                f"but the scene's dimension is {d}",
            )
        if body.particles is not None and body.particles.dimension != d:
            yield Problem(
                (*here, "particles"),
                f"found positions in {body.particles.dimension}D, but the scene's dimension is {d}",
            )
        if isinstance(body.velocity, tuple):
            yield from vector((*here, "velocity"), body.velocity)
            for part in body.velocity:
                yield from expression((*here, "velocity"), part)
        if isinstance(body, Fluid):
            yield from expression((*here, "pressure"), body.pressure)
        if body.shape is not None and body.shape.function is not None:
            yield from expression((*here, "shape", "function", "value"), body.shape.function.value)
    for probe in scene.probe:
        here = ("probe", probe.name, probe.kind)
        yield from vector((*here, "at"), getattr(probe.what, "at", None))
        yield from vector((*here, "about"), getattr(probe.what, "about", None))
        yield from vector((*here, "direction"), getattr(probe.what, "direction", None))
        if d == 2 and isinstance(probe.what, FrontProbe) and probe.what.axis == "z":
            yield Problem((*here, "axis"), 'found "z", must be "x" or "y" in 2D')
    if scene.periodic is not None and d == 2 and scene.periodic.z is not None:
        yield Problem(("periodic", "z"), "there is no z in 2D: leave it out")


def _materials(scene: Scene) -> Iterator[Problem]:
    first = scene.fluid[0]
    for fluid in scene.fluid[1:]:
        for key in MATERIAL:
            if getattr(fluid, key) != getattr(first, key):
                yield Problem(
                    ("fluid", fluid.name, key),
                    f"differs from that of '{first.name}': all fluids of a scene share one "
                    "material; give both the same value",
                )
    if first.surface_tension is not None and not scene.free_surface:
        yield Problem(
            ("fluid", first.name, "surface_tension"),
            f"found {first.surface_tension:g}, but the fluid has no free surface: leave it out, or "
            "set numerics.free_surface = true",
        )
    for wall in scene.wall[1:]:
        if wall.slip != scene.wall[0].slip:
            yield Problem(
                ("wall", wall.name, "slip"),
                f'found "{wall.slip}", but \'{scene.wall[0].name}\' has "{scene.wall[0].slip}": '
                "all walls of a scene slip alike",
            )
    for wall in scene.wall:
        if wall.motion is not None and wall.velocity is not None:
            yield Problem(
                ("wall", wall.name, "velocity"),
                "found beside 'motion': give a wall one of them",
            )
    if not scene.weight.any():
        for fluid in scene.fluid:
            if fluid.pressure == "hydrostatic":
                yield Problem(
                    ("fluid", fluid.name, "pressure"),
                    'found "hydrostatic", but nothing has weight: gravity is absent or acts along '
                    'periodic axes only. Use "zero"',
                )


def _probes(scene: Scene) -> Iterator[Problem]:
    fluids = [b.name for b in scene.fluid]
    walls = [b.name for b in scene.wall]
    for probe in scene.probe:
        here = ("probe", probe.name, probe.kind)
        what = probe.what
        if isinstance(what, FrontProbe) and what.body is not None and what.body not in fluids:
            yield Problem((*here, "body"), _no_body(what.body, "fluid", fluids))
        wall = what.body if isinstance(what, (ForceProbe, PressureProbe)) else None
        if wall is not None and wall not in walls:
            yield Problem((*here, "body"), _no_body(wall, "wall", walls))
        if isinstance(what, LevelProbe) and what.direction is None and not scene.weight.any():
            yield Problem(
                (*here, "direction"), "is missing: without gravity nothing says what is up"
            )


def _no_body(name: str, kind: str, known: list[str]) -> str:
    have = f"There is {', '.join(known)}" if known else f"The scene has no {kind}"
    return f'found "{name}", which is no {kind}{nearest(name, known) or "."} {have}'


def _periods(scene: Scene) -> Iterator[Problem]:
    for axis, interval in zip("xyz", scene.periodic_axes, strict=False):
        # Two images of one particle within the support would be two neighbours that are one.
        if interval is not None and interval[1] - interval[0] < 2.0 * scene.support * (1 - 1e-9):
            yield Problem(
                ("periodic", axis),
                f"found a period of {interval[1] - interval[0]:g} m, must be at least two support "
                f"radii, {2.0 * scene.support:g} m at this spacing: lengthen it or refine spacing",
            )


def _numerics(scene: Scene) -> Iterator[Problem]:
    if scene.numerics.density_diffusion == "fourtakas" and not np.any(
        scene.gravity_at_start or 0.0
    ):
        yield Problem(
            ("numerics", "density_diffusion"),
            'found "fourtakas", which subtracts the hydrostatic part, but the scene has no '
            'gravity: use "molteni" or "antuono"',
        )
    scheme = scene.numerics.scheme
    if scheme in ("edac", "riemann"):
        for key in ("density_diffusion", "delta"):
            if getattr(scene.numerics, key) != Numerics.model_fields[key].default:
                yield Problem(
                    ("numerics", key),
                    f'found {shown(getattr(scene.numerics, key))}, but the scheme "{scheme}" has a '
                    'diffusion of its own: leave it out, or use scheme = "delta-sph"',
                )
    for fluid in scene.fluid:
        if scheme == "riemann" and fluid.viscosity and fluid.viscosity.artificial is not None:
            yield Problem(
                ("fluid", fluid.name, "viscosity", "artificial"),
                f'found {shown(fluid.viscosity.artificial)}, but the scheme "riemann" has a '
                'dissipation of its own: leave it out, or use scheme = "delta-sph"',
            )
    if scene.numerics.shifting == "gentle" and not scene.free_surface:
        yield Problem(
            ("numerics", "shifting"),
            'found "gentle", which is for fluid with a free surface: use "sun", "consistent", '
            '"lind" or "transport-velocity"',
        )
    if scene.numerics.shifting == "transport-velocity" and scene.free_surface:
        yield Problem(
            ("numerics", "shifting"),
            'found "transport-velocity", whose background pressure drives fluid with a free '
            'surface apart: use "sun", "consistent" or "lind"',
        )
    remedy, method = scene.numerics.tensile_control, scene.numerics.wall
    if remedy not in ("auto", "none") and method in FACETS and scene.wall:
        yield Problem(
            ("numerics", "tensile_control"),
            f'found "{remedy}", which needs walls of particles, but the walls are "{method}": use '
            '"adami", "dynamic" or "modified-dynamic" walls, or "none"',
        )
