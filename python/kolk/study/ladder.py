"""Which runs a study makes: spacings from coarse to fine, and alternatives of settings."""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from kolk.errors import SceneError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

if TYPE_CHECKING:
    from kolk.scene import Scene

RATIO = math.sqrt(2.0)
"""Between neighbouring spacings: half the square root of the cost of a halving, in 2D."""

LEVELS = 4
"""An order needs three levels, and its interval a fourth."""

DEFAULT_RUNGS = (2, 1, 0, -1, -2, -3)
"""Spacings of a study over the scene's own, as powers of RATIO: the first four that fit."""

DEFAULT = "as it is"
"""Label of the scene without any alternative."""


@dataclass(frozen=True)
class Variant:
    """A set of settings that a ladder is run with."""

    label: str
    """Such as `kernel=cubic`."""
    changes: Mapping[str, Any] = field(default_factory=dict)
    """Keys of the scene, and `precision`."""

    def scene(self, base: Scene, spacing: float) -> Scene:
        """The scene of one run."""
        keys = {
            full_key(key, value): value for key, value in self.changes.items() if key != "precision"
        }
        return base.replace({**keys, "spacing": spacing})

    @property
    def precision(self) -> Any:
        """The precision that it asks for, or None."""
        return self.changes.get("precision")


def full_key(key: str, value: Any) -> str:
    """The key in the scene: `wall=dynamic` and `shifting=none` mean those of `numerics`."""
    from kolk.scene import Numerics, Scene

    known = key in Scene.model_fields and not (key == "wall" and isinstance(value, str))
    return f"numerics.{key}" if not known and key in Numerics.model_fields else key


def default_spacings(scene: Scene) -> list[float]:
    """Four spacings around the scene's own, from coarse to fine; see `snapped`.

    A scene that is too narrow for the coarse ones (a period needs room for two supports) is
    studied at finer ones instead: a shorter ladder could say nothing of the order.
    """
    chosen: list[float] = []
    for power in DEFAULT_RUNGS:
        if len(chosen) == LEVELS:
            break
        spacing = snapped(scene, scene.spacing * RATIO**power)
        if all(abs(spacing / other - 1.0) > 0.05 for other in chosen) and fits(scene, spacing):
            chosen.append(spacing)
    return chosen


def snapped(scene: Scene, spacing: float) -> float:
    """The spacing nearby that divides the thinnest extent of the first fluid, m.

    So that a ladder changes the resolution alone: bodies that no whole number of particles fills
    are filled by a lattice stretched a little, differently on each level.
    """
    body = scene.fluid[0]
    if body.shape is None:
        return spacing
    low, high = body.shape.shape.bounds()
    across = float(min(high - low))
    return across / max(2, round(across / spacing))


def snapped_finer(scene: Scene, spacing: float) -> float:
    """The spacing at or below one that divides the fluid; see `snapped`."""
    near = snapped(scene, spacing)
    if near <= spacing * (1 + 1e-9) or scene.fluid[0].shape is None:
        return near
    low, high = scene.fluid[0].shape.shape.bounds()
    across = float(min(high - low))
    return across / math.ceil(across / spacing)


def fits(scene: Scene, spacing: float) -> bool:
    """Whether the scene can be filled so coarsely."""
    from kolk.scene.memory import estimated_particles

    try:
        other = scene.replace(spacing=spacing)
        if sum(estimated_particles(other, body) for body in other.fluid) > 1e6:
            return True  # far from too coarse; not worth filling to know
        other.bodies()
    except SceneError:
        return False
    return True


def check_spacings(spacings: Sequence[float]) -> list[float]:
    """The spacings from coarse to fine, each once. Raises `SceneError` for any that is none."""
    for value in spacings:
        if not (math.isfinite(value) and value > 0.0):
            raise SceneError(f"spacings: found {value!r}, must be lengths above 0 in m")
    if not spacings:
        raise SceneError("spacings: found none, must be one or more; three or more give an order")
    return sorted(set(map(float, spacings)), reverse=True)


def variants(vary: Mapping[str, Sequence[Any]] | None, *, cross: bool = False) -> list[Variant]:
    """The scene as it is, then one key changed at a time; with `cross` every combination."""
    found = [Variant(DEFAULT)]
    if not vary:
        return found
    if cross:
        for chosen in itertools.product(*vary.values()):
            changes = dict(zip(vary, chosen, strict=True))
            found.append(Variant(_label(changes), changes))
        return found
    for key, values in vary.items():
        found += [Variant(_label({key: value}), {key: value}) for value in values]
    return found


def parse_vary(texts: Sequence[str]) -> dict[str, list[Any]]:
    """`KEY=A,B` of the command line as a key and its values: TOML's notation, or bare words.

    Several in one text are read too: `kernel=cubic,quintic,wall=dynamic`. Raises `SceneError`.
    """
    found: dict[str, list[Any]] = {}
    for text in texts:
        key = ""
        for piece in _split(text):
            name, sign, value = piece.partition("=")
            if sign and _is_key(name):
                key, piece = name.strip(), value
            if not key or not piece.strip():
                raise SceneError(
                    f"--vary {text}: must be KEY=VALUE,VALUE such as kernel=cubic,wendland-c4"
                )
            found.setdefault(key, []).append(_value(piece.strip()))
    return found


def _is_key(text: str) -> bool:
    return all(
        part.replace("-", "_").isidentifier() or part.isdecimal()
        for part in text.strip().split(".")
    )


def _split(text: str) -> list[str]:
    """At commas that stand outside brackets and quotes."""
    pieces, depth, quote, start = [], 0, "", 0
    for i, c in enumerate(text):
        if quote:
            quote = "" if c == quote else quote
        elif c in "\"'":
            quote = c
        elif c in "[{":
            depth += 1
        elif c in "]}":
            depth -= 1
        elif c == "," and depth == 0:
            pieces.append(text[start:i])
            start = i + 1
    return [*pieces, text[start:]]


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _label(changes: Mapping[str, Any]) -> str:
    return ", ".join(f"{key}={_shown(value)}" for key, value in changes.items())


def _shown(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
