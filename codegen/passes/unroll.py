"""Write loops out: every instance in the place of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from codegen.ir.builder import Builder
from codegen.ir.inline import inline
from codegen.ir.looped import GEOMETRY, Axis, Loop, Looped, Segment, places
from codegen.ir.ops import Constant
from codegen.ir.program import Output, Program, Sparsity
from codegen.passes.pipeline import simplify


def unroll(looped: Looped) -> Program:
    """Give the program that evaluates all instances; what the table of a loop says is constant. Not simplified."""
    builder = Builder()
    entries: dict[str, dict[tuple[int, int], int]] = {name: {} for name in looped.shapes}
    for loop in looped.loops:
        for instance in range(loop.count):
            program = _copy(loop.program, instance)
            found = inline(builder, program, _reader(builder, loop, instance))
            for name, values in found.items():
                rows, columns = (places(axis, instance) for axis in loop.outputs[name])
                entries[name] |= {(rows[row], columns[column]): value for (row, column), value in values.items()}
    outputs = []
    for name, (nrow, ncol) in looped.shapes.items():
        sparsity = Sparsity.of_entries(nrow, ncol, entries[name])
        outputs.append(Output(name, sparsity, tuple(entries[name][place] for place in sparsity.entries())))
    return builder.freeze(looped.arguments, tuple(outputs), dict(looped.legend))


def _copy(program: Program, instance: int) -> Program:
    """The program with names of its own for an instance but the first."""
    if instance == 0:
        return program
    named = (
        i._replace(label=(f"{i.label[0]}_copy_{instance + 1}", i.label[1])) if i.label else i
        for i in program.instructions
    )
    return replace(program, instructions=tuple(named))


def _reader(builder: Builder, loop: Loop, instance: int) -> Callable[[str, int], int]:
    own = {name: places(axis, instance) for name, axis in loop.arguments.items()}

    def read(argument: str, index: int) -> int:
        if argument == GEOMETRY:
            return builder.constant(loop.geometry[instance][index])
        return builder.input(argument, own[argument][index])

    return read


def unroll_short(looped: Looped, least: int) -> Looped:
    """Write loops of fewer instances than ``least`` out, as programs that are run once."""
    loops = [part for loop in looped.loops for part in (_apart(loop) if loop.count < least else [loop])]
    return replace(looped, loops=tuple(loops))


def _apart(loop: Loop) -> Iterator[Loop]:
    for instance in range(loop.count):
        arguments = {name: _moved(axis, instance) for name, axis in loop.arguments.items()}
        outputs = {
            name: (_moved(rows, instance), _moved(columns, instance)) for name, (rows, columns) in loop.outputs.items()
        }
        values = loop.geometry[instance]
        program = simplify(with_constants(loop.program, values)) if values else loop.program
        yield Loop(program, loop.kind, 1, arguments, outputs, ((),))


def with_constants(program: Program, values: Sequence[Constant]) -> Program:
    """Give the program with constants for its argument ``geometry``; not simplified."""
    builder = Builder()

    def read(argument: str, index: int) -> int:
        return builder.constant(values[index]) if argument == GEOMETRY else builder.input(argument, index)

    found = inline(builder, program, read)
    outputs = tuple(
        replace(output, values=tuple(found[output.name][place] for place in output.sparsity.entries()))
        for output in program.outputs
    )
    arguments = tuple(argument for argument in program.arguments if argument.name != GEOMETRY)
    return builder.freeze(arguments, outputs, dict(program.legend))


def _moved(axis: Axis, instance: int) -> Axis:
    return tuple(Segment(segment.length, segment.place(instance), segment.stride) for segment in axis)
