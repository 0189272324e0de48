"""The parameters of a routine: shapes, layouts, frames and units, in the words of the C ABI."""

from __future__ import annotations

from codegen.emit.routine import Member, Parameter, Routine, Subject, Words
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result


def parameters(routine: Routine, dense: bool, program: Program | Looped | None = None) -> tuple[Parameter, ...]:
    """Describe the parameters of a routine, in the order of its signature.

    Args:
        routine: for its subject, the arguments it uses and the patterns of its outputs.
        dense: whether matrix outputs are stored dense.
        program: in the place of the routine's own.
    """
    program, prepared = program or routine.program, routine.prepared_members
    inputs = tuple(_input(argument, routine.subject, prepared) for argument in program.used_arguments())
    return inputs + tuple(_output(output, routine.subject, dense, prepared) for output in program.outputs)


def _input(argument: Argument, subject: Subject, prepared: tuple[Member, ...]) -> Parameter:
    words = Words("body", "mixed", prepared) if argument.name == "prepared" else subject.argument(argument)
    name, shape, length = argument.name, argument.shape, argument.length
    return Parameter(name, "in", shape, length, "column-major", words.frame, words.unit, words.members, words.repeats)


def _output(output: Result, subject: Subject, dense: bool, prepared: tuple[Member, ...]) -> Parameter:
    pattern = output.sparsity
    if output.name == "prepared":
        shape = (pattern.nrow, 1)
        return Parameter(output.name, "out", shape, pattern.nrow, "column-major", "body", "mixed", prepared)
    words = subject.output(output)
    stored_dense = dense or pattern.ncol == 1
    length = pattern.nrow * pattern.ncol if stored_dense else pattern.nonzeros
    layout = "column-major" if stored_dense else "compressed-columns"
    shape = (pattern.nrow, pattern.ncol)
    return Parameter(output.name, "out", shape, length, layout, words.frame, words.unit, words.members, words.repeats)
