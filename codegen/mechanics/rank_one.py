"""The identity behind every rotational block of a second derivative: ``a~ R b~ = (R b)(R^T a)^T - (a . R b) R``.

It holds for a rotation R. Its right-hand side costs two outer products of vectors that the Jacobian has already,
where the left-hand side costs two products of matrices (SPEC S1.6).
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import sympy

from codegen.ir.lower import Tilde
from codegen.mechanics.algebra import Algebra
from codegen.mechanics.terms import Factors, Terms, assemble, transposed_chain


def rank_one(expression: Any, algebra: Algebra) -> Any:
    """Rewrite every ``a~ R b~`` with a rotation between the two tildes; ``a~ b~`` alone is cheaper as it stands."""
    rewritten: Terms = []
    for coefficient, factors in collect_pairs(algebra.terms(expression), algebra):
        rewritten += [(coefficient * c, chain) for c, chain in _rewrite(factors, algebra)]
    return algebra.normal(assemble(rewritten, expression.shape))


def collect_pairs(terms: Terms, algebra: Algebra) -> Terms:
    """Collect products of two tildes that share one: ``l1 a~ R b~ + l2 c~ R b~ = (l1 a + l2 c)~ R b~``."""
    return min((_collected(terms, side, algebra) for side in (1, 0)), key=len)


def _collected(terms: Terms, first_side: int, algebra: Algebra) -> Terms:
    for side in (first_side, 1 - first_side):
        groups: dict[Factors, Terms] = {}
        order: list[tuple[Factors | None, Any, Factors]] = []
        for coefficient, factors in terms:
            places = [k for k, factor in enumerate(factors) if isinstance(factor, Tilde)]
            if len(places) != 2 or not algebra.is_plain(coefficient):
                order.append((None, coefficient, factors))
                continue
            k = places[side]
            key = (sympy.Integer(k), *factors[:k], *factors[k + 1 :])
            if key not in groups:
                order.append((key, coefficient, factors))
            groups.setdefault(key, []).append((coefficient, (factors[k].vector,)))
        terms = [_joined(groups[key], key, algebra) if key else (c, factors) for key, c, factors in order]
    return terms


def _joined(group: Terms, key: Factors, algebra: Algebra) -> tuple[Any, Factors]:
    k, rest = int(key[0]), key[1:]
    if len(group) == 1:
        coefficient, (vector,) = group[0]
        return coefficient, (*rest[:k], Tilde(vector), *rest[k:])
    return sympy.S.One, (*rest[:k], Tilde(algebra.normal(assemble(group, (3, 1)))), *rest[k:])


def _rewrite(factors: Factors, algebra: Algebra) -> Terms:
    tildes = [k for k, factor in enumerate(factors) if isinstance(factor, Tilde)]
    for first, second in pairwise(tildes):
        between = factors[first + 1 : second]
        if not between or not all(_is_rotation(factor, algebra) for factor in between):
            continue
        a, b = factors[first].vector, factors[second].vector
        before, after = factors[:first], factors[second + 1 :]
        sign, a_row = _row(a)
        outer = (*before, *between, b, *a_row, *between, *after)
        b_turned = assemble([(sympy.S.One, (*between, b))], (3, 1))
        return [(sympy.Integer(sign), outer), (-algebra.dot(a, b_turned), (*before, *between, *after))]
    return [(sympy.S.One, factors)]


def _row(vector: Any) -> tuple[int, Factors]:
    if isinstance(vector, sympy.MatMul) and vector.as_coeff_matrices()[0] == 1:
        return transposed_chain(tuple(vector.as_coeff_matrices()[1]))
    return transposed_chain((vector,))


def _is_rotation(factor: Any, algebra: Algebra) -> bool:
    plain = factor.arg if isinstance(factor, sympy.Transpose) else factor
    return plain in algebra.rotations
