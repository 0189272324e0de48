"""Lay the program of a loop out for a routine that gets pointers: an array for each segment, nonzeros as they lie."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from codegen.ir.looped import GEOMETRY, Loop, Looped
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.passes.drop_unused import drop_unused


@dataclass(frozen=True, slots=True)
class Piece:
    """An array of an instance, and where it lies.

    Attributes:
        name: in the flat program.
        array: in the whole.
        first: its first entry among those of the array of an instance.
        length: number of entries.
        start: place of its first entry in the whole, for the first instance.
        stride: entries from one instance to the next.
    """

    name: str
    array: str
    first: int
    length: int
    start: int
    stride: int


@dataclass(frozen=True, slots=True)
class Flat:
    """The program of an instance over pieces.

    Attributes:
        program: its arguments and outputs are full vectors.
        inputs: its arguments, in order, but for ``geometry``.
        outputs: its outputs, in order.
    """

    program: Program
    inputs: tuple[Piece, ...]
    outputs: tuple[Piece, ...]


def flatten(looped: Looped, loop: Loop) -> Flat:
    """Give the flat program of a loop; outputs without nonzeros are left out."""
    inputs = [piece for argument in loop.program.arguments for piece in _inputs(loop, argument.name)]
    outputs = [piece for output in loop.program.outputs for piece in _outputs(looped, loop, output.name)]
    program = drop_unused(_flat(loop.program, inputs, outputs))
    used = {argument.name for argument in program.used_arguments()}
    return Flat(program, tuple(piece for piece in inputs if piece.name in used), tuple(outputs))


def _inputs(loop: Loop, name: str) -> Iterator[Piece]:
    first = 0
    for number, segment in enumerate(loop.arguments.get(name, ())):
        yield Piece(_name(name, number), name, first, segment.length, segment.start, segment.stride)
        first += segment.length


def _outputs(looped: Looped, loop: Loop, name: str) -> Iterator[Piece]:
    for number, block in enumerate(looped.blocks(loop, name)):
        entries = block.entries
        yield Piece(_name(name, number), name, entries.start, len(entries), block.start, block.stride)


def _name(name: str, number: int) -> str:
    return f"{name}_{number + 1}" if number else name


def _flat(program: Program, inputs: list[Piece], outputs: list[Piece]) -> Program:
    sources = {(p.array, p.first + k): (p.name, k) for p in inputs for k in range(p.length)}
    instructions = tuple(
        i if i.source is None or i.source[0] == GEOMETRY else i._replace(source=sources[i.source])
        for i in program.instructions
    )
    arguments = [a for a in program.arguments if a.name == GEOMETRY]
    arguments += [Argument(piece.name, (piece.length, 1)) for piece in inputs]
    values = {output.name: output.values for output in program.outputs}
    stored = tuple(
        Output(piece.name, _full(piece.length), values[piece.array][piece.first : piece.first + piece.length])
        for piece in outputs
    )
    return Program(tuple(arguments), instructions, stored, program.legend)


def _full(length: int) -> Sparsity:
    return Sparsity(length, 1, (0, length), tuple(range(length)))
