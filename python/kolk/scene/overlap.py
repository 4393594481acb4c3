"""Fluid where no fluid can be: in a wall, in another fluid, outside the tank or the domain."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from kolk.errors import Problem, SceneError

from .model import Scene
from .parts import Fluid, Wall
from .shapes import Tank

FloatArray = npt.NDArray[np.float64]

DEPTH = 0.01
"""Depth in spacings from which a particle counts as inside another body: above all rounding."""

CLOSEST = 0.5
"""Distance in spacings under which particles of two bodies overlap, where one has no shape."""


def check_places(scene: Scene, fluids: list[FloatArray], walls: list[FloatArray]) -> None:
    """Raise SceneError for every fluid that lies, in part, where it cannot."""
    problems: list[Problem] = []
    for i, (fluid, position) in enumerate(zip(scene.fluid, fluids, strict=True)):
        problems += _outside(scene, fluid, position)
        for wall, other in zip(scene.wall, walls, strict=True):
            if wall.shape is None or not isinstance(wall.shape.shape, Tank):
                problems += _overlap(scene, fluid, position, wall, other)
        for second, other in zip(scene.fluid[:i], fluids[:i], strict=True):
            problems += _overlap(scene, fluid, position, second, other)
    if problems:
        raise SceneError(problems=problems)


def _point(position: FloatArray) -> str:
    return "[" + ", ".join(f"{x:.4g}" for x in position) + "]"


def _where(fluid: Fluid) -> tuple[str, ...]:
    return ("fluid", fluid.name, "particles" if fluid.shape is None else "shape")


def _outside(scene: Scene, fluid: Fluid, position: FloatArray) -> list[Problem]:
    problems: list[Problem] = []
    margin = DEPTH * scene.spacing
    tanks = [w for w in scene.wall if w.shape is not None and isinstance(w.shape.shape, Tank)]
    if tanks:
        # With several tanks it is enough to lie in one of them.
        inside = np.zeros(len(position), bool)
        for wall in tanks:
            assert wall.shape is not None
            inside |= wall.shape.shape.distance(position) > -margin
        if not inside.all():
            names = " or ".join(f"'{w.name}'" for w in tanks)
            problems.append(
                Problem(
                    _where(fluid),
                    f"{_count(~inside)} outside tank {names}, such as the one at "
                    f"{_point(position[~inside][0])}: move or shrink it, or enlarge the tank",
                )
            )
    for axis, interval in enumerate(scene.periodic_axes):
        if interval is not None:
            x = position[:, axis]
            beyond = (x < interval[0] - margin) | (x > interval[1] + margin)
            if beyond.any():
                problems.append(
                    Problem(
                        _where(fluid),
                        f"{_count(beyond)} outside the period [{interval[0]:g}, {interval[1]:g}] "
                        f"along {'xyz'[axis]}, such as the one at {_point(position[beyond][0])}: "
                        "move or shrink it, or widen the period",
                    )
                )
    return problems


def _count(mask: npt.NDArray[np.bool_]) -> str:
    n = int(mask.sum())
    return f"{n:,} of {len(mask):,} particles lie"


def _overlap(
    scene: Scene, fluid: Fluid, position: FloatArray, body: Fluid | Wall, other: FloatArray
) -> list[Problem]:
    if body.shape is not None:
        inside = body.shape.shape.distance(position) < -DEPTH * scene.spacing
    else:
        inside = _near(position, other, CLOSEST * scene.spacing)
    if not inside.any():
        return []
    kind = "fluid" if isinstance(body, Fluid) else "wall"
    return [
        Problem(
            _where(fluid),
            f"{_count(inside)} inside {kind} '{body.name}', such as the one at "
            f"{_point(position[inside][0])}: move one of them, or cut it out with 'difference'",
        )
    ]


def _near(position: FloatArray, other: FloatArray, radius: float) -> npt.NDArray[np.bool_]:
    from scipy.spatial import cKDTree

    distance, _ = cKDTree(other).query(position, k=1, distance_upper_bound=radius)
    return np.asarray(np.isfinite(distance))
