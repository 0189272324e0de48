"""How an operation is priced: models that turn the counts of a program into one number.

The paper prices every operation the same and leaves out what it calls given. Hardware does not: an addition that
takes a product can be one fused operation, a division costs as much as several products, a sine-cosine pair as much
as dozens.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from codegen.ir.ops import Op
from codegen.ir.program import Program
from flopcount.count import count
from flopcount.counts import Counts


@dataclass(frozen=True, slots=True)
class Operations:
    """What the models price.

    Attributes:
        counts: operations by kind.
        contractions: additions and subtractions that can take a product with them in one fused operation.
    """

    counts: Counts
    contractions: int

    @staticmethod
    def of(program: Program) -> Operations:
        """Count a program."""
        return Operations(count(program), contractions(program))


@dataclass(frozen=True, slots=True)
class Model:
    """Prices by kind of operation.

    Attributes:
        name: of the model.
        words: what it says, for headings.
        prices: kind (see `Counts`) -> price; a kind that is missing is free.
        contracts: whether an addition and a product that feeds it count as the product alone.
    """

    name: str
    words: str
    prices: Mapping[str, float]
    contracts: bool = False

    def price(self, operations: Operations) -> float:
        """Price of a program."""
        kinds = operations.counts.as_dict()
        total = sum(self.prices.get(kind, 0.0) * number for kind, number in kinds.items() if kind != "total")
        return total - self.prices.get("add", 0.0) * operations.contractions * self.contracts


_ARITHMETIC = {"add": 1.0, "mul": 1.0, "div": 1.0, "fma": 2.0}
_FUNCTIONS = {"sqrt": 1.0, "sincos": 1.0, "sin": 1.0, "cos": 1.0, "atan2": 1.0, "select": 1.0}

PAPER = Model("paper", "every operation 1", _ARITHMETIC | _FUNCTIONS)
MULTIPLY = Model("multiply", "multiplications and divisions only", {"mul": 1.0, "div": 1.0, "fma": 1.0})
FMA = Model(
    "fma", "a product and the addition it feeds count as one", _ARITHMETIC | _FUNCTIONS | {"fma": 1.0}, contracts=True
)

MODELS: dict[str, Model] = {model.name: model for model in (PAPER, MULTIPLY, FMA)}
"""The models that need no measurement."""


def measured(costs: Mapping[str, float]) -> Model:
    """The model of a machine.

    Args:
        costs: kind -> cost in units of an addition.
    """
    return Model("measured", "measured on this machine, in additions", dict(costs))


def contractions(program: Program) -> int:
    """Count the additions and subtractions that can absorb a product: each product at most once, used nowhere else."""
    uses = program.uses()
    return sum(
        instruction.op in (Op.ADD, Op.SUBTRACT)
        and any(program.instructions[o].op is Op.MULTIPLY and uses[o] == 1 for o in instruction.operands)
        for instruction in program.instructions
    )
