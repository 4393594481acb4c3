"""What a scene is before it runs: its particles, its numbers, its warnings, and a picture.

:func:`check` does the whole validation, particles included, :func:`describe` says it in words, and
:func:`picture` draws it. None of them needs the engine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from kolk.scene import Body, Scene
from kolk.scene.fill import lattice
from kolk.scene.memory import BYTES_PER_PARTICLE, available
from kolk.scene.parts import FieldProbe, LevelProbe, PressureProbe, Wall
from kolk.scene.shapes import Tank

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = npt.NDArray[np.float64]

FEW_ACROSS = 8
"""Particles across a fluid below which its flow is not resolved."""

MOST_NEIGHBOURS = {2: 60, 3: 250}
"""Neighbours beyond which a run pays for smoothing that it hardly needs, by dimension."""

COURANT = 0.5
"""Courant number that the time step at the start is estimated with, where the scene has none."""


@dataclass(frozen=True)
class BodyReport:
    """One body in figures."""

    name: str
    kind: str
    particles: int
    low: tuple[float, ...]
    """Lowest corner of its particles, m."""
    high: tuple[float, ...]
    mass: float
    """kg, per metre in 2D."""
    layers: int | None
    """Layers of particles behind a wall's surface; None for fluids and own particles."""


@dataclass(frozen=True)
class Report:
    """A scene in figures."""

    name: str
    title: str | None
    dimension: int
    spacing: float
    """m"""
    smoothing_length: float
    """m"""
    kernel: str
    neighbours: float
    """Neighbours of a particle inside the fluid, on average."""
    bodies: tuple[BodyReport, ...]
    sound_speed: float
    """m/s"""
    automatic: bool
    """Whether the sound speed was chosen, and from which speed:"""
    expected_speed: float
    """m/s; 0 where the scene gives the sound speed."""
    until: float
    """s"""
    time_step: float
    """s, about, at the start."""
    memory: int
    """Bytes, about."""
    memory_free: int
    """Bytes that are free now."""
    warnings: tuple[str, ...]

    @property
    def particles(self) -> int:
        """Of all bodies."""
        return sum(b.particles for b in self.bodies)

    def __str__(self) -> str:
        return _words(self)


def check(scene: Scene) -> Report:
    """Validate ``scene`` to the last particle and describe it. Raises SceneError."""
    bodies = scene.bodies()
    report = Report(
        name=scene.name,
        title=scene.title,
        dimension=scene.dimension,
        spacing=scene.spacing,
        smoothing_length=scene.smoothing_length,
        kernel=scene.kernel,
        neighbours=_neighbours(scene),
        bodies=tuple(_body(scene, body) for body in bodies),
        sound_speed=scene.sound_speed,
        automatic=scene.fluid[0].sound_speed == "auto",
        expected_speed=scene.filling.expected_speed,
        until=scene.until,
        time_step=_time_step(scene),
        memory=BYTES_PER_PARTICLE * sum(len(b) for b in bodies),
        memory_free=available(),
        warnings=tuple(_warnings(scene, bodies)),
    )
    return report


def describe(scene: Scene) -> str:
    """:func:`check` in words, some lines of plain text. Raises SceneError."""
    return str(check(scene))


def _neighbours(scene: Scene) -> float:
    """Particles of the lattice within the support of one of them."""
    radius = scene.support / scene.spacing
    reach = math.ceil(radius)
    axes = [np.arange(-reach, reach + 1)] * scene.dimension
    squared = sum(g**2 for g in np.meshgrid(*axes))
    return float(np.sum(squared < radius**2 * (1 - 1e-9)) - 1)


def _body(scene: Scene, body: Body) -> BodyReport:
    part = next(p for p in (*scene.fluid, *scene.wall) if p.name == body.name)
    layers = None
    if isinstance(part, Wall) and part.shape is not None:
        layers = _layers(scene, part)
    return BodyReport(
        name=body.name,
        kind=body.kind,
        particles=len(body),
        low=tuple(body.position.min(axis=0).tolist()),
        high=tuple(body.position.max(axis=0).tolist()),
        mass=float(body.mass.sum()),
        layers=layers,
    )


def _layers(scene: Scene, wall: Wall) -> int:
    """How many layers deep the wall is filled: fewer than the kernel reaches if it is thin."""
    assert wall.shape is not None
    shape = wall.shape.shape
    if isinstance(shape, Tank):
        return scene.wall_layers
    points, steps = lattice(shape, scene.spacing, scene.wall_layers)
    deepest = float(-shape.distance(points).min())
    # The deepest particle of a plate of n layers lies half of them, rounded up, behind a face.
    depth = max(1, math.ceil(deepest / float(steps.min()) - 1e-6))
    return min(scene.wall_layers, 2 * depth)


def _time_step(scene: Scene) -> float:
    """Smallest of the acoustic, viscous and force limits at the start, about, in s."""
    numerics, h = scene.numerics, scene.smoothing_length
    if numerics.time_step is not None:
        return numerics.time_step
    speed = max(float(np.linalg.norm(b.velocity, axis=1).max()) for b in scene.bodies())
    limits = [(numerics.courant or COURANT) * h / (scene.sound_speed + speed)]
    viscosity = scene.fluid[0].viscosity
    if viscosity is not None and viscosity.laminar is not None:
        limits.append(0.125 * h**2 / viscosity.laminar)
    yielding = None if viscosity is None else viscosity.herschel_bulkley
    if yielding is not None and yielding.max_viscosity is not None:
        limits.append(0.045 * h**2 * scene.fluid[0].density / yielding.max_viscosity)
    if scene.gravity_at_start is not None and any(scene.gravity_at_start):
        limits.append(0.25 * math.sqrt(h / float(np.linalg.norm(scene.gravity_at_start))))
    return min(limits)


def _warnings(scene: Scene, bodies: list[Body]) -> list[str]:
    found: list[str] = []
    for fluid, body in zip(scene.fluid, bodies, strict=False):
        across = float(np.min(np.ptp(body.position, axis=0))) / scene.spacing + 1.0
        if across < FEW_ACROSS - 0.5:
            found.append(
                f"fluid '{fluid.name}' is {across:.0f} particles across at its thinnest: "
                f"{FEW_ACROSS} or more resolve a flow"
            )
    neighbours = _neighbours(scene)
    if neighbours > MOST_NEIGHBOURS[scene.dimension]:
        found.append(
            f"{neighbours:.0f} neighbours per particle cost time and blur the flow: a "
            "smoothing_ratio of 1.3 to 2 is usual"
        )
    found += _wall_warnings(scene, bodies)
    found += _probe_warnings(scene)
    c0, given = scene.sound_speed, scene.fluid[0].sound_speed != "auto"
    if given:
        # Filled anew with an automatic sound speed: what it would have been.
        automatic = scene.replace({f"fluid.{f.name}.sound_speed": "auto" for f in scene.fluid})
        wanted = _automatic(automatic)
        if wanted is not None and c0 < 0.99 * wanted:
            found.append(
                f"the sound speed of {c0:g} m/s is below {wanted:g} m/s, ten times the speed "
                "that the flow can reach: the fluid will be compressed by more than 1 %"
            )
    viscosity = scene.fluid[0].viscosity
    if viscosity is None:
        found.append(
            "the fluid has no viscosity: nothing damps noise. For free-surface flow "
            "viscosity = { artificial = 0.02 } is usual"
        )
    return found


def _automatic(scene: Scene) -> float | None:
    from kolk.errors import SceneError

    try:
        return scene.sound_speed
    except SceneError:
        return None


def _wall_warnings(scene: Scene, bodies: list[Body]) -> list[str]:
    found: list[str] = []
    by_name = {b.name: b for b in bodies}
    for i, wall in enumerate(scene.wall):
        if wall.shape is None:
            continue
        layers = _layers(scene, wall)
        if layers < scene.wall_layers:
            found.append(
                f"wall '{wall.name}' is {layers} layers thick, the kernel reaches "
                f"{scene.wall_layers}: fluid on its two sides would feel each other. Thicken it, "
                "or refine spacing"
            )
        for other in scene.wall[:i]:
            position = by_name[other.name].position
            double = wall.shape.shape.distance(position) < -0.01 * scene.spacing
            if not isinstance(wall.shape.shape, Tank) and double.any():
                found.append(
                    f"walls '{wall.name}' and '{other.name}' overlap in {int(double.sum()):,} "
                    "particles: fluid near them feels both. Make one wall of them with 'union', or "
                    "move one"
                )
    if not scene.wall and scene.weight.any():
        found.append("there is gravity but no wall: the fluid will fall for ever")
    return found


def _probe_warnings(scene: Scene) -> list[str]:
    found: list[str] = []
    for probe in scene.probe:
        what = probe.what
        if not isinstance(what, (PressureProbe, LevelProbe, FieldProbe)):
            continue
        point = np.array([what.at])
        for wall in scene.wall:
            if wall.shape is None:
                continue
            depth = -float(wall.shape.shape.distance(point)[0])
            if depth > 0.5 * scene.spacing:
                found.append(
                    f"probe '{probe.name}' lies {depth:.3g} m inside wall '{wall.name}': put it "
                    "on the wall's surface"
                )
    return found


def _words(report: Report) -> str:
    d = report.dimension
    lines = [f"{report.name}: {report.title}" if report.title else report.name]
    lines.append(
        f"  {d}D, spacing {report.spacing:.4g} m, smoothing length {report.smoothing_length:.4g} m "
        f"({report.kernel}), {report.neighbours:.0f} neighbours per particle"
    )
    width = max(len(b.name) for b in report.bodies)
    for body in report.bodies:
        spans = " x ".join(
            f"{high - low + report.spacing:.4g}"
            for low, high in zip(body.low, body.high, strict=True)
        )
        tail = f", {body.layers} layers" if body.layers is not None else ""
        lines.append(
            f"  {body.kind:5} {body.name:{width}}  {body.particles:>10,} particles{tail}, "
            f"{spans} m"
            + (f", {body.mass:.4g} kg{'/m' if d == 2 else ''}" if body.kind == "fluid" else "")
        )
    reason = f" (automatic: ten times {report.expected_speed:.4g} m/s)" if report.automatic else ""
    lines.append(f"  sound speed {report.sound_speed:.4g} m/s{reason}")
    lines.append(
        f"  until {report.until:.4g} s: about {report.until / report.time_step:,.0f} steps of "
        f"{report.time_step:.3g} s"
    )
    lines.append(
        f"  about {_bytes(report.memory)} for {report.particles:,} particles, "
        f"{_bytes(report.memory_free)} free"
    )
    lines += [f"  warning: {w}" for w in report.warnings]
    if not report.warnings:
        lines.append("  no warnings")
    return "\n".join(lines)


def _bytes(size: float) -> str:
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(size / 1e6, 0.1):.1f} MB"


def picture(scene: Scene, path: str | Path) -> Path:
    """Draw the set-up as PNG: every particle in 2D, three views of the outline in 3D.

    Returns the path. Raises SceneError for the scene, RunError where the file cannot be written.
    """
    from matplotlib.collections import PathCollection

    from kolk.output.atomic import storage_error
    from kolk.render.style import figure, look, save

    path = Path(path)
    bodies = scene.bodies()
    low = np.min([b.position.min(axis=0) for b in bodies], axis=0)
    high = np.max([b.position.max(axis=0) for b in bodies], axis=0)
    size = high - low + scene.spacing
    views = [(0, 1)] if scene.dimension == 2 else [(0, 2), (0, 1)]
    width = 9.0 * min(1.0, *(0.8 * float(size[a] / size[b]) for a, b in views))
    heights = [width * float(size[b] / size[a]) for a, b in views]
    with look():
        made = figure(max(width, 4.0), sum(heights) + 0.6 * len(views) + 0.8)
        made.set_layout_engine("constrained")
        grid = made.add_gridspec(len(views), 1, height_ratios=heights)
        for i, (a, b) in enumerate(views):
            _view(made.add_subplot(grid[i, 0]), scene, bodies, a, b, width)
        handles, labels = made.axes[0].get_legend_handles_labels()
        made.suptitle(scene.title or scene.name, x=0.01, ha="left", fontweight="bold")
        legend = made.legend(handles, labels, loc="outside lower left", ncols=4)
        for handle in legend.legend_handles:
            if isinstance(handle, PathCollection):
                handle.set_sizes([24.0])
        try:
            return save(made, path)
        except OSError as error:
            raise storage_error(path, error, "write the picture") from error


def _view(axes: Axes, scene: Scene, bodies: list[Body], a: int, b: int, width: float) -> None:
    """One view along the axis that is neither ``a`` nor ``b``."""
    from matplotlib.patheffects import withStroke

    from kolk.render.style import REFERENCE, RUN, WALL, bare

    wet = ["#2f7fc1", "#66b3a6", "#8a7fc7", "#c9a24b"]
    bare(axes)
    lows = np.min([x.position.min(axis=0) for x in bodies], axis=0) - scene.spacing
    highs = np.max([x.position.max(axis=0) for x in bodies], axis=0) + scene.spacing
    axes.set_xlim(lows[a], highs[a])
    axes.set_ylim(lows[b], highs[b])
    fluids = 0
    # Side of a square marker in points, so that neighbours just touch.
    pitch = 72.0 * width * scene.spacing / float(highs[a] - lows[a])
    for body in bodies:
        shown = body.position if scene.dimension == 2 else _seen(scene, body, a, b)
        if not len(shown):
            continue
        colour = WALL if body.kind == "wall" else wet[fluids % len(wet)]
        fluids += body.kind == "fluid"
        axes.scatter(
            shown[:, a],
            shown[:, b],
            s=max((0.92 * pitch) ** 2, 0.1),
            c=colour,
            marker="s",
            linewidths=0,
            label=f"{body.name} ({len(body):,})",
            rasterized=True,
        )
    for probe in scene.probe:
        at = getattr(probe.what, "at", None)
        if at is not None:
            axes.plot(at[a], at[b], marker="o", ms=4, mfc="white", mec=REFERENCE, ls="none")
            axes.annotate(
                probe.name,
                (at[a], at[b]),
                xytext=(4, 3),
                textcoords="offset points",
                fontsize=7,
                color=REFERENCE,
                path_effects=[withStroke(linewidth=2.0, foreground="white")],
            )
    for axis, spot in ((a, axes.axvline), (b, axes.axhline)):
        interval = scene.periodic_axes[axis]
        for edge in interval or ():
            spot(edge, color=RUN, lw=0.8, ls="--")
    axes.set_xlabel(f"{'xyz'[a]} [m]")
    axes.set_ylabel(f"{'xyz'[b]} [m]")


def _seen(scene: Scene, body: Body, a: int, b: int) -> FloatArray:
    """What a view along the third axis shows of a body in 3D: of a tank a cut through its middle,
    of anything else its shadow."""
    wall = next((w for w in scene.wall if w.name == body.name), None)
    if wall is not None and wall.shape is not None and isinstance(wall.shape.shape, Tank):
        depth = body.position[:, 3 - a - b]
        middle = 0.5 * (depth.min() + depth.max())
        return np.asarray(body.position[np.abs(depth - middle) < 0.75 * scene.spacing])
    cells = np.round(body.position[:, [a, b]] / (0.05 * scene.spacing)).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return np.asarray(body.position[first])
