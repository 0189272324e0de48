"""Householder's triangular factor in straight-line code, and what follows from it.

The reflections are backward stable whatever the matrix, so that every value that is read off the factor is right to
eps kappa, where Gram matrices lose eps kappa^2. A column that is dependent on those before it, but for rounding, is
reflected by nothing and leaves an exact zero on the diagonal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import sympy

from codegen.ir.lower.staged import Select, Stages

TINY = sympy.Rational(1, 2**120)
"""Below any value that is not zero: intermediate results are of size 1."""


@dataclass
class Reflections:
    """A factorisation under way.

    Attributes:
        stages: gets its steps.
        name: of the matrix.
        columns: of the matrix, reflected so far; entries that are structurally zero stay so.
        limits: size of each column's remainder below which it is rounding.
        are_values_judged: whether the diagonal of what is rounding becomes 0; otherwise it stays.
        inverses: of the diagonal; 0 where the diagonal is 0.
    """

    stages: Stages
    name: str
    columns: list[sympy.Matrix]
    limits: Sequence[sympy.Rational]
    are_values_judged: bool = True
    inverses: list[sympy.Expr] = field(default_factory=list)
    _finished: list[int] = field(default_factory=list)

    def eliminate(self, step: int, column: int, rows: Sequence[int]) -> None:
        """Reflect so that a column keeps only the first of some rows.

        Args:
            step: number of the reflection, for names.
            column: that is eliminated.
            rows: the row that stays and those that become zero.
        """
        stages, name = self.stages, f"{self.name}_{step + 1}"
        rows = [rows[0], *(row for row in rows[1:] if self.columns[column][row] != 0)]
        x = [self.columns[column][row] for row in rows]
        norm = stages.stage(f"x_{name}", _one(sympy.sqrt(sum(v * v for v in x))), "norm of what is eliminated")[0]
        limit = self.limits[column]
        signed = stages.stage(f"signed_{name}", _one(Select(x[0], 0, -norm, norm)), f"x_{name} with the sign of v_1")[0]
        head = stages.stage(f"v_{name}", _one(x[0] + signed), "first component of v; the others stay as they are")[0]
        weight = stages.stage(f"y_{name}", _one(signed * head), "|v|^2 / 2")[0]
        quotient = stages.stage(f"q_{name}", _one(1 / weight), "1 / weight")[0]
        words = "the reflection is I - beta v v^T, the first row of it with the other sign"
        beta = stages.stage(f"beta_{name}", _one(Select(norm, limit, 0, quotient)), words)[0]
        v = [head, *x[1:]]
        for k in (k for k in range(len(self.columns)) if k not in (*self._finished, column)):
            self._reflect(f"{name}_{k + 1}", k, rows, v, beta)
        value = Select(norm, limit, 0, signed) if self.are_values_judged else signed
        diagonal = stages.stage(f"r_{name}", _one(value), f"diagonal {step + 1} of R")[0]
        inverse = stages.stage(f"i_{name}", _one(beta * head), "its inverse, or 0")[0]
        self.inverses.append(inverse)
        self._finish(column, rows, diagonal)

    def last(self, step: int, column: int, row: int) -> None:
        """Judge the last diagonal of a square factor, which needs no reflection."""
        name, x = f"{self.name}_{step + 1}", self.columns[column][row]
        size = self.stages.stage(f"x_{name}", _one(sympy.Abs(x)), "size of what is left")[0]
        limit = self.limits[column]
        value = Select(size, limit, 0, x) if self.are_values_judged else x
        diagonal = self.stages.stage(f"r_{name}", _one(value), f"diagonal {step + 1} of R")[0]
        inverse = self.stages.stage(f"i_{name}", _one(Select(size, limit, 0, 1 / x)), "its inverse, or 0")[0]
        self.inverses.append(inverse)
        self._finish(column, [row], diagonal)

    def _reflect(self, name: str, k: int, rows: list[int], v: list[sympy.Expr], beta: sympy.Expr) -> None:
        column = self.columns[k]
        rest = sum((a * column[row] for a, row in zip(v[1:], rows[1:], strict=True)), sympy.Integer(0))
        rest = self.stages.stage(f"s_{name}", _one(rest), "v^T a but for the first components, which come later")[0]
        product = v[0] * column[rows[0]] + rest
        if product == 0:
            return
        factor = self.stages.stage(f"f_{name}", _one(product), "v^T a")[0]
        factor = self.stages.stage(f"g_{name}", _one(factor * beta), "beta v^T a")[0]
        changed = list(column)
        for a, row in zip(v, rows, strict=True):
            changed[row] = column[row] - factor * a
        changed[rows[0]] = -changed[rows[0]]
        words = "a - beta v v^T a, the first row with the other sign"
        self.columns[k] = self.stages.stage(f"a_{name}", sympy.Matrix(changed), words)

    def _finish(self, column: int, rows: Sequence[int], diagonal: sympy.Expr) -> None:
        entries = list(self.columns[column])
        entries[rows[0]] = diagonal
        for row in rows[1:]:
            entries[row] = sympy.Integer(0)
        self.columns[column] = sympy.Matrix(entries)
        self._finished.append(column)

    def block(self, rows: Sequence[int], columns: Sequence[int]) -> sympy.Matrix:
        """Rows and columns of what has become of the matrix."""
        return sympy.Matrix([[self.columns[k][row] for k in columns] for row in rows])


@dataclass(frozen=True)
class Triangle:
    """An upper triangular 3 x 3 block.

    Attributes:
        name: of the values that it has, for example ``sigma``.
        T: [3, 3].
        inverses: of its diagonal; 0 where that is 0.
        inverse: [3, 3] of the block.
    """

    name: str
    T: sympy.Matrix
    inverses: tuple[sympy.Expr, sympy.Expr, sympy.Expr]
    inverse: sympy.Matrix


def triangle(
    stages: Stages, name: str, T: sympy.Matrix, inverses: tuple[sympy.Expr, sympy.Expr, sympy.Expr]
) -> Triangle:
    """Make a triangle; its inverse comes by substitution.

    Args:
        stages: gets the steps.
        name: of its values.
        T: [3, 3] upper triangular.
        inverses: of its diagonal.
    """
    a, b, c = inverses
    products = stages.stage(f"products_{name}", sympy.Matrix([T[0, 1] * b, T[1, 2] * c]), "t_12 / t_22, t_23 / t_33")
    v_12 = stages.stage(f"v12_{name}", _one(-a * products[0]), "entry 1, 2 of the inverse")[0]
    v_23 = stages.stage(f"v23_{name}", _one(-b * products[1]), "entry 2, 3 of the inverse")[0]
    rest = stages.stage(f"rest_{name}", _one(T[0, 1] * v_23 + T[0, 2] * c), "t_12 v_23 + t_13 / t_33")[0]
    v_13 = stages.stage(f"v13_{name}", _one(-a * rest), "entry 1, 3 of the inverse")[0]
    return Triangle(name, T, inverses, sympy.Matrix([[a, v_12, v_13], [0, b, v_23], [0, 0, c]]))


def solved(stages: Stages, name: str, triangle: Triangle, right: sympy.Matrix) -> sympy.Matrix:
    """Solve ``T x = right`` for any number of columns, by substitution from the last row up."""
    a, b, c = triangle.inverses
    T = triangle.T
    x_3 = stages.stage(f"{name}_3", right[2, :] * c, "last row of the solution")
    rest_2 = stages.stage(f"{name}_rest_2", right[1, :] - T[1, 2] * x_3, "right-hand side of row 2")
    x_2 = stages.stage(f"{name}_2", rest_2 * b, "second row of the solution")
    rest_1 = right[0, :] - T[0, 1] * x_2 - T[0, 2] * x_3
    rest_1 = stages.stage(f"{name}_rest_1", rest_1, "right-hand side of row 1")
    x_1 = stages.stage(f"{name}_1", rest_1 * a, "first row of the solution")
    return sympy.Matrix.vstack(x_1, x_2, x_3)


def _one(value: sympy.Expr) -> sympy.Matrix:
    return sympy.Matrix([value])
