"""The numbers of a scene: sound speed, resolution, viscosity, and the time step."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from kolk.errors import SceneError
from kolk.scene import Body, Scene, automatic

FloatArray = npt.NDArray[np.float64]

FEW_ACROSS = 8
"""Particles across a fluid below which its flow is not resolved."""

SHARE = 0.1
"""Share of a fluid's particles in its thin parts from which on they are worth a warning."""

MOST_NEIGHBOURS = {2: 60, 3: 250}
"""Neighbours beyond which a run pays for smoothing that it hardly needs, by dimension."""

MOST_STEPS = 2e7
"""Steps beyond which a run is hopeless, however few its particles."""

MOST_WORK = 1e15
"""Particles times steps beyond which it is: years, at a million a second and core."""


def warnings(scene: Scene, bodies: list[Body]) -> list[str]:
    """What is doubtful about the numbers of ``scene``."""
    return [
        *_resolution(scene, bodies),
        *_sound(scene),
        *_time(scene, bodies),
        *_viscosity(scene),
    ]


def neighbours(scene: Scene) -> float:
    """Particles of the lattice within the support of one of them."""
    radius = scene.support / scene.spacing
    reach = math.ceil(radius)
    axes = [np.arange(-reach, reach + 1)] * scene.dimension
    squared = sum(g**2 for g in np.meshgrid(*axes))
    return float(np.sum(squared < radius**2 * (1 - 1e-9)) - 1)


def own_courant(scene: Scene) -> float:
    """The Courant number of the scene's integrator, where the scene names none."""
    return automatic.COURANT[str(automatic.integrator(scene).value)]


def time_step(scene: Scene) -> tuple[float, str]:
    """Smallest of the acoustic, viscous and force limits at the start, about, in s; and which."""
    numerics, h = scene.numerics, scene.smoothing_length
    if numerics.time_step is not None:
        return numerics.time_step, "numerics.time_step"
    courant = numerics.courant or own_courant(scene)
    speed = max(float(np.linalg.norm(b.velocity, axis=1).max()) for b in scene.bodies())
    limits = [(courant * h / (scene.sound_speed + speed), "sound")]
    viscosity = scene.fluid[0].viscosity
    if viscosity is not None and viscosity.laminar is not None:
        limits.append((0.125 * h**2 / viscosity.laminar, "viscosity"))
    yielding = None if viscosity is None else viscosity.herschel_bulkley
    if yielding is not None and yielding.max_viscosity is not None:
        stiffest = yielding.max_viscosity / scene.fluid[0].density
        limits.append((0.045 * h**2 / stiffest, "viscosity"))
    gravity = scene.gravity_at_start
    if gravity is not None and any(gravity):
        limits.append((0.25 * math.sqrt(h / float(np.linalg.norm(gravity))), "gravity"))
    return min(limits)


def _resolution(scene: Scene, bodies: list[Body]) -> list[str]:
    found: list[str] = []
    for fluid, body in zip(scene.fluid, bodies, strict=False):
        across = float(np.min(np.ptp(body.position, axis=0))) / scene.spacing + 1.0
        if across < FEW_ACROSS - 0.5:
            found.append(
                f"fluid '{fluid.name}' is {across:.0f} particles across at its thinnest: "
                f"{FEW_ACROSS} or more resolve a flow"
            )
        elif (thin := _thin_share(scene, body.position)) > SHARE:
            found.append(
                f"{100 * thin:.0f} % of fluid '{fluid.name}' are in parts less than "
                f"{FEW_ACROSS // 2} particles thick, which a spacing of {scene.spacing:g} m does "
                "not resolve: refine it"
            )
    crowd = neighbours(scene)
    if crowd > MOST_NEIGHBOURS[scene.dimension]:
        found.append(
            f"{crowd:.0f} neighbours per particle cost time and blur the flow: a "
            "smoothing_ratio of 1.3 to 2 is usual"
        )
    return found


def _thin_share(scene: Scene, position: FloatArray) -> float:
    """Share of the particles where no cube of ``FEW_ACROSS / 2`` of them fits into the fluid."""
    from scipy import ndimage

    cell = np.floor((position - position.min(axis=0)) / scene.spacing + 0.5).astype(np.int64)
    shape = cell.max(axis=0) + 1
    if np.prod(shape.astype(float)) > 50.0 * len(position):
        return 0.0  # scattered over so much space that it is no solid
    full = np.zeros(shape, bool)
    full[tuple(cell.T)] = True
    side = FEW_ACROSS // 2
    # Rounding to cells leaves single holes in a lattice that is not its own.
    closed = ndimage.binary_closing(np.pad(full, 2), np.ones((2,) * scene.dimension))
    thick = ndimage.binary_opening(closed, np.ones((side,) * scene.dimension))
    return 1.0 - float(thick[tuple((cell + 2).T)].mean())


def _sound(scene: Scene) -> list[str]:
    if scene.fluid[0].sound_speed == "auto":
        return []
    # Filled anew with an automatic sound speed: what it would have been.
    automatic = scene.replace({f"fluid.{f.name}.sound_speed": "auto" for f in scene.fluid})
    try:
        wanted = automatic.sound_speed
    except SceneError:
        return []
    c0 = scene.sound_speed
    if c0 < 0.99 * wanted:
        return [
            f"the sound speed of {c0:g} m/s is below {wanted:g} m/s, ten times the speed "
            "that the flow can reach: the fluid will be compressed by more than 1 %"
        ]
    if c0 > 20.0 * wanted:
        return [
            f"the sound speed of {c0:g} m/s is far above the {wanted:g} m/s that keep the fluid "
            "nearly incompressible, and the time step is as much shorter"
        ]
    return []


def _time(scene: Scene, bodies: list[Body]) -> list[str]:
    step, limit = time_step(scene)
    found: list[str] = []
    numerics = scene.numerics
    own = own_courant(scene)
    if numerics.time_step is not None:
        acoustic = own * scene.smoothing_length / scene.sound_speed
        if step > acoustic:
            found.append(
                f"numerics.time_step of {step:g} s is longer than sound allows, {acoustic:.3g} s: "
                "the run will be unstable. Leave it out"
            )
    if numerics.courant is not None and numerics.courant > 1.2 * own:
        found.append(
            f"numerics.courant of {numerics.courant:g} is above {own:g}, where the step is known "
            "to be stable: leave it out"
        )
    steps = scene.until / step
    work = steps * sum(len(b) for b in bodies)
    if steps > MOST_STEPS or work > MOST_WORK:
        remedy = {
            "sound": "lower sound_speed, or choose a larger spacing",
            "viscosity": "choose a larger spacing: the step goes with its square",
            "gravity": "choose a larger spacing",
        }.get(limit, "give a longer one, or leave it out")
        found.append(
            f"{steps:,.0f} steps of {step:.2g} s, set by {limit}, are more than a run can take: "
            f"{remedy}, or end it earlier (until)"
        )
    return found


def _viscosity(scene: Scene) -> list[str]:
    if scene.fluid[0].viscosity is None and automatic.scheme(scene).value != "riemann":
        return [
            "the fluid has no viscosity: nothing damps noise. For free-surface flow "
            "viscosity = { artificial = 0.02 } is usual"
        ]
    return []
