"""Floating-point operations of a pair, counted by hand from the formulae as the engine has them.

Additions, multiplications, divisions and square roots count one each, a multiply-add two.
Comparisons, choices, loads, and what does not depend on the neighbour count nothing; what two
effects share is counted once. Either sweep of a step visits every pair once, for both of its
particles: a directed pair, a neighbour of a particle, costs half of that. Selecting those within
reach is not counted, nor is what a wall particle adds on its one side beyond that half.
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


def pressure() -> int:
    """``(p_i + p_j) F``: 2."""
    return 2


def core() -> int:
    """The soft core: depth 2, dashpot 2, their product 2, to the rest of the push 1."""
    return 7


def artificial_viscosity() -> int:
    """Monaghan's without its quadratic term: the other's density 1, the regularised distance 1,
    both densities 1, one reciprocal for both 2, ``μ`` 2, times densities and slope 3, to the rest
    of the push 1."""
    return 11


def push(dimension: int) -> int:
    """What pushes the pair apart, times either volume 2, added up along ``r_ij`` twice: 4D."""
    return 2 + 4 * dimension


def continuity() -> int:
    """``(u_ij · r_ij) F``: 1."""
    return 1


def fourtakas(dimension: int) -> int:
    """Density diffusion: ``g · r_ij`` 2D - 1, its rate 1, the excess 2, their product 1, the second
    order 3."""
    return 2 * dimension + 6


def rates() -> int:
    """The other's density 1, what either gets 6, times either volume and added up: 4."""
    return 11


def of_a_pair(dimension: int) -> int:
    """Of a directed pair in both sweeps, with artificial viscosity and Fourtakas' diffusion."""
    shared = geometry(dimension) + approach(dimension)
    forces = shared + pressure() + core() + artificial_viscosity() + push(dimension)
    density = shared + continuity() + fourtakas(dimension) + rates()
    return (forces + density) // 2
