"""What is solved with the triangular factors: the inverse of J, accompanying motions, factors of the ellipsoids."""

from __future__ import annotations

import sympy

from codegen.ir.lower.staged import Stages
from codegen.mechanics.velocity.blocks import Blocks
from codegen.mechanics.velocity.triangular import solved

BLOCKS = ("sigma", "beta", "alpha", "gamma")


def inverse_jacobian(stages: Stages, found: Blocks, unit: sympy.Expr) -> dict[str, sympy.Matrix]:
    """``Q1``, ``Q2`` with ``J^-1 = [Q1'; Q2']`` (Eq. 14), and ``limits``; finite but no inverse in singular poses.

    Args:
        stages: gets the steps.
        found: with the reflected identity.
        unit: the length unit in m.
    """
    v = solved(stages, "Q1", found.sigma, found.right[3:, :])
    rest = stages.stage("Q2_right", found.right[:3, :] - found.R12 * v, "Q' I - R12 Q1'")
    w = solved(stages, "Q2", found.gamma, rest) / unit
    sums = [sum(sympy.Abs(x) for x in row) for M in (v, w) for row in M.tolist()]
    return {"Q1": v.T, "Q2": w.T, "limits": sympy.Matrix(sums)}


def accompanying(stages: Stages, found: Blocks, unit: sympy.Expr) -> dict[str, sympy.Matrix]:
    """``w = -(J2'J2)^-1 J2'J1 v`` and ``v = -(J1'J1)^-1 J1'J2 w`` as matrices (Eqs. 37, 38)."""
    w = solved(stages, "w_of_v", found.gamma, found.R12)
    v = solved(stages, "v_of_w", found.beta, found.S12)
    return {"w_of_v": -w / unit, "v_of_w": -v * unit}


def ellipsoids(found: Blocks, unit: sympy.Expr) -> sympy.Matrix:
    """Factors ``F = T^-1`` of the four ellipsoids ``{F u: |u| <= 1}`` (Eqs. 18 to 21), [3, 12]."""
    scale = {"sigma": 1, "beta": 1, "alpha": unit, "gamma": unit}
    factors = [getattr(found, name).inverse / scale[name] for name in BLOCKS]
    return sympy.Matrix.hstack(*factors)
