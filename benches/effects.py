"""What every effect costs and holds, in a scene that calls for it: the columns of docs/effects.md.

    python benches/effects.py [SECONDS]

`kolk explain` measures each in short runs with and without it, SECONDS (10) each; bytes are what
the simulation holds with the effect and not without it.
"""

from __future__ import annotations

import sys
from typing import Any

from kolk import Scene, Simulation
from kolk.explain import explain

WATER = "fluid.water.viscosity"
MUD = {"herschel_bulkley": {"yield_stress": 20.0, "consistency": 1.0}}

CALLED_FOR: dict[str, dict[str, Any]] = {
    "pressure": {},
    "gravity": {},
    "walls": {},
    "artificial viscosity": {},
    "density diffusion": {},
    "acoustic damper": {},
    "particle shifting": {},
    "laminar viscosity": {WATER: {"laminar": 1e-3}},
    "Herschel-Bulkley": {WATER: MUD},
    "turbulence": {WATER: {"artificial": 0.02, "turbulence": 0.12}},
    "surface tension": {"fluid.water.surface_tension": 0.072},
    "linear drag": {"fluid.water.drag": 2.0},
    "Riemann dissipation": {WATER: None, "numerics.scheme": "riemann"},
    "tensile control": {"numerics.tensile_control": "sun"},
    "artificial stress": {"numerics.tensile_control": "monaghan"},
    "moving walls": {"wall.tank.motion": {"translate": {"velocity": [0.1, 0.0]}}},
}
"""What calls for an effect in the dam break below; nothing where it has it anyway."""


def dam_break() -> Scene:
    """A dam break of 3,200 particles."""
    return Scene(
        name="dam-break",
        dimension=2,
        spacing=0.0075,
        gravity=[0.0, -9.81],
        until=1.0,
        fluid=[
            {
                "name": "water",
                "shape": {"box": {"from": [0.0, 0.0], "to": [0.6, 0.3]}},
                "viscosity": {"artificial": 0.02},
            }
        ],
        wall=[
            {
                "name": "tank",
                "shape": {"tank": {"from": [0.0, 0.0], "to": [1.61, 0.6], "open": ["top"]}},
            }
        ],
    )


def held(scene: Scene) -> float:
    """Bytes per particle of the fluid."""
    simulation = Simulation(scene, threads=1)
    return sum(simulation.memory.values()) / simulation.particles["fluid"]


def absent(name: str, scene: Scene) -> Scene | None:
    """The scene without one effect, for what it holds; None where every scene has it."""
    off: dict[str, dict[str, Any]] = {
        "density diffusion": {"numerics.density_diffusion": "none"},
        "particle shifting": {"numerics.shifting": "none"},
        "acoustic damper": {"numerics.acoustic_damper": 0.0},
        "artificial viscosity": {WATER: None},
    }
    if CALLED_FOR[name]:
        return dam_break()
    return scene.replace(off[name]) if name in off else None


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    print("| effect | ns per particle-step | 95 % | share of the step | bytes per particle |")
    print("|---|---|---|---|---|")
    for name, changes in CALLED_FOR.items():
        scene = dam_break().replace(changes)
        found = next(e for e in explain(scene, seconds=seconds).effects if e.name == name)
        cost, without = found.cost, absent(name, scene)
        assert cost is not None
        ns = cost.nanoseconds
        extra = "" if without is None else f"{held(scene) - held(without):.0f}"
        print(
            f"| {name} | {ns.value:.0f} | {ns.low:.0f} to {ns.high:.0f} "
            f"| {100.0 * cost.share:.0f} % | {extra} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
