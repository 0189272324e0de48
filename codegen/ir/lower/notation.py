"""Names and definitions of stages in the notation of the papers, for the readers of the emitted code."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy
from sympy.matrices.matrixbase import MatrixBase

from codegen.ir.lower.operators import Dot, Tilde

Factors = tuple[Any, ...]


def notation(expression: Any, aliases: Mapping[Factors, str]) -> str:
    """Write a definition on one line: ``A_i^T A_j``, ``r_j + A_j s_j - r_i - A_i s_i``, ``tilde(f_i) x``."""
    if isinstance(expression, sympy.MatAdd):
        terms = [notation(term, aliases) for term in expression.args]
        return " + ".join(terms).replace("+ -", "- ")
    if isinstance(expression, sympy.MatMul):
        coefficient, factors = expression.as_coeff_matrices()
        chain = chain_notation(tuple(factors), aliases)
        if coefficient in (1, -1):
            return chain if coefficient == 1 else f"-{chain}"
        return f"({coefficient}) {chain}"
    if isinstance(expression, sympy.Transpose):
        return f"{notation(expression.arg, aliases)}^T"
    if isinstance(expression, Tilde):
        return f"tilde({notation(expression.vector, aliases)})"
    if isinstance(expression, Dot):
        return " . ".join(notation(side, aliases) for side in expression.args)
    if isinstance(expression, MatrixBase):
        rows = "; ".join(", ".join(str(entry) for entry in expression.row(k)) for k in range(expression.shape[0]))
        return f"[{rows}]"
    return str(expression)


def definition_notation(name: str, expression: Any, aliases: Mapping[Factors, str]) -> str:
    """Write the definition of a name, which may not stand for itself in it."""
    return notation(expression, {chain: alias for chain, alias in aliases.items() if alias != name})


def chain_notation(factors: Factors, aliases: Mapping[Factors, str]) -> str:
    """Write a product of factors, with named products under their names."""
    words: list[str] = []
    position = 0
    while position < len(factors):
        ends = [end for end in range(len(factors), position + 1, -1) if factors[position:end] in aliases]
        end = ends[0] if ends else position + 1
        words.append(aliases[factors[position:end]] if ends else notation(factors[position], aliases))
        position = end
    return " ".join(words)
