"""Richardson extrapolation and the grid convergence index, for two and for three grids."""

from __future__ import annotations

import math

SAFETY = 1.25
"""Factor of safety where three grids or more show an order in the asymptotic range (Roache 1994)"""

SAFETY_UNSURE = 3.0
"""Factor of safety for two grids, or where the order is not the theoretical one (Roache 1994)."""

LARGEST_ORDER = 20.0
"""Beyond it a change between grids is noise, not convergence."""


def richardson(fine: float, coarse: float, ratio: float, order: float) -> float:
    """The value at spacing zero: f1 + (f1 - f2) / (r^p - 1) (Richardson 1911; Roache 1994).

    fine, coarse: values on the two grids; ratio: of the spacings, coarse over fine, above 1.
    """
    return fine + (fine - coarse) / math.expm1(order * math.log(ratio))


def grid_convergence_index(
    fine: float, coarse: float, ratio: float, order: float, safety: float = SAFETY
) -> float:
    """Half-width of the fine value's error bar: F_s |f1 - f2| / (r^p - 1) (Roache 1994).

    In the unit of the values, where Roache divides by the fine one.
    """
    return safety * abs(fine - coarse) / math.expm1(order * math.log(ratio))


def three_grid_order(
    fine: float, medium: float, coarse: float, ratio_fine: float, ratio_coarse: float
) -> float:
    """Apparent order of three grids (Celik et al. 2008, J. Fluids Eng. 130, 078001).

    The root p of (r32^p - 1) r21^p / (r21^p - 1) = (f3 - f2) / (f2 - f1). NaN where the values do
    not converge monotonically: oscillation, divergence, or no change at all.
    """
    from scipy.optimize import brentq

    near, far = medium - fine, coarse - medium
    if near == 0.0 or far / near <= 0.0:
        return math.nan
    quotient = math.log(far / near)
    first, second = math.log(ratio_fine), math.log(ratio_coarse)

    def mismatch(order: float) -> float:
        return (
            math.log(math.expm1(order * second)) - math.log(-math.expm1(-order * first)) - quotient
        )

    low = 1e-6
    if mismatch(low) >= 0.0 or mismatch(LARGEST_ORDER) <= 0.0:
        return math.nan
    return float(brentq(mismatch, low, LARGEST_ORDER, xtol=1e-12))
