"""Attitudes that are no rotations: the nearest rotation, and how far it is.

The polar factor of A, the rotation nearest to it in the Frobenius norm, by Newton's method ``X -> (X + X^-T) / 2``
(Higham 1986). An error e becomes e^2 / 2, so that three steps leave rounding of errors up to 0.02. Since
``X^-T = cof X / det X``, A is a rotation just if ``A = cof A`` and ``det A = 1`` (0 meets the first, too).
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.errors import InternalError
from codegen.ir.lower.staged import Stages
from codegen.ir.program import Program

STEPS = 3
"""Of Newton's method."""


def attitude_program(quantity: str, bodies: int | None = None, is_planar: bool = False) -> Program:
    """Derive a quantity of the attitudes of some bodies; the program is not simplified.

    Args:
        quantity: ``orthonormalise``: attitudes as A has them; ``check_orthonormal``: a number for each body.
        bodies: how many, of which ``A`` is the array; None for the routine of one matrix ``A``.
        is_planar: whether each is [2, 2], a turn about the normal.
    """
    stages = Stages()
    size = 2 if is_planar else 3
    given = stages.argument("A", size, size).T if bodies is None else stages.argument("A", size * size * bodies)
    entries, found = list(given), list[Any]()
    for body in range(bodies or 1):
        own = entries[size * size * body : size * size * (body + 1)]
        A = sympy.eye(3)
        A[:size, :size] = sympy.Matrix(size, size, own).T
        found += _quantity(stages, quantity, A, size, "" if bodies is None else f"_{body + 1}")
    stages.output(quantity, sympy.Matrix(found))
    return stages.program()


def _quantity(stages: Stages, quantity: str, A: Any, size: int, ending: str) -> list[Any]:
    if quantity == "orthonormalise":
        X = A
        for step in range(STEPS):
            X = _newton_step(stages, X, f"{ending}_{step + 1}")
        return list(X[:size, :size].T)
    if quantity == "check_orthonormal":
        apart = stages.stage(f"apart{ending}", sympy.Matrix(defects(stages, A, ending)), "A - cof A, det A - 1")
        return [sympy.sqrt(sum((entry**2 for entry in apart), sympy.S.Zero))]
    raise InternalError(f"no quantity {quantity} of attitudes")


def _newton_step(stages: Stages, X: Any, ending: str) -> Any:
    """``(X + X^-T) / 2``."""
    cofactors = stages.stage(f"cof{ending}", cofactor_matrix(X), "cofactors of X")
    determinant = stages.stage(f"det{ending}", sympy.Matrix([_expansion(X, cofactors)]), "det X")[0]
    half = stages.stage(f"half{ending}", sympy.Matrix([sympy.Rational(1, 2) / determinant]), "1 / (2 det X)")[0]
    return stages.stage(f"X{ending}", X / 2 + half * cofactors, "(X + X^-T) / 2")


def _expansion(A: Any, cofactors: Any) -> Any:
    return sum((A[0, k] * cofactors[0, k] for k in range(3)), sympy.S.Zero)


def defects(stages: Stages, A: Any, ending: str) -> list[Any]:
    """What is zero for rotations and for no other [3, 3] matrix: ``A - cof A`` and ``det A - 1``, 10 numbers."""
    cofactors = stages.stage(f"cof{ending}", cofactor_matrix(A), "cofactors of A")
    return [*(A - cofactors), _expansion(A, cofactors) - 1]


def cofactor_matrix(A: Any) -> Any:
    """Cofactors of a [3, 3] matrix: ``det(A) A^-T``."""

    def entry(i: int, j: int) -> Any:
        a, b, c, d = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
        return A[a, c] * A[b, d] - A[a, d] * A[b, c]

    return sympy.Matrix(3, 3, entry)
