"""Blocks of a plane scene: of a turn only the part about the normal of the plane is left."""

from __future__ import annotations

from typing import Any

import sympy

from codegen.ir.lower import Dot
from codegen.mechanics.derivation import is_matrix


def about_normal(expression: Any, rows: Any | None, columns: Any | None) -> Any:
    """Keep of a block the turn about the normal of the plane.

    The normal comes first in a scalar product: its frame is that of components that are written out in the other.

    Args:
        expression: matrix, vector, row or scalar.
        rows: the normal, where the rows of the block are turns.
        columns: the normal, where its columns are turns.
    """
    if columns is not None:
        is_row = is_matrix(expression) and expression.shape[0] == 1
        expression = Dot(columns, _turned(expression)) if is_row else sympy.MatMul(expression, columns)
    if rows is not None:
        is_column = is_matrix(expression) and expression.shape[1] == 1
        expression = Dot(rows, expression) if is_column else sympy.MatMul(sympy.Transpose(rows), expression)
    return expression


def _turned(row: Any) -> Any:
    return row.arg if isinstance(row, sympy.Transpose) else sympy.Transpose(row)
