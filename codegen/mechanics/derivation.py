"""Derive the quantities of a routine from the rows of a formulation.

``phi``; ``phi_q``, S1 Eqs. (5) to (8), (13), (20), (32); ``phi_q_t_lambda_q`` = d(phi_q^T lambda)/dq, Eqs. (9), (14), (25),
(36), (37); ``gamma``, the right-hand side of ``phi_q a = gamma``; and the products ``phi_q v`` and ``phi_q^T lambda``.
All of them are read off variations; no derivative is typed in.
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.ir.lower import Block, Dot, SymbolicOutput
from codegen.mechanics import frames
from codegen.mechanics.formulation import Formulation, height
from codegen.mechanics.rank_one import rank_one
from codegen.mechanics.terms import assemble, expand
from codegen.mechanics.variation import Variation, coefficient, gradient


def derive(form: Formulation, quantity: str) -> SymbolicOutput:
    """Derive one quantity; its name is one of `codegen.spec.request.OUTPUTS` except ``all``."""
    return {
        "phi": _phi,
        "phi_q": _phi_q,
        "phi_q_t_lambda_q": _phi_q_t_lambda_q,
        "gamma": _gamma,
        "phi_q_v": _phi_q_v,
        "phi_q_t_lambda": _phi_q_t_lambda,
    }[quantity](form)


def _virtual(form: Formulation) -> Variation:
    return Variation(form.algebra, form.stages, form.virtual, form.partials)


def _offsets(form: Formulation) -> list[tuple[int, Any]]:
    """Each entry of the rows with the number of the row it starts at."""
    places, start = [], 0
    for row in form.rows:
        places.append((start, row))
        start += height(row)
    return places


def _column(name: str, form: Formulation, rows: list[Any]) -> SymbolicOutput:
    starts = [start for start, _ in _offsets(form)]
    blocks = tuple(Block(start, 0, row) for start, row in zip(starts, rows, strict=True))
    return SymbolicOutput(name, (form.row_count, 1), blocks)


def _phi(form: Formulation) -> SymbolicOutput:
    return _column("phi", form, list(form.rows))


def jacobian_blocks(form: Formulation) -> list[tuple[int, int, Any]]:
    """Blocks of phi_q: (row, column, expression); a scalar row's block is the gradient vector, to be transposed."""
    variation = _virtual(form)
    blocks = []
    for start, row in _offsets(form):
        varied = variation.of(row)
        for displacement, column in form.displacements:
            read = coefficient if height(row) == 3 else gradient
            blocks.append((start, column, substituted(read(varied, displacement, form.algebra), form)))
    return [block for block in blocks if not _is_zero(block[2])]


def _phi_q(form: Formulation) -> SymbolicOutput:
    heights = {start: height(row) for start, row in _offsets(form)}
    blocks = tuple(
        Block(row, column, sympy.Transpose(block) if heights[row] == 1 and column < 12 else block)
        for row, column, block in jacobian_blocks(form)
    )
    return SymbolicOutput("phi_q", (form.row_count, form.column_count), blocks)


def substituted(expression: Any, form: Formulation) -> Any:
    """Insert the joint relation (S1 section 3.2), where the formulation asks for it."""
    if not form.substitution:
        return expression
    replaced = expression.xreplace(form.substitution)
    if not isinstance(replaced, sympy.matrices.expressions.matexpr.MatrixExpr):
        dots = {dot: form.algebra.dot(*dot.args) for dot in sorted(replaced.atoms(Dot), key=str)}
        return sympy.sympify(replaced.xreplace(dots))
    return form.algebra.normal(form.algebra.normal(replaced))


def lagrangian(form: Formulation) -> Any:
    """``lambda^T phi``; scalar products that share a vector are collected, so that lambda is multiplied in first."""
    multipliers = frames.multipliers(form.row_count)
    total = sympy.S.Zero
    for start, row in _offsets(form):
        if height(row) == 3:
            force = sympy.ImmutableDenseMatrix(multipliers[start : start + 3])
            for c, chain in form.algebra.terms(row):
                total += c * form.algebra.dot(force, assemble([(sympy.S.One, chain)], (3, 1)))
        else:
            total += multipliers[start] * row
    return collected(total, form)


def collected(expression: Any, form: Formulation) -> Any:
    """Collect ``l1 a . c + l2 b . c`` to ``(l1 a + l2 b) . c``, on the side that leaves fewer scalar products."""
    pairs, rest = [], sympy.S.Zero
    for term in sympy.Add.make_args(expand(expression)):
        dots = term.atoms(Dot)
        if len(dots) == 1:
            dot = next(iter(dots))
            pairs.append((term.coeff(dot), *dot.args))
        else:
            rest += term
    groupings = [_grouped(pairs, side) for side in (2, 1)]
    best = min(groupings, key=len)
    for shared, parts, side in best:
        summed = form.algebra.normal(assemble([(c, (vector,)) for c, vector in parts], (3, 1)))
        rest += form.algebra.dot(summed, shared) if side == 2 else form.algebra.dot(shared, summed)
    return rest


def _grouped(pairs: list[tuple[Any, Any, Any]], side: int) -> list[tuple[Any, list[tuple[Any, Any]], int]]:
    groups: dict[Any, list[tuple[Any, Any]]] = {}
    for pair in pairs:
        groups.setdefault(pair[side], []).append((pair[0], pair[3 - side]))
    return [(shared, parts, side) for shared, parts in groups.items()]


def force_blocks(form: Formulation) -> list[tuple[int, Any]]:
    """Blocks of ``phi_q^T lambda``: (first row, expression)."""
    varied = _virtual(form).of(lagrangian(form))
    blocks = [
        (column, substituted(gradient(varied, displacement, form.algebra), form))
        for displacement, column in form.displacements
    ]
    return [(column, block) for column, block in blocks if not _is_zero(block)]


def _phi_q_t_lambda(form: Formulation) -> SymbolicOutput:
    blocks = tuple(Block(row, 0, block) for row, block in force_blocks(form))
    return SymbolicOutput("phi_q_t_lambda", (form.column_count, 1), blocks)


def _phi_q_t_lambda_q(form: Formulation) -> SymbolicOutput:
    variation = _virtual(form)
    blocks = []
    for row, force in force_blocks(form):
        varied = variation.of(force)
        for displacement, column in form.displacements:
            if column < 12 and form.substitution:
                continue
            if row < 12:
                block = rank_one(coefficient(varied, displacement, form.algebra), form.algebra)
            else:
                block = gradient(varied, displacement, form.algebra)
            if not _is_zero(block):
                blocks.append(Block(row, column, sympy.Transpose(block) if row >= 12 and column < 12 else block))
    size = form.column_count
    return SymbolicOutput("phi_q_t_lambda_q", (size, size), tuple(blocks))


def velocity_rows(form: Formulation) -> list[Any]:
    """``phi_q v``, entry by entry of the rows."""
    if not form.substitution:
        variation = Variation(form.algebra, form.stages, form.rates, form.partials)
        return [variation.of(row) for row in form.rows]
    velocity_of = {column: v for (_, column), v in zip(form.displacements, form.velocities, strict=True)}
    rows: dict[int, Any] = {}
    for start, row in _offsets(form):
        rows[start] = sympy.ZeroMatrix(3, 1) if height(row) == 3 else sympy.S.Zero
    for start, column, block in jacobian_blocks(form):
        velocity = velocity_of[column]
        if isinstance(rows[start], sympy.matrices.expressions.matexpr.MatrixExpr):
            product = sympy.MatMul(block, velocity) if column < 12 else sympy.MatMul(velocity, block)
            rows[start] = sympy.MatAdd(rows[start], _distributed(product))
        else:
            rows[start] += form.algebra.dot(block, velocity) if column < 12 else block * velocity
    return [
        form.algebra.normal(row) if isinstance(row, sympy.matrices.expressions.matexpr.MatrixExpr) else row
        for row in rows.values()
    ]


def _distributed(product: Any) -> Any:
    """Multiply a velocity into a sum."""
    first, last = product.args
    for factor, other, is_left in ((first, last, True), (last, first, False)):
        if isinstance(factor, sympy.MatAdd):
            return sympy.MatAdd(*(sympy.MatMul(*((t, other) if is_left else (other, t))) for t in factor.args))
    return product


def _phi_q_v(form: Formulation) -> SymbolicOutput:
    return _column("phi_q_v", form, velocity_rows(form))


def _gamma(form: Formulation) -> SymbolicOutput:
    """``-d(phi_q v)/dt`` at zero acceleration (rddot = 0 in world axes, omegadot = 0, alphaddot = 0)."""
    variation = Variation(form.algebra, form.stages, form.rates | form.velocity_rates, form.partials)
    return _column("gamma", form, [_negated(variation.of(row)) for row in velocity_rows(form)])


def _negated(expression: Any) -> Any:
    if isinstance(expression, sympy.matrices.expressions.matexpr.MatrixExpr):
        return sympy.MatMul(-1, expression) if not isinstance(expression, sympy.ZeroMatrix) else expression
    return -expression


def _is_zero(expression: Any) -> bool:
    return expression == 0 or isinstance(expression, sympy.ZeroMatrix)
