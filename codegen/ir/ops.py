"""The operations of a program: what each takes, and whether it costs anything.

This is the one definition of an operation. ``SINCOS`` yields the pair of sine and cosine of one angle; ``SIN`` and
``COS`` of a pair are free projections of it (``SINE_OF``, ``COSINE_OF``). ``FMA`` is ``a b + c`` rounded once; its
negated forms are changes of sign of its operands. ``SELECT`` of ``a, b, x, y`` is ``x`` where ``a < b`` and ``y``
elsewhere, also where ``a`` or ``b`` is no number: straight-line code without branches.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from fractions import Fraction


class Op(Enum):
    """An operation of the program."""

    # Members are single objects, and programs ask for their hash by the million.
    __hash__ = object.__hash__

    CONSTANT = "constant"
    INPUT = "input"
    NEGATE = "neg"
    ADD = "add"
    SUBTRACT = "sub"
    MULTIPLY = "mul"
    DIVIDE = "div"
    FMA = "fma"
    SQRT = "sqrt"
    SIN = "sin"
    COS = "cos"
    SINCOS = "sincos"
    SINE_OF = "sine_of"
    COSINE_OF = "cosine_of"
    ATAN2 = "atan2"
    ABS = "abs"
    SELECT = "select"


for _op in Op:  # as plain attributes, which Python 3.12 makes of them; 3.11 finds members by a slow detour
    type.__setattr__(Op, _op.name, _op)

ARITY: dict[Op, int] = {
    Op.CONSTANT: 0,
    Op.INPUT: 0,
    Op.NEGATE: 1,
    Op.ADD: 2,
    Op.SUBTRACT: 2,
    Op.MULTIPLY: 2,
    Op.DIVIDE: 2,
    Op.FMA: 3,
    Op.SQRT: 1,
    Op.SIN: 1,
    Op.COS: 1,
    Op.SINCOS: 1,
    Op.SINE_OF: 1,
    Op.COSINE_OF: 1,
    Op.ATAN2: 2,
    Op.ABS: 1,
    Op.SELECT: 4,
}

COMMUTATIVE = frozenset({Op.ADD, Op.MULTIPLY, Op.FMA})
"""The first two operands may change places."""

LEAVES = frozenset({Op.CONSTANT, Op.INPUT})
PROJECTIONS = frozenset({Op.SINE_OF, Op.COSINE_OF})


@dataclass(frozen=True, slots=True, order=True)
class Constant:
    """An exact constant ``rational * pi**pi_power``."""

    rational: Fraction
    pi_power: int = 0

    def __post_init__(self) -> None:
        if self.rational == 0:
            object.__setattr__(self, "pi_power", 0)

    def __neg__(self) -> Constant:
        return Constant(-self.rational, self.pi_power)

    @property
    def is_zero(self) -> bool:
        """Whether the constant is exactly zero."""
        return self.rational == 0

    def equals(self, value: int) -> bool:
        """Whether the constant is exactly the integer ``value``."""
        return self.rational == value and self.pi_power == 0

    def __str__(self) -> str:
        pi = {0: "", 1: " pi"}.get(self.pi_power, f" pi^{self.pi_power}")
        return f"{self.rational}{pi}"


ZERO = Constant(Fraction(0))
ONE = Constant(Fraction(1))
