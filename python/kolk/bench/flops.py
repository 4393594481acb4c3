"""Floating-point operations of a pair, counted by hand from the formulae as the engine has them.

Additions, multiplications, divisions and square roots count one each, a multiply-add two.
Comparisons, choices, loads, and what does not depend on the neighbour count nothing; what two
effects share is counted once. A step visits every directed pair twice: in the sweep of forces and
in the sweep of continuity.
"""

from __future__ import annotations


def geometry(dimension: int) -> int:
    """Separation, its square, and the slope of Wendland's C2 kernel: in either sweep.

    ``r_i - r_j``: D; ``r²``: 2D - 1; ``q = sqrt(r²)/h``: 2; ``1 - q/2``: 2; its cube: 2; times -5
    and the normalisation: 2.
    """
    return 3 * dimension + 7


def approach(dimension: int) -> int:
    """``u_ij`` and ``u_ij · r_ij``: once a sweep, whatever uses it. D and 2D - 1."""
    return 3 * dimension - 1


def pressure(dimension: int) -> int:
    """``-V_j (p_i + p_j) F r_ij``, added up: 1, 2, and 2D."""
    return 3 + 2 * dimension


def core(dimension: int) -> int:
    """The soft core: depth 2, dashpot 2, their product 3, added up along ``r_ij``: 2D."""
    return 7 + 2 * dimension


def artificial_viscosity(dimension: int) -> int:
    """Monaghan's: two densities 2, the regularised distance 1, one reciprocal for both 2, ``μ`` 3,
    ``α c0 - β μ`` times ``μ`` 3, densities 3, the push 3, added up along ``r_ij``: 2D."""
    return 17 + 2 * dimension


def continuity() -> int:
    """``(ρ_i/ρ0) V_j (u_ij · r_ij) F``, added up: 4."""
    return 4


def fourtakas(dimension: int) -> int:
    """Density diffusion: ``g · r_ij`` 2D - 1, its second order 3, the excess 2, the rate 2, added
    up: 2."""
    return 2 * dimension + 8


def of_a_pair(dimension: int) -> int:
    """Both sweeps of a step with artificial viscosity and Fourtakas' diffusion."""
    forces = geometry(dimension) + approach(dimension) + pressure(dimension)
    forces += core(dimension) + artificial_viscosity(dimension)
    rates = geometry(dimension) + approach(dimension) + continuity() + fourtakas(dimension)
    return forces + rates
