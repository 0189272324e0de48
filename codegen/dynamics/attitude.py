"""Attitudes from the state: Euler parameters in space, an angle in the plane.

``A(p)`` is the rotation of ``p / |p|``, so that it is a rotation for every ``p`` but 0. With ``s = 2 / (p . p)`` its
derivative is ``delta A = A delta pi~``, ``delta pi = s G(p) delta p``, ``G = [-e, p_0 I - e~]``, also where ``p`` is
not of norm 1.
"""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.inline import Entries
from codegen.ir.ops import Op

_G = ((-1, 0, 3, -2), (-2, -3, 0, 1), (-3, 2, -1, 0))
"""Rows of G: number and sign of the Euler parameter; a zero is that of ``w``, which is never negative there."""


def scaled_parameters(builder: Builder, p: list[int]) -> list[int]:
    """``s p`` with ``s = 2 / (p . p)``."""
    factor = builder.emit(Op.DIVIDE, builder.constant(2), norm_squared(builder, p))
    return [builder.emit(Op.MULTIPLY, factor, entry) for entry in p]


def norm_squared(builder: Builder, p: list[int]) -> int:
    """``p . p``."""
    squares = [builder.emit(Op.MULTIPLY, entry, entry) for entry in p]
    first = builder.emit(Op.ADD, squares[0], squares[1])
    return builder.emit(Op.ADD, first, builder.emit(Op.ADD, squares[2], squares[3]))


def rotation(builder: Builder, p: list[int], scaled: list[int]) -> Entries:
    """``A(p)``, [3, 3].

    Args:
        builder: where it is computed.
        p: the Euler parameters.
        scaled: `scaled_parameters`.
    """
    emit = builder.emit
    w, *e = p
    found: Entries = {}
    one = builder.constant(1)
    squares = [emit(Op.MULTIPLY, scaled[k + 1], e[k]) for k in range(3)]
    for k in range(3):
        m, n = (k + 1) % 3, (k + 2) % 3
        found[k, k] = emit(Op.SUBTRACT, one, emit(Op.ADD, squares[m], squares[n]))
        product = emit(Op.MULTIPLY, scaled[m + 1], e[n])
        turn = emit(Op.MULTIPLY, scaled[k + 1], w)
        found[m, n] = emit(Op.SUBTRACT, product, turn)
        found[n, m] = emit(Op.ADD, product, turn)
    return found


def plane_rotation(builder: Builder, angle: int) -> Entries:
    """The turn about the normal, [2, 2]."""
    cosine, sine = builder.emit(Op.COS, angle), builder.emit(Op.SIN, angle)
    return {(0, 0): cosine, (1, 0): sine, (0, 1): builder.emit(Op.NEGATE, sine), (1, 1): cosine}


def rate_map(builder: Builder, p: list[int]) -> Entries:
    """``G(p)``, [3, 4]; with ``s p`` in place of ``p`` what ``delta pi`` is of ``delta p``."""
    found: Entries = {}
    for i, row in enumerate(_G):
        for k, signed in enumerate(row):
            found[i, k] = builder.emit(Op.NEGATE, p[-signed]) if signed < 0 else p[signed]
    return found
