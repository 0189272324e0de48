"""The symbols of a joint between bodies i and j, and where each stands in the arguments of a routine.

Frames and units: ``r`` m, world; ``A`` body to world; ``s`` m, body axes; ``C = [f g h]`` joint frame in body axes;
``d_ij`` m, world. Argument layouts are those of the C ABI.
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.ir.program import Argument
from codegen.spec.joints import JointType


def vector(name: str) -> Any:
    """A [3] vector symbol."""
    return sympy.MatrixSymbol(name, 3, 1)


def matrix(name: str) -> Any:
    """A [3, 3] matrix symbol."""
    return sympy.MatrixSymbol(name, 3, 3)


r_i, r_j = vector("r_i"), vector("r_j")
r_ij = vector("r_ij")
"""``r_j - r_i``, m, world, taken as a whole: far from the origin the difference of neighbours is exact, and products
with one position alone are not."""
A_i, A_j = matrix("A_i"), matrix("A_j")
s_i, s_j = vector("s_i"), vector("s_j")
C_i, C_j = matrix("C_i"), matrix("C_j")
A_ij = matrix("A_ij")
d_ij = vector("d_ij")
dp_ij = vector("dp_ij")
"""``d'_ij = A_i^T d_ij``: the joining vector in the axes of body i."""
e_ij = vector("e_ij")
"""``e_ij = r_j + A_j s_j - r_i = d_ij + A_i s_i``: from the origin of body i to the joint on body j, m, world."""
ep_ij = vector("ep_ij")
"""``e'_ij = A_i^T e_ij``."""
H = matrix("H")
"""Rotation of joint frame j seen from joint frame i, a function of alpha."""

delta_r_i, delta_r_j = vector("delta_r_i"), vector("delta_r_j")
delta_pi_i, delta_pi_j = vector("delta_pi_i"), vector("delta_pi_j")
v_i, v_j = vector("v_i"), vector("v_j")
omega_i, omega_j = vector("omega_i"), vector("omega_j")

BODY_DISPLACEMENTS = (delta_r_i, delta_pi_i, delta_r_j, delta_pi_j)
BODY_VELOCITIES = (v_i, omega_i, v_j, omega_j)

pitch, theta_0, revolutions = sympy.symbols("pitch theta_0 revolutions")

GEOMETRY = ((s_i, 0), (C_i, 3), (s_j, 12), (C_j, 15))
"""Layout of ``geometry``: symbol and offset; joint parameters follow at 24."""

PARAMETERS_OFFSET = 24


def components(symbol: Any) -> tuple[Any, Any, Any]:
    """The components of a [3] vector symbol as scalars."""
    x, y, z = sympy.symbols(f"{symbol.name}_0 {symbol.name}_1 {symbol.name}_2")
    return x, y, z


def column(symbol: Any) -> Any:
    """A [3] vector symbol written out in its `components`."""
    return sympy.ImmutableDenseMatrix(components(symbol))


def alpha(count: int) -> tuple[Any, ...]:
    """The parametric coordinates alpha_0 ... (m or rad)."""
    return tuple(sympy.Symbol(f"alpha_{k}") for k in range(count))


def delta_alpha(count: int) -> tuple[Any, ...]:
    """Their virtual displacements."""
    return tuple(sympy.Symbol(f"delta_alpha_{k}") for k in range(count))


def alpha_dot(count: int) -> tuple[Any, ...]:
    """Their rates (m/s or rad/s)."""
    return tuple(sympy.Symbol(f"alphadot_{k}") for k in range(count))


def multipliers(count: int) -> tuple[Any, ...]:
    """The Lagrange multipliers lambda_0 ..., one a row."""
    return tuple(sympy.Symbol(f"lambda_{k}") for k in range(count))


def arguments(joint: JointType, coordinates: int, rows: int) -> tuple[Argument, ...]:
    """Give the arguments of a routine, in the order of the C ABI.

    Args:
        joint: for the length of ``geometry``.
        coordinates: number of alphas; 0 in the conventional form.
        rows: number of constraint rows.
    """
    bodies = (
        Argument("r_i", (3, 1)),
        Argument("A_i", (3, 3)),
        Argument("r_j", (3, 1)),
        Argument("A_j", (3, 3)),
    )
    parametric = (Argument("alpha", (coordinates, 1)),) if coordinates else ()
    geometry = Argument("geometry", (PARAMETERS_OFFSET + len(joint.parameters), 1))
    return (
        *bodies,
        *parametric,
        geometry,
        Argument("velocity", (12 + coordinates, 1)),
        Argument("lambda", (rows, 1)),
    )


def inputs(coordinates: int, rows: int) -> dict[Any, tuple[str, int]]:
    """Say for each symbol which argument it is read from, and at which offset."""
    places: dict[Any, tuple[str, int]] = {symbol: (symbol.name, 0) for symbol in (r_i, A_i, r_j, A_j)}
    places |= {part: (r.name, k) for r in (r_i, r_j) for k, part in enumerate(components(r))}
    places |= {symbol: ("geometry", offset) for symbol, offset in GEOMETRY}
    places |= {p: ("geometry", PARAMETERS_OFFSET + k) for k, p in enumerate((pitch, theta_0, revolutions))}
    places |= {symbol: ("velocity", 3 * k) for k, symbol in enumerate(BODY_VELOCITIES)}
    places |= {symbol: ("alpha", k) for k, symbol in enumerate(alpha(coordinates))}
    places |= {symbol: ("velocity", 12 + k) for k, symbol in enumerate(alpha_dot(coordinates))}
    places |= {symbol: ("lambda", k) for k, symbol in enumerate(multipliers(rows))}
    return places
