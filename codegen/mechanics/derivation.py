"""Derive the quantities of a routine from the rows of a formulation.

``phi``; ``phi_q``, S1 Eqs. (5) to (8), (13), (20), (32); ``phi_q_t_lambda_q`` = d(phi_q^T lambda)/dq, Eqs. (9), (14),
(25), (36), (37); ``gamma``, the right-hand side of ``phi_q a = gamma``; the products ``phi_q v`` and
``phi_q^T lambda``; and ``phi_q_v_q`` = d(phi_q v)/dq at fixed v. All of them are read off variations; no derivative is
typed in.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import sympy
from sympy.matrices.expressions.matexpr import MatrixExpr

from codegen.errors import InternalError
from codegen.ir.lower import Block, SymbolicOutput
from codegen.mechanics import frames
from codegen.mechanics.algebra import Algebra
from codegen.mechanics.formulation import Formulation, height
from codegen.mechanics.terms import assemble, expand, scalar_products
from codegen.mechanics.variation import Variation, coefficient, gradient

AS_IT_STANDS = ("phi", "branch")
"""Quantities that never take the joint relation for granted: they say whether it holds."""


def is_matrix(expression: Any) -> bool:
    """Whether an expression is a vector or matrix, not a scalar."""
    return isinstance(expression, MatrixExpr)


class Derivation:
    """Everything that follows from one formulation; each part is derived once, when it is first asked for."""

    def __init__(self, form: Formulation) -> None:
        self.form = form
        self._virtual = Variation(form.algebra, form.stages, form.virtual, form.partials)
        self._quantities: dict[str, SymbolicOutput] = {}

    def quantity(self, name: str) -> SymbolicOutput:
        """Derive one of the quantities of `codegen.spec.request`, ``phi_q_v_q`` or ``branch``."""
        if name not in self._quantities:
            self._quantities[name] = self._derived(name)
        return self._quantities[name]

    def _derived(self, name: str) -> SymbolicOutput:
        form = self.form
        size = form.column_count
        match name:
            case "phi":
                return self._column("phi", list(form.rows))
            case "phi_q":
                return SymbolicOutput("phi_q", (form.row_count, size), self._laid(self.jacobian_blocks))
            case "phi_q_t_lambda_q":
                return SymbolicOutput("phi_q_t_lambda_q", (size, size), self._second_derivative())
            case "gamma":
                return self._column("gamma", self._gamma_rows())
            case "phi_q_v":
                return self._column("phi_q_v", self.velocity_rows)
            case "phi_q_v_q":
                blocks = self._laid(self._derivatives(self.velocity_rows))
                return SymbolicOutput("phi_q_v_q", (form.row_count, size), blocks)
            case "phi_q_t_lambda":
                blocks = tuple(Block(row, 0, block) for row, block in self.force_blocks)
                return SymbolicOutput("phi_q_t_lambda", (size, 1), blocks)
            case "branch":
                return SymbolicOutput("branch", (1, 1), (Block(0, 0, form.branch),))
        raise InternalError(f"no derivation of {name}")

    @cached_property
    def _places(self) -> list[tuple[int, Any]]:
        """Each entry of the rows with the number of the row it starts at."""
        places, start = [], 0
        for row in self.form.rows:
            places.append((start, row))
            start += height(row)
        return places

    def _column(self, name: str, rows: list[Any]) -> SymbolicOutput:
        blocks = tuple(Block(start, 0, row) for (start, _), row in zip(self._places, rows, strict=True))
        return SymbolicOutput(name, (self.form.row_count, 1), blocks)

    @cached_property
    def jacobian_blocks(self) -> list[tuple[int, int, Any]]:
        """Blocks of phi_q: (row, column, expression); the block of a scalar row is its gradient, to be transposed."""
        return self._derivatives(list(self.form.rows))

    def _derivatives(self, rows: list[Any]) -> list[tuple[int, int, Any]]:
        """Blocks of the derivative of rows that stand at the places of the constraint's, as `jacobian_blocks`."""
        blocks = []
        for (start, _), row in zip(self._places, rows, strict=True):
            varied = self._virtual.of(row)
            read = coefficient if is_matrix(row) else gradient
            for displacement, column in self.form.displacements:
                block = self.substituted(read(varied, displacement, self.form.algebra))
                if not is_zero(block):
                    blocks.append((start, column, block))
        return blocks

    def _laid(self, derivatives: list[tuple[int, int, Any]]) -> tuple[Block, ...]:
        tall = {start for start, row in self._places if is_matrix(row)}
        return tuple(
            Block(row, column, block if row in tall or column >= 12 else sympy.Transpose(block))
            for row, column, block in derivatives
        )

    def substituted(self, expression: Any) -> Any:
        """Insert the joint relation (S1 section 3.2) where the formulation asks for it; else reduce stages."""
        algebra = self.form.algebra
        replaced = expression.xreplace(self.form.substitution or self.form.reduction)
        if is_matrix(replaced):
            return algebra.normal(algebra.normal(replaced))
        return replaced.xreplace({dot: algebra.dot(*dot.args) for dot in scalar_products(replaced)})

    @cached_property
    def force_blocks(self) -> list[tuple[int, Any]]:
        """Blocks of ``phi_q^T lambda``: (first row, expression)."""
        varied = self._virtual.of(lagrangian(self.form))
        blocks = [
            (column, self.substituted(gradient(varied, displacement, self.form.algebra)))
            for displacement, column in self.form.displacements
        ]
        return [(column, block) for column, block in blocks if not is_zero(block)]

    def _second_derivative(self) -> tuple[Block, ...]:
        blocks = []
        for row, force in self.force_blocks:
            varied = self._virtual.of(force)
            for displacement, column in self.form.displacements:
                block = self._second_block(varied, displacement)
                if not is_zero(block):
                    blocks.append(Block(row, column, sympy.Transpose(block) if row >= 12 and column < 12 else block))
        return tuple(blocks)

    def _second_block(self, varied_force: Any, displacement: Any) -> Any:
        algebra = self.form.algebra
        if is_matrix(varied_force):
            return coefficient(varied_force, displacement, algebra)
        return gradient(varied_force, displacement, algebra)

    @cached_property
    def velocity_rows(self) -> list[Any]:
        """``phi_q v``, entry by entry of the rows."""
        form = self.form
        if not form.substitution:
            variation = Variation(form.algebra, form.stages, form.rates, form.partials)
            return [self.substituted(variation.of(row)) for row in form.rows]
        velocity_of = {column: v for (_, column), v in zip(form.displacements, form.velocities, strict=True)}
        rows: dict[int, Any] = {
            start: sympy.ZeroMatrix(3, 1) if is_matrix(row) else sympy.S.Zero for start, row in self._places
        }
        for start, column, block in self.jacobian_blocks:
            velocity = velocity_of[column]
            if is_matrix(rows[start]):
                rows[start] = sympy.MatAdd(rows[start], _product(block, velocity))
            else:
                rows[start] += form.algebra.dot(block, velocity) if column < 12 else block * velocity
        return [form.algebra.normal(row) if is_matrix(row) else row for row in rows.values()]

    def _gamma_rows(self) -> list[Any]:
        """``-d(phi_q v)/dt`` at zero acceleration (rddot = 0 in world axes, omegadot = 0, alphaddot = 0)."""
        form = self.form
        variation = Variation(form.algebra, form.stages, form.rates | form.velocity_rates, form.partials)
        return [_negated(variation.of(row)) for row in self.velocity_rows]


def lagrangian(form: Formulation) -> Any:
    """``lambda^T phi``; scalar products that share a vector are collected, so that lambda is multiplied in first."""
    multipliers = frames.multipliers(form.row_count)
    total, start = sympy.S.Zero, 0
    for row in form.rows:
        if is_matrix(row):
            force = sympy.ImmutableDenseMatrix(multipliers[start : start + 3])
            for c, chain in form.algebra.terms(row):
                total += c * form.algebra.dot(force, assemble([(sympy.S.One, chain)], (3, 1)))
        else:
            total += multipliers[start] * row
        start += height(row)
    return collected(total, form.algebra)


def collected(expression: Any, algebra: Algebra) -> Any:
    """Collect ``l1 a . c + l2 b . c`` to ``(l1 a + l2 b) . c``, on the side that leaves fewer scalar products."""
    pairs, rest = [], sympy.S.Zero
    for term in sympy.Add.make_args(expand(expression)):
        dots = scalar_products(term)
        if len(dots) == 1:
            pairs.append((term.coeff(dots[0]), *dots[0].args))
        else:
            rest += term
    for shared, parts, side in min((_grouped(pairs, side) for side in (2, 1)), key=len):
        summed = algebra.normal(assemble([(c, (vector,)) for c, vector in parts], (3, 1)))
        rest += algebra.dot(summed, shared) if side == 2 else algebra.dot(shared, summed)
    return rest


def _grouped(pairs: list[tuple[Any, Any, Any]], side: int) -> list[tuple[Any, list[tuple[Any, Any]], int]]:
    groups: dict[Any, list[tuple[Any, Any]]] = {}
    for pair in pairs:
        groups.setdefault(pair[side], []).append((pair[0], pair[3 - side]))
    return [(shared, parts, side) for shared, parts in groups.items()]


def _product(block: Any, velocity: Any) -> Any:
    """Block times velocity, term by term; a column times a scalar rate where the coordinate is an alpha."""
    terms = block.args if isinstance(block, sympy.MatAdd) else (block,)
    products = [sympy.MatMul(term, velocity) if is_matrix(velocity) else sympy.MatMul(velocity, term) for term in terms]
    return sympy.MatAdd(*products) if len(products) > 1 else products[0]


def _negated(expression: Any) -> Any:
    if not is_matrix(expression):
        return -expression
    return expression if isinstance(expression, sympy.ZeroMatrix) else sympy.MatMul(-1, expression)


def is_zero(expression: Any) -> bool:
    """Whether an expression is structurally zero."""
    return isinstance(expression, sympy.ZeroMatrix) or (not is_matrix(expression) and expression == 0)
