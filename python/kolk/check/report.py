"""A scene in figures and in words."""

from __future__ import annotations

from dataclasses import dataclass

from kolk.scene import Body, Scene
from kolk.scene.automatic import Choice, choices
from kolk.scene.memory import BYTES_PER_PARTICLE, available
from kolk.scene.parts import Wall

from . import numbers, places, walls


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
    until: float
    """s"""
    time_step: float
    """s, about, at the start."""
    memory: int
    """Bytes, about."""
    memory_free: int
    """Bytes that are free now."""
    choices: tuple[Choice, ...]
    """What the scene may leave to kolk, and what came of it."""
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
        neighbours=numbers.neighbours(scene),
        bodies=tuple(_body(scene, body) for body in bodies),
        sound_speed=scene.sound_speed,
        until=scene.until,
        time_step=numbers.time_step(scene)[0],
        memory=BYTES_PER_PARTICLE * sum(len(b) for b in bodies),
        memory_free=available(),
        choices=choices(scene),
        warnings=(
            *numbers.warnings(scene, bodies),
            *walls.warnings(scene, bodies),
            *places.warnings(scene, bodies),
        ),
    )
    return report


def describe(scene: Scene) -> str:
    """:func:`check` in words, some lines of plain text. Raises SceneError."""
    return str(check(scene))


def _body(scene: Scene, body: Body) -> BodyReport:
    part = next(p for p in (*scene.fluid, *scene.wall) if p.name == body.name)
    layers = None
    if isinstance(part, Wall) and part.shape is not None:
        layers = walls.layers(scene, part)
    return BodyReport(
        name=body.name,
        kind=body.kind,
        particles=len(body),
        low=tuple(body.position.min(axis=0).tolist()),
        high=tuple(body.position.max(axis=0).tolist()),
        mass=float(body.mass.sum()),
        layers=layers,
    )


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
    lines.append(f"  sound speed {report.sound_speed:.4g} m/s")
    lines.append(
        f"  until {report.until:.4g} s: about {report.until / report.time_step:,.0f} steps of "
        f"{report.time_step:.3g} s"
    )
    lines.append(
        f"  about {_bytes(report.memory)} for {report.particles:,} particles, "
        f"{_bytes(report.memory_free)} free"
    )
    lines.append("  chosen by kolk:")
    lines += [f"    {choice}" for choice in report.choices if choice.automatic]
    lines += [f"  warning: {w}" for w in report.warnings]
    if not report.warnings:
        lines.append("  no warnings")
    return "\n".join(lines)


def _bytes(size: float) -> str:
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(size / 1e6, 0.1):.1f} MB"
