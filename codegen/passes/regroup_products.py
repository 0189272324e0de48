"""Regroup products of three so that they take a product that is there anyway.

``x (s b)`` is ``s (x b)``. Where every use of ``s b`` can be written with a product that is computed in any case,
``s b`` itself is not needed: a scaled vector in an outer product, where dot and cross product are wanted too.
"""

from __future__ import annotations

from codegen.ir.ops import Op
from codegen.ir.program import Program
from codegen.passes.drop_unused import drop_unused
from codegen.passes.rewrite import Rebuilding
from codegen.passes.share_subexpressions import share_subexpressions

_Grouping = tuple[int, int, int]
"""The factor that comes last, and the two of the product that is there anyway."""


def regroup_products(program: Program) -> Program:
    """Give the program with fewer products; ``program`` computes each value once (`share_subexpressions`)."""
    groupings = _Regrouping(program).found()
    if not groupings:
        return program
    rebuilding = Rebuilding(program)
    for position, instruction in enumerate(program.instructions):
        if position not in groupings:
            rebuilding.copy(instruction)
            continue
        last, *pair = (rebuilding.moved[value] for value in groupings[position])
        product = rebuilding.builder.emit(Op.MULTIPLY, *pair)
        rebuilding.put(instruction, rebuilding.builder.emit(Op.MULTIPLY, last, product))
    return drop_unused(share_subexpressions(rebuilding.finish()))


class _Regrouping:
    """Chooses the products that are dropped, first come, first served."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._products = {
            frozenset(instruction.operands): position
            for position, instruction in enumerate(program.instructions)
            if instruction.op is Op.MULTIPLY
        }
        self._users: list[list[int]] = [[] for _ in program.instructions]
        for position, instruction in enumerate(program.instructions):
            for operand in set(instruction.operands):
                self._users[operand].append(position)
        self._needed = {value for output in program.outputs for value in output.values}
        self._taken: set[int] = set()
        self._groupings: dict[int, _Grouping] = {}

    def found(self) -> dict[int, _Grouping]:
        """Products that are regrouped, and how."""
        for value, instruction in enumerate(self._program.instructions):
            if instruction.op is Op.MULTIPLY and self._users[value] and not self._is_settled(value):
                self._drop(value)
        return self._groupings

    def _is_settled(self, value: int) -> bool:
        return value in self._needed or value in self._groupings

    def _drop(self, value: int) -> None:
        """Drop a product if all of its uses can do without it."""
        chosen: dict[int, _Grouping] = {}
        for user in self._users[value]:
            grouping = self._grouping(user, value)
            if grouping is None:
                return
            chosen[user] = grouping
        taken = {self._products[frozenset((a, b))] for _, a, b in chosen.values()}
        if not taken & chosen.keys():
            self._groupings |= chosen
            self._taken |= taken
            self._needed |= taken | {last for last, _, _ in chosen.values()}

    def _grouping(self, user: int, value: int) -> _Grouping | None:
        """Write ``x (s b)`` with ``x b`` or ``x s``, if that is computed anyway and stays as it is."""
        instruction = self._program.instructions[user]
        first, second = instruction.operands if instruction.op is Op.MULTIPLY else (value, value)
        if first == second or user in self._taken or user in self._groupings:
            return None
        other = second if first == value else first
        s, b = self._program.instructions[value].operands
        for last, factor in ((s, b), (b, s)):
            product = self._products.get(frozenset((other, factor)))
            if product is not None and product != value and product not in self._groupings:
                return last, other, factor
        return None
