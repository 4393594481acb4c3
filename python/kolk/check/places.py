"""Where things are: particles on top of each other, fluid that touches nothing, probes in walls."""

from __future__ import annotations

import numpy as np

from kolk.scene import Body, Scene
from kolk.scene.parts import FieldProbe, LevelProbe, PressureProbe

CLOSE = 0.5
"""Distance in spacings below which two particles are on top of each other."""


def warnings(scene: Scene, bodies: list[Body]) -> list[str]:
    """What is doubtful about the places of particles and probes."""
    return [*_crowds(scene, bodies), *_loose(scene, bodies), *_probes(scene)]


def _crowds(scene: Scene, bodies: list[Body]) -> list[str]:
    from scipy.spatial import cKDTree

    position = np.concatenate([b.position for b in bodies])
    owner = np.repeat(np.arange(len(bodies)), [len(b) for b in bodies])
    distance, other = cKDTree(position).query(
        position, k=2, distance_upper_bound=CLOSE * scene.spacing
    )
    near = np.isfinite(distance[:, 1])
    # Two particles in one place: either may be found first.
    other = np.where(other[:, 1] == np.arange(len(position)), other[:, 0], other[:, 1])
    # Walls on top of each other are told apart from this.
    near[near] &= ~(_wall(bodies, owner[near]) & _wall(bodies, owner[other[near]]))
    if not near.any():
        return []
    first = int(np.flatnonzero(near)[0])
    names = sorted({bodies[owner[first]].name, bodies[owner[other[first]]].name})
    where = "[" + ", ".join(f"{x:.4g}" for x in position[first]) + "]"
    of = f"in '{names[0]}'" if len(names) == 1 else f"of '{names[0]}' and '{names[1]}'"
    return [
        f"{int(near.sum()):,} particles are nearer than half a spacing to another, such as those "
        f"{of} at {where}: they will fly apart. Bodies that touch are best filled from one corner, "
        "a whole number of spacings long; beside slanted or curved walls with "
        'arrangement = "packed"'
    ]


def _wall(
    bodies: list[Body], owner: np.ndarray[tuple[int], np.dtype[np.int64]]
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return np.array([b.kind == "wall" for b in bodies])[owner]


def _loose(scene: Scene, bodies: list[Body]) -> list[str]:
    """Fluids under gravity with nothing in reach."""
    from scipy.spatial import cKDTree

    if not scene.weight.any():
        return []
    if not scene.wall:
        return ["there is gravity but no wall: the fluid will fall for ever"]
    found: list[str] = []
    for fluid in (b for b in bodies if b.kind == "fluid"):
        others = np.concatenate([b.position for b in bodies if b is not fluid])
        distance, _ = cKDTree(others).query(fluid.position, distance_upper_bound=scene.support)
        if not np.isfinite(distance).any():
            found.append(
                f"fluid '{fluid.name}' touches no wall and no other fluid: it will fall until it "
                "does"
            )
    return found


def _probes(scene: Scene) -> list[str]:
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
