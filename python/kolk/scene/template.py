"""What ``kolk new`` writes: a commented scene that runs as it stands."""

from __future__ import annotations

TEMPLATE = """\
# A kolk scene: water collapses in a tank. SI units throughout.
# Check it with    kolk check FILE --picture
# Run it with      kolk run FILE
name = "NAME"
title = "Water collapses in a tank"
dimension = 2                      # 2 or 3
spacing = 0.01                     # m, initial particle spacing: half of it costs 8 times (2D)
gravity = [0.0, -9.81]             # leave it out and no gravity term exists
until = 2.0                        # s

# smoothing_ratio = 2.0            # smoothing length over spacing
# kernel = "auto"                  # or wendland-c2, wendland-c4, wendland-c6, cubic, quintic
# periodic = { x = [0.0, 1.0] }    # the domain repeats along these axes

# Bodies of fluid. Shapes: box, sphere, disc, cylinder, polygon, union, difference, function:
#   { disc = { centre = [0.3, 0.2], radius = 0.1 } }
#   { polygon = { points = [[0.0, 0.0], [0.4, 0.0], [0.0, 0.3]] } }
#   { difference = { of = { box = { ... } }, minus = [{ disc = { ... } }] } }
#   { function = { from = [0.0, 0.0], to = [1.0, 1.0], value = "hypot(x, y) - 0.3" } }
[[fluid]]
name = "water"
shape = { box = { from = [0.0, 0.0], to = [0.6, 0.3] } }
density = 1000.0
sound_speed = "auto"               # from the largest expected speed and depth
viscosity = { artificial = 0.02 }  # and/or { laminar = 1e-6 }; leave it out and there is none
# surface_tension = 0.072         # N/m, of a free surface
# drag = 2.0                      # 1/s: slowed down as in a porous bed
# velocity = [0.0, 0.0]            # numbers, or expressions such as ["0.1*y", 0.0]
# pressure = "hydrostatic"         # or "zero", or an expression in Pa
# arrangement = "packed"           # for curved and slanted shapes: relaxed, not on a lattice

# Walls: a tank leaves a box free; any other shape is a solid.
[[wall]]
name = "tank"
shape = { tank = { from = [0.0, 0.0], to = [1.61, 0.6], open = ["top"] } }
slip = "free"                      # or "no": the fluid sticks to the wall

# Probes: pressure, level, front, force or field.
[[probe]]
name = "P2"
pressure = { at = [1.61, 0.015] }  # on the wall: no shift needed

[[probe]]
name = "level"
level = { at = [0.5, 0.0] }

[[probe]]
name = "front"
front = { axis = "x", body = "water" }

[[probe]]
name = "load"
force = { body = "tank" }

[numerics]
scheme = "auto"                    # or delta-sph, edac, riemann
density_diffusion = "antuono"      # or molteni, fourtakas, none
tensile_control = "auto"           # or none, sun, monaghan: for fluid under tension
shifting = "auto"                  # or none, sun, gentle, lind
acoustic_damper = "auto"           # or a number, 0 for none: takes up sound
wall = "adami"                     # or dynamic

[output]
every = 0.02                       # s
"""


def template(name: str = "tank") -> str:
    """The text of a new scene called ``name``."""
    return TEMPLATE.replace("NAME", name)
