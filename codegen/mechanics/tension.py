"""The tension ``k (l - l0) + c ldot`` of a spring and damper between two points, over the length: a force density."""

from __future__ import annotations

from typing import Any

import sympy

square, length, inverse, inverse_square = sympy.symbols("length_squared length inverse_length inverse_square")
"""``d . d``, ``l``, ``1 / l`` and ``1 / l^2``."""

closing = sympy.Symbol("length_rate")
"""``d . ddot = l ldot``."""

density, stiffening, drag = sympy.symbols("force_density stiffening drag")
"""Tension over length, N/m, and its derivatives by ``d . d / 2`` and by ``d . ddot``."""


def tension(k: Any, c: Any, l_0: Any) -> dict[Any, Any]:
    """Define the density and its derivatives by `square` and `closing`; without a free length no root is taken.

    Args:
        k: stiffness, N/m.
        c: damping, N s/m.
        l_0: free length, m.

    Returns:
        Symbol -> definition, each in symbols of those before it.
    """
    has_root = k * l_0 != 0
    roots = {length: sympy.sqrt(square), inverse: 1 / length} if has_root else {inverse_square: 1 / square}
    over_square = inverse**2 if has_root else inverse_square
    return roots | {
        drag: c * over_square,
        density: k * (1 - l_0 * inverse) + drag * closing,
        stiffening: (k * l_0 * inverse - 2 * drag * closing) * over_square,
    }
