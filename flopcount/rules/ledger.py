"""The tally: walks the blocks of a part and writes down every operation, under the rules R0 to R5.

Input: a `Part`, a `Method`. Output: `Term`s, whose operations add up to the count. The order of evaluation
is the method's: the paper's (R2), or vectors first (`flopcount.rules.vectors`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from flopcount.paper import Derivative
from flopcount.rules import patterns
from flopcount.rules.expressions import (
    Block,
    Expr,
    Mat,
    Negate,
    Part,
    Product,
    Scalar,
    Scale,
    Skew,
    Sum,
    Transpose,
    Vec,
    text,
)
from flopcount.rules.identity import Key, factors_of, key
from flopcount.rules.patterns import Pattern


@dataclass(frozen=True, slots=True)
class Term:
    """One line of an explanation.

    Attributes:
        part: the constraint that the operation belongs to.
        place: the block.
        text: the expression that is formed.
        operations: multiplications and additions; 0 for what is free.
        rule: the rule that prices it, ``R0`` to ``R5``, or the name of a switch.
    """

    part: str
    place: str
    text: str
    operations: int
    rule: str

    def __str__(self) -> str:
        return f"{self.part} {self.place}: {self.text}  {self.operations}  [{self.rule}]"


@dataclass(frozen=True, slots=True)
class Method:
    """An order of evaluation.

    Attributes:
        name: of the method.
        next_pair: given the patterns of a chain, which neighbours are multiplied next (the index of the left
            one).
        rewrite: what is done to the blocks of a part before they are walked.
        opens_brackets: whether a row in front of a bracket is multiplied into it.
        keeps_scaled_vectors: whether a vector times a multiplier serves all blocks.
    """

    name: str
    next_pair: Callable[[Sequence[Pattern]], int]
    rewrite: Callable[[Expr, str | None], Expr]
    opens_brackets: bool
    keeps_scaled_vectors: bool


def as_written(expression: Expr, carrier: str | None) -> Expr:
    """Leave a block as it is."""
    del carrier
    return expression


def matrix_times_skew_first(chain: Sequence[Pattern]) -> int:
    """R2: the first general matrix in front of a skew matrix; without one, the leftmost pair."""
    for at, (left, right) in enumerate(pairwise(chain)):
        if left.is_general_matrix and right.skew:
            return at
    return 0


PAPER = Method("paper", matrix_times_skew_first, as_written, opens_brackets=True, keeps_scaled_vectors=False)
"""The paper's order of evaluation."""


@dataclass(slots=True)
class _Walk:
    """A walk over the blocks of one derivative of one part; the one mutable object of this package."""

    part: str
    method: Method
    structure: Mapping[str, Pattern]
    terms: list[Term] = field(default_factory=list)
    finished: dict[Key, Pattern] = field(default_factory=dict)
    formed: dict[Key, Pattern] = field(default_factory=dict)
    place: str = ""

    def block(self, block: Block, value: Expr, formed: dict[Key, Pattern]) -> None:
        """Form one block; ``formed`` holds the sub-products that it may share (R3)."""
        self.place, self.formed = block.place, formed
        before, known = len(self.terms), self._known(value) is not None
        pattern = self._form(value)
        if len(self.terms) == before:
            self._write(text(value), 0, "R3" if known else "R0")
        self._keep(self.finished, value, pattern)

    def free(self, block: Block, rule: str) -> None:
        """Note a block that a rule makes free."""
        self.place = block.place
        self._write(text(block.value), 0, rule)

    def _form(self, expression: Expr) -> Pattern:
        match expression:
            case Scalar():
                return patterns.SCALAR
            case Vec():
                return patterns.COLUMN
            case Mat(name):
                return self.structure.get(name, patterns.MATRIX)
            case Negate(operand):
                return self._form(operand)
            case Transpose(operand):
                return self._form(operand).transposed
            case Skew(vector):
                self._form(vector)
                return patterns.SKEW
        known = self._known(expression)
        return known if known is not None else self._form_composite(expression)

    def _form_composite(self, expression: Scale | Product | Sum) -> Pattern:
        match expression:
            case Scale(factor, operand):
                pattern = self._scale(expression, factor, operand)
            case Product(factors):
                pattern = self._chain(self._operands(factors_of(Product(factors))))
            case Sum(terms):
                pattern = self._add([(term, self._form(term)) for term in terms])
        self._keep(self.formed, expression, pattern)
        return pattern

    def _scale(self, expression: Expr, factor: Expr, operand: Expr) -> Pattern:
        self._form(factor)
        pattern = self._form(operand)
        multiplier = isinstance(factor, Scalar) and factor.name.endswith("lambda")
        self._write(text(expression), pattern.numbers, "R4" if multiplier else "R1")
        if multiplier and isinstance(operand, Vec) and self.method.keeps_scaled_vectors:
            self._keep(self.finished, expression, pattern)
        return pattern

    def _add(self, terms: Sequence[tuple[Expr, Pattern]]) -> Pattern:
        expressions, pattern = [terms[0][0]], terms[0][1]
        for expression, other in terms[1:]:
            expressions.append(expression)
            cost, pattern = patterns.add(pattern, other)
            self._write(text(Sum(tuple(expressions))), cost, "R1")
        return pattern

    def _chain(self, factors: Sequence[Expr]) -> Pattern:
        """Multiply a chain in the order of the method."""
        if self.method.opens_brackets and isinstance(factors[-1], Sum) and self._form(factors[0]).is_row:
            return self._open(factors[:-1], factors[-1])
        chain = [(factor, self._form(factor)) for factor in factors]
        while len(chain) > 1:
            at = self.method.next_pair([pattern for _, pattern in chain])
            (left, a), (right, b) = chain[at], chain[at + 1]
            cost, pattern = patterns.multiply(a, b)
            joined = Product((left, right))
            self._write(text(joined), cost, "R2" if a.is_general_matrix and b.skew else "R1")
            self._keep(self.formed, joined, pattern)
            chain[at : at + 2] = [(joined, pattern)]
        return chain[0][1]

    def _open(self, row: Sequence[Expr], bracket: Sum) -> Pattern:
        """R2: multiply a row into the bracket behind it."""
        products = [(*row, *factors_of(term)) for term in bracket.terms]
        return self._add([(Product(chain), self._chain(chain)) for chain in products])

    def _operands(self, factors: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """R3: take the longest run of factors that is known as one factor."""
        for length in range(len(factors) - 1, 1, -1):
            for start in range(len(factors) - length + 1):
                run = Product(factors[start : start + length])
                if self._known(run) is not None:
                    return (*factors[:start], run, *factors[start + length :])
        return factors

    def _known(self, expression: Expr) -> Pattern | None:
        name = key(expression)
        return self.finished.get(name) or self.formed.get(name)

    @staticmethod
    def _keep(where: dict[Key, Pattern], expression: Expr, pattern: Pattern) -> None:
        where[key(expression)] = pattern
        where[key(expression, transposed=True)] = pattern.transposed

    def _write(self, words: str, operations: int, rule: str) -> None:
        self.terms.append(Term(self.part, self.place, words, operations, rule))


STRUCTURE: Mapping[str, Pattern] = {"I": patterns.DIAGONAL}
"""Matrices with structural zeros; all others are full."""


def walk(
    part: Part,
    derivative: Derivative,
    method: Method = PAPER,
    structure: Mapping[str, Pattern] = STRUCTURE,
) -> tuple[Term, ...]:
    """Write down the operations of one derivative of a part.

    Args:
        part: the constraint.
        derivative: which derivative.
        method: the order of evaluation.
        structure: patterns of matrices that are not full, by name.

    Returns:
        The operations in the order in which they are done, and a line with 0 for each block that is free.
    """
    ledger = _Walk(part.label, method, structure)
    shared: dict[frozenset[str], dict[Key, Pattern]] = {}
    for block in part.blocks(derivative):
        jacobian = derivative == "phi_q"
        if jacobian and block.column.startswith("alpha"):
            ledger.free(block, "R5")
            continue
        unit = frozenset({block.row} if jacobian else {block.row, block.column})
        ledger.block(block, method.rewrite(block.value, part.carrier), shared.setdefault(unit, {}))
    return tuple(ledger.terms)
