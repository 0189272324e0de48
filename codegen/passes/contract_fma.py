"""Contract a product and the sum that takes it into one fused multiply-add, which rounds once.

A product is contracted where it is used once, by an addition or a subtraction. Where both terms are products, the one
whose factors are ready last is fused and the other is rounded by itself: it is finished by the time it is wanted. Signs
go to the operands: ``a b - c = fma(a, b, -c)``, ``c - a b = fma(-a, b, c)``; processors have these forms. A negated
result becomes ``fma(-a, b, -c)`` as well: GCC does that by itself, though it changes the sign of a zero.

The bits then depend on this pass alone, provided that no compiler contracts anything else (``-ffp-contract=off``).
"""

from __future__ import annotations

from collections.abc import Sequence

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program
from codegen.passes.drop_unused import drop_unused
from codegen.passes.latency import LATENCY
from codegen.passes.rewrite import Rebuilding, negated


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
    return _signs_inside(drop_unused(rebuilding.finish()))


def _signs_inside(program: Program) -> Program:
    """Move the sign of a fused result that nothing else takes to its operands."""
    while True:
        uses = program.uses()
        rebuilding = Rebuilding(program)
        for instruction in program.instructions:
            inner = program.instructions[instruction.operands[0]] if instruction.op is Op.NEGATE else None
            if inner is None or inner.op is not Op.FMA or uses[instruction.operands[0]] > 1:
                rebuilding.copy(instruction)
                continue
            a, b, addend = (rebuilding.moved[operand] for operand in inner.operands)
            place = _contracted(rebuilding.builder, Op.SUBTRACT, 1, (a, b), _negative(rebuilding.builder, addend))
            rebuilding.put(instruction, place)
        moved = drop_unused(rebuilding.finish())
        if moved == program:
            return program
        program = moved


def _ready(program: Program) -> list[int]:
    """Cycle at which each value is ready, were there processors enough."""
    ready: list[int] = []
    for instruction in program.instructions:
        start = max((ready[operand] for operand in instruction.operands), default=0)
        ready.append(start + LATENCY.get(instruction.op, 0))
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
        a, b = sorted(factors, key=lambda factor: _reluctance(builder, factor))
        a = _negative(builder, a)
    return builder.emit(Op.FMA, a, b, addend)


def _reluctance(builder: Builder, factor: int) -> int:
    """Which factor is to change its sign: a constant or a negative one best, a fused result last."""
    op = builder.instructions[factor].op
    return 0 if op in (Op.CONSTANT, Op.NEGATE) else 2 if op is Op.FMA else 1


def _negative(builder: Builder, position: int) -> int:
    instruction = builder.instructions[position]
    return instruction.operands[0] if instruction.op is Op.NEGATE else negated(builder, position)
