"""The two vector operations that sympy's matrix expressions lack: `Tilde` (skew matrix of a vector) and `Dot`."""

from __future__ import annotations

from typing import Any

import sympy
from sympy.matrices.expressions.matexpr import MatrixExpr


class Tilde(MatrixExpr):
    """Skew matrix of a 3-vector: ``Tilde(a) b = a x b``, the tilde of S1 Eq. (6)."""

    def __new__(cls, vector: Any) -> Tilde:
        """Build the node; ``vector`` is a [3] matrix expression."""
        return MatrixExpr.__new__(cls, vector)

    @property
    def shape(self) -> tuple[int, int]:
        """Always 3 x 3."""
        return (3, 3)

    @property
    def vector(self) -> Any:
        """The vector whose cross product this is."""
        return self.args[0]

    def _sympystr(self, printer: Any) -> str:
        return f"tilde({printer.doprint(self.args[0])})"


class Dot(sympy.Expr):
    """Scalar product of two 3-vectors given as matrix expressions."""

    is_commutative = True

    def __new__(cls, left: Any, right: Any) -> Dot:
        """Build the node as it stands; the order of the two is kept."""
        return sympy.Expr.__new__(cls, left, right)

    def _sympystr(self, printer: Any) -> str:
        return f"dot({printer.doprint(self.args[0])}, {printer.doprint(self.args[1])})"
