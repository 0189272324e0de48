"""Take sines and cosines of input angles as inputs: for callers that know them, from a table or from the last step."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Instruction, Program
from codegen.passes.drop_unused import drop_unused
from codegen.passes.rewrite import rebuild

SINES_COSINES = "sines_cosines"
"""Name of the argument [2, n]: sine and cosine of each entry of the angles' argument."""

_PLACES = {Op.SIN: 0, Op.SINE_OF: 0, Op.COS: 1, Op.COSINE_OF: 1}


def given_trigonometry(program: Program, angles: str = "alpha") -> Program:
    """Replace the sine and cosine of every entry of an argument by inputs.

    Args:
        program: what to rebuild; given back as it is where it takes no such sine or cosine.
        angles: name of the argument that holds the angles, rad.
    """
    source = next((argument for argument in program.arguments if argument.name == angles), None)
    if source is None:
        return program
    found = False

    def place(builder: Builder, instruction: Instruction) -> int:
        nonlocal found
        index = _angle(builder, instruction, angles)
        if index is None:
            return builder.append(instruction)
        found = True
        return builder.input(SINES_COSINES, 2 * index + _PLACES[instruction.op])

    rebuilt = rebuild(program, place)
    if not found:
        return program
    position = program.arguments.index(source) + 1
    arguments = list(program.arguments)
    arguments.insert(position, Argument(SINES_COSINES, (2, source.length)))
    return drop_unused(replace(rebuilt, arguments=tuple(arguments)))


def _angle(builder: Builder, instruction: Instruction, angles: str) -> int | None:
    """Index of the angle of which this is the sine or cosine; None for anything else."""
    if instruction.op not in _PLACES:
        return None
    operand = builder.instructions[instruction.operands[0]]
    if operand.op is Op.SINCOS:
        operand = builder.instructions[operand.operands[0]]
    if operand.op is Op.INPUT and operand.source is not None and operand.source[0] == angles:
        return operand.source[1]
    return None
