"""Remove arithmetic with zero and one, and keep only the structural nonzeros of the outputs."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Output, Program, Sparsity
from codegen.passes.rewrite import is_constant, negated, rebuild


def eliminate_zeros(program: Program) -> Program:
    """Apply ``x + 0 = x``, ``0 x = 0``, ``1 x = x``, ``x - x = 0`` and their like."""
    return rebuild(program, without_zeros)


def without_zeros(builder: Builder, instruction: Instruction) -> int | None:
    """What an operation with zero or one leaves: a rule of `rebuild`."""
    match instruction.op:
        case Op.ADD:
            first, second = instruction.operands
            if is_constant(builder, first, 0):
                return second
            if is_constant(builder, second, 0):
                return first
        case Op.SUBTRACT:
            first, second = instruction.operands
            if first == second:
                return builder.constant(0)
            if is_constant(builder, second, 0):
                return first
            if is_constant(builder, first, 0):
                return negated(builder, second)
        case Op.MULTIPLY:
            return _product(builder, instruction)
        case Op.DIVIDE:
            first, second = instruction.operands
            if is_constant(builder, first, 0) or is_constant(builder, second, 1):
                return first
        case Op.FMA:
            return _fused(builder, instruction)
        case Op.SELECT:
            first, second, chosen, other = instruction.operands
            if chosen == other or first == second:
                return other
        case Op.NEGATE:
            return negated(builder, instruction.operands[0])
    return None


def _fused(builder: Builder, instruction: Instruction) -> int | None:
    """Leave what a zero or a one makes of ``a b + c``."""
    first, second, addend = instruction.operands
    if is_constant(builder, addend, 0):
        return _placed(builder, Instruction(Op.MULTIPLY, (first, second)))
    for factor, other in ((first, second), (second, first)):
        if is_constant(builder, factor, 0):
            return addend
        if is_constant(builder, factor, 1):
            return _placed(builder, Instruction(Op.ADD, (other, addend)))
        if is_constant(builder, factor, -1):
            return _placed(builder, Instruction(Op.SUBTRACT, (addend, other)))
    return None


def _placed(builder: Builder, instruction: Instruction) -> int:
    position = without_zeros(builder, instruction)
    return builder.append(instruction) if position is None else position


def _product(builder: Builder, instruction: Instruction) -> int | None:
    for factor, other in (instruction.operands, instruction.operands[::-1]):
        if is_constant(builder, factor, 0):
            return factor
        if is_constant(builder, factor, 1):
            return other
        if is_constant(builder, factor, -1):
            return negated(builder, other)
    return None


def compress(program: Program) -> Program:
    """Drop the entries of matrix outputs that are exactly zero from their patterns; vectors stay full."""
    return replace(program, outputs=tuple(_compressed(program, output) for output in program.outputs))


def _compressed(program: Program, output: Output) -> Output:
    pattern = output.sparsity
    if pattern.ncol == 1:
        return output
    kept = [
        (entry, value)
        for entry, value in zip(pattern.entries(), output.values, strict=True)
        if not _is_zero(program.instructions[value])
    ]
    sparsity = Sparsity.of_entries(pattern.nrow, pattern.ncol, [entry for entry, _ in kept])
    return Output(output.name, sparsity, tuple(value for _, value in kept))


def _is_zero(instruction: Instruction) -> bool:
    return instruction.constant is not None and instruction.constant.is_zero
