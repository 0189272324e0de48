"""Which branch a joint was closed on: constraints have solutions that no joint can reach.

Newton's method from a bad start may end on one. Axes that are to be parallel may be antiparallel (S1 Table 1 asks for
perpendicular ones only), and the three rows of a rotation hold for a relative attitude that is off by half a turn
(SPEC S1.2). ``branch`` is the cosine of what is off: 1 where the joint is closed as it was meant, -1 half a turn off.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy

from codegen.mechanics.algebra import Algebra
from codegen.mechanics.basic import axis_i, axis_j
from codegen.mechanics.frames import A_i, C_i, H
from codegen.mechanics.terms import unit
from codegen.spec.joints import Axis, BasicConstraint, Dot1

_AXES: tuple[Axis, ...] = ("f", "g", "h")
_PARALLEL = {Dot1("f", "h"), Dot1("g", "h")}


def conventional_branch(constraints: Sequence[BasicConstraint], algebra: Algebra) -> Any:
    """Branch of a joint in the conventional form.

    Args:
        constraints: of the joint.
        algebra: normal form in force.

    Returns:
        ``h_i . h_j`` where two rows make these axes parallel; the cosine of the whole relative rotation where a third
        row fixes it; 1 for joints whose attitudes hang together (ball, universal).
    """
    dots = {constraint for constraint in constraints if isinstance(constraint, Dot1)}
    if not dots >= _PARALLEL:
        return sympy.S.One
    if len(dots) == len(_PARALLEL):
        return algebra.dot(axis_i("h"), axis_j("h"))
    return _cosine([axis_i(axis) for axis in _AXES], algebra)


def parametric_branch(rotations: int, algebra: Algebra) -> Any:
    """Branch of a joint in the parametric form: ``(trace(H^T C_i^T A_ij C_j) - 1) / 2``.

    Args:
        rotations: k of ``rot_k``.
        algebra: normal form in force.
    """
    turned = [sympy.MatMul(A_i, C_i, H, unit(k)) if rotations else axis_i(axis) for k, axis in enumerate(_AXES)]
    return _cosine(turned, algebra)


def _cosine(starred: Sequence[Any], algebra: Algebra) -> Any:
    """Cosine of the angle from three axes to those of joint frame j."""
    trace = sympy.Add(*(algebra.dot(axis, axis_j(name)) for axis, name in zip(starred, _AXES, strict=True)))
    return (trace - 1) / 2
