"""Indices of a pose from their definition, in 50 digits, by nothing that the routines use.

The values of a block are roots of eigenvalues of its Gram matrix, found by Jacobi rotations of mpmath.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np

DIGITS = 50


@dataclass(frozen=True)
class Truth:
    """What a pose is.

    Attributes:
        J: [6, 6].
        D, C: [4] by sigma, beta, alpha, gamma.
        values: [12] in the same order, descending.
        kappa: condition number of J, angular velocities measured so that the greatest value of gamma is 1.
    """

    J: Any
    D: list[Any]
    C: list[Any]
    values: list[Any]
    kappa: float


def jacobian(base: Any, joints: Any, o: Any, R: Any) -> Any:
    """The Jacobian [6, 6] of numbers that are taken as they are, by the definition of the length of a leg."""
    B, P, R, o = (mpmath.matrix(np.asarray(x, dtype=float).tolist()) for x in (base, joints, R, o))
    J = mpmath.matrix(6, 6)
    for i in range(6):
        p = R * P[:, i]
        l = p + o - B[:, i]
        e = l / mpmath.norm(l)
        moment = (p[1] * e[2] - p[2] * e[1], p[2] * e[0] - p[0] * e[2], p[0] * e[1] - p[1] * e[0])
        for k in range(3):
            J[i, k], J[i, 3 + k] = e[k], moment[k]
    return J


def truth(base: Any, joints: Any, o: Any, R: Any) -> Truth:
    """All indices of a pose that is not singular."""
    with mpmath.workdps(DIGITS):
        J = jacobian(base, joints, o, R)
        J1, J2 = J[:, :3], J[:, 3:]
        first, second, mixed = J1.T * J1, J2.T * J2, J1.T * J2
        N_v = first - mixed * (second**-1) * mixed.T
        N_w = second - mixed.T * (first**-1) * mixed
        blocks = [_values(block) for block in (N_v, first, N_w, second)]
        kappa = _condition(J, blocks[3][0])
        D = [v[0] * v[1] * v[2] for v in blocks]
        return Truth(J, D, [v[0] / v[2] for v in blocks], [x for v in blocks for x in v], kappa)


def error(found: float, expected: Any) -> float:
    """Relative error."""
    with mpmath.workdps(DIGITS):
        return float(abs(mpmath.mpf(float(found)) / expected - 1))


def _values(block: Any) -> list[Any]:
    return sorted((mpmath.sqrt(abs(x)) for x in mpmath.eigsy(block, eigvals_only=True)), reverse=True)


def _condition(J: Any, size: Any) -> float:
    scaled = np.array((J * mpmath.diag([1, 1, 1] + [1 / size] * 3)).tolist(), dtype=float)
    return float(np.linalg.cond(scaled))
