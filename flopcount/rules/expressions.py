"""Matrix expressions as data: what the paper writes, before anybody counts or evaluates it.

Input: names of scalars, vectors and matrices. Output: immutable trees. A tree says how the paper groups a
formula; it does not say what it costs (`flopcount.rules.ledger`) nor what its value is
(`flopcount.rules.evaluate`). Vectors are columns of three numbers, matrices are 3 x 3. ``Skew(a)`` is the
paper's a with a tilde: ``a~ b = a x b``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias


@dataclass(frozen=True, slots=True)
class Scalar:
    """A number known by name."""

    name: str


@dataclass(frozen=True, slots=True)
class Vec:
    """A column of three numbers known by name."""

    name: str


@dataclass(frozen=True, slots=True)
class Mat:
    """A 3 x 3 matrix known by name."""

    name: str


@dataclass(frozen=True, slots=True)
class Skew:
    """The skew matrix of a vector."""

    vector: Expr


@dataclass(frozen=True, slots=True)
class Transpose:
    """The transpose of a vector or matrix."""

    operand: Expr


@dataclass(frozen=True, slots=True)
class Negate:
    """The expression with its sign changed."""

    operand: Expr


@dataclass(frozen=True, slots=True)
class Scale:
    """A vector or matrix times a scalar."""

    factor: Expr
    operand: Expr


@dataclass(frozen=True, slots=True)
class Product:
    """A chain of scalars, or of matrices and vectors, from left to right."""

    factors: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class Sum:
    """A sum of expressions of one shape."""

    terms: tuple[Expr, ...]


Expr: TypeAlias = Scalar | Vec | Mat | Skew | Transpose | Negate | Scale | Product | Sum

IDENTITY = Mat("I")
"""The unit matrix, the one matrix whose value needs not be given."""


@dataclass(frozen=True, slots=True)
class Block:
    """One non-zero block of a derivative.

    Attributes:
        row: the constraint (phi_q) or the variation (second derivative) that its rows belong to.
        column: the variation that its columns belong to: ``r_i``, ``pi_i``, ``r_j``, ``pi_j`` or ``alpha_k``.
        value: the block, with one row (scalar constraints) or three.
    """

    row: str
    column: str
    value: Expr

    @property
    def place(self) -> str:
        """The place of the block, for a reader."""
        return f"({self.row}, {self.column})"


@dataclass(frozen=True, slots=True)
class Part:
    """A constraint whose derivatives are counted together: a basic constraint, or a trn or rot constraint.

    Attributes:
        name: ``dot-1``, ``dot-2``, ``spherical``, ``screw``, ``trn0`` to ``trn3`` or ``rot0`` to ``rot3``.
        label: the name with its vectors.
        phi_q: blocks of the Jacobian, row by row.
        phi_q_t_lambda_q: blocks of the second derivative in the order in which the paper forms them: column
            by column; those of (Phi_Z^T lambda)_alpha before those of (Phi_alpha^T lambda)_alpha.
        carrier: the vector in which a scalar constraint is linear, None for the others.
    """

    name: str
    label: str
    phi_q: tuple[Block, ...]
    phi_q_t_lambda_q: tuple[Block, ...]
    carrier: str | None = None

    def blocks(self, derivative: Literal["phi_q", "phi_q_t_lambda_q"]) -> tuple[Block, ...]:
        """Select the blocks of one derivative."""
        return self.phi_q if derivative == "phi_q" else self.phi_q_t_lambda_q


def product(*factors: Expr) -> Expr:
    """Chain the factors; one factor is itself."""
    return factors[0] if len(factors) == 1 else Product(factors)


def total(terms: Iterable[Expr]) -> Expr:
    """Add the terms; one term is itself."""
    summands = tuple(terms)
    return summands[0] if len(summands) == 1 else Sum(summands)


def text(expression: Expr) -> str:
    """Print an expression in the paper's manner, in one line: ``f_i^T (A_ij s_j~)``."""
    match expression:
        case Scalar(name) | Vec(name) | Mat(name):
            return name
        case Skew(vector):
            return f"{_atom(vector)}~"
        case Transpose(operand):
            return f"{_atom(operand)}^T"
        case Negate(operand):
            return f"-{_enclosed(operand, (Sum, Negate))}"
        case Scale(factor, operand):
            return f"{_enclosed(factor, (Sum, Negate))} {_enclosed(operand, (Sum, Negate))}"
        case Product(factors):
            return " ".join(_enclosed(factor, (Product, Scale, Sum, Negate)) for factor in factors)
        case Sum(terms):
            return _sum_text(terms)


def _sum_text(terms: tuple[Expr, ...]) -> str:
    words = [text(terms[0])]
    for term in terms[1:]:
        sign, operand = ("-", term.operand) if isinstance(term, Negate) else ("+", term)
        words.append(f"{sign} {_enclosed(operand, (Sum, Negate))}")
    return " ".join(words)


def _enclosed(expression: Expr, kinds: tuple[type, ...]) -> str:
    inside = text(expression)
    return f"({inside})" if isinstance(expression, kinds) else inside


def _atom(expression: Expr) -> str:
    inside = text(expression)
    return f"({inside})" if " " in inside else inside
