"""Normal form of matrix expressions by the identities of three-dimensional vector algebra.

`Algebra` knows which symbols are rotations and which products have a name, and reduces chains of factors accordingly.
It never multiplies out entries.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import sympy
from sympy.matrices.matrixbase import MatrixBase

from codegen.ir.lower import Dot, Tilde
from codegen.mechanics.terms import Factors, Terms, assemble, skew, transposed, transposed_chain


@dataclass(frozen=True)
class Algebra:
    """The identities in force.

    Attributes:
        rotations: symbols X with X^T X = I.
        names: chain of factors -> the symbol that names it.
        pulled: rotations that a scalar product moves from its left to its right: ``A a . b = a . A^T b``.
        flipped: rotations R for which ``x . R^T y`` is written ``y . R x``.
        displacements: scalar virtual displacements; they stay in coefficients, never inside explicit factors.
    """

    rotations: frozenset[Any]
    names: Mapping[Factors, Any] = field(default_factory=dict)
    pulled: frozenset[Any] = frozenset()
    flipped: frozenset[Any] = frozenset()
    displacements: frozenset[Any] = frozenset()
    _known: dict[Any, Terms] = field(default_factory=dict, init=False, repr=False, compare=False)

    def without_names(self) -> Algebra:
        """The same identities, but no product is replaced by its name: for the definitions of the names."""
        return replace(self, names={})

    def is_plain(self, coefficient: Any) -> bool:
        """Whether a coefficient may be moved into a vector: no virtual displacement is read off it later."""
        return not coefficient.atoms(Dot) and not self.displacements & coefficient.free_symbols

    def terms(self, expression: Any) -> Terms:
        """Give the reduced terms of a matrix expression; like terms are collected."""
        if expression not in self._known:
            self._known[expression] = self._reduced(expression)
        return list(self._known[expression])

    def _reduced(self, expression: Any) -> Terms:
        reduced: dict[Factors, Any] = {}
        for coefficient, factors in self._flat(expression):
            sign, chain = self._reduce(list(factors))
            if sign != 0:
                reduced[chain] = reduced.get(chain, 0) + sign * coefficient
        kept = [(sympy.sympify(c), chain) for chain, c in reduced.items() if c != 0]
        return _merge_tildes(_merge_explicit(kept, self), self)

    def normal(self, expression: Any) -> Any:
        """Give the normal form of a matrix expression."""
        return assemble(self.terms(expression), expression.shape)

    def _flat(self, expression: Any) -> Terms:
        if isinstance(expression, sympy.MatAdd):
            return [term for part in expression.args for term in self._flat(part)]
        if isinstance(expression, sympy.MatMul):
            coefficient, factors = expression.as_coeff_matrices()
            return [(coefficient * c, chain) for c, chain in self._flat_chain(factors)]
        if isinstance(expression, sympy.ZeroMatrix) or (
            isinstance(expression, MatrixBase) and expression.is_zero_matrix
        ):
            return []
        if isinstance(expression, sympy.Identity):
            return [(sympy.S.One, ())]
        if isinstance(expression, Tilde):
            vector = self.terms(expression.vector)
            if len(vector) == 1:
                return [(vector[0][0], (Tilde(assemble([(sympy.S.One, vector[0][1])], (3, 1))),))]
            return [(sympy.S.One, (Tilde(assemble(vector, (3, 1))),))] if vector else []
        if isinstance(expression, sympy.Transpose) and not isinstance(expression.arg, sympy.MatrixSymbol):
            turned = [(c, transposed_chain(chain)) for c, chain in self._flat(expression.arg)]
            return [(c * sign, chain) for c, (sign, chain) in turned]
        return [(sympy.S.One, (expression,))]

    def _flat_chain(self, factors: Iterable[Any]) -> Terms:
        """Flatten a product; a sum inside it stays one factor unless it is the whole product."""
        coefficient, chain = sympy.S.One, []
        for factor in factors:
            parts = self._flat(factor)
            if not parts:
                return []
            if len(parts) > 1:
                chain.append(assemble(parts, factor.shape))
            else:
                coefficient *= parts[0][0]
                chain.extend(parts[0][1])
        return [(coefficient, tuple(chain))]

    def _reduce(self, chain: list[Any]) -> tuple[Any, Factors]:
        """Apply the identities to one chain until none fits; sign 0 means the chain is zero."""
        sign: Any = 1
        position = 0
        while position < len(chain):
            step = self._step(chain, position)
            if step is None:
                position += 1
                continue
            factor_sign, width, replacement = step
            if factor_sign == 0:
                return 0, ()
            sign *= factor_sign
            chain[position : position + width] = replacement
            position = max(position - 3, 0)
        return sign, tuple(chain)

    def _step(self, chain: list[Any], position: int) -> tuple[Any, int, list[Any]] | None:
        """Find an identity that fits at a position: (sign, number of factors replaced, their replacement)."""
        here = chain[position]
        after = chain[position + 1] if position + 1 < len(chain) else None
        if isinstance(here, MatrixBase):
            if here.is_zero_matrix:
                return 0, 1, []
            if here.shape == (3, 3) and here == sympy.eye(3):
                return 1, 1, []
            if isinstance(after, MatrixBase) and here.shape[1] > 1:
                return 1, 2, [sympy.ImmutableDenseMatrix((here * after).applyfunc(sympy.expand))]
        if isinstance(here, Tilde):
            found = self._tilde_step(here, chain, position)
            if found:
                return found
        if after is not None and self._is_rotation(here) and transposed(here)[1] == after:
            return 1, 2, []
        if after is not None and isinstance(after, Tilde) and self._is_rotation(here):
            inner = self._without_leading(after.vector, transposed(here)[1])
            if inner is not None:
                return 1, 2, [Tilde(inner), here]
        for names, name in self.names.items():
            if tuple(chain[position : position + len(names)]) == names:
                return 1, len(names), [name]
        return None

    def _tilde_step(self, tilde: Tilde, chain: list[Any], position: int) -> tuple[Any, int, list[Any]] | None:
        if isinstance(tilde.vector, MatrixBase):
            return 1, 1, [skew(tilde.vector)]
        rest = tuple(chain[position + 1 :])
        if rest and self._chain_of(tilde.vector) == rest:
            return 0, 1, []
        if rest and self._is_rotation(rest[0]):
            inner = self._without_leading(tilde.vector, rest[0])
            if inner is not None:
                return 1, 2, [rest[0], Tilde(inner)]
        return None

    def _chain_of(self, vector: Any) -> Factors:
        terms = self._flat(vector)
        return terms[0][1] if len(terms) == 1 else ()

    def _is_rotation(self, factor: Any) -> bool:
        plain = factor.arg if isinstance(factor, sympy.Transpose) else factor
        return plain in self.rotations

    def _without_leading(self, vector: Any, rotation: Any) -> Any:
        """Take a leading rotation off every term of a vector, or give None where one lacks it."""
        terms = self._flat(vector)
        if not terms or any(not chain or chain[0] != rotation or len(chain) < 2 for _, chain in terms):
            return None
        return assemble([(c, chain[1:]) for c, chain in terms], (3, 1))

    def dot(self, left: Any, right: Any) -> Any:
        """Scalar product in normal form: coefficients in front, rotations on the right."""
        left_terms, right_terms = self.terms(left), self.terms(right)
        if not left_terms or not right_terms:
            return sympy.S.Zero
        if len(left_terms) == 1:
            coefficient, chain = left_terms[0]
            if coefficient != 1:
                return coefficient * self.dot(assemble([(sympy.S.One, chain)], (3, 1)), right)
            if len(chain) > 1 and chain[0] in self.pulled:
                moved = sympy.MatMul(sympy.Transpose(chain[0]), assemble(right_terms, (3, 1)))
                return self.dot(assemble([(sympy.S.One, chain[1:])], (3, 1)), self._distributed(moved))
        if len(right_terms) == 1:
            coefficient, chain = right_terms[0]
            if coefficient != 1:
                return coefficient * self.dot(left, assemble([(sympy.S.One, chain)], (3, 1)))
            first = chain[0]
            if isinstance(first, sympy.Transpose) and first.arg in self.flipped and len(left_terms) == 1:
                flipped = assemble([(sympy.S.One, (first.arg, *left_terms[0][1]))], (3, 1))
                return self.dot(assemble([(sympy.S.One, chain[1:])], (3, 1)), flipped)
            if len(left_terms) == 1 and first in self.rotations and left_terms[0][1][0] == first:
                inner = (assemble([(sympy.S.One, rest[1:])], (3, 1)) for rest in (left_terms[0][1], chain))
                return self.dot(*inner)
        left, right = assemble(left_terms, (3, 1)), assemble(right_terms, (3, 1))
        if isinstance(left, MatrixBase) and isinstance(right, MatrixBase):
            return left.dot(right)
        return Dot(left, right)

    def _distributed(self, product: Any) -> Any:
        """Multiply a leading factor into a sum."""
        first, rest = product.args[0], product.args[1]
        if isinstance(rest, sympy.MatAdd):
            return sympy.MatAdd(*(sympy.MatMul(first, term) for term in rest.args))
        return product


def _merge_explicit(terms: Terms, algebra: Algebra) -> Terms:
    """Collect terms that differ in their explicit last factor only: ``C_i e1 l1 + C_i e2 l2 = C_i [l1, l2, 0]``."""
    plain: dict[Factors, Any] = {}
    explicit: dict[tuple[Factors, tuple[int, int]], Any] = {}
    for coefficient, chain in terms:
        last = chain[-1] if chain else None
        if isinstance(last, MatrixBase) and algebra.is_plain(coefficient):
            key = (chain[:-1], last.shape)
            explicit[key] = explicit.get(key, sympy.zeros(*last.shape)) + coefficient * last
        else:
            plain[chain] = plain.get(chain, 0) + coefficient
    result: Terms = [(coefficient, chain) for chain, coefficient in plain.items()]
    for (before, _), matrix in explicit.items():
        if not matrix.is_zero_matrix:
            content, rest = _content(matrix)
            result.append((content, (*before, sympy.ImmutableDenseMatrix(rest))))
    return result


def _content(matrix: Any) -> tuple[Any, Any]:
    """Take a factor that all entries share (up to sign) out of an explicit matrix."""
    entries = [entry for entry in matrix if entry != 0]
    common = entries[0]
    if all(entry in (common, -common) for entry in entries):
        return common, (matrix / common).applyfunc(sympy.cancel) if common not in (1, -1) else matrix * common
    return sympy.S.One, matrix


def _merge_tildes(terms: Terms, algebra: Algebra) -> Terms:
    """Collect terms that differ in the vector of one tilde only: ``a~ l + b~ l = (a + b)~ l``."""
    groups: dict[tuple[Factors, Factors], Terms] = {}
    result: Terms = []
    for coefficient, chain in terms:
        places = [k for k, factor in enumerate(chain) if isinstance(factor, Tilde)]
        if len(places) == 1 and algebra.is_plain(coefficient):
            k = places[0]
            groups.setdefault((chain[:k], chain[k + 1 :]), []).append((coefficient, (chain[k].vector,)))
        else:
            result.append((coefficient, chain))
    for (before, after), group in groups.items():
        coefficient, (vector,) = group[0]
        if len(group) > 1:
            coefficient, vector = sympy.S.One, algebra.normal(assemble(group, (3, 1)))
        result.append((coefficient, (*before, Tilde(vector), *after)))
    return result
