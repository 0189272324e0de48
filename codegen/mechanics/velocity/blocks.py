"""The four blocks of a platform as triangles: ``T' T`` is N_v, J1'J1, N_w and J2'J2 (S3 Eqs. 12 to 14).

``[J2 J1] = Q [R11 R12; 0 R22]`` gives R11 for gamma and R22 for sigma. The same reflected columns in the other order,
``[R12 R11; R22 0]``, have mostly zeros; their factor gives beta and alpha for half of the work.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy

from codegen.ir.lower.staged import Stages
from codegen.mechanics.velocity.geometry import Legs
from codegen.mechanics.velocity.triangular import Reflections, Triangle, triangle

FIRST, SECOND = (0, 1, 2), (3, 4, 5)

_ROWS = [0, 2, 4, 1, 3, 5]
"""Legs in the order of the rows of the factor: neighbours, which often meet in a corner, lie apart."""


@dataclass(frozen=True)
class Blocks:
    """Two triangular factors of the Jacobian.

    Attributes:
        gamma, sigma: diagonal blocks of the factor of [J2 J1].
        beta, alpha: diagonal blocks of the factor of [J1 J2].
        R12: [3, 3] the block between gamma and sigma.
        S12: [3, 3] the block between beta and alpha.
        right: [6, n] what the reflections made of further columns.
    """

    gamma: Triangle
    sigma: Triangle
    beta: Triangle
    alpha: Triangle
    R12: sympy.Matrix
    S12: sympy.Matrix
    right: sympy.Matrix


def blocks(
    stages: Stages,
    legs: Legs,
    limits: tuple[sympy.Rational, sympy.Rational],
    with_inverse: bool = False,
    are_values_judged: bool = False,
) -> Blocks:
    """Factor the Jacobian of a platform in both orders.

    Args:
        stages: gets the steps.
        legs: with J1 and J2.
        limits: sizes of a remainder of J1 and of J2 that are rounding.
        with_inverse: whether the identity is reflected too, for the inverse of J.
        are_values_judged: whether a diagonal that is rounding becomes 0.
    """
    of_J1, of_J2 = [limits[0]] * 3, [limits[1]] * 3
    columns = [legs.J2[_ROWS, k] for k in range(3)] + [legs.J1[_ROWS, k] for k in range(3)]
    columns += [sympy.eye(6)[_ROWS, k] for k in range(6 * with_inverse)]
    first = triangular(stages, "R", columns, [*of_J2, *of_J1], are_values_judged)
    R11, R12, R22 = first.block(FIRST, FIRST), first.block(FIRST, SECOND), first.block(SECOND, SECOND)
    again = [sympy.Matrix.vstack(R12, R22)[:, k] for k in range(3)]
    again += [sympy.Matrix.vstack(R11, sympy.zeros(3, 3))[:, k] for k in range(3)]
    second = triangular(stages, "S", again, [*of_J1, *of_J2], are_values_judged)
    return Blocks(
        _triangle(stages, "gamma", first, FIRST),
        _triangle(stages, "sigma", first, SECOND),
        _triangle(stages, "beta", second, FIRST),
        _triangle(stages, "alpha", second, SECOND),
        R12,
        second.block(FIRST, SECOND),
        first.block((*FIRST, *SECOND), range(6, len(columns))) if with_inverse else sympy.zeros(6, 0),
    )


def triangular(
    stages: Stages, name: str, columns: list[sympy.Matrix], limits: list[sympy.Rational], are_values_judged: bool
) -> Reflections:
    """Bring the first six columns to triangular form; the others are reflected with them."""
    found = Reflections(stages, name, columns, limits, are_values_judged)
    for k in range(5):
        found.eliminate(k, k, range(k, 6))
    found.last(5, 5, 5)
    return found


def _triangle(stages: Stages, name: str, factor: Reflections, places: tuple[int, int, int]) -> Triangle:
    a, b, c = (factor.inverses[k] for k in places)
    return triangle(stages, name, factor.block(places, places), (a, b, c))
