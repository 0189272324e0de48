"""Variations of staged expressions, and the linear forms they are read as.

A model names its stages (``A_ij``, ``d_ij`` ...). The variation of a root symbol is given (``delta A_i = A_i delta
pi_i~``); that of a stage follows from its definition, once, and stays in named terms. A Jacobian is read off a
variation by moving the virtual displacement to the right (S1 Eqs. (5) to (8)); the same product rule with velocities
in place of virtual displacements gives time derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy
from sympy.matrices.matrixbase import MatrixBase

from codegen.errors import InternalError
from codegen.ir.lower import Dot, Tilde
from codegen.mechanics.algebra import Algebra
from codegen.mechanics.terms import (
    Factors,
    Terms,
    assemble,
    expand,
    scalar_products,
    transposed_chain,
)


class Variation:
    """The product rule for given variations of the root symbols.

    Args:
        algebra: normal form in force.
        stages: symbol -> definition.
        roots: symbol -> its variation, a matrix expression (or a scalar for scalar symbols); others are constant.
        partials: scalar stage -> its partial derivatives by other scalar stages, where they are known in better
            terms than those of its definition.
    """

    def __init__(
        self,
        algebra: Algebra,
        stages: Mapping[Any, Any],
        roots: Mapping[Any, Any],
        partials: Mapping[Any, Mapping[Any, Any]],
    ) -> None:
        self.algebra = algebra
        self._stages = stages
        self._partials = partials
        self._known: dict[Any, Any] = dict(roots)

    def of(self, expression: Any) -> Any:
        """Vary a scalar or matrix expression."""
        if isinstance(expression, sympy.matrices.expressions.matexpr.MatrixExpr | MatrixBase):
            return assemble(self._matrix(expression), expression.shape)
        return self._scalar(expression)

    def _matrix(self, expression: Any) -> Terms:
        return self._product_rule(self.algebra.terms(expression), expression.shape)

    def _product_rule(self, terms: Terms, shape: tuple[int, int]) -> Terms:
        varied: Terms = []
        for coefficient, factors in terms:
            change = self._scalar(coefficient)
            if change != 0:
                varied.append((change, factors))
            for k, factor in enumerate(factors):
                varied += [
                    (coefficient * c, (*factors[:k], *chain, *factors[k + 1 :])) for c, chain in self._factor(factor)
                ]
        return self.algebra.terms(assemble(varied, shape))

    def _factor(self, factor: Any) -> Terms:
        if isinstance(factor, sympy.MatrixSymbol):
            change = self._symbol(factor)
            return [] if change is None else self.algebra.terms(change)
        if isinstance(factor, sympy.Transpose):
            turned = [(c, transposed_chain(chain)) for c, chain in self._factor(factor.arg)]
            return [(c * sign, chain) for c, (sign, chain) in turned]
        if isinstance(factor, Tilde):
            return [(c, (Tilde(assemble([(sympy.S.One, chain)], (3, 1))),)) for c, chain in self._matrix(factor.vector)]
        if isinstance(factor, sympy.MatAdd):
            return self._matrix(factor)
        if isinstance(factor, MatrixBase):
            symbols = sorted(factor.free_symbols, key=lambda symbol: symbol.name)
            changes = [(self._symbol(symbol), symbol) for symbol in symbols]
            return [
                (change, (sympy.ImmutableDenseMatrix(factor.diff(symbol)),))
                for change, symbol in changes
                if change is not None
            ]
        raise InternalError(f"no variation of {type(factor).__name__}")

    def _symbol(self, symbol: Any) -> Any:
        """Variation of a root or stage; None for a constant."""
        if symbol not in self._known and symbol in self._partials:
            changes = [partial * (self._symbol(by) or 0) for by, partial in self._partials[symbol].items()]
            self._known[symbol] = expand(sympy.Add(*changes))
        if symbol not in self._known:
            definition = self._stages.get(symbol)
            change = None if definition is None else self._of_definition(definition)
            is_zero = change is None or change == 0 or isinstance(change, sympy.ZeroMatrix)
            self._known[symbol] = None if is_zero else change
        return self._known[symbol]

    def _of_definition(self, definition: Any) -> Any:
        """Vary a definition as it is written: its own name must not be folded back into it."""
        if isinstance(definition, sympy.matrices.expressions.matexpr.MatrixExpr | MatrixBase):
            terms = self.algebra.without_names().terms(definition)
            return assemble(self._product_rule(terms, definition.shape), definition.shape)
        return self._scalar(definition)

    def _scalar(self, expression: Any) -> Any:
        if expression.is_Number:
            return sympy.S.Zero
        stand_ins = {dot: sympy.Symbol(f"__dot_{k}") for k, dot in enumerate(scalar_products(expression))}
        plain = expression.xreplace(stand_ins)
        back = {stand_in: dot for dot, stand_in in stand_ins.items()}
        change = sympy.S.Zero
        for symbol in sorted(plain.free_symbols, key=lambda symbol: symbol.name):
            rate = self._dot(back[symbol]) if symbol in back else self._symbol(symbol)
            if rate is not None and rate != 0:
                change += plain.diff(symbol).xreplace(back) * rate
        return expand(change)

    def _dot(self, dot: Dot) -> Any:
        """``delta (a . b) = delta a . b + a . delta b``, one scalar product for each varied term."""
        left, right = dot.args
        change = sympy.S.Zero
        for c, chain in self._matrix(left):
            change += c * self.algebra.dot(assemble([(sympy.S.One, chain)], (3, 1)), right)
        for c, chain in self._matrix(right):
            change += c * self.algebra.dot(left, assemble([(sympy.S.One, chain)], (3, 1)))
        return change


def coefficient(expression: Any, displacement: Any, algebra: Algebra) -> Any:
    """Read the matrix that multiplies a virtual displacement in a varied vector.

    Args:
        expression: [n] vector, linear in the displacement.
        displacement: [3] vector symbol, or a scalar symbol.
        algebra: normal form in force.

    Returns:
        [n, 3] matrix expression, or [n] vector for a scalar displacement.
    """
    scalar = not isinstance(displacement, sympy.MatrixSymbol)
    collected: Terms = []
    for c, factors in algebra.terms(expression):
        if scalar:
            collected.append((expand(c).coeff(displacement), factors))
            continue
        matrix = _isolated(factors, displacement)
        collected += [(c * sign, chain) for sign, chain in matrix]
        for part, row in _rows(c, displacement, algebra):
            sign, turned = transposed_chain(row)
            collected.append((part * sign, (*factors, *turned)))
    nrow = expression.shape[0]
    return algebra.normal(assemble([t for t in collected if t[0] != 0], (nrow, 1 if scalar else 3)))


def gradient(expression: Any, displacement: Any, algebra: Algebra) -> Any:
    """Read the vector g with ``delta e = g . displacement`` off a varied scalar.

    Returns:
        [3] vector expression, or a scalar for a scalar displacement.
    """
    if not isinstance(displacement, sympy.MatrixSymbol):
        return expand(expression).coeff(displacement)
    return algebra.normal(assemble(_rows(expression, displacement, algebra), (3, 1)))


def _rows(expression: Any, displacement: Any, algebra: Algebra) -> Terms:
    """Terms of the gradient of a scalar that is linear in the displacement."""
    collected: Terms = []
    for term in sympy.Add.make_args(expand(expression)):
        dots = [dot for dot in scalar_products(term) if dot.has(displacement)]
        if not dots:
            continue
        if len(dots) > 1:
            raise InternalError(f"not linear in {displacement}: {term}")
        left, right = dots[0].args
        moving, still = (left, right) if left.has(displacement) else (right, left)
        for c, chain in algebra.terms(moving):
            for inner, matrix in _isolated(chain, displacement):
                sign, turned = transposed_chain(matrix)
                still_terms = algebra.terms(still)
                rest = [(outer, (*turned, *vector)) for outer, vector in still_terms]
                collected += [(term.coeff(dots[0]) * c * inner * sign * outer, vector) for outer, vector in rest]
    return collected


def _isolated(factors: Factors, displacement: Any) -> Terms:
    """Move the displacement to the right end of a chain and drop it: ``P (Q d)~ b = -P b~ Q d``."""
    if factors and factors[-1] == displacement:
        return [(sympy.S.One, factors[:-1])]
    for k, factor in enumerate(factors):
        if not factor.has(displacement):
            continue
        if not isinstance(factor, Tilde):
            raise InternalError(f"{displacement} stands in {factor}")
        after = assemble([(sympy.S.One, factors[k + 1 :])], (3, 1))
        inner: Terms = []
        for c, chain in _raw_terms(factor.vector):
            inner += [(-c * sign, (*factors[:k], Tilde(after), *rest)) for sign, rest in _isolated(chain, displacement)]
        return inner
    return []


def _raw_terms(vector: Any) -> Terms:
    parts = vector.args if isinstance(vector, sympy.MatAdd) else (vector,)
    terms: Terms = []
    for part in parts:
        c, chain = part.as_coeff_matrices() if isinstance(part, sympy.MatMul) else (sympy.S.One, (part,))
        terms.append((c, tuple(chain)))
    return terms
