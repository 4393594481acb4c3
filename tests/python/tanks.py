"""Scenes that many tests change a little."""

from __future__ import annotations

from kolk.scene import Body, Scene

GRAVITY = 9.81


def tank(**changes: object) -> Scene:
    """Water in the corner of a tank."""
    data: dict[str, object] = {
        "name": "tank",
        "dimension": 2,
        "spacing": 0.02,
        "gravity": [0.0, -GRAVITY],
        "until": 1.0,
        "fluid": [{"name": "water", "shape": {"box": {"from": [0.0, 0.0], "to": [0.6, 0.3]}}}],
        "wall": [
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [1.0, 0.6], "open": ["top"]}},
            }
        ],
    }
    return Scene(**(data | changes))


def vortex(**changes: object) -> Scene:
    """A periodic box without gravity."""
    data: dict[str, object] = {
        "name": "vortex",
        "dimension": 2,
        "spacing": 0.05,
        "until": 1.0,
        "periodic": {"x": [0.0, 1.0], "y": [0.0, 1.0]},
        "fluid": [
            {
                "name": "fluid",
                "shape": {"box": {"from": [0.0, 0.0], "to": [1.0, 1.0]}},
                "velocity": ["sin(2*pi*y)", 0.0],
                "viscosity": {"laminar": 0.01},
            }
        ],
    }
    return Scene(**(data | changes))


def body(scene: Scene, name: str) -> Body:
    """The body of that name."""
    return next(b for b in scene.bodies() if b.name == name)
