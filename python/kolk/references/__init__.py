"""What a run is set beside: short tables of published figures, and analytic solutions.

Tables: :func:`load` and :func:`names`. Analytic solutions are plain functions of position and time
in SI units, each with its formula and its source in the docstring.
"""

from __future__ import annotations

from .capillary import CapillaryDrop
from .channel import couette, herschel_bulkley, poiseuille
from .collapse import DamBreakStates, ritter, stoker, stoker_states
from .drops import (
    DropHistory,
    oscillating_drop,
    oscillating_drop_period,
    stretching_drop,
)
from .slump import slump
from .tables import Reference, load, names
from .vortex import taylor_green, taylor_green_decay_rate
from .waves import StandingWave, hydrostatic_pressure, standing_wave

__all__ = [
    "CapillaryDrop",
    "DamBreakStates",
    "DropHistory",
    "Reference",
    "StandingWave",
    "couette",
    "herschel_bulkley",
    "hydrostatic_pressure",
    "load",
    "names",
    "oscillating_drop",
    "oscillating_drop_period",
    "poiseuille",
    "ritter",
    "slump",
    "standing_wave",
    "stoker",
    "stoker_states",
    "stretching_drop",
    "taylor_green",
    "taylor_green_decay_rate",
]
