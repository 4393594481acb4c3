"""Water at rest for a long time."""

from __future__ import annotations

import math

import numpy as np

import kolk

from ..suite import Case, Figure, Result
from ..watching import Watch, number, simulation

DEPTH, GRAVITY, DENSITY = 0.5, 9.81, 1000.0
SCHEMES: dict[str, dict[str, object]] = {
    "edac": {"numerics.scheme": "edac"},
    # It has a dissipation of its own.
    "riemann": {"numerics.scheme": "riemann", "fluid.water.viscosity": None},
}
"""Beside the default, and what a scene says for it."""


def run(variant: str) -> Result:
    long = number(variant)
    resolution = 50 if long > 50 else 20
    changes = next((keys for scheme, keys in SCHEMES.items() if scheme in variant), {})
    scene = kolk.load("still-water").replace({"spacing": DEPTH / resolution, **changes})
    sim = simulation(scene)
    water, unit = sim.bodies["water"], math.sqrt(DEPTH / GRAVITY)
    height = float(np.mean(water.position[:, 1]))
    watch = Watch(sim).run(long * unit, 20)
    drift = float(np.mean(water.position[:, 1])) - height
    weight = float(water.mass.sum()) * GRAVITY * DEPTH
    bottom = np.stack([np.linspace(0.3, 0.7, 9), np.zeros(9)], axis=1)
    total = 0.0
    for _ in range(40):
        sim.advance(0.05 * unit)
        total += float(np.mean(sim.sample(bottom, ["density"])["density"]))
    rest = sim.initial["water"]
    lowest = rest.position[:, 1] < 0.6 * DEPTH / resolution
    exact = float(rest.density[lowest].mean())
    return watch.result(
        variant,
        *watch.figures(closest=0.6, speed=0.1 * math.sqrt(GRAVITY * DEPTH)),
        # The middle of the water rises by half of what its surface does.
        Figure("drift of the level", 2.0 * abs(drift) * resolution / DEPTH, most=0.5, unit="Δp"),
        Figure("kinetic energy / (m g H)", sim.energy.kinetic / weight, most=1e-5, goal=1e-8),
        Figure("error of density at the bottom", abs(total / 40 / exact - 1.0), most=1e-3),
    )


case = Case(
    title="Water at rest",
    setup="A tank at rest for 1000 √(H/g), H/Δp = 50; with the other schemes for 200 √(H/g).",
    failure="the surface swells, currents",
    run=run,
    short=("√(H/g) x 8",),
    remarks="""Particles of the two topmost rows, which carry hardly any pressure, approach each
other slowly and stay: at H/Δp = 20 the closest pair is 0.75 Δp after 5 √(H/g), 0.69 after 100,
0.55 after 400 and 0.56 after 1000. It is not rounding (f64: 0.56 after 400) and not shifting
(without any: 0.65), and neither level nor kinetic energy feel it; the soft core keeps pairs apart
that come nearer. The limit of 0.6 Δp is this case's own, as all others have 0.3; it is not met.
With the Riemann scheme, whose dissipation acts on approaching particles only, motion is left: it
misses the goal for the kinetic energy, and its pairs come closer.""",
    full=("√(H/g) x 1000", *(f"{scheme}, √(H/g) x 200" for scheme in SCHEMES)),
)
