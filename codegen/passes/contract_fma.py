"""Contract a product and the sum that takes it into one fused multiply-add, which rounds once.

A product is contracted where it is used once, by an addition or a subtraction. Where both terms are products, the one
whose factors are ready last is fused and the other is rounded by itself: it is finished by the time it is wanted. Signs
go to the operands: ``a b - c = fma(a, b, -c)``, ``c - a b = fma(-a, b, c)``; processors have these forms.

The bits then depend on this pass alone, provided that no compiler contracts anything else (``-ffp-contract=off``).
"""

from __future__ import annotations

from collections.abc import Sequence

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program
from codegen.passes.drop_unused import drop_unused
from codegen.passes.rewrite import Rebuilding, negated

_LATENCY: dict[Op, int] = {
    Op.ADD: 4,
    Op.SUBTRACT: 4,
    Op.MULTIPLY: 4,
    Op.FMA: 4,
    Op.DIVIDE: 13,
    Op.SQRT: 18,
    Op.SIN: 60,
    Op.COS: 60,
    Op.SINCOS: 80,
    Op.ATAN2: 100,
}
"""Cycles until a result is ready, about, on processors of today; what is missing is there at once."""


def contract_fma(program: Program) -> Program:
    """Fuse products and sums; the outputs are the same in exact arithmetic and are rounded less often."""
    program = drop_unused(program)
    ready = _ready(program)
    uses = program.uses()
    rebuilding = Rebuilding(program)
    for instruction in program.instructions:
        fused = _fused_term(program, instruction, uses, ready)
        if fused is None:
            rebuilding.copy(instruction)
        else:
            factors = program.instructions[instruction.operands[fused]].operands
            a, b = (rebuilding.moved[factor] for factor in factors)
            addend = rebuilding.moved[instruction.operands[1 - fused]]
            place = _contracted(rebuilding.builder, instruction.op, fused, (a, b), addend)
            rebuilding.put(instruction, place)
    return drop_unused(rebuilding.finish())


def _ready(program: Program) -> list[int]:
    """Cycle at which each value is ready, were there processors enough."""
    ready: list[int] = []
    for instruction in program.instructions:
        start = max((ready[operand] for operand in instruction.operands), default=0)
        ready.append(start + _LATENCY.get(instruction.op, 0))
    return ready


def _fused_term(program: Program, instruction: Instruction, uses: Sequence[int], ready: Sequence[int]) -> int | None:
    """Say which term of a sum is the product to fuse, 0 or 1; None for no product, or for no sum."""
    if instruction.op not in (Op.ADD, Op.SUBTRACT):
        return None
    products = [
        term
        for term, operand in enumerate(instruction.operands)
        if program.instructions[operand].op is Op.MULTIPLY and uses[operand] == 1
    ]
    return max(products, key=lambda term: (ready[instruction.operands[term]], term), default=None)


def _contracted(builder: Builder, op: Op, fused: int, factors: tuple[int, int], addend: int) -> int:
    a, b = factors
    if op is Op.SUBTRACT and fused == 0:
        addend = _negative(builder, addend)
    elif op is Op.SUBTRACT:
        if _has_free_negative(builder, b):
            a, b = b, a
        a = _negative(builder, a)
    return builder.emit(Op.FMA, a, b, addend)


def _has_free_negative(builder: Builder, position: int) -> bool:
    return builder.instructions[position].op in (Op.CONSTANT, Op.NEGATE)


def _negative(builder: Builder, position: int) -> int:
    instruction = builder.instructions[position]
    return instruction.operands[0] if instruction.op is Op.NEGATE else negated(builder, position)
