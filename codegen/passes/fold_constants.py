"""Evaluate operations on constants, exactly."""

from __future__ import annotations

from fractions import Fraction

from codegen.ir.builder import Builder
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Instruction, Program
from codegen.passes.rewrite import rebuild


def fold_constants(program: Program) -> Program:
    """Replace operations on constants by their exact value, where that is a rational times a power of pi."""
    return rebuild(program, folded)


def folded(builder: Builder, instruction: Instruction) -> int | None:
    """The constant that an operation on constants gives: a rule of `rebuild`."""
    known = []
    for operand in instruction.operands:
        value = builder.value_of(operand)
        if value is None:
            return None
        known.append(value)
    constant = _fold(instruction.op, known) if known else None
    return None if constant is None else builder.constant(constant)


def _fold(op: Op, values: list[Constant]) -> Constant | None:
    first, second = values[0], values[-1]
    if op is Op.NEGATE:
        return -first
    if op is Op.MULTIPLY:
        return Constant(first.rational * second.rational, first.pi_power + second.pi_power)
    if op is Op.DIVIDE and not second.is_zero:
        return Constant(first.rational / second.rational, first.pi_power - second.pi_power)
    if op in (Op.ADD, Op.SUBTRACT) and first.pi_power == second.pi_power:
        sign = 1 if op is Op.ADD else -1
        return Constant(first.rational + sign * second.rational, first.pi_power)
    if op is Op.FMA:
        product = Constant(first.rational * values[1].rational, first.pi_power + values[1].pi_power)
        return _fold(Op.ADD, [product, second])
    if op is Op.ABS:
        return Constant(abs(first.rational), first.pi_power)
    if op is Op.SELECT and first.pi_power == values[1].pi_power == 0:
        return values[2] if first.rational < values[1].rational else values[3]
    if op is Op.SIN and first.is_zero:
        return first
    if op is Op.COS and first.is_zero:
        return Constant(Fraction(1))
    return None
